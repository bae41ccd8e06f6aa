"""Sections of the lattice: where they are, and their zero-lift angle by the lattice itself."""

import numpy as np
import pytest

from propmdao.aerodynamics.lattice.rings import vortex_rings
from propmdao.aerodynamics.lattice.strips import blade_strips
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes, strip_radii
from propmdao.propeller.description import Propeller

R = np.array([0.2, 0.6, 1.0])


def strips_of(airfoil, beta_deg=(30.0, 20.0, 12.0), n=16):
    propeller = Propeller("x", 0.3, 2, R, [0.2, 0.2, 0.1], list(beta_deg), [(0.2, airfoil)])
    span = lattice_interpolation(R, n)
    nodes = lattice_nodes(Blade.from_propeller(propeller), span, 8)
    return blade_strips(nodes, vortex_rings(nodes), 0.15)


def test_sections_lie_where_the_polars_are_made_for():
    strips = strips_of("naca2412")
    np.testing.assert_allclose(strips.r_over_R, strip_radii(0.2, 16), rtol=1e-12)
    np.testing.assert_allclose(strips.radius, 0.15 * strips.r_over_R, rtol=1e-12)
    np.testing.assert_allclose(strips.width.sum(), 0.8 * 0.15, rtol=1e-3)


def test_chord_line_has_the_blade_angle():
    strips = strips_of("naca2412", beta_deg=(18.0, 18.0, 18.0))
    beta = np.degrees(np.arctan2(-strips.backward[:, 2], -strips.backward[:, 1]))
    np.testing.assert_allclose(beta, 18.0, rtol=1e-9)
    # The suction side looks toward thrust.
    np.testing.assert_allclose(strips.upward[:, 2], np.cos(np.radians(18.0)), rtol=1e-9)


@pytest.mark.parametrize(("airfoil", "angle"), [("naca0010", 0.0), ("naca4412", -4.155)])
def test_zero_lift_angle_is_that_of_thin_airfoil_theory(airfoil, angle):
    strips = strips_of(airfoil)
    # Eight cosine panels.
    np.testing.assert_allclose(np.degrees(strips.zero_lift_angle), angle, atol=0.06)
