"""Boundary layer at the trailing edge from momentum thickness, shape factor and transition.

In place of the fits of NASA RP-1218 to a NACA 0012, where a polar model knows the section's own.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.boundary_layer import BoundaryLayer, nonzero_chord
from propmdao.acoustics.broadband.smooth import ramp, smooth_step
from propmdao.records.loads import EdgeSide

#: Shape factors of a laminar layer on a flat plate (Blasius) and where it separates: Drela and
#: Giles, Viscous-inviscid analysis of transonic and low Reynolds number airfoils, AIAA J. 25
#: (1987); the second is where the friction of their laminar closure is zero.
LAMINAR_SHAPE, SEPARATED_SHAPE = 2.59, 4.0
#: Transition behind the first of these leaves a layer that may shed, behind the second all of it.
LAMINAR_FROM, LAMINAR_TO = 0.8, 0.9
_LEAST_SHAPE, _SHAPE_CORNER = 1.2, 0.1  # no layer has less; its thickness goes with 1 / (H - 1)
_SIDES = 0.5  # half width of the angle in which the suction side changes sides [deg]


def layer_of_sections(
    chord: ArrayLike,
    angle_of_attack: ArrayLike,
    upper: EdgeSide,
    lower: EdgeSide,
) -> BoundaryLayer:
    """Boundary layer of sections whose both sides are known.

    Parameters
    ----------
    chord : array
        Chord [m].
    angle_of_attack : array
        Angle from zero lift [rad]; its sign tells which side is the suction side.
    upper, lower : EdgeSide
        Both sides at the trailing edge.

    Returns
    -------
    BoundaryLayer
        Thicknesses, of the shape to which the arguments broadcast, and the share of laminar vortex
        shedding: 0 where the layer is tripped, because it is turbulent.

    Notes
    -----
    The thickness is theta (3.15 + 1.72 / (H - 1)) + delta*, of Drela and Giles.

    Airfoils shed laminar vortices where the layer of the pressure side separates laminar ahead of
    the trailing edge and is not turbulent there: the bubble amplifies the waves that the edge
    scatters (Desquesnes, Terracol and Sagaut, J. Fluid Mech. 591, 2007; Yakhina et al., Acoustics
    2, 2020: "a necessary condition"). The share is the product of two steps, over the shape factor
    from that of a flat plate to that of separation and over the place of transition.
    """
    on_top = smooth_step(jnp.rad2deg(jnp.asarray(angle_of_attack)), _SIDES)
    suction = jax.tree.map(lambda up, low: low + on_top * (up - low), upper, lower)
    pressure = jax.tree.map(lambda up, low: up + on_top * (low - up), upper, lower)
    c = nonzero_chord(chord)
    thick_s, displacement_s, momentum_s = _thicknesses(suction, c)
    thick_p, displacement_p, momentum_p = _thicknesses(pressure, c)
    return BoundaryLayer(
        thickness_pressure=thick_p,
        thickness_suction=thick_s,
        displacement_pressure=displacement_p,
        displacement_suction=displacement_s,
        momentum_pressure=momentum_p,
        momentum_suction=momentum_s,
        shedding=_laminar_share(pressure),
    )


def _thicknesses(side: EdgeSide, chord: Array) -> tuple[Array, Array, Array]:
    """Thickness, displacement and momentum thickness of a side [m]."""
    momentum = side.momentum_over_chord * chord
    shape = _LEAST_SHAPE + ramp(side.shape_factor - _LEAST_SHAPE, _SHAPE_CORNER)
    displacement = momentum * shape
    return momentum * (3.15 + 1.72 / (shape - 1)) + displacement, displacement, momentum


def _laminar_share(side: EdgeSide) -> Array:
    """Share of laminar vortex shedding, 0 ... 1."""

    def rise(x: Array, start: float, end: float) -> Array:
        return smooth_step(x - 0.5 * (start + end), 0.5 * (end - start))

    laminar = rise(side.transition, LAMINAR_FROM, LAMINAR_TO)
    return laminar * rise(side.shape_factor, LAMINAR_SHAPE, SEPARATED_SHAPE)
