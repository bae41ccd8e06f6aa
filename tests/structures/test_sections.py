"""Blades as beams: areas, inertias, elastic axis and torsion of known sections."""

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.propeller.description import Propeller
from propmdao.structures.beam import Material
from propmdao.structures.sections import beam_of, beam_radii, elastic_axis, filled

PLASTIC = Material(10e9, 4e9, 1500.0)
STATIONS = np.linspace(0.2, 1.0, 9)
CHORD, RADIUS = 0.02, 0.1


def propeller(airfoil="naca0012", beta_deg=0.0, **changes):
    values = {
        "name": "plank",
        "diameter": 2 * RADIUS,
        "n_blades": 2,
        "r_over_R": STATIONS,
        "c_over_R": np.full(9, CHORD / RADIUS),
        "beta_deg": np.full(9, beta_deg),
        "airfoils": [(1.0, airfoil)],
    }
    return Propeller(**values | changes)


def beam(described):
    return beam_of(Blade.from_propeller(described), beam_radii(described.r_over_R), PLASTIC)


def plate(described):
    """Sections of constant thickness, 5 % of the chord."""
    blade = Blade.from_propeller(described)
    flat = dataclasses.replace(
        blade,
        thickness_shape=jnp.ones_like(blade.thickness_shape),
        thickness_over_chord=jnp.full(9, 0.05),
    )
    return beam_of(flat, beam_radii(STATIONS), PLASTIC)


def test_a_plate_has_the_stiffness_of_a_plate():
    found, thick = plate(propeller()), 0.05 * CHORD
    np.testing.assert_allclose(found.areas.sum(axis=1), CHORD * thick, rtol=1e-10)
    inertia = (found.areas[..., None] * found.fibres**2).sum(axis=1)
    np.testing.assert_allclose(inertia[:, 0], CHORD**3 * thick / 12, rtol=1e-10)
    np.testing.assert_allclose(inertia[:, 1], CHORD * thick**3 / 12, rtol=1e-10)
    first = (found.areas[..., None] * found.fibres).sum(axis=1)
    np.testing.assert_allclose(first, 0.0, atol=1e-18)  # the elastic axis is in the middle
    thin = CHORD * thick**3 / 3
    np.testing.assert_allclose(found.torsion_constant, thin / (1 + 4 / 3 * 0.05**2), rtol=1e-10)
    # The exact constant of such a rectangle (Timoshenko and Goodier, 1970, section 109).
    assert found.torsion_constant[0] == pytest.approx(thin * (1 - 0.630 * 0.05), rel=0.03)


def test_an_ellipse_twists_as_saint_venant_has_it():
    """pi a^3 b^3 / (a^2 + b^2), to which the formula for thin sections is fitted."""
    blade = Blade.from_propeller(propeller())
    x = np.asarray(0.5 * (1 - np.cos(np.linspace(0, np.pi, 81))))
    shape = np.sqrt(np.maximum(1 - (2 * x - 1) ** 2, 0))
    ellipse = dataclasses.replace(
        blade,
        thickness_shape=jnp.asarray(np.tile(shape, (9, 1))),
        thickness_over_chord=jnp.full(9, 0.1),
    )
    found = beam_of(ellipse, beam_radii(STATIONS), PLASTIC)
    a, b = CHORD / 2, CHORD / 20
    np.testing.assert_allclose(
        found.torsion_constant, np.pi * a**3 * b**3 / (a**2 + b**2), rtol=1e-6
    )


def test_a_section_can_be_filled_to_its_area():
    blade = Blade.from_propeller(propeller())
    radii = beam_radii(STATIONS)
    plain = beam_of(blade, radii, PLASTIC)
    own = plain.areas.sum(axis=1) / CHORD**2
    full = beam_of(filled(blade, np.full(9, 2.0 * float(own[0]))), radii, PLASTIC)
    np.testing.assert_allclose(full.areas.sum(axis=1), 2.0 * own * CHORD**2, rtol=1e-3)
    # Twice as thick: eight times the torsion constant, but for the correction of thick sections.
    assert float(full.torsion_constant[0] / plain.torsion_constant[0]) == pytest.approx(8, rel=0.06)


def test_camber_stiffens_bending_but_not_torsion():
    flat, cambered = (beam(propeller(name)) for name in ("naca0006", "naca6406"))
    inertia = [float((b.areas[0] * (b.fibres[0, :, 1]) ** 2).sum()) for b in (flat, cambered)]
    assert inertia[1] > 2.0 * inertia[0]
    np.testing.assert_allclose(cambered.torsion_constant, flat.torsion_constant, rtol=1e-12)


def test_elastic_axis_is_where_the_thickness_is():
    blade = Blade.from_propeller(propeller("naca0012", beta_deg=90.0))
    aft = -np.asarray(elastic_axis(blade, strip_interpolation(STATIONS, 4)))[:, 1] * RADIUS / CHORD
    # Along the chord, which points down at 90 degrees; the thickest point of the section is 0.3 c.
    assert np.all((aft > 0.05) & (aft < 0.15))


def test_axis_follows_sweep_rake_and_twist():
    straight = propeller()
    swept = dataclasses.replace(
        straight,
        sweep_over_R=0.2 * (STATIONS - 0.2),
        rake_over_R=0.1 * (STATIONS - 0.2),
        beta_deg=np.degrees(0.5 - 0.3 * STATIONS),
    )
    plain, found = beam(straight), beam(swept)
    np.testing.assert_allclose(plain.axis_slope, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.twist_rate, -0.3 / RADIUS, rtol=1e-10)
    # The sweep of the quarter chord, and the elastic axis that turns about it.
    np.testing.assert_allclose(found.axis_slope[:, 0], -0.2, atol=0.02)
    np.testing.assert_allclose(found.axis_slope[:, 1], 0.1, atol=0.02)
    assert float(found.root) == pytest.approx(0.02) and float(found.length) == pytest.approx(0.08)
