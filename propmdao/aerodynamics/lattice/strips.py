"""Sections of the blade in the strips of its lattice: where they are, how they meet the air."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import Rings
from propmdao.geometry.lattice import lattice_chord_fraction, strip_middle
from propmdao.records.pytrees import Scalar, record


@record
class Strips:
    """Sections of blade 1 in the middle of the strips, one row each.

    Attributes
    ----------
    quarter_chord : (ns, 3) array
        Quarter points of the chord lines [m].
    radius, r_over_R : (ns,) arrays
        Distance of the quarter points from the axis [m], and this over the tip radius.
    chord, width : (ns,) arrays
        Chord, and width of the strip across the chord [m].
    backward, upward : (ns, 3) arrays
        Unit vectors along the chord line, leading to trailing edge, and normal to it, toward the
        suction side.
    zero_lift_angle : (ns,) array
        Angle of attack at which thin-airfoil theory has no lift [rad].
    """

    quarter_chord: Array
    radius: Array
    r_over_R: Array
    chord: Array
    width: Array
    backward: Array
    upward: Array
    zero_lift_angle: Array


def blade_strips(nodes: Array, rings: Rings, tip_radius: Scalar) -> Strips:
    """Find the sections of a lattice.

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Corner points of the lattice of blade 1, from leading edge and root [m].
    rings : Rings
        Rings of the lattice of blade 1.
    tip_radius : float
        Tip radius [m].

    Returns
    -------
    Strips
        Sections in the middle of the strips, where the collocation points are.
    """
    nc, ns = nodes.shape[0] - 1, nodes.shape[1] - 1
    f = jnp.asarray(strip_middle(ns))[:, None]
    edges = jnp.stack([nodes[0], nodes[-1]])
    leading, trailing = (1.0 - f) * edges[:, :-1] + f * edges[:, 1:]
    chord = jnp.linalg.norm(trailing - leading, axis=-1)
    backward = (trailing - leading) / chord[:, None]
    quarter_line = 0.75 * nodes[0] + 0.25 * nodes[-1]
    across = quarter_line[1:] - quarter_line[:-1]
    across = across - (across * backward).sum(-1, keepdims=True) * backward
    width = jnp.linalg.norm(across, axis=-1)
    upward = jnp.cross(backward, across / width[:, None])

    normal = rings.normal.reshape(nc, ns, 3)
    slope = -(normal * backward).sum(-1) / (normal * upward).sum(-1)
    quarter_chord = 0.75 * leading + 0.25 * trailing
    radius = jnp.sqrt(quarter_chord[:, 0] ** 2 + quarter_chord[:, 1] ** 2)
    return Strips(
        quarter_chord=quarter_chord,
        radius=radius,
        r_over_R=radius / tip_radius,
        chord=chord,
        width=width,
        backward=backward,
        upward=upward,
        zero_lift_angle=jnp.asarray(_zero_lift_weights(nc)) @ slope,
    )


def _zero_lift_weights(n_chordwise: int) -> np.ndarray:
    """Share of the camber line's slope at each collocation point in the zero-lift angle.

    It follows from the lattice in two dimensions: with vortices at x_j and the condition at x_i,
    sum_j gamma_j / (2 pi (x_i - x_j)) = W (alpha - slope_i), and the sum of the gammas is
    pi c W (alpha - alpha_0) (Katz and Plotkin 2001, section 11.1.1).
    """
    x = lattice_chord_fraction(n_chordwise)
    vortex, collocation = x[:-1] + 0.25 * np.diff(x), x[:-1] + 0.75 * np.diff(x)
    kernel = 1.0 / (2.0 * np.pi * (collocation[:, None] - vortex[None, :]))
    weights: np.ndarray = np.linalg.solve(kernel.T, np.ones(n_chordwise)) / np.pi
    return weights
