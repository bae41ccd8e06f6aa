"""Blade elements at an incidence, azimuth by azimuth, in the inflow of Pitt and Peters.

In the mean over a turn an annulus keeps the momentum of `blade_element`, with the flux of air that
Glauert's theory of the tilted disk has for it (ARC R&M 1026, 1926),

    4 F G u = sigma <W^2 c_n>,   4 F G v = sigma <W^2 c_t>,   G^2 = (V cos i + u)^2 + (V sin i)^2

with the induced velocity u along the shaft, the swirl v and means <> over the azimuths. Around the
turn the induced velocity is that of D. M. Pitt and D. A. Peters (Vertica 5, 1981), in the form of
Peters and HaQuang (J. Am. Helicopter Soc. 33, 1988): with psi from downstream,

    u + Omega R (l_1 + (l_c cos psi + l_s sin psi) r / R)
    l_1 = - 15 pi / 64 X C_c / v_m                              X = tan(chi / 2)
    l_s = 4 / (1 + cos chi) C_s / v_m
    l_c = 15 pi / 64 X C_T / v_T + 4 cos chi / (1 + cos chi) C_c / v_m

where C_T is the thrust over rho pi R^2 (Omega R)^2, C_c and C_s the moments that the thrust has
about the hub, weighted by cos psi and sin psi, over that times R; v_T is the resultant of the air
through the disk, v_m its mass flow parameter, chi the skew of the wake. In axial flight the load is
the same all around, nothing of this is left, and the equations are those of `blade_element`.

`solve`, `flow_at`, `evaluate` and `solution` are those of `propmdao.aerodynamics.trim.Solver`.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import spun
from propmdao.aerodynamics.sections.laws import SectionLaws, section_laws
from propmdao.aerodynamics.sections.recambering import SectionStates
from propmdao.aerodynamics.solutions.blade_element import (
    BladeElements,
    flow_at,
    loss_at,
    solidity_of,
)
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.elements import (
    LEAST_SINE,
    Element,
    against_rotation,
    element_in,
    rough,
)
from propmdao.aerodynamics.solutions.period.flow import azimuths_for
from propmdao.aerodynamics.solutions.period.onset import azimuths_of
from propmdao.aerodynamics.solutions.result import TiltedLoads, sections_agree, unless_still
from propmdao.aerodynamics.wakes.momentum import (
    momentum_induced_velocity,
    within_momentum_theory,
)
from propmdao.records.loads import PeriodicLoads
from propmdao.records.pytrees import Scalar
from propmdao.runtime import linear_algebra
from propmdao.runtime.compilation import compiled

__all__ = ["evaluate", "flow_at", "rough", "solution", "solve"]

# Of the equations, which are of the order of the inflow ratio squared; derivatives are taken there.
_TOLERANCE = 1.0e-13
_MAX_STEPS = 40
_FRACTIONS = 0.5 ** np.arange(8)  # of a Newton step that are tried: polars bend sharply near stall
_SWEEPS = 8  # of the uniform induced velocity with which the search begins
_COUPLING = 15.0 * np.pi / 64.0
# Of the tip speed: where a blade retreats the air may stand still, and polars have no Reynolds
# number of 0. It is below what meets an element in axial flight.
_LEAST_SPEED = 1.0e-2


@compiled
def solve(case: RotorCase) -> TiltedLoads:
    """Solve for the loads at a rotation speed.

    Parameters
    ----------
    case : RotorCase
        The rotor and how it turns and flies; a rotation speed of 0 gives zero loads.

    Returns
    -------
    TiltedLoads
        Loads, exactly differentiable in every argument; forces act at the quarter points.
    """
    turning, moving = case.never_still()
    flow = flow_at(moving)
    return unless_still(turning, _tilted_loads(flow, _inflow(flow)))


def evaluate(
    flow: BladeElements, thrust_required: Scalar, rotation_speed: Scalar
) -> tuple[Array, Array]:
    """Thrust at a rotation speed.

    Parameters
    ----------
    flow : BladeElements
        Elements of the blade.
    thrust_required : float
        Mean thrust of all blades [N]; the elements find their inflow without it.
    rotation_speed : float
        Rotation speed of the trial [rad/s].

    Returns
    -------
    thrust, inflow : float, (2 ns + 3,) array
        Mean thrust of all blades [N], and the inflow over the tip speed.
    """
    flow = flow.turning(rotation_speed)
    inflow = _inflow(flow)
    return _thrust(flow, _air(flow, _laws(flow), inflow)), inflow


def solution(
    flow: BladeElements, thrust_required: Scalar, rotation_speed: Scalar, inflow: Array
) -> TiltedLoads:
    """Loads of the rotor in the inflow that `evaluate` returned.

    Parameters
    ----------
    flow : BladeElements
        Elements of the blade.
    thrust_required : float
        Mean thrust of all blades [N].
    rotation_speed : float
        Rotation speed at which the thrust is the one required [rad/s].
    inflow : (2 ns + 3,) array
        Inflow at that rotation speed.

    Returns
    -------
    TiltedLoads
        Loads of all blades.
    """
    return _tilted_loads(flow.turning(rotation_speed), inflow)


class _Air(NamedTuple):
    """The air at the elements in an inflow, and what it does."""

    element: Element  # (n_azimuths, ns), of velocities
    on_blade: Array  # (n_azimuths, ns, 3), force on the elements, in the blade's frame [N]
    mean_angle: Array  # (ns,), of the mean air to the plane [rad]
    flux: Array  # (ns,), G [m/s]
    axial: Array  # (ns,), u [m/s]
    swirl: Array  # (ns,), v [m/s]


def _psi(flow: BladeElements) -> Array:
    """Azimuths of blade 1, (n_azimuths, 1)."""
    case = flow.case
    return jnp.asarray(azimuths_of(azimuths_for(case.n_azimuths, case.rotor.n_blades)))[:, None]


def _tip_speed(flow: BladeElements) -> Array:
    return jnp.asarray(flow.case.state.rotation_speed * flow.case.rotor.radius)


def _laws(flow: BladeElements) -> SectionLaws | None:
    """Polars of the elements at each azimuth; induced velocities change them by little."""
    case, strips = flow.case, flow.strips
    if case.sections is None:
        return None
    state, sections, tip_speed = case.state, case.sections, _tip_speed(flow)
    turned = state.rotation_speed * strips.radius - state.edgewise_speed * jnp.sin(_psi(flow))
    speed = jnp.maximum(jnp.hypot(turned, state.axial_speed), _LEAST_SPEED * tip_speed)
    share = tip_speed / jnp.hypot(tip_speed, state.axial_speed)
    return jax.vmap(lambda w: section_laws(strips, w, share, state.air, sections))(speed)


def _air(flow: BladeElements, laws: SectionLaws | None, inflow: Array) -> _Air:
    state, strips, psi = flow.case.state, flow.strips, _psi(flow)
    ns, tip_speed = strips.radius.size, _tip_speed(flow)
    edgewise, through = state.edgewise_speed, state.axial_speed
    u, v = tip_speed * inflow[:ns], tip_speed * inflow[ns : 2 * ns]
    uniform, fore_aft, sideways = tip_speed * inflow[2 * ns :]
    # Azimuths of Pitt and Peters begin downstream, at -x.
    around = uniform - strips.r_over_R * (fore_aft * jnp.cos(psi) + sideways * jnp.sin(psi))
    down = through + u + around
    turned = state.rotation_speed * strips.radius - v
    stream = jnp.stack(
        jnp.broadcast_arrays(-edgewise * jnp.cos(psi), edgewise * jnp.sin(psi), -down), axis=-1
    )
    wind = turned[:, None] * against_rotation(strips) + stream
    if laws is None:
        element = jax.vmap(lambda air: element_in(strips, None, air))(wind)
    else:
        element = jax.vmap(lambda law, air: element_in(strips, law, air))(laws, wind)
    area = 0.5 * state.air.density * strips.chord * strips.width
    speed = jnp.hypot(turned, through + u)
    flux = jnp.sqrt((through + u) ** 2 + edgewise**2 + (LEAST_SINE * speed) ** 2)
    angle = jnp.arctan2(through + u, turned)
    return _Air(element, area[:, None] * element.force, angle, flux, u, v)


def _thrust(flow: BladeElements, air: _Air) -> Array:
    """Mean thrust of all blades [N]."""
    return flow.case.rotor.n_blades * air.on_blade[..., 2].sum(axis=1).mean()


def _missing(flow: BladeElements, laws: SectionLaws | None, inflow: Array) -> Array:
    """What the equations of the inflow miss, over the square of the tip speed: (2 ns + 3,)."""
    air, tip_speed = _air(flow, laws, inflow), _tip_speed(flow)
    solidity, flux = solidity_of(flow), 4.0 * loss_at(flow, air.mean_angle) * air.flux
    push, turn = air.element.c_n.mean(axis=0), air.element.c_t.mean(axis=0)
    annuli = flux * air.axial - solidity * push, flux * air.swirl - solidity * turn
    around = inflow[-3:] - _around_the_disk(flow, air)
    return jnp.concatenate([*annuli, tip_speed**2 * around]) / tip_speed**2


def _around_the_disk(flow: BladeElements, air: _Air) -> Array:
    """Parts l_1, l_c and l_s of the inflow by Pitt and Peters: (3,), over the tip speed."""
    rotor, state, tip_speed, psi = flow.case.rotor, flow.case.state, _tip_speed(flow), _psi(flow)
    lift = air.on_blade[..., 2]
    unit = rotor.n_blades / (state.air.density * jnp.pi * rotor.radius**2 * tip_speed**2)
    arm = flow.strips.r_over_R
    c_thrust = unit * lift.sum(axis=1).mean()
    # Against the axes of the rotor: psi of the model begins at -x.
    c_cos, c_sin = (
        -unit * (arm * wave * lift).sum(axis=1).mean() for wave in (jnp.cos(psi), jnp.sin(psi))
    )
    mu, through = state.edgewise_speed / tip_speed, state.axial_speed / tip_speed
    induced = momentum_induced_velocity(_thrust(flow, air), state, rotor.radius) / tip_speed
    total = jnp.hypot(mu, through + induced)
    mass = (mu**2 + (through + induced) * (through + 2.0 * induced)) / total
    cosine = (through + induced) / total
    tangent = mu / (total + through + induced)  # of half the skew
    return jnp.stack(
        [
            -_COUPLING * tangent * c_cos / mass,
            _COUPLING * tangent * c_thrust / total + 4.0 * cosine / (1.0 + cosine) * c_cos / mass,
            4.0 / (1.0 + cosine) * c_sin / mass,
        ]
    )


def _inflow(flow: BladeElements) -> Array:
    """Solve for the inflow over the tip speed, (2 ns + 3,): u, v, l_1, l_c, l_s.

    Damped Newton steps from the uniform inflow of momentum theory; the last one gives derivatives.
    """
    laws = _laws(flow)
    fixed = jax.lax.stop_gradient((flow, laws))

    def missing(inflow: Array) -> Array:
        return _missing(*fixed, inflow)

    def with_value(inflow: Array) -> tuple[Array, Array]:
        value = missing(inflow)
        return value, value

    slope_and_missing = jax.jacfwd(with_value, has_aux=True)

    def unfinished(state: _Newton) -> Array:
        return (state.n_steps < _MAX_STEPS) & (jnp.abs(state.missing).max() > _TOLERANCE)

    def step(state: _Newton) -> _Newton:
        slope, value = slope_and_missing(state.inflow)
        trials = state.inflow - jnp.asarray(_FRACTIONS)[:, None] * linear_algebra.solve(
            slope, value
        )
        best = jnp.nanargmin((jax.vmap(missing)(trials) ** 2).sum(axis=1))
        settled = jnp.abs(value).max() <= _TOLERANCE
        following = jnp.where(settled, state.inflow, trials[best])
        return _Newton(state.n_steps + 1, following, value, slope)

    start = _uniform(*fixed)
    first = _Newton(0, start, jnp.full_like(start, jnp.inf), jnp.eye(start.size))
    end = jax.lax.while_loop(unfinished, step, first)
    inflow, slope = jax.lax.stop_gradient((end.inflow, end.slope))
    return inflow - linear_algebra.solve(slope, _missing(flow, laws, inflow))


class _Newton(NamedTuple):
    """State of Newton's method."""

    n_steps: Array | int
    inflow: Array
    missing: Array
    slope: Array


def _uniform(flow: BladeElements, laws: SectionLaws | None) -> Array:
    """Inflow of momentum theory that is the same everywhere, nearly that of its own thrust."""
    state, radius, ns = flow.case.state, flow.case.rotor.radius, flow.strips.radius.size
    tip_speed = _tip_speed(flow)
    everywhere = jnp.concatenate([jnp.ones(ns), jnp.zeros(ns + 3)])

    def nearer(_: int, w: Array) -> Array:
        thrust = _thrust(flow, _air(flow, laws, w / tip_speed * everywhere))
        return 0.5 * (w + momentum_induced_velocity(thrust, state, radius))

    w = jax.lax.fori_loop(0, _SWEEPS, nearer, 0.05 * tip_speed)
    return w / tip_speed * everywhere


def _tilted_loads(flow: BladeElements, inflow: Array) -> TiltedLoads:
    rotor, state, strips = flow.case.rotor, flow.case.state, flow.strips
    laws, psi, tip_speed = _laws(flow), _psi(flow), _tip_speed(flow)
    air = _air(flow, laws, inflow)
    missing = _missing(flow, laws, inflow)
    moment = jnp.cross(strips.quarter_chord, air.on_blade)
    # In the axes that do not turn.
    blade_force, blade_moment = (
        spun(of_strips.sum(axis=1), psi[:, 0]) for of_strips in (air.on_blade, moment)
    )
    hub_force, hub_moment = (
        rotor.n_blades * of_blade.mean(axis=0) for of_blade in (blade_force, blade_moment)
    )
    speed, element = air.element.share, air.element
    ns = strips.radius.size
    of_annulus = jnp.abs(missing[:ns]) + jnp.abs(missing[ns : 2 * ns])
    residual = of_annulus * (tip_speed / (state.rotation_speed * strips.radius)) ** 2
    sections = SectionStates(
        relative_speed=speed,
        angle_of_attack=element.alpha,
        lift_coefficient=element.cl,
        drag_coefficient=element.cd,
        borrowed_lift=jnp.zeros_like(speed),
        residual=jnp.broadcast_to(residual / solidity_of(flow), speed.shape),
    )
    settled = jnp.abs(missing[-3:]).max() < 1.0e-8
    within = within_momentum_theory(hub_force[2], state, rotor.radius)
    circulation = 0.5 * strips.chord * speed * element.cl
    return TiltedLoads(
        thrust=hub_force[2],
        torque=-hub_moment[2],
        hub_force=hub_force,
        hub_moment=hub_moment,
        blade_force=blade_force,
        blade_moment=blade_moment,
        strip_thrust=air.on_blade[..., 2].mean(axis=0),
        strip_torque=-moment[..., 2].mean(axis=0),
        induced_velocity=momentum_induced_velocity(hub_force[2], state, rotor.radius),
        circulation=circulation[:, None, :],
        point_loads=PeriodicLoads(strips.quarter_chord, -air.on_blade),
        strips=strips,
        sections=sections,
        attached=jnp.ones_like(speed),
        converged=within & settled & sections_agree(sections),
    )
