"""A search for the recambering that has not ended says what is missing, in a turn as at a point."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections import period_recambering, recambering
from propmdao.aerodynamics.sections.laws import section_laws, viscous_sections
from propmdao.aerodynamics.sections.period_recambering import PeriodFlow
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.recambering import SectionStates, StripFlow
from propmdao.aerodynamics.solutions import blade_element
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.air import Air

N_CHORDWISE, N_STRIPS, OMEGA = 2, 5, 440.0


@pytest.fixture(scope="module")
def flow_and_laws(slow_flyer):
    """Strips of a blade, each for itself, some of which would stall without recambering."""
    case: RotorCase = slow_flyer.case(OMEGA, nodes=slow_flyer.nodes(N_CHORDWISE, N_STRIPS))
    strips = blade_element.flow_at(case).strips
    polars = polars_for(load_propeller("apcsf_11x4.7_uiuc"))
    middle = strip_interpolation(slow_flyer.stations, N_STRIPS)
    sections = viscous_sections(polars, slow_flyer.blade, middle)
    speed = OMEGA * strips.radius
    laws = section_laws(strips, speed, jnp.asarray(1.0), Air(), sections)
    per_angle = jnp.pi * strips.chord * speed
    angle = jnp.linspace(0.05, 0.4, N_STRIPS)
    return StripFlow(strips, speed, per_angle * angle, 0.6 * jnp.diag(per_angle)), laws


def states_at_one(flow: StripFlow, laws) -> SectionStates:
    return jax.jit(lambda: recambering.solve_recambering(flow, laws)[1])()


def states_of_a_turn(flow: StripFlow, laws) -> SectionStates:
    """The same at the one azimuth of a turn, with flow from ahead."""
    turn = PeriodFlow(
        flow.strips,
        flow.relative_speed[None],
        jnp.ones((1, N_STRIPS)),
        jnp.zeros((1, N_STRIPS)),
        flow.circulation[None],
        flow.response,
    )
    laws = jax.tree.map(lambda of_strips: jnp.asarray(of_strips)[None], laws)
    none = jnp.zeros((1, N_STRIPS))
    solve = period_recambering.solve_period_recambering
    held = jax.jit(lambda: solve(turn, laws, none))()
    return jax.tree.map(lambda of_turn: of_turn[0], held.by_lattice)


@pytest.mark.parametrize("solved", [states_at_one, states_of_a_turn])
def test_what_is_missing_is_said(solved, flow_and_laws, monkeypatch) -> None:
    flow, laws = flow_and_laws
    settled = solved(flow, laws)
    assert np.abs(settled.residual).max() < 1e-9
    monkeypatch.setattr(recambering, "_MAX_STEPS", 2)
    monkeypatch.setattr(period_recambering, "_MAX_STEPS", 1)
    monkeypatch.setattr(period_recambering, "_FIRST_TIMES", (0.5,))
    ended = solved(flow, laws)
    assert np.abs(ended.residual).max() > 1e-3
    # And it is the lift of the lattice less that of the polars at the angle that is told.
    more, drag = laws.beyond_thin(ended.angle_of_attack)
    held = laws.thin(ended.angle_of_attack) + laws.mean @ more
    np.testing.assert_allclose(ended.lift_coefficient, held, rtol=1e-12)
    np.testing.assert_allclose(ended.drag_coefficient, drag, rtol=1e-12)


def test_both_find_the_same(flow_and_laws) -> None:
    one, turn = (solved(*flow_and_laws) for solved in (states_at_one, states_of_a_turn))
    np.testing.assert_allclose(turn.lift_coefficient, one.lift_coefficient, rtol=1e-8)
    np.testing.assert_allclose(turn.angle_of_attack, one.angle_of_attack, rtol=1e-8)
