"""The study of a flyover: its files and what it prints."""

from __future__ import annotations

import csv
import dataclasses
import re
from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest

pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    module = import_study("flyover")
    module.FLIGHT = dataclasses.replace(module.FLIGHT, duration=20.0)
    module.ARC = np.linspace(-90.0, 90.0, 7)
    return module


@pytest.mark.slow  # a flyover by the command is heard in tests/commands
def test_files_and_levels(study, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("sys.argv", ["flyover.py", "--output", str(tmp_path)])
    study.main()
    assert {file.name for file in tmp_path.iterdir()} == {
        "levels_dba.csv", "levels.png", "hemisphere.png"
    }  # fmt: skip
    with (tmp_path / "levels_dba.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) in (39, 40)  # 20 s in steps of 0.5 s, whole ones between the ends
    total = np.array([float(row["total"]) for row in rows])
    assert np.all(total > [float(row["loading"]) for row in rows])
    # Bubbles at these Reynolds numbers leave thicker boundary layers than trips do, and are louder.
    assert 1.0 < total.max() - max(float(row["total, tripped"]) for row in rows) < 4.0
    (printed,) = (one for one in capsys.readouterr().out.splitlines() if one.startswith("total: "))
    loudest, sel = (float(one) for one in re.findall(r"(?:LAmax|SEL) ([\d.]+) dBA", printed))
    assert loudest == pytest.approx(total.max(), abs=0.06)  # both are rounded
    exposure = 10 * np.log10(np.sum(10 ** (total / 10)) * study.STEP)
    assert sel == pytest.approx(exposure, abs=0.06)
