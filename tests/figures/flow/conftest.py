"""A rotor in axial flight and at an incidence, coarse."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

import propmdao as pm
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
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


@pytest.fixture(scope="session")
def marched(edgewise):
    """The same as if it had been marched for two revolutions, with a wake of random numbers."""
    loads = edgewise.loads
    fields = {field.name: getattr(loads, field.name) for field in dataclasses.fields(loads)}
    wakes = jnp.asarray(np.random.default_rng(1).random((3, 2, 6, 4, 3)))
    of_march = MarchedLoads(
        **fields,
        thrust_history=jnp.ones(16),
        torque_history=jnp.ones(16),
        change=jnp.zeros(1),
        settled=jnp.asarray(True),
        wake=wakes[2],
        wake_age=jnp.array([0.0, 0.5, 1.0, 2.0]),
        snapshots=wakes[:2],
        snapshot_azimuth=jnp.array([np.pi, 2.0 * np.pi]),
        average=2,
    )
    return dataclasses.replace(edgewise, loads=of_march)
