"""The study of a flyover: what is heard from overhead is what is heard flying along."""

from __future__ import annotations

import csv
import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from propmdao.acoustics.levels import oaspl_db
from propmdao.analysis import Analysis, analyze

pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def study(checkout: Path) -> ModuleType:
    path = checkout / "studies" / "flyover.py"
    spec = importlib.util.spec_from_file_location("flyover_study", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.DURATION, module.ARC = 20.0, np.linspace(-90.0, 90.0, 7)
    return module


@pytest.fixture(scope="module")
def found(study) -> Analysis:
    """Of the study's flight, heard by somebody who flies along below."""
    return analyze(
        study.PROPELLER, thrust=study.THRUST, speed=study.SPEED, density=study.DENSITY,
        broadband=True, observers=[(study.HEIGHT, 0.0)],
    )  # fmt: skip


def level(mean_square) -> float:
    return float(10 * np.log10(np.sum(mean_square) / 4e-10))


def test_tones_from_overhead(study, found):
    # Half a second around: on 4 m of the way, at 20 m height, the level hardly changes.
    time, bands = study.tone_bands(found)
    overhead = np.abs(time) < study.STEP
    heard = [level(one) for one in bands["total"][overhead]]
    assert np.mean(heard) == pytest.approx(float(oaspl_db(found.tones.total)[0]), abs=0.2)


def test_broadband_noise_from_overhead(study, found):
    (heard,) = study.broadband_bands(found, np.zeros(1))
    # The Doppler shift of the sound that arrives at this moment moves energy between bands.
    assert level(heard) == pytest.approx(level(found.broadband.total[0]), abs=0.1)


def test_tripped_blades_shed_no_laminar_vortices(study, found):
    loud, quiet = (study.broadband_bands(found, np.zeros(1), trip) for trip in ("none", "heavy"))
    assert level(loud) - level(quiet) > 10.0


def test_files_and_levels(study, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("sys.argv", ["flyover.py", "--output", str(tmp_path)])
    study.main()
    assert {file.name for file in tmp_path.iterdir()} == {
        "levels_dba.csv", "levels.png", "hemisphere.png"
    }  # fmt: skip
    with (tmp_path / "levels_dba.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 40
    total = np.array([float(row["total"]) for row in rows])
    assert np.all(total > [float(row["loading"]) for row in rows])
    (printed,) = (one for one in capsys.readouterr().out.splitlines() if one.startswith("total: "))
    assert f"LAmax {total.max():.1f} dBA" in printed
    exposure = 10 * np.log10(np.sum(10 ** (total / 10)) * study.STEP)
    assert f"SEL {exposure:.1f} dBA" in printed
