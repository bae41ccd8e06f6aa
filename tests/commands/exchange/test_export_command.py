"""``propmdao export``: what it writes is read back, what it cannot write is refused."""

from __future__ import annotations

import csv
import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared_mesh import COARSE

from propmdao.analysis import single_point
from propmdao.commands.program import main
from propmdao.formats.propellers import load_propeller
from propmdao.formats.wopwop.cases import read_cases
from propmdao.propeller.airfoils.coordinate_files import read_coordinates

PROPELLER = "apcsf_11x4.7"


def export(path: Path, *arguments: str) -> int:
    return main(["export", PROPELLER, "--to", str(path), *arguments])


def test_a_propeller_file_is_the_propeller(tmp_path: Path) -> None:
    assert export(tmp_path / "mine.toml") == 0
    mine, shipped = load_propeller(tmp_path / "mine.toml"), load_propeller(PROPELLER)
    np.testing.assert_array_equal(mine.beta_deg, shipped.beta_deg)
    assert mine.source == shipped.source


def test_a_turned_blade_says_so(tmp_path: Path) -> None:
    assert export(tmp_path / "mine.toml", "--twist-offset", "-1.5") == 0
    mine, shipped = load_propeller(tmp_path / "mine.toml"), load_propeller(PROPELLER)
    np.testing.assert_allclose(mine.beta_deg, shipped.beta_deg - 1.5)
    assert mine.source == f"{shipped.source} Changed: blade angle -1.5 deg everywhere."


def test_distributions_are_columns(tmp_path: Path) -> None:
    assert export(tmp_path / "blade.csv") == 0
    with (tmp_path / "blade.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    propeller = load_propeller(PROPELLER)
    assert [float(row["r_over_R"]) for row in rows] == propeller.r_over_R.tolist()
    radius = 0.5 * propeller.diameter
    np.testing.assert_allclose([float(r["chord_m"]) for r in rows], radius * propeller.c_over_R)
    camber, _ = propeller.sections()
    np.testing.assert_allclose([float(r["camber_over_chord"]) for r in rows], camber.max(axis=1))


def test_a_section_is_read_back_as_it_was(tmp_path: Path) -> None:
    propeller = load_propeller(PROPELLER)
    station = 7
    assert export(tmp_path / "s.dat", "--section", str(propeller.r_over_R[station])) == 0
    read = read_coordinates(tmp_path / "s.dat")
    camber, thickness = (shape[station] for shape in propeller.sections())
    if propeller.thickness_over_chord is not None:
        thickness = thickness * propeller.thickness_over_chord[station] / thickness.max()
    # Seven digits in the file; reading turns the chord into the line to the farthest point.
    np.testing.assert_allclose(read.camber, camber, atol=2e-4)
    np.testing.assert_allclose(read.thickness, thickness, atol=2e-4)


def test_a_surface_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert export(tmp_path / "BLADE.STL") == 0
    n = (len((tmp_path / "BLADE.STL").read_bytes()) - 84) // 50
    assert f"{n} triangles, metres" in capsys.readouterr().out
    assert export(tmp_path / "mm.stl", "--units", "mm") == 0
    assert f"{n} triangles, millimetres" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize("name", ["case", "case_5269.99"])
def test_a_case_of_psu_wopwop_is_read_again(tmp_path: Path, name: str) -> None:
    """An ending that is no format, as a rotation speed in the name, belongs to the folder."""
    assert export(tmp_path / name, *"--rpm 4200 --speed 8 --arc 1.905 -45 0".split()) == 0
    (case,) = read_cases(tmp_path / name)
    assert len(case.observers) == 2 and len(case.containers) == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--to b.iges", "there is no export to '.iges'; a file ends in .stl, .step, .stp, .toml"),
        ("--to no/b.stl", "there is no folder no"),
        ("--to b.dat", "a .dat or .txt file is of one section"),
        ("--to b.csv --section 0.5", "a .dat or .txt file is of one section"),
        ("--to b.dat --section 0.01", "r_over_R must be within the blade's stations"),
        ("--to b.stl --rpm 4000", "a .stl file holds no loads"),
        ("--to b.csv --units mm", "--units is of an .stl file"),
        ("--to case --rpm 4000 --units mm", "--units is of an .stl file"),
        ("--to b.stl --hub 30 10", "--hub is of a .step file"),
        ("--to b.txt --section 0.7", "a .txt file is of one Reynolds number"),
        ("--to case", "it needs --rpm or --thrust"),
        ("--to case --rpm 4000", "a PSU-WOPWOP case needs observers"),
        ("", "required: --to"),
    ],
)
def test_what_is_not_written(
    refused: Callable[..., str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: str,
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert message in refused("export", PROPELLER, *arguments.split())
    assert list(tmp_path.iterdir()) == []


def test_a_folder_is_no_file(refused: Callable[..., str], tmp_path: Path) -> None:
    (tmp_path / "blade.toml").mkdir()
    assert "it is a folder" in refused("export", PROPELLER, "--to", str(tmp_path / "blade.toml"))


def test_loads_that_did_not_converge_say_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As analyze does: the case is written, exit status 0, and its reader is warned."""
    analyze = single_point.analyze

    def unconverged(*values: Any, **asked: Any) -> Any:
        analysis = analyze(*values, **asked, fidelity=COARSE)
        loads = dataclasses.replace(analysis.loads, converged=np.asarray(False))
        return dataclasses.replace(analysis, loads=loads)

    arguments = "--rpm 4200 --speed 8 --arc 1.905 -45 0".split()
    monkeypatch.setattr(single_point, "analyze", unconverged)
    assert export(tmp_path / "case", *arguments) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "NOT CONVERGED at 4200.0 rpm, do not use these numbers: thrust" in out
    monkeypatch.setattr(single_point, "analyze", lambda *a, **k: analyze(*a, **k, fidelity=COARSE))
    assert export(tmp_path / "case", *arguments) == 0
    assert "CONVERGED" not in capsys.readouterr().out
