"""The lattice's kernel on fixed wings: two-dimensional sections and the elliptic wing.

A wing along x in air from +z is a blade that does not turn: chord along -z, lift along -y or +y.
"""

from functools import partial

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.lattice.steady_wake import WakeInfluence, wake_influence
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.lattice_loads import (
    axial_onset,
    blade_influence_of,
    lattice_geometry,
    loads_with_wake,
)
from propmdao.geometry.lattice import lattice_chord_fraction
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION, naca4_camber_line
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

SPEED = 10.0
DENSITY = 1.2


def wing_nodes(span, chord, alpha, n_chordwise, n_spanwise, camber=lambda x: 0.0 * x):
    """Nodes of a wing of chord(2x/span), cosine both ways, flat but for its camber."""
    eta = -np.cos(np.linspace(0.0, np.pi, n_spanwise + 1))
    fraction = lattice_chord_fraction(n_chordwise)[:, None]
    c = chord(eta)[None, :]
    along, up = (fraction - 0.25) * c, camber(fraction) * c
    # Leading to trailing edge along -z; the suction side of a blade turned to 90 deg looks to -y.
    y = -(up * np.cos(alpha) - along * np.sin(alpha))
    z = -(along * np.cos(alpha) + up * np.sin(alpha))
    x = np.broadcast_to(0.5 * span * eta, z.shape)
    return jnp.asarray(np.stack([x, y, z], axis=-1))


@partial(compiled, optimisation=0)
def wing_loads(nodes, span):
    """Circulation per strip, lift and drag, with a straight wake along the stream."""
    # The "radius" only scales the bound vortices' core; a unit is the chord of the long wing.
    wing = RotorGeometry(nodes, 1.0, 1)
    lattice = lattice_geometry(wing)
    edge = lattice.rings.corner[-1]
    length = jnp.asarray([0.0, 0.1, 1.0, 10.0, 100.0]) * span
    wake = edge[:, None, None, :] - length[None, None, :, None] * jnp.array([0.0, 0.0, 1.0])
    air = Air(density=DENSITY)
    onset = axial_onset(lattice, RotorState(0.0, SPEED, air), 0.0)
    by_wake = WakeInfluence(wake_influence(lattice.points, wake, jnp.full(4, 1e-6)))
    loads = loads_with_wake(lattice, blade_influence_of(lattice, wing), by_wake, onset, air, None)
    force = loads.force.sum(axis=0)
    return loads, -force[1], -force[2]


@pytest.mark.parametrize("n_chordwise", [2, 8])
def test_section_of_a_long_wing_has_the_lift_slope_of_thin_airfoil_theory(n_chordwise):
    span, alpha = 1.0e3, 0.02
    nodes = wing_nodes(span, np.ones_like, alpha, n_chordwise, 21)
    loads, _, _ = wing_loads(nodes, span)
    lift_coefficient = 2 * float(loads.circulation[-1, 10]) / SPEED
    # At an aspect ratio of 1000 the middle still sees 1/500 of downwash.
    assert lift_coefficient == pytest.approx(2 * np.pi * np.sin(alpha) / 1.002, rel=1e-3)


def test_section_of_a_long_wing_has_the_lift_of_its_mean_line():
    # NACA 4-digit, 4 % at 0.4 c: zero-lift angle -4.15 deg by thin-airfoil theory.
    line = naca4_camber_line(0.04, 0.4)
    nodes = wing_nodes(
        1.0e3, np.ones_like, 0.0, 8, 21, lambda x: np.interp(x, CHORD_FRACTION, line)
    )
    loads, _, _ = wing_loads(nodes, 1.0e3)
    lift = 2 * float(loads.circulation[-1, 10]) / SPEED
    zero_lift = np.degrees(lift / (2 * np.pi))
    assert zero_lift == pytest.approx(4.155, abs=0.06)


def test_elliptic_wing_has_elliptic_loading_and_the_least_induced_drag():
    aspect_ratio, alpha = 20.0, 0.03
    span = 1.0
    root = 4 * span / (np.pi * aspect_ratio)
    # A chord of nothing has no panel; 1e-3 of the root at the tip is 1e-5 of the area.
    nodes = wing_nodes(span, lambda eta: root * np.sqrt(np.clip(1 - eta**2, 1e-6, 1)), alpha, 4, 40)
    loads, lift, drag = wing_loads(nodes, span)
    pressure_area = 0.5 * DENSITY * SPEED**2 * span**2 / aspect_ratio
    cl, cd = float(lift) / pressure_area, float(drag) / pressure_area
    # Lifting-surface lift slope (Helmbold), lifting-line induced drag (Prandtl).
    slope = 2 * np.pi * aspect_ratio / (2 + np.sqrt(4 + aspect_ratio**2))
    assert cl / np.sin(alpha) == pytest.approx(slope, rel=0.01)
    assert np.pi * aspect_ratio * cd / cl**2 == pytest.approx(1.0, abs=0.01)
    eta = -np.cos(np.linspace(0.0, np.pi, 81))[1::2]
    ellipse = loads.circulation[-1] / np.sqrt(1 - eta**2)
    np.testing.assert_allclose(ellipse[8:-8] / ellipse[20], 1.0, atol=0.02)
