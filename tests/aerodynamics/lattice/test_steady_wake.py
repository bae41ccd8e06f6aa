"""The wake of steady flow, read in three parts, against all of its segments at all points."""

from functools import partial

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.lattice.chord_lines import (
    ChordLines,
    coarse_points,
    every_second,
    from_coarse,
    through_nearest,
)
from propmdao.aerodynamics.lattice.rings import BOUND_CORE
from propmdao.aerodynamics.lattice.steady_wake import (
    WakeInfluence,
    left_by_coarse_reading,
    steady_wake,
    wake_influence,
)
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.lattice_loads import axial_onset, loads_with_wake
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.runtime.compilation import compiled


def wake_of(flow, w):
    case = flow.case
    nodes = helical_wake(flow.lattice.rings.corner[-1], case.wake, case.rotor, case.state, w)
    core = core_radius(middles(jnp.asarray(case.wake.ages)), case.state, BOUND_CORE * 0.14)
    return nodes, core


@partial(compiled, optimisation=0)
def both(flow, w):
    """Loads in a wake that is read, and in the same one exactly."""
    nodes, core = wake_of(flow, w)
    lattice, wake = flow.lattice, flow.case.wake
    onset, air = axial_onset(lattice, flow.case.state, w), flow.case.state.air
    read = steady_wake(lattice.points, lattice.lines, nodes, core, (wake.n_near, wake.n_turn))
    exact = WakeInfluence(wake_influence(lattice.points, nodes, core))
    loads = [loads_with_wake(lattice, flow.blades, by, onset, air, None) for by in (read, exact)]
    return [jnp.stack([blade.thrust, blade.torque]) for blade in loads]


def test_wake_that_is_read_gives_the_loads_of_all_its_segments(slow_flyer):
    case = slow_flyer.case(nodes=slow_flyer.nodes(8, 24))
    prepared = compiled(axial.flow_at, optimisation=0)(case)
    for speed in (0.0, 8.0, 16.0):
        flow = axial.AxialFlow(
            slow_flyer.case(440.0, speed, nodes=case.rotor.nodes).in_floats(),
            prepared.lattice,
            prepared.blades,
        )
        # About the induced velocity of the loads: 0.05, 0.03 and -0.01 of the tip speed.
        read, exact = both(flow, {0.0: 4.3, 8.0: 1.6, 16.0: -0.6}[speed])
        np.testing.assert_allclose(read, exact, rtol=1e-3)
        assert (np.abs(read - exact) > 0.0).all()


@partial(compiled, optimisation=0)
def in_parts(case):
    """The wake read in three parts, and the influence of all of it.

    Few panels are read nowhere: influence at all points. Else at the lines, without the filaments
    that act everywhere, and with what coarse reading leaves.
    """
    flow = axial.flow_at(case)
    nodes, core = wake_of(flow, 3.0)
    lattice, wake = flow.lattice, flow.case.wake
    read = steady_wake(lattice.points, lattice.lines, nodes, core, (wake.n_near, wake.n_turn))
    if read.at_lines is None:
        return read, wake_influence(lattice.points, nodes, core), None
    left = left_by_coarse_reading(lattice.lines, nodes, core, wake.n_turn)
    near = wake_influence(
        lattice.lines.points, nodes[:, :1, : wake.n_near + 1], core[: wake.n_near]
    )
    return read, wake_influence(lattice.lines.points, nodes, core) - near, left


@pytest.mark.parametrize(("nc", "ns"), [(4, 20), (6, 8)])
def test_few_panels_leave_less_to_read(slow_flyer, nc, ns):
    read, exact, left = in_parts(slow_flyer.case(nodes=slow_flyer.nodes(nc, ns)))
    assert (read.at_lines is None) == (nc < 6)
    if nc < 6:
        np.testing.assert_array_equal(read.at_points, exact)
    else:
        # All filaments act on the lines, but those that act everywhere.
        np.testing.assert_allclose(read.at_lines, exact, rtol=1e-9, atol=1e-9)
        np.testing.assert_array_equal(left, 0.0)


def test_what_coarse_reading_leaves_is_the_difference(slow_flyer):
    read, exact, left = in_parts(slow_flyer.case(nodes=slow_flyer.nodes(6, 16)))
    np.testing.assert_allclose(read.at_lines - left, exact, rtol=1e-9, atol=1e-9)
    assert 0.0 < np.abs(left).max() < 0.1 * np.abs(exact).max()


def test_a_cubic_between_numbers_is_read_exactly_from_every_second():
    for n in (7, 12, 25):
        kept, number = every_second(n), np.arange(n)
        assert kept[0] == 0
        assert kept[-1] == n - 1

        def cubic(x):
            return 1.0 + x - 0.2 * x**2 + 0.01 * x**3

        np.testing.assert_allclose(
            through_nearest(kept, number) @ cubic(kept), cubic(number), rtol=1e-11, atol=1e-11
        )


def test_a_parabola_along_the_chord_is_read_exactly_from_coarse_points():
    ns, n = 12, 5
    place = np.cos(np.pi * (np.arange(n) + 0.5) / n)
    points = np.stack(
        [*np.meshgrid(place, np.arange(ns), indexing="ij"), np.zeros((n, ns))], axis=-1
    )
    lines = ChordLines(jnp.asarray(points.reshape(-1, 3)), jnp.zeros((n * ns, 3)))

    def flow(points):
        return (1.0 + points[:, 0] ** 2) * (2.0 - 0.1 * points[:, 1] ** 3)

    read = from_coarse(flow(coarse_points(lines, ns)), ns)
    np.testing.assert_allclose(read, flow(lines.points), rtol=1e-11)
