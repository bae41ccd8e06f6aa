"""Studies of mesh, time step and revolutions: what they vary, and what does not depend on it."""

from __future__ import annotations

import csv
import dataclasses
import sys

import pytest

pytest.importorskip("matplotlib")

from propmdao.records.fidelity import Fidelity, Marching
from propmdao.records.wake_law import WakeGrid

TESTED = Fidelity(
    n_chordwise=2,
    n_spanwise=5,
    n_contour=9,
    n_surface_span=6,
    n_harmonics=3,
    period_wake=WakeGrid(2.0, 4.0, 1.5, 30.0),
)
SCHEDULE = Marching(timestep_deg=30.0, start="impulsive")
STEADY = dataclasses.replace(SCHEDULE, start="steady")


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_mesh_of_the_thesis_is_a_surface_and_half_of_it_a_lattice(import_study):
    spatial = import_study("spatial_convergence")
    mesh = spatial.mesh_of(65, 80)
    assert (mesh.n_contour, mesh.n_surface_span) == (65, 80)
    assert (mesh.n_chordwise, mesh.n_spanwise) == (32, 79)
    assert len(spatial.MESHES) == 10 and spatial.MESHES[7] == (65, 80)


@pytest.mark.slow
def test_spatial_study_writes_table_and_figures(import_study, monkeypatch, capsys, tmp_path):
    spatial = import_study("spatial_convergence")
    monkeypatch.setattr(spatial, "DEFAULT", TESTED)
    monkeypatch.setattr(
        spatial, "mesh_of", lambda w, u: dataclasses.replace(TESTED, n_spanwise=u // 8)
    )
    folder = tmp_path / "spatial"
    monkeypatch.setattr(sys, "argv", ["spatial_convergence.py", "--quick", "--output", str(folder)])
    spatial.main()
    rows = rows_of(folder / "spatial.csv")
    assert [row["mesh"] for row in rows] == ["default", "25 x 40", "33 x 50"]
    thrust = [float(row["thrust, N"]) for row in rows]
    assert thrust[0] == pytest.approx(thrust[1], rel=1e-12)  # the same lattice
    assert thrust[2] != thrust[0] and all(0.4 < value < 0.6 for value in thrust)
    assert all(float(row["run time, s"]) > 0.0 for row in rows)
    assert {path.name for path in folder.iterdir()} == {"spatial.csv", "thrust.png", "oaspl.png"}
    assert "From lowest to highest: thrust" in capsys.readouterr().out


def test_spread_is_from_the_quietest_to_the_loudest(import_study):
    study = import_study("discretisation")
    rows = [
        {f"total {elevation:g}, dB": level + k for k, elevation in enumerate(study.ELEVATION_DEG)}
        for level in (50.0, 50.5, 49.75)
    ]
    assert study.spreads_db(rows) == [0.75] * 3


@pytest.mark.slow
def test_thickness_noise_does_not_depend_on_time_and_revolutions_settle(import_study):
    revolutions = import_study("revolutions")
    three, four = revolutions.compare((3, 4), SCHEDULE, TESTED)
    assert (three["revolutions"], four["revolutions"]) == (3, 4)
    assert three["thickness -45, dB"] == pytest.approx(four["thickness -45, dB"], abs=1e-9)
    # The start has more thrust: without wake there is no downwash.
    assert three["thrust, N"] > four["thrust, N"] > four["last turn, N"]
    (row,) = import_study("temporal_convergence").compare((30.0,), STEADY, TESTED)
    assert row["thrust, N"] == pytest.approx(four["last turn, N"], rel=0.02)


def test_time_steps_divide_the_march(import_study):
    temporal = import_study("temporal_convergence")
    assert temporal.TIMESTEPS_DEG[0] == 3.0 and all(
        Marching(timestep_deg=step).n_steps > 0 for step in temporal.TIMESTEPS_DEG
    )


@pytest.mark.slow
def test_forces_that_are_straight_between_time_steps_are_heard(import_study):
    temporal = import_study("temporal_convergence")
    (row,) = temporal.compare((30.0,), STEADY, TESTED)
    # From the steady wake every revolution has the same thrust.
    assert row["thrust, N"] == pytest.approx(row["last turn, N"], rel=1e-3)
    # Nothing but the tones of steady loads is heard, unless forces are straight between steps of
    # 30 deg: what is smooth has corners then.
    assert row["total -45, dB"] == pytest.approx(row["BPF -45, dB"], abs=0.05)
    assert 0.2 < row["straight -45, dB"] - row["loading -45, dB"] < 3.0
