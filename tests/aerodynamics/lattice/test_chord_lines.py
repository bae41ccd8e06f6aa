"""Flow read between a few points of each strip: polynomials exactly, far vortices closely."""

from functools import partial

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.lattice.chord_lines import at_collocation, at_segments, chord_lines
from propmdao.aerodynamics.lattice.rings import ring_segments, vortex_rings
from propmdao.geometry.lattice import lattice_chord_fraction, lattice_span, strip_middle
from propmdao.runtime.compilation import compiled

NC, NS, CHORD = 8, 12, 0.2


@partial(compiled, optimisation=0)
def parts_of(nodes):
    """Points of the strips, collocation points and both ends of all segments."""
    rings, lines = vortex_rings(nodes), chord_lines(nodes)
    return lines.points, rings.collocation, *ring_segments(rings)


@pytest.fixture(scope="module")
def plate():
    """A flat blade: points of its strips, collocation points, middles of its segments."""
    span = lattice_span(0.2, NS)
    y = -CHORD * lattice_chord_fraction(NC)[:, None] + 0.0 * span
    nodes = jnp.asarray(np.stack([span + 0.0 * y, y, 0.0 * y], axis=-1))
    lines, collocation, start, end = map(np.asarray, parts_of(nodes))
    middle = np.concatenate([np.tile(strip_middle(NS), NC), np.full(NC * (NS + 1), 0.5)])[:, None]
    return lines, collocation, (1.0 - middle) * start + middle * end


def test_a_polynomial_along_the_chord_is_read_exactly(plate):
    lines, collocation, segments = plate

    def flow(points):
        x = points[:, 1] / CHORD
        return 1.0 + x - 3.0 * x**2 + x**3 + 2.0 * x**4

    np.testing.assert_allclose(at_collocation(flow(lines), NC), flow(collocation), rtol=1e-12)
    np.testing.assert_allclose(at_segments(flow(lines), NC), flow(segments), rtol=1e-12)


@pytest.mark.parametrize("distance", [0.5, 1.0, 2.0])
def test_a_vortex_is_missed_by_what_chebyshev_points_miss(plate, distance):
    # A vortex across the chord, under its middle, so many half chords away. With the polynomial
    # T of n Chebyshev points, 1 / (x - a) is missed by T(x) / T(a) / (x - a).
    lines, collocation, segments = plate
    bound = segments[: NC * NS]
    first, last = lines[0, 1], lines[-1, 1]
    n = lines.shape[0] // NS
    half = 0.5 * (first - last) / np.cos(0.5 * np.pi / n)
    polynomial, vortex = np.polynomial.chebyshev.Chebyshev.basis(n), 1j * distance

    def place(points):
        return np.asarray((points[:, 1] - 0.5 * (first + last)) / half)

    flow = (1.0 / (place(lines) - vortex)).real
    for read, points in (
        (at_collocation(jnp.asarray(flow), NC), collocation),
        (at_segments(jnp.asarray(flow), NC)[: NC * NS], bound),
    ):
        x = place(points)
        missed = (polynomial(x) / polynomial(vortex) / (x - vortex)).real
        np.testing.assert_allclose(read, (1.0 / (x - vortex)).real - missed, atol=1e-12)
        ratio = distance + np.hypot(1.0, distance)
        assert np.abs(missed).max() < 3.0 / distance * ratio**-n


def test_a_cubic_in_the_spanwise_angle_is_read_exactly_between_the_strips(plate):
    lines, _, segments = plate
    angle = np.pi * (np.arange(NS) + 0.5) / NS
    edge = np.pi * np.arange(NS + 1) / NS

    def flow(angle):
        return 1.0 + angle - 0.3 * angle**3

    values = np.tile(flow(angle), lines.shape[0] // NS)
    read = at_segments(jnp.asarray(values), NC)[NC * NS :].reshape(NC, NS + 1)
    expected = np.tile(flow(edge), (NC, 1))
    np.testing.assert_allclose(read[:, 1:-1], expected[:, 1:-1], rtol=1e-12)
    # At root and tip, on the line through the two nearest.
    for end, first, second in ((0, 0, 1), (-1, -1, -2)):
        line = 1.5 * flow(angle[first]) - 0.5 * flow(angle[second])
        np.testing.assert_allclose(read[:, end], line, rtol=1e-12)
