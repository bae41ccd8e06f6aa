"""Cost of marching in time, prescribed and free, and of a step against the length of the wake.

The targets, on two cores and after compilation, for four revolutions of two blades at an incidence
with 8 x 24 panels: 2 s prescribed and 10 s free at 10 deg, 8 s prescribed at 3 deg.
"""

from __future__ import annotations

import jax
import pytest

import propmdao as pm
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.flow import march_flow
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.solutions.marching.stepping import advance, march_start
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes, strip_interpolation
from propmdao.records.fidelity import Marching
from propmdao.records.wake_law import WakeGrid, WakeLaw

SLOW_FLYER = pm.load_propeller("apcsf_11x4.7")
POINT = pm.OperatingPoint(rpm=4000.0, speed=8.0, incidence_deg=70.0)


def case_of(turns: float) -> RotorCase:
    """Return the slow flyer in flight, with so many turns of wake."""
    fidelity, blade = pm.Fidelity(), Blade.from_propeller(SLOW_FLYER)
    stations, n_spanwise = SLOW_FLYER.r_over_R, fidelity.n_spanwise
    span = lattice_interpolation(stations, n_spanwise)
    nodes = lattice_nodes(blade, span, fidelity.n_chordwise)
    middle = strip_interpolation(stations, n_spanwise)
    return RotorCase(
        RotorGeometry(nodes, 0.5 * SLOW_FLYER.diameter, SLOW_FLYER.n_blades),
        POINT.at(POINT.rotation_speed),
        viscous_sections(polars_for(SLOW_FLYER), blade, middle),
        wake_transport(WakeLaw(), WakeGrid(turns, 0.25, 1.25, 10.0)),
    )


@pytest.mark.parametrize(
    ("timestep_deg", "wake_motion"), [(10.0, "prescribed"), (3.0, "prescribed"), (10.0, "free")]
)
def test_four_revolutions(benchmark, timestep_deg, wake_motion):
    schedule = Marching(timestep_deg=timestep_deg, wake_motion=wake_motion)
    case = case_of(4.0)
    march(case, schedule)
    loads = benchmark.pedantic(march, (case, schedule), rounds=2)
    assert loads.thrust > 0.0


@pytest.mark.parametrize("turns", [2.0, 4.0, 8.0])
@pytest.mark.parametrize("wake_motion", ["prescribed", "free"])
def test_step_against_the_length_of_the_wake(benchmark, turns, wake_motion):
    schedule = Marching(timestep_deg=10.0, wake_motion=wake_motion)
    flow = march_flow(case_of(turns), schedule)
    state = march_start(flow, schedule)
    advance(flow, state, 0.0)
    totals = benchmark(lambda: jax.block_until_ready(advance(flow, state, 0.0))[2])
    assert totals.thrust > 0.0
