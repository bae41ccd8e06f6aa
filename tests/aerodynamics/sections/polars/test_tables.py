"""The tables that ship: limits of theory, symmetry, derivatives, how they were made."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.family import (
    blade_tables,
    section_tables,
    warn_outside_sections,
)
from propmdao.aerodynamics.sections.polars.high_angle import ATTACHED_DEG, FloatArray
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import REYNOLDS, neuralfoil_polars
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.shipped import (
    SHAPES,
    SHIPPED,
    SHIPPED_N_CRIT,
    SHIPPED_TRIPPED,
    shape,
    shipped_polars,
    shipped_settings,
    shipped_shares,
)
from propmdao.aerodynamics.sections.polars.table import (
    PolarRangeWarning,
    PolarTable,
    section_coefficients,
    warn_outside,
)
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.propeller.airfoils.airfoil import naca4
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.catalog import catalog_names
from propmdao.propeller.description import Propeller
from propmdao.records.models import FREE, Transition

Section = Callable[..., PolarTable]


def test_version_and_settings_are_recorded() -> None:
    settings = shipped_settings()
    assert settings.startswith("NeuralFoil 0.") and "model xxxlarge, incompressible" in settings


@pytest.mark.parametrize("re", [2e4, 1e5, 5e5])
def test_a_symmetric_section_has_no_lift_at_no_angle(section: Section, re: float) -> None:
    cl, _, cm = section_coefficients(section("naca0009"), jnp.zeros(1), jnp.full(1, re))
    np.testing.assert_allclose([cl[0], cm[0]], 0.0, atol=1e-12)


def test_lift_upside_down_is_lift_the_other_way(section: Section) -> None:
    alpha, re = jnp.radians(jnp.linspace(-170.0, 170.0, 69)), jnp.full(69, 8e4)
    upright = section_coefficients(section("naca4409", 69, camber=0.04), alpha, re)
    turned = section_coefficients(section("naca4409", 69, camber=-0.04), -alpha, re)
    np.testing.assert_allclose(turned[0], -upright[0], atol=1e-12)
    np.testing.assert_allclose(turned[1], upright[1], rtol=1e-12)
    np.testing.assert_allclose(turned[2], -upright[2], atol=1e-12)


@pytest.mark.parametrize("airfoil", ["naca0012", "naca4412", "clarky"])
def test_lift_slope_at_high_reynolds_numbers_is_near_that_of_thin_airfoils(
    section: Section, airfoil: str
) -> None:
    alpha = jnp.radians(jnp.array([1.0, 4.0]))
    cl, _, _ = section_coefficients(section(airfoil, 2), alpha, jnp.full(2, 1e6))
    slope = float((cl[1] - cl[0]) / (alpha[1] - alpha[0]) / (2.0 * jnp.pi))
    assert 0.90 < slope < 1.10  # thickness adds 0.77 t/c, the boundary layer takes away


@pytest.mark.parametrize("airfoil", ["naca4412", "clarky"])
def test_zero_lift_angle_is_near_that_of_thin_airfoils(section: Section, airfoil: str) -> None:
    alpha = np.radians(np.arange(-12.0, 0.0, 0.05))
    cl, _, _ = section_coefficients(
        section(airfoil, alpha.size), jnp.asarray(alpha), jnp.full(alpha.size, 1e6)
    )
    last_negative = np.flatnonzero(np.asarray(cl) < 0.0)[-1]
    difference = np.degrees(alpha[last_negative] - find_airfoil(airfoil).zero_lift_angle)
    assert abs(difference) < 0.5


def test_drag_falls_with_reynolds_number(section: Section) -> None:
    """Up to a million: from there transition moves forward, which costs what the number saves."""
    re = jnp.asarray(REYNOLDS[1:11])
    _, cd, _ = section_coefficients(section("clarky", re.size), jnp.full(re.size, 0.05), re)
    assert np.all(np.diff(cd) < 0.0)


@pytest.mark.parametrize("alpha_deg", [-171.3, -20.0, -7.0, 2.5, 9.0, 14.0, 21.0, 75.0, 180.0])
def test_c1_in_angle_and_reynolds_number(section: Section, alpha_deg: float) -> None:
    table = section("e63")

    def coefficients(alpha: jax.Array, log_re: jax.Array) -> jax.Array:
        return jnp.concatenate(section_coefficients(table, alpha[None], jnp.exp(log_re)[None]))

    jacobian = jax.jacfwd(coefficients, (0, 1))
    alpha, log_re = jnp.radians(alpha_deg), jnp.log(1e5)  # 1e5 is a node of the table
    below, above = (jacobian(alpha + d, log_re + d) for d in (-1e-8, 1e-8))
    # Second derivatives are below 1e3: lift changes its slope of 2 pi within a degree at stall.
    np.testing.assert_allclose(np.array(below), np.array(above), atol=1e-4)


def test_reynolds_numbers_outside_are_held(section: Section) -> None:
    alpha, table = jnp.full(1, 0.05), section("clarky")
    far = section_coefficients(table, alpha, jnp.array([1e9]))
    further = section_coefficients(table, alpha, jnp.array([1e12]))
    end = section_coefficients(table, alpha, jnp.array(REYNOLDS[-1:]))
    np.testing.assert_allclose(np.ravel(far), np.ravel(further), rtol=1e-9)
    assert float(far[0][0]) == pytest.approx(float(end[0][0]), abs=0.02)


def test_one_warning_names_the_station_furthest_outside(section: Section) -> None:
    re, r = np.array([3e3, 2e3, 5e4]), np.array([0.2, 0.3, 0.9])
    with pytest.warns(PolarRangeWarning, match=r"2e\+03 at r/R 0.3 .*2 of 3 sections") as caught:
        warn_outside(section("clarky", 3), re, r)
    assert len(caught) == 1
    with pytest.warns(PolarRangeWarning, match=r"Mach number 0.8 at r/R 0.9 is above 0.7"):
        warn_outside(section("clarky", 3), np.full(3, 1e5), r, np.array([0.2, 0.3, 0.8]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_outside(section("clarky", 3), np.full(3, 1e4), r, 0.7)


@pytest.mark.parametrize("name", catalog_names())
def test_every_propeller_of_the_catalogue_has_polars(name: str) -> None:
    propeller = load_propeller(name)
    polars = polars_for(propeller)
    np.testing.assert_allclose(polars.weights.sum(axis=1), 1.0)
    assert np.isfinite(polars.values).all()


def test_camber_or_thickness_outside_the_polars_is_told(
    propeller: Callable[..., Propeller],
) -> None:
    described = propeller((0.0, "naca4412"))
    blade, polars = Blade.from_propeller(described), polars_for(described)
    warn_outside_sections(polars, blade, described.r_over_R)
    thick = dataclasses.replace(blade, thickness_over_chord=jnp.array([0.3, 0.12, 0.1]))
    with pytest.warns(PolarRangeWarning, match=r"thickness_over_chord 0.3 at r/R 0.2 .*0.03..0.22"):
        warn_outside_sections(polars, thick, described.r_over_R)


@pytest.mark.parametrize("field", ["camber_over_chord", "thickness_over_chord"])
def test_derivatives_along_the_sections(propeller: Callable[..., Propeller], field: str) -> None:
    described = propeller((0.2, "e63"), (1.0, "clarky"))
    blade, polars = Blade.from_propeller(described), polars_for(described)
    span = span_interpolation(described.r_over_R, np.linspace(0.2, 1.0, 7))
    alpha, re = jnp.linspace(-0.05, 0.2, 7), jnp.geomspace(2e4, 2e5, 7)

    def coefficients(change: jax.Array | float) -> jax.Array:
        changed = getattr(blade, field) + change * jnp.array([1.0, -0.5, 0.7])
        table = blade_tables(polars, dataclasses.replace(blade, **{field: changed}), span)
        return jnp.concatenate(section_coefficients(table, alpha, re))

    step = 1e-6
    difference = (coefficients(step) - coefficients(-step)) / (2.0 * step)
    # Third derivatives are below 1e7 (cells of 1 %): step^2 / 6 of that.
    np.testing.assert_allclose(jax.jacfwd(coefficients)(0.0), difference, rtol=1e-6, atol=1e-5)


def test_stations_of_the_slow_flyer_use_the_blends_on_either_side(
    propeller: Callable[..., Propeller],
) -> None:
    described = propeller((0.0, "e63"), (1.0, "clarky"))  # Clark-Y shares 0.2, 0.5, 1
    weights = np.asarray(polars_for(described).weights)
    # in the order e63, clarky, e63-clarky
    np.testing.assert_allclose(weights, [[0.6, 0.0, 0.4], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])


def test_other_blends_count_by_camber(propeller: Callable[..., Propeller]) -> None:
    weights = np.asarray(polars_for(propeller((0.0, "e63"), (1.0, "naca4412"))).weights)
    e63, naca = find_airfoil("e63").max_camber, find_airfoil("naca4412").max_camber
    np.testing.assert_allclose(weights[1], [e63 / (e63 + naca), naca / (e63 + naca)])


@pytest.mark.parametrize("n_crit", np.linspace(3.0, 9.0, 25))
def test_shares_of_the_tables_are_those_of_a_straight_line(n_crit: float) -> None:
    """What is linear in n_crit comes back, so that there is no step from one to the other."""
    shares = shipped_shares(Transition(n_crit).completed())
    assert sum(shares.values()) == pytest.approx(1.0, abs=1e-12)
    mean = sum(share * (made.n_crit or 0.0) for made, share in shares.items())
    assert mean == pytest.approx(n_crit, abs=1e-12)
    assert (len(shares) == 1) == (n_crit in SHIPPED_N_CRIT)


@pytest.mark.parametrize("node", SHIPPED_N_CRIT[1:-1])
def test_shares_have_no_kink_at_a_table(node: float) -> None:
    def lift(n_crit: float) -> float:  # of no straight line: cubic in n_crit
        shares = shipped_shares(Transition(n_crit).completed())
        return sum(share * (made.n_crit or 0.0) ** 3 for made, share in shares.items())

    below, above = lift(node) - lift(node - 1e-6), lift(node + 1e-6) - lift(node)
    assert below == pytest.approx(above, rel=1e-4)


@pytest.mark.parametrize(
    "beyond",
    [
        Transition(2.99, FREE, FREE),
        Transition(9.01, FREE, FREE),
        Transition(5.0, 0.05, FREE),
        Transition(6.0, 0.05, 0.05),
    ],
)
def test_tables_do_not_reach_further_than_they_were_made(beyond: Transition) -> None:
    assert shipped_shares(beyond) == {}


def test_more_lift_comes_smoothly_with_less_n_crit(propeller: Callable[..., Propeller]) -> None:
    """E63 at Re 1e5 and 3 deg: what bubbles take away, with the values of the tables between."""
    described = propeller((0.0, "e63"))
    blade, at = Blade.from_propeller(described), span_interpolation([0.2, 0.5, 1.0], [0.5])

    def lift(n_crit: float) -> float:
        table = blade_tables(polars_for(described, None, Transition(n_crit)), blade, at)
        cl, _, _ = section_coefficients(table, jnp.radians(jnp.full(1, 3.0)), jnp.full(1, 1e5))
        return float(cl[0])

    cl = np.array([lift(n_crit) for n_crit in (3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0)])
    assert np.all(np.diff(cl) < 0.0)
    assert np.abs(np.diff(cl, n=2)).max() < 0.5 * np.abs(np.diff(cl)).max()


def drag(transition: Transition, re: FloatArray) -> FloatArray:
    """Drag of a NACA section of 12 % with 3 % camber at 2 deg."""
    coefficients = shipped_polars("naca4", transition).coefficients
    found: FloatArray = coefficients[2, 4, 1, np.isin(REYNOLDS, re), ATTACHED_DEG == 2.0]
    return found


def test_a_tripped_section_has_the_drag_of_a_turbulent_plate() -> None:
    """Prandtl's 0.074 Re^-1/5 on both sides, times Hoerner's form factor (Fluid-Dynamic Drag)."""
    re = REYNOLDS[REYNOLDS > 3e5]
    plate = 2.0 * 0.074 * re**-0.2 * (1.0 + 2.0 * 0.12 + 60.0 * 0.12**4)
    np.testing.assert_allclose(drag(SHIPPED_TRIPPED, re), plate, rtol=0.1)


def test_the_later_transition_is_the_less_drag_above_the_bubbles() -> None:
    re = REYNOLDS[REYNOLDS > 9e5]
    rows = np.stack([drag(t, re) for t in (SHIPPED_TRIPPED, *SHIPPED[: len(SHIPPED_N_CRIT)])])
    assert np.all(np.diff(rows, axis=0) < 0.0)


@pytest.mark.parametrize("transition", SHIPPED, ids=str)
@pytest.mark.parametrize("name", SHAPES)
def test_drag_falls_and_stall_rises_to_the_highest_reynolds_number(
    name: str, transition: Transition
) -> None:
    """Means over sections of 6.5 to 15.5 %, over a decade each."""
    polars = shipped_polars(name, transition).coefficients[:, 2:6]
    decades = polars[:, :, :, [5, 9, 13]]  # Re 56 thousand, 560 thousand, 5.6 million
    attached = np.log(decades[:, :, 1][..., np.abs(ATTACHED_DEG - 2.0) <= 4.0])
    assert np.all(np.diff(attached.mean(axis=(0, 1, 3))) < -0.1)
    highest = decades[:, :, 0][..., np.abs(ATTACHED_DEG - 12.0) <= 8.0].max(axis=-1)
    assert np.all(np.diff(highest.mean(axis=(0, 1))) > 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["naca4", "e63", "clarky"])
def test_neuralfoil_makes_the_same_tables_again(name: str) -> None:
    pytest.importorskip("neuralfoil", reason="the extra `polars` is not installed")
    camber, thickness = shape(name)
    alpha = np.array([-2.0, 3.0, 6.0])
    section = 0.045 * camber[None], 0.09 * thickness[None]
    columns = 26 + alpha.astype(int)
    for transition in SHIPPED:
        polars = neuralfoil_polars(*section, alpha, REYNOLDS[2:], transition)
        cl, cd, cm = (values[0] for values in polars[:3])
        stored = shipped_polars(name, transition).coefficients[3, 3]  # camber 0.045, thickness 0.09
        unit = 2.0 if transition == Transition().completed() else 5.0
        # The rounding of the file, and what other versions of numpy may add.
        np.testing.assert_allclose(stored[0][2:, columns], cl, atol=1e-4 * unit)
        np.testing.assert_allclose(stored[1][2:, columns], cd, rtol=1e-4 * unit)
        np.testing.assert_allclose(stored[2][2:, columns], cm, atol=2e-5 * unit)


# Mean |dcl|, |dcd| over -4..8 deg at Re 6e4: what interpolation and blending of shapes cost.
BETWEEN_NODES = {"naca": (0.0034, 0.00027), "quarter blend": (0.0119, 0.00053)}


@pytest.mark.slow
@pytest.mark.parametrize("case", BETWEEN_NODES)
def test_sections_between_the_nodes_are_near_neuralfoil(
    propeller: Callable[..., Propeller], case: str
) -> None:
    pytest.importorskip("neuralfoil", reason="the extra `polars` is not installed")
    if case == "naca":
        section, described = naca4(0.0525, 0.4, 0.105), propeller((0.0, "naca4412"))
        camber, thickness = section.camber, section.thickness
    else:
        described = propeller((0.4, "e63"), (0.8, "clarky"))  # a share of 0.25 at r/R 0.5
        camber, thickness = (values[1] for values in described.sections())
    polars, alpha, re = polars_for(described), np.arange(-4.0, 8.5, 0.5), 6e4
    table = section_tables(
        polars, polars.weights[1:2], jnp.array([camber.max()]), jnp.array([thickness.max()])
    )
    repeated = dataclasses.replace(table, values=jnp.repeat(table.values, alpha.size, axis=0))
    between = section_coefficients(repeated, jnp.radians(alpha), jnp.full(alpha.size, re))
    exact = neuralfoil_polars(
        camber[None], thickness[None], alpha, np.array([re]), Transition().completed()
    )
    differences = [np.abs(np.asarray(between[k]) - exact[k][0, 0]).mean() for k in range(2)]
    np.testing.assert_allclose(differences, BETWEEN_NODES[case], rtol=0.1)


# Mean |dcl|, mean |d ln cd| over -4..8 deg at n_crit 6 halfway between tables, by Reynolds number.
BETWEEN_TABLES = {6e4: (0.00326, 0.00943), 1e5: (0.00213, 0.00973)}


@pytest.mark.slow
@pytest.mark.parametrize("re", BETWEEN_TABLES)
def test_transition_between_the_tables_is_near_neuralfoil(
    propeller: Callable[..., Propeller], re: float
) -> None:
    pytest.importorskip("neuralfoil", reason="the extra `polars` is not installed")
    alpha, section = np.arange(-4.0, 8.5, 1.0), find_airfoil("naca4409")
    polars = polars_for(propeller((0.0, "naca4409")), None, Transition(6.0))
    table = section_tables(
        polars,
        jnp.tile(polars.weights[:1], (alpha.size, 1)),
        jnp.full(alpha.size, section.max_camber),
        jnp.full(alpha.size, section.max_thickness),
    )
    cl, cd, _ = section_coefficients(table, jnp.radians(alpha), jnp.full(alpha.size, re))
    exact = neuralfoil_polars(
        section.camber[None],
        section.thickness[None],
        alpha,
        np.array([re]),
        Transition(6.0).completed(),
    )
    found = np.abs(cl - exact[0][0, 0]).mean(), np.abs(np.log(cd / exact[1][0, 0])).mean()
    np.testing.assert_allclose(found, BETWEEN_TABLES[re], rtol=0.1)
