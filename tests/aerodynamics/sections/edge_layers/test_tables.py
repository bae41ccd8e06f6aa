"""Tables of boundary layers: against the report's NACA 0012, mirrored, smooth, complete."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import propmdao as pm
from propmdao.acoustics.broadband.boundary_layer import boundary_layer
from propmdao.acoustics.broadband.section_layers import layer_of_sections
from propmdao.aerodynamics.sections.edge_layers.propeller_layers import layers_for, shipped_settings
from propmdao.aerodynamics.sections.edge_layers.tables import blade_layers, edge_sides
from propmdao.aerodynamics.sections.polars.shipped import SHIPPED, SHIPPED_TRIPPED
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.models import FREE, Transition
from propmdao.runtime.compilation import compiled

R = np.array([0.2, 0.6, 1.0])
NATURAL = Transition(9.0, FREE, FREE)


sides_of = compiled(edge_sides, optimisation=0)


fit_of = compiled(boundary_layer, static_argnums=(4,), optimisation=0)


@partial(compiled, optimisation=0)
def layer_in(table, degrees, reynolds):
    angle = jnp.radians(jnp.full(2, degrees))
    sides = edge_sides(table, angle, jnp.full(2, reynolds))
    return layer_of_sections(1.0, angle, *sides)


def blade_of(airfoil, **changes):
    blade = {"c_over_R": 0.2 + 0 * R, "beta_deg": 10 + 0 * R, "airfoils": [(1.0, airfoil)]}
    return pm.Propeller(name="blade", diameter=0.3, n_blades=2, r_over_R=R, **(blade | changes))


def table_of(propeller, transition):
    blade, span = Blade.from_propeller(propeller), strip_interpolation(propeller.r_over_R, 2)
    return blade_layers(layers_for(propeller, transition), blade, span)


def layer_at(degrees, reynolds, transition, airfoil="naca0012"):
    """Layer of a section of 1 m chord, angle from zero lift that of a symmetric section."""
    return layer_in(table_of(blade_of(airfoil), transition), degrees, reynolds)


@pytest.mark.parametrize("reynolds", [1e5, 2e5, 5e5, 1e6, 1.5e6])
@pytest.mark.parametrize("degrees", [0.0, 2.0, 4.0])
def test_forced_transition_is_the_light_trip_of_the_report(reynolds, degrees):
    # NASA RP-1218 measured a NACA 0012 with grit; its program takes 0.6 of that for a light trip.
    got = layer_at(degrees, reynolds, SHIPPED_TRIPPED)
    fit = fit_of(1.0, reynolds, np.radians(degrees), 1.0, "light")
    for name in ("displacement_suction", "displacement_pressure"):
        decibels = 10 * np.log10(getattr(got, name)[0] / getattr(fit, name))
        assert abs(float(decibels)) < 1.4, name


@pytest.mark.parametrize("reynolds", [5e5, 1e6, 1.5e6])
@pytest.mark.parametrize("degrees", [0.0, 2.0, 4.0])
def test_natural_transition_is_near_the_fits_where_the_suction_side_is_turbulent(reynolds, degrees):
    got = layer_at(degrees, reynolds, NATURAL)
    fit = fit_of(1.0, reynolds, np.radians(degrees), 1.0, "none")
    decibels = 10 * np.log10(got.displacement_suction[0] / fit.displacement_suction)
    assert -2.2 < float(decibels) < 0.2


def test_shedding_is_where_the_report_measured_it():
    # It is loudest at log Re 4.978 + 0.215 alpha up to 3 deg, and 0.12 per degree beyond (59).
    loudest = {0.0: 9.5e4, 2.0: 2.6e5, 4.0: 5.5e5, 6.0: 9.6e5}
    for degrees, reynolds in loudest.items():
        assert float(layer_at(degrees, reynolds, NATURAL).shedding[0]) > 0.9, degrees
    # At these, 20 dB and more below its loudest, the layer is turbulent.
    for degrees, reynolds in ((0.0, 1e6), (2.0, 1.5e6), (0.0, 5e5)):
        assert float(layer_at(degrees, reynolds, NATURAL).shedding[0]) < 0.05, degrees


def test_a_section_upside_down_has_its_sides_exchanged():
    camber = np.full(3, 0.04)
    upright, turned = (
        table_of(blade_of("naca4412", camber_over_chord=sign * camber), Transition())
        for sign in (1, -1)
    )
    angle, re = jnp.radians(jnp.array([3.0, -2.0])), jnp.array([8e4, 2e5])
    upper, lower = sides_of(upright, angle, re)
    turned_upper, turned_lower = sides_of(turned, -angle, re)
    jax.tree.map(assert_allclose, (upper, lower), (turned_lower, turned_upper))


def test_nothing_jumps_over_angle_and_reynolds_number():
    table = table_of(pm.load_propeller("apcsf_11x4.7"), Transition())

    def values(t):
        angle = jnp.radians(-30.0 + 60.0 * t) * jnp.ones(len(table.values))
        re = 10 ** (3.0 + 4.0 * t) * jnp.ones(len(table.values))
        return jnp.stack(jax.tree.leaves(edge_sides(table, angle, re)))[:, 0]

    along = np.linspace(0.0, 1.0, 4001)
    traced = np.asarray(jax.jit(jax.vmap(values))(along))
    slope = np.asarray(jax.jit(jax.vmap(jax.jacfwd(values)))(along))
    assert np.all(np.isfinite(traced))
    assert np.all(np.isfinite(slope))
    numeric = (traced[2:] - traced[:-2]) / (along[2:] - along[:-2])[:, None]
    assert_allclose(slope[1:-1], numeric, atol=0.05 * np.abs(slope).max())


def test_a_turn_has_the_layers_of_its_azimuths():
    table = table_of(blade_of("naca4412"), Transition())
    angle = jnp.radians(jnp.array([[1.0, 2.0], [3.0, -4.0]]))
    re = jnp.array([[5e4, 8e4], [6e4, 0.0]])
    together = sides_of(table, angle, re)
    for k in range(2):
        alone = sides_of(table, angle[k], re[k])
        jax.tree.map(lambda a, b, k=k: assert_allclose(a[k], b), together, alone)


@pytest.mark.parametrize("transition", SHIPPED)
def test_every_shipped_transition_has_layers(transition):
    layers = layers_for(pm.load_propeller("apce_10x5"), transition)
    values = np.asarray(layers.values)
    assert np.all(np.isfinite(values))
    momentum, shape = np.exp(values[..., 0, :, :]), np.exp(values[..., 1, :, :])
    assert 5e-5 < momentum.min() < momentum.max() < 0.1
    assert shape.min() > 1.0
    place = values[..., 2, :, :]
    assert place.min() >= 0.0
    assert place.max() <= 1.0


def test_the_tables_say_how_they_were_made():
    assert shipped_settings().startswith("NeuralFoil 0.3.3, model xxxlarge")
