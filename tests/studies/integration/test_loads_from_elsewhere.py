"""The study that takes loads from a table: its numbers are those of other ways to them."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.sources.rotors import rotor_histories
from propmdao.analysis.wopwop.foreign_case import run_case
from propmdao.commands.exchange.wopwop_command import levels
from propmdao.records.air import Air

AIR, DISTANCE = Air(density=1.226, sound_speed=340.0), 30.48


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("loads_from_elsewhere")


def printed(
    study: ModuleType, capsys: pytest.CaptureFixture[str], *arguments: str
) -> tuple[str, dict[float, list[str]]]:
    """Return the first line and the cells of the table by elevation."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["loads_from_elsewhere.py", *arguments])
        study.main()
    first, *lines = capsys.readouterr().out.splitlines()
    rows = [
        line.split() for line in lines if line.strip() and line.split()[0].lstrip("-").isdigit()
    ]
    return first, {float(row[0]): row[1:] for row in rows}


def decibels(pressure: np.ndarray) -> float:
    return float(20 * np.log10(np.std(pressure) / 20e-6))


def test_default_table_and_its_levels_by_marching(study, capsys):
    first, rows = printed(study, capsys)
    assert first == "2 blades at 1400 rpm: thrust 562.4 N, torque 47.05 N m"
    # nothing on the axis
    assert rows[-90.0] == ["-"] * 5
    rotor = study.make_rotor(
        study.read_blade(study.HERE / "loads_from_elsewhere.csv"), [0, 180], 1400
    )
    t = np.arange(512) * 60 / 1400 / 512
    places = Observers(jnp.asarray(arc(DISTANCE, [-45.0, 0.0, 45.0])), jnp.zeros(3))
    heard = rotor_histories([rotor], places, t, AIR)
    for i, elevation in enumerate((-45.0, 0.0, 45.0)):
        _, thickness, loading, total, _ = map(float, rows[elevation])
        assert thickness == pytest.approx(decibels(heard.parts["thickness"][i]), abs=0.06)
        assert loading == pytest.approx(decibels(heard.parts["loading"][i]), abs=0.06)
        assert total == pytest.approx(decibels(heard.total[i]), abs=0.06)


def test_unequal_blades_sound_at_multiples_of_the_rotation(study, capsys):
    _, equal = printed(study, capsys)
    _, unequal = printed(study, capsys, "--azimuths", "0", "170")
    assert float(equal[-45.0][0]) > 60.0
    assert 40.0 < float(unequal[-45.0][0]) < 60.0  # at half of that frequency
    assert float(unequal[-45.0][3]) == pytest.approx(float(equal[-45.0][3]), abs=0.6)


def test_the_case_for_psu_wopwop_has_the_same_loading_noise(study, capsys, tmp_path):
    _, rows = printed(study, capsys, "--wopwop", str(tmp_path), "--elevations", "-45", "10")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        groups = levels(run_case(tmp_path))
    for elevation, group in zip((-45.0, 10.0), groups, strict=True):
        level = group["observers"][0]["oaspl_loading_db"]
        assert float(rows[elevation][2]) == pytest.approx(level, abs=0.06)


@pytest.mark.validation
def test_levels_are_those_of_anopp2(study, capsys, reference_data: Path):
    """Climbing at 5 m/s, microphone flying along; levels of the first blade passage."""
    path = reference_data / "f1a" / "anopp2" / "apth_rpm1400_const_vel_theta-45.csv"
    record = np.genfromtxt(path, delimiter=",", names=True)
    passage = record["t_s"] - record["t_s"][0] < 30.0 / 1400
    _, rows = printed(study, capsys, "--speed", "5", "--elevations", "-45")
    for cell, name in zip(rows[-45.0][1:3], ("p_monopole_Pa", "p_dipole_Pa"), strict=True):
        assert float(cell) == pytest.approx(decibels(record[name][passage]), abs=0.1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("r_m,length_m\n1,2\n", "no column thrust_n_per_m; there are r_m, length_m"),
        (
            "r_m,length_m,thrust_n_per_m,drag_n_per_m\n1,0.1,2,3\n2,0.1,x,3\n",
            "thrust_n_per_m must be a number in every row; row 2 has none",
        ),
        ("a,b\n1\n1,2,3\n", "not a table of loads"),
    ],
)
def test_tables_that_are_none(study, tmp_path, text, message):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(SystemExit, match=message):
        study.read_blade(tmp_path / "t.csv")


def test_what_the_physics_refuses_is_one_line(study, capsys):
    with pytest.raises(SystemExit, match="tip Mach number must be below 1"):
        printed(study, capsys, "--rpm", "5000")
