"""A rotor in axial flight and at an incidence, coarse."""

from __future__ import annotations

import pytest

import propmdao as pm
from propmdao.analysis.single_point import analyze
from propmdao.records.fidelity import Fidelity
from propmdao.records.wake_law import WakeGrid

COARSE = Fidelity(
    n_chordwise=2,
    n_spanwise=5,
    n_contour=9,
    n_surface_span=6,
    n_harmonics=3,
    n_azimuths=8,
    period_wake=WakeGrid(2.0, 2.0, 1.5, 40.0),
)


def coarse(**asked):
    flight = {"rpm": 4200.0, "speed": 8.0, "viscous": False, "fidelity": COARSE}
    return analyze(pm.load_propeller("apcsf_11x4.7"), **flight | asked)


@pytest.fixture(scope="session")
def edgewise():
    return coarse(incidence_deg=80.0)


@pytest.fixture(scope="session")
def axial():
    return coarse()
