"""A blade of a few strips, in hover and about the size of an 11 inch propeller."""

from __future__ import annotations

from collections.abc import Callable

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.rotor import StripFlow
from propmdao.acoustics.broadband.section import Section


@pytest.fixture(scope="session")
def section() -> Callable[..., Section]:
    """Make a section; chord, span, speed, angle [deg], edge thickness, edge angle [deg]."""

    def make(chord=0.02, span=0.01, speed=40.0, degrees=4.0, edge=1e-4, edge_degrees=10.0):
        angles = np.radians(degrees), np.radians(edge_degrees)
        values = (chord, span, speed, angles[0], edge, angles[1])
        return Section(*(jnp.asarray(v, float) for v in values))

    return make


@pytest.fixture(scope="session")
def strips() -> StripFlow:
    r = np.linspace(0.04, 0.135, 6)
    beta = np.arctan2(0.02, r)
    chord_direction = np.stack([0 * r, -np.cos(beta), -np.sin(beta)], axis=-1)
    chord = 0.03 - 0.1 * r
    section = Section(
        chord=jnp.asarray(chord),
        span=jnp.full(6, 0.019),
        speed=jnp.asarray(440.0 * r),
        angle_of_attack=jnp.linspace(0.15, 0.04, 6),
        trailing_edge_thickness=jnp.full(6, 2e-4),
        trailing_edge_angle=jnp.full(6, 0.2),
    )
    return StripFlow(
        position=jnp.asarray(
            np.stack([r, 0 * r, 0 * r], axis=-1) + 0.75 * chord[:, None] * chord_direction
        ),
        chord_direction=jnp.asarray(chord_direction),
        span_direction=jnp.asarray(np.tile([1.0, 0.0, 0.0], (6, 1))),
        section=section,
    )
