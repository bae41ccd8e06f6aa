"""Elements of a blade in air that meets them: their coefficients, Prandtl's loss, and their thrust.

An element is the section in the middle of a strip, with the polar of two-dimensional flow.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple, Protocol, Self

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.sections.laws import SectionLaws, section_laws
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.wakes.momentum import (
    axial_induced_velocity,
    momentum_induced_velocity,
)
from propmdao.records.pytrees import Scalar
from propmdao.records.states import RotorState

# The swirl of an annulus that no air passes would be infinite: |sin phi| is kept above this,
# smoothly. At an inflow angle of 3 deg it changes the momentum by 0.02 %.
LEAST_SINE = 1.0e-3


class Element(NamedTuple):
    """Elements in air that meets them, which is a unit vector or a velocity.

    Attributes
    ----------
    force : (ns, 3) array
        Force over that of the dynamic pressure of 1 m/s on chord times width, [m^2/s^2] where the
        air is a velocity.
    c_n, c_t : (ns,) arrays
        Part of the force along the thrust, and against the rotation.
    alpha : (ns,) array
        Angle of attack of the sections [rad].
    share : (ns,) array
        Size of the part of the air that is in the plane of the sections.
    cl, cd : (ns,) arrays
        Coefficients of lift and drag.
    """

    force: Array
    c_n: Array
    c_t: Array
    alpha: Array
    share: Array
    cl: Array
    cd: Array


def against_rotation(strips: Strips) -> Array:
    """Directions against the rotation at the quarter points of the sections, (ns, 3)."""
    x, y, _ = strips.quarter_chord.T
    return jnp.stack([y, -x, jnp.zeros_like(x)], axis=1) / strips.radius[:, None]


def element_in(strips: Strips, laws: SectionLaws | None, wind: Array) -> Element:
    """Elements in air that meets them.

    Parameters
    ----------
    strips : Strips
        Elements of blade 1.
    laws : SectionLaws or None
        Polars of the elements; None for thin airfoils without drag.
    wind : (ns, 3) array
        Direction of the air, or its velocity.

    Returns
    -------
    Element
        Coefficients and angles.
    """
    backward, upward = ((wind * axis).sum(axis=1) for axis in (strips.backward, strips.upward))
    alpha, share = jnp.arctan2(upward, backward), jnp.sqrt(upward**2 + backward**2)
    if laws is None:
        cl, cd = 2.0 * jnp.pi * (alpha - strips.zero_lift_angle), jnp.zeros_like(alpha)
    else:
        more, cd = laws.beyond_thin(alpha)
        cl = laws.thin(alpha) + more
    cosine, sine = jnp.cos(alpha)[:, None], jnp.sin(alpha)[:, None]
    lift = cosine * strips.upward - sine * strips.backward
    drag = cosine * strips.backward + sine * strips.upward
    force = (share**2)[:, None] * (cl[:, None] * lift + cd[:, None] * drag)
    c_t = (force * against_rotation(strips)).sum(axis=1)
    return Element(force, force[:, 2], c_t, alpha, share, cl, cd)


def prandtl_loss(n_blades: int, distance: Array, sine: Array) -> Array:
    """Prandtl's loss at an end of the blades.

    Parameters
    ----------
    n_blades : int
        Number of blades.
    distance : array
        Distance from the end, over the radius at which the inflow angle counts; not 0.
    sine : array
        Size of the sine of that angle; not 0.

    Returns
    -------
    array
        Loss F, from 0 at the end to 1.
    """
    return 2.0 / jnp.pi * jnp.arccos(jnp.exp(-0.5 * n_blades * distance / sine))


def rough_thrust(case: RotorCase, strips: Strips, induced_velocity: Scalar) -> Array:
    """Thrust of all blades in uniform inflow, where the searches of other solutions begin.

    Elements with Prandtl's loss at the tip have the thrust of the lattice to about a tenth, at a
    hundredth of its cost; at an incidence that of the mean over a turn.

    Parameters
    ----------
    case : RotorCase
        Case to solve; it turns.
    strips : Strips
        Elements of blade 1.
    induced_velocity : float
        Induced velocity everywhere in the disk [m/s].

    Returns
    -------
    float
        Thrust [N].
    """
    state, rotor = case.state, case.rotor
    turned, axial = state.rotation_speed * strips.radius, state.axial_speed + induced_velocity
    speed = jnp.sqrt(turned**2 + axial**2 + 0.5 * state.edgewise_speed**2)
    laws = None
    if case.sections is not None:
        tip_speed = state.rotation_speed * rotor.radius
        share = tip_speed / jnp.sqrt(tip_speed**2 + axial**2)
        laws = section_laws(strips, speed, share, state.air, case.sections)
    downward = jnp.array([0.0, 0.0, -1.0])
    wind = turned[:, None] * against_rotation(strips) + axial * downward
    element = element_in(strips, laws, wind / jnp.sqrt(turned**2 + axial**2)[:, None])
    # The quarter line of a swept tip may end a little beyond the tip radius.
    distance = jnp.maximum(rotor.radius / strips.radius - 1.0, 1.0e-3)
    loss = prandtl_loss(rotor.n_blades, distance, jnp.sqrt((axial / speed) ** 2 + LEAST_SINE**2))
    pressure = 0.5 * state.air.density * speed**2
    lifted = pressure * strips.chord * strips.width * element.c_n * loss
    return rotor.n_blades * lifted.sum()


class Flow(Protocol):
    """What a solver prepares: a case, and the sections of its blade."""

    @property
    def case(self) -> RotorCase:
        """Case to solve."""

    @property
    def strips(self) -> Strips:
        """Sections of blade 1."""

    def turning(self, rotation_speed: Scalar) -> Self:
        """Return the same flow at another rotation speed [rad/s]."""


def rough(
    flow: Flow,
    thrust_required: Scalar,
    rotation_speed: Scalar,
    momentum: Callable[[Scalar, RotorState, Scalar], Array] = momentum_induced_velocity,
) -> Array:
    """Thrust at a rotation speed, in the uniform inflow of the thrust required.

    Parameters
    ----------
    flow : Flow
        What the solver has prepared.
    thrust_required : float
        Thrust of all blades [N].
    rotation_speed : float
        Rotation speed of the trial [rad/s].
    momentum : callable
        Momentum theory of the solver.

    Returns
    -------
    float
        Thrust of all blades by `rough_thrust` [N].
    """
    flow = flow.turning(rotation_speed)
    state, radius = flow.case.state, flow.case.rotor.radius
    return rough_thrust(flow.case, flow.strips, momentum(thrust_required, state, radius))


#: `rough` of solvers without incidence, whose momentum theory is that of axial flight.
axial_rough = partial(rough, momentum=axial_induced_velocity)
