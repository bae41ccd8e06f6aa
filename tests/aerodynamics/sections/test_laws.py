"""What sections are held to: stall delay adds where a section stalls, and nowhere else."""

from functools import partial

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.lattice.rings import vortex_rings
from propmdao.aerodynamics.lattice.strips import blade_strips
from propmdao.aerodynamics.sections.laws import section_laws, viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import (
    lattice_interpolation,
    lattice_nodes,
    strip_interpolation,
)
from propmdao.records.air import Air
from propmdao.runtime.compilation import compiled

NC, NS, OMEGA = 4, 10, 440.0


def laws(name, delay):
    propeller = load_propeller(name)
    stations, blade = propeller.r_over_R, Blade.from_propeller(propeller)
    nodes = lattice_nodes(blade, lattice_interpolation(stations, NS), NC)
    at = strip_interpolation(stations, NS)
    sections = viscous_sections(polars_for(propeller), blade, at, delay)
    return laws_of(nodes, 0.5 * propeller.diameter, sections)


@partial(compiled, optimisation=0)
def laws_of(nodes, radius, sections):
    strips = blade_strips(nodes, vortex_rings(nodes), radius)
    air = Air(density=1.2, sound_speed=340.0)
    speed = jnp.hypot(OMEGA * strips.radius, 8.0)
    tip_speed = OMEGA * radius
    return section_laws(strips, speed, tip_speed / jnp.hypot(tip_speed, 8.0), air, sections)


@partial(compiled, optimisation=0)
def beyond_thin(laws, angle):
    return laws.beyond_thin(angle)


@pytest.fixture(scope="module", params=["apcsf_11x4.7_uiuc", "apce_10x7_uiuc"])
def both(request):
    """Laws in two dimensions, and on the rotating blade."""
    return laws(request.param, 0.0), laws(request.param, 1.0)


def test_rotation_adds_nothing_in_attached_flow(both):
    flat, turning = both
    attached = -0.5 * flat.zero_lift_angle
    for two_dimensional, rotating in zip(
        beyond_thin(flat, attached), beyond_thin(turning, attached), strict=True
    ):
        np.testing.assert_allclose(rotating, two_dimensional, atol=1e-12)


def test_rotation_adds_lift_and_drag_past_stall(both):
    flat, turning = both
    stalled = jnp.full(NS, np.radians(18.0))
    (lift, drag), (more_lift, more_drag) = (beyond_thin(q, stalled) for q in (flat, turning))
    inboard = slice(0, NS // 2)
    assert (more_lift - lift)[inboard].min() > 0.1
    np.testing.assert_allclose(
        more_drag - drag, (more_lift - lift) * np.tan(np.radians(18.0)), rtol=1e-9
    )


def test_lift_that_the_boundary_layer_takes_off_camber_is_no_stall(both):
    flat, turning = both
    # At the Reynolds numbers of the outer half: one to three degrees.
    lost = np.degrees(turning.potential_zero_lift_angle - flat.zero_lift_angle)[NS // 2 :]
    assert lost.min() > 0.5 and lost.max() < 4.0
