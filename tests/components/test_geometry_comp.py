"""GeometryComp hands over the meshes of the physics, with their derivatives."""

import dataclasses

import jax.numpy as jnp
import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose
from openmdao.utils.assert_utils import assert_check_partials

from propmdao.aerodynamics.sections.polars.family import blade_tables
from propmdao.components import GeometryComp
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import (
    lattice_interpolation,
    lattice_nodes,
    strip_interpolation,
)
from propmdao.geometry.surface import surface_interpolation, surface_nodes


@pytest.fixture
def problem(small, problem_of):
    """Problem with a `GeometryComp` of the given options."""
    return lambda **options: problem_of(GeometryComp(fidelity=small, **options))


def test_initial_values_give_the_meshes_of_the_propeller(problem, propeller):
    prob = problem(propeller=propeller)  # not run: solvers start from what it holds
    blade, stations = Blade.from_propeller(propeller), propeller.r_over_R
    at = lattice_interpolation(stations, 4)
    assert_allclose(prob.get_val("lattice_nodes"), lattice_nodes(blade, at, 2), atol=1e-15)
    at = surface_interpolation(stations, 4)
    assert_allclose(prob.get_val("surface_nodes"), surface_nodes(blade, at, 5), atol=1e-15)
    assert_allclose(prob.get_val("beta", units="deg"), propeller.beta_deg)


@pytest.mark.parametrize("camber", ["camber_over_chord", "design_lift_coefficient"])
def test_partials(problem, propeller, camber):
    prob = problem(propeller=propeller, camber=camber)
    prob.run_model()
    # central differences of a smooth function: truncation 1e-12, roundoff 1e-16 / 1e-6 = 1e-10
    data = prob.check_partials(out_stream=None, method="fd", form="central", step=1e-6)
    assert_check_partials(data, atol=1e-8, rtol=1e-7)


def test_polars_of_the_sections_are_those_of_the_blade(meshes, propeller, polars):
    stations = propeller.r_over_R
    middle = strip_interpolation(stations, 4)
    table = blade_tables(polars, Blade.from_propeller(propeller), middle)
    assert_allclose(meshes.get_val("section_polars"), table.values, atol=1e-14)
    assert_allclose(meshes.get_val("section_thickness_over_chord"), table.thickness, rtol=1e-14)


def test_partials_with_polars(problem, propeller, polars, assert_directional):
    prob = problem(propeller=propeller, polars=polars)
    prob.run_model()
    # truncation of 1e-8 at the finest step
    assert_directional(prob, 1e-7, forward=True)


def test_both_ways_to_give_camber_are_the_same_blade(problem, propeller):
    by_camber = problem(propeller=propeller)
    by_lift = problem(propeller=propeller, camber="design_lift_coefficient")
    for prob in (by_camber, by_lift):
        prob.run_model()
    assert_allclose(
        by_lift.get_val("lattice_nodes"), by_camber.get_val("lattice_nodes"), atol=1e-15
    )
    # NACA 4-digit, 6 % camber at 0.4 c: cl_i 0.767 by theory (0.779 in table 4.9 of the thesis)
    naca = dataclasses.replace(propeller, airfoils=((0.15, "naca6412"), (1.0, "naca6412")))
    prob = problem(propeller=naca, camber="design_lift_coefficient")
    assert_allclose(prob.get_val("design_lift_coefficient"), 0.767, atol=2e-3)


def test_blade_angle_can_be_set_in_degrees(problem, propeller):
    prob = problem(propeller=propeller)
    prob.set_val("beta", propeller.beta_deg + 2.0, units="deg")
    prob.run_model()
    blade = Blade.from_propeller(propeller)
    blade = dataclasses.replace(blade, beta=jnp.radians(propeller.beta_deg + 2.0))
    stations = propeller.r_over_R
    at = lattice_interpolation(stations, 4)
    assert_allclose(prob.get_val("lattice_nodes"), lattice_nodes(blade, at, 2), atol=1e-12)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("chord_over_R", -0.01, "chord_over_R must be positive; station 3 .* has -0.01"),
        ("thickness_over_chord", 1.2, "thickness_over_chord must be above 0 and below 1"),
        ("chord_over_R", np.nan, "chord_over_R must be positive; station 3 .* has nan"),
    ],
)
def test_blades_that_cannot_be_are_failed_analyses(problem, propeller, name, value, message):
    prob = problem(propeller=propeller)
    values = prob.get_val(name).copy()
    values[3] = value
    prob.set_val(name, values)
    with pytest.raises(om.AnalysisError, match=message):
        prob.run_model()


def test_a_chord_that_swings_below_zero_between_stations_is_a_failed_analysis(problem, propeller):
    prob = problem(propeller=propeller)
    # Large where the spline counts them against an edge of the lattice, small elsewhere.
    edges = np.asarray(lattice_interpolation(propeller.r_over_R, 4).smooth)
    weights = edges[np.argmin(edges.min(axis=1))]
    prob.set_val("chord_over_R", np.where(weights < 0.0, 0.3, 0.002))
    with pytest.raises(om.AnalysisError, match="positive between stations, too; .* at r/R"):
        prob.run_model()
