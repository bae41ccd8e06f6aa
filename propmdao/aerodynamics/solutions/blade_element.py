"""Blade elements in annuli: loads of a rotor in axial flight, without the lattice.

In each annulus the momentum of the air changes as the elements of the blades push it (Glauert 1935,
division L, chapter VII). With the inflow angle phi of the air that meets an element at the speed W,
its axial part W sin(phi) = V + u and its part in the plane W cos(phi) = Omega r - v,

    4 F |sin phi| (W sin phi - V)       = sigma W c_n
    4 F |sin phi| (Omega r - W cos phi) = sigma W c_t            sigma = B c / (2 pi r)

with the coefficients c_n along the thrust and c_t against the rotation and the loss F at tip and
root (Prandtl 1919, as Glauert has it). Without W this is one equation for phi,

    g(phi) = Omega r (4 F |sin phi| sin phi - sigma c_n)
             - V (4 F |sin phi| cos phi + sigma c_t) = 0,

continuous from windmilling to hover and finite everywhere, that of Ning (Wind Energy 17, 2014;
Struct. Multidiscip. Optim. 63, 2021) times what it is singular with.

`solve`, `flow_at`, `rough`, `evaluate` and `solution` are those of
`propmdao.aerodynamics.trim.Solver`.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.rings import vortex_rings
from propmdao.aerodynamics.lattice.strips import Strips, blade_strips
from propmdao.aerodynamics.sections.laws import SectionLaws, section_laws
from propmdao.aerodynamics.sections.recambering import SectionStates
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.elements import (
    LEAST_SINE,
    Element,
    against_rotation,
    element_in,
    prandtl_loss,
)
from propmdao.aerodynamics.solutions.elements import axial_rough as rough
from propmdao.aerodynamics.solutions.result import RotorLoads, sections_agree, unless_still
from propmdao.aerodynamics.solutions.roots import Guess, decreasing_root
from propmdao.aerodynamics.wakes.momentum import (
    axial_induced_velocity,
    within_momentum_theory,
)
from propmdao.records.loads import PointLoads
from propmdao.records.pytrees import Scalar, record
from propmdao.runtime.compilation import compiled

__all__ = ["evaluate", "flow_at", "rough", "solution", "solve"]

# Relative, in the inflow angle, before the last step: derivatives are taken there.
_TOLERANCE = 1.0e-10


@record
class BladeElements:
    """Elements of the blades of a rotor, in the case that they are to be solved for.

    Attributes
    ----------
    case : RotorCase
        Case to solve; its rotation speed is not 0.
    strips : Strips
        Elements of blade 1.
    inner, outer : (ns,) arrays
        Radii between which the elements lie [m].
    """

    case: RotorCase
    strips: Strips
    inner: Array
    outer: Array

    def turning(self, rotation_speed: Scalar) -> BladeElements:
        """The same elements at another rotation speed [rad/s]."""
        return BladeElements(self.case.turning(rotation_speed), self.strips, self.inner, self.outer)


def flow_at(case: RotorCase) -> BladeElements:
    """Divide the blade into elements: the strips of its lattice.

    Parameters
    ----------
    case : RotorCase
        Case to solve; its wake is not used.

    Returns
    -------
    BladeElements
        Elements of the blade, all numbers as floats.
    """
    case = case.in_floats()
    nodes, radius = case.rotor.nodes, case.rotor.radius
    quarter_line = 0.75 * nodes[0] + 0.25 * nodes[-1]
    edges = jnp.sqrt(quarter_line[:, 0] ** 2 + quarter_line[:, 1] ** 2)
    strips = blade_strips(nodes, vortex_rings(nodes), radius)
    return BladeElements(case, strips, edges[:-1], edges[1:])


def inflow_angles(flow: BladeElements) -> Array:
    """Solve for the angle between the air that meets each element and the rotor's plane.

    Parameters
    ----------
    flow : BladeElements
        Elements of the blade.

    Returns
    -------
    (ns,) array
        Inflow angle phi, exactly differentiable [rad]. Of several roots, one on the side of 0 on
        which the lift at the blade angle points.
    """
    laws = _laws(flow)
    fixed = jax.lax.stop_gradient((flow, laws))

    def missing(phi: Array, _: tuple[()]) -> tuple[Array, tuple[()]]:
        return -_momentum(fixed[0], _element(*fixed, phi), phi) / slope, ()

    zero = jnp.zeros_like(fixed[0].strips.radius)
    still = _element(*fixed, zero)
    guess, slope = _guess(fixed[0], still)
    downwash = _momentum(fixed[0], still, zero) < 0.0
    right = jnp.full_like(guess, 0.5 * jnp.pi)
    low, high = jnp.where(downwash, 0.0, -right), jnp.where(downwash, right, 0.0)
    phi, _ = decreasing_root(missing, low, high, Guess(guess, ()), _TOLERANCE, straight=True)
    # One Newton step squares the error left, and in it alone the arguments count: it gives the
    # derivatives.
    phi = jax.lax.stop_gradient(phi)
    by_angle = jax.jvp(
        lambda at: _momentum(fixed[0], _element(*fixed, at), at), (phi,), (jnp.ones_like(phi),)
    )[1]
    return phi - _momentum(flow, _element(flow, laws, phi), phi) / by_angle


@compiled
def solve(case: RotorCase) -> RotorLoads:
    """Solve for the loads at a rotation speed.

    Parameters
    ----------
    case : RotorCase
        The rotor and how it turns and flies; a rotation speed of 0 gives zero loads.

    Returns
    -------
    RotorLoads
        Loads, exactly differentiable in every argument; forces act at the quarter points.
    """
    turning, moving = case.never_still()
    flow = flow_at(moving)
    return unless_still(turning, _rotor_loads(flow, inflow_angles(flow)))


def evaluate(
    flow: BladeElements, thrust_required: Scalar, rotation_speed: Scalar
) -> tuple[Array, Array]:
    """Thrust at a rotation speed.

    Parameters
    ----------
    flow : BladeElements
        Elements of the blade.
    thrust_required : float
        Thrust of all blades [N]; the elements find their inflow without it.
    rotation_speed : float
        Rotation speed of the trial [rad/s].

    Returns
    -------
    thrust, phi : float, (ns,) array
        Thrust of all blades [N], inflow angles of the elements [rad].
    """
    flow = flow.turning(rotation_speed)
    phi = inflow_angles(flow)
    force, _ = _forces(flow, phi)
    return flow.case.rotor.n_blades * force[:, 2].sum(), phi


def solution(
    flow: BladeElements, thrust_required: Scalar, rotation_speed: Scalar, phi: Array
) -> RotorLoads:
    """Loads of the rotor at the inflow angles that `evaluate` returned.

    Parameters
    ----------
    flow : BladeElements
        Elements of the blade.
    thrust_required : float
        Thrust of all blades [N].
    rotation_speed : float
        Rotation speed at which the thrust is the one required [rad/s].
    phi : (ns,) array
        Inflow angles at that rotation speed [rad].

    Returns
    -------
    RotorLoads
        Loads of all blades.
    """
    return _rotor_loads(flow.turning(rotation_speed), phi)


def _laws(flow: BladeElements) -> SectionLaws | None:
    """Polars of the elements; induced velocities change their Reynolds numbers by little."""
    case, strips = flow.case, flow.strips
    if case.sections is None:
        return None
    turned, flown = case.state.rotation_speed * strips.radius, case.state.speed
    tip_speed = case.state.rotation_speed * case.rotor.radius
    share = tip_speed / jnp.sqrt(tip_speed**2 + flown**2)
    speed = jnp.sqrt(turned**2 + flown**2)
    return section_laws(strips, speed, share, case.state.air, case.sections)


def _element(flow: BladeElements, laws: SectionLaws | None, phi: Array) -> Element:
    """Elements in air of the speed 1 at an inflow angle."""
    downward = jnp.array([0.0, 0.0, -1.0])
    wind = jnp.cos(phi)[:, None] * against_rotation(flow.strips) + jnp.sin(phi)[:, None] * downward
    return element_in(flow.strips, laws, wind)


def solidity_of(flow: BladeElements) -> Array:
    """Share of the annuli that the blades take, (ns,)."""
    strips = flow.strips
    area = flow.case.rotor.n_blades * strips.chord * strips.width
    return area / (2.0 * jnp.pi * strips.radius * (flow.outer - flow.inner))


def _sine(phi: Array) -> Array:
    """|sin phi|, smooth at 0."""
    return jnp.sqrt(jnp.sin(phi) ** 2 + LEAST_SINE**2)


def loss_at(flow: BladeElements, phi: Array) -> Array:
    """Prandtl's loss F at tip and root."""
    r, sine, n_blades = flow.strips.radius, _sine(phi), flow.case.rotor.n_blades
    # The quarter line of a swept tip may end a little beyond the tip radius.
    root, tip = flow.inner[0], flow.outer[-1]
    at_root = prandtl_loss(n_blades, (r - root) / root, sine)
    return at_root * prandtl_loss(n_blades, (tip - r) / r, sine)


def _momentum(flow: BladeElements, element: Element, phi: Array) -> Array:
    """g(phi) over the speed Omega r, (ns,)."""
    solidity, loss = solidity_of(flow), loss_at(flow, phi)
    advance = flow.case.state.speed / (flow.case.state.rotation_speed * flow.strips.radius)
    momentum = 4.0 * loss * _sine(phi)
    axial = momentum * jnp.sin(phi) - solidity * element.c_n
    return axial - advance * (momentum * jnp.cos(phi) + solidity * element.c_t)


def _guess(flow: BladeElements, still: Element) -> tuple[Array, Array]:
    """Inflow angle for small angles and a lift of 2 pi per radian, and the slope of g there.

    g is 4 phi (phi - V / Omega r) - 2 pi sigma (theta - phi) then, with theta the blade angle from
    zero lift, which elements at an inflow angle of 0 meet.
    """
    lift = 2.0 * jnp.pi * solidity_of(flow)
    advance = flow.case.state.speed / (flow.case.state.rotation_speed * flow.strips.radius)
    theta = still.alpha - flow.strips.zero_lift_angle
    b = lift - 4.0 * advance
    root = jnp.sqrt(b * b + 16.0 * lift * jnp.abs(theta))
    phi = jnp.where(theta > 0.0, (root - b) / 8.0, -(root - b) / 8.0)
    phi = jnp.clip(phi, -1.4, 1.4)
    return phi, 8.0 * jnp.abs(phi - 0.5 * advance) + lift


def _forces(flow: BladeElements, phi: Array) -> tuple[Array, SectionStates]:
    """Forces on the elements of blade 1, (ns, 3) [N], and how its sections work."""
    state, strips, laws = flow.case.state, flow.strips, _laws(flow)
    element, solidity, loss = _element(flow, laws, phi), solidity_of(flow), loss_at(flow, phi)
    momentum = 4.0 * loss * _sine(phi)
    turned = state.rotation_speed * strips.radius
    speed = momentum * turned / (momentum * jnp.cos(phi) + solidity * element.c_t)
    pressure = 0.5 * state.air.density * speed**2
    force = (pressure * strips.chord * strips.width)[:, None] * element.force
    states = SectionStates(
        relative_speed=speed * element.share,
        angle_of_attack=element.alpha,
        lift_coefficient=element.cl,
        drag_coefficient=element.cd,
        borrowed_lift=jnp.zeros_like(speed),
        residual=_momentum(flow, element, phi) / solidity,
    )
    return force, states


def _rotor_loads(flow: BladeElements, phi: Array) -> RotorLoads:
    state, strips, n_blades = flow.case.state, flow.strips, flow.case.rotor.n_blades
    force, sections = _forces(flow, phi)
    x, y, _ = strips.quarter_chord.T
    strip_torque = y * force[:, 0] - x * force[:, 1]
    thrust, radius = n_blades * force[:, 2].sum(), flow.case.rotor.radius
    circulation = 0.5 * strips.chord * sections.relative_speed * sections.lift_coefficient
    return RotorLoads(
        thrust=thrust,
        torque=n_blades * strip_torque.sum(),
        induced_velocity=axial_induced_velocity(thrust, state, radius),
        circulation=circulation[None],
        strip_thrust=force[:, 2],
        strip_torque=strip_torque,
        point_loads=PointLoads(strips.quarter_chord, -force),
        strips=strips,
        sections=sections,
        converged=within_momentum_theory(thrust, state, radius) & sections_agree(sections),
    )
