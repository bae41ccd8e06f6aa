"""The study of blades that give: its table, and the frequency that tests stiffness and mass."""

from __future__ import annotations

import csv
import dataclasses
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from propmdao.formats.propellers import load_propeller
from propmdao.formats.toml_files import write_toml
from propmdao.records.fidelity import Fidelity
from propmdao.records.models import ElasticModel


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("blade_deflection")


@pytest.mark.slow
def test_blades_are_compared_rigid_and_elastic(
    study: ModuleType,
    coarsest: Fidelity,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
):
    blade = dataclasses.replace(
        load_propeller("apcsf_11x4.7"), youngs_modulus=20e9, material_density=1700.0
    )
    write_toml(tmp_path / "blade.toml", blade)
    monkeypatch.setattr(study, "COARSE", coarsest)
    arguments = [str(tmp_path / "blade.toml"), "--rpm", "2500", "5000", "--output", str(tmp_path)]
    monkeypatch.setattr(sys, "argv", ["blade_deflection.py", *arguments])
    study.main()
    with (tmp_path / "apcsf_11x4.7.csv").open() as stream:
        slow, fast = csv.DictReader(stream)
    # Measured at UIUC: 0.1042 at 2556 rpm, 0.1209 at 5175 rpm.
    assert 0.1020 < float(slow["measured"]) < 0.1059 and 0.119 < float(fast["measured"]) < 0.121
    assert 0.0 < float(slow["tip"]) < float(fast["tip"])
    assert float(fast["elastic"]) != pytest.approx(float(fast["rigid"]), rel=1e-3)
    shown = capsys.readouterr().out
    assert "gain of CT" in shown and "lowest bending frequency" in shown


def test_the_material_scales_the_frequency(study: ModuleType):
    blade = load_propeller("apce_10x7")
    light, heavy = (
        study.bending_frequency(blade, ElasticModel(youngs_modulus=18e9, material_density=density))
        for density in (1000.0, 4000.0)
    )
    assert light == pytest.approx(2.0 * heavy, rel=1e-6)
    assert 100.0 < heavy < light < 1000.0  # [Hz]
