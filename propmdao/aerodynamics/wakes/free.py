"""Free wake: nodes that move with the local velocity.

A node's place is where its blade shed it, carried by the free stream, and its displacement D by all
that blades and wake induce,

    x(a) = Rz(psi - a) (p + D(a)) + stream,        dD/dt + Omega dD/da = v(x),

in axes of the blade at the moment of shedding, which stay with the node: so D is the same for all
blades in axial flight, and smooth in the age a. It is held at equally spaced ages; from one step to
the next it is carried along by the angle of the step, read between the ages by a cubic, and grows
by the method of Adams and Bashforth of second order, with one evaluation of the velocity per step.

After some turns the law of the prescribed wake takes over, gradually: v -> (1 - s) v + s v_law. So
no wake ends where others roll up, and what becomes of its far part does not come back.
Only some of the filaments move, and the sheets between them, with cores that grow, act on them;
what the others do is read between them.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import spun
from propmdao.aerodynamics.vortices.biot_savart import summed_velocities
from propmdao.aerodynamics.wakes.lags import lag_weights, read
from propmdao.aerodynamics.wakes.sheets import (
    SINGLE,
    aged_sheets,
    fewer_filaments,
    sheet_velocities,
)
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.records.pytrees import Scalar, record
from propmdao.records.states import RotorState


@record
class FreeFilaments:
    """Filaments that move, and how the lattice's follow from them.

    Attributes
    ----------
    edge : (n_filaments, 3) array
        Where they leave blade 1 [m].
    ages : (n_ages,) array
        Ages at which their displacement is held, equally spaced from 0 [rad].
    by_law : (n_ages,) array
        Share of the prescribed law in their velocity.
    core : scalar
        Core radius when they are shed [m].
    to_lattice : (ns + 1, n_filaments) array
        Weights from their displacement to that of all filaments.
    to_strips : (n_filaments - 1, ns) array
        Weights from the circulation of the lattice's strips to that between them.
    """

    edge: Array
    ages: Array
    by_law: Array
    core: Scalar
    to_lattice: Array
    to_strips: Array


@record
class FreeWakeState:
    """Where a free wake is.

    Attributes
    ----------
    displacement : (m, n_filaments, n_ages, 3) array
        Displacement by induced velocities of the wakes of m blades, in axes of the blade when the
        node was shed [m].
    velocity : (m, n_filaments, n_ages, 3) array
        Velocity at the step before, in the same axes [m/s].
    """

    displacement: Array
    velocity: Array


def free_filaments(
    edge: Array, ages: np.ndarray, free_turns: float, core: Scalar, n_filaments: int
) -> FreeFilaments:
    """Choose the filaments that move; call it outside ``jit``.

    Parameters
    ----------
    edge : (ns + 1, 3) array
        Where the lattice's filaments leave blade 1 [m].
    ages : (n_ages,) array
        Ages at which the displacement is held, equally spaced from 0 [rad].
    free_turns : float
        Turns after which the law takes over, over one turn.
    core : float
        Core radius when they are shed [m].
    n_filaments : int
        Filaments that move, at most those of the lattice.

    Returns
    -------
    FreeFilaments
        Every so many of the lattice's filaments, root and tip among them.
    """
    chosen, to_strips = fewer_filaments(edge, n_filaments)
    step = np.diff(np.asarray(edge), axis=0)
    place = np.concatenate([[0.0], np.cumsum(np.linalg.norm(step, axis=1))])
    identity = np.eye(chosen.size)
    to_lattice = np.stack([np.interp(place, place[chosen], row) for row in identity], axis=1)
    x = np.clip(ages / (2.0 * np.pi) - free_turns, 0.0, 1.0)
    return FreeFilaments(
        edge[chosen],
        jnp.asarray(ages),
        jnp.asarray(x * x * (3.0 - 2.0 * x)),
        core,
        jnp.asarray(to_lattice),
        jnp.asarray(to_strips),
    )


def placed(
    edge: Array,
    displacement: Array,
    shed: tuple[Array, Array],
    azimuth: Array,
    state: RotorState,
) -> Array:
    """Nodes of the wake of all blades, seen from one of them.

    Parameters
    ----------
    edge : (n_filaments, 3) array
        Where the filaments leave a blade, in its frame [m].
    displacement : (n_blades, n_filaments, n_nodes, 3) array
        Displacement by induced velocities, in axes of the blade when the node was shed, of the
        blades from the one that sees them on [m].
    shed : tuple of (n_nodes,) arrays
        Azimuths of the nodes behind their blade [rad], and the way along the shaft by which the
        stream has carried them since [m].
    azimuth : float
        Azimuth of the blade that sees them [rad].
    state : RotorState
        Rotation speed, flight speed and incidence of the rotor.

    Returns
    -------
    (n_filaments, n_blades, n_nodes, 3) array
        Nodes in the frame of the blade [m].
    """
    n_blades, (ages, downstream) = displacement.shape[0], shed
    nodes = spun(edge[:, None, :] + displacement, _behind(ages, n_blades))
    stream = sideways_drift(ages, azimuth[None], state)[0].at[:, 2].add(-downstream)
    return (nodes + stream).swapaxes(0, 1)


def _behind(ages: Array, n_blades: int) -> Array:
    """Angles from a blade to where the nodes of each were shed, (n_blades, 1, n_nodes) [rad]."""
    return (2.0 * jnp.pi / n_blades * jnp.arange(n_blades))[:, None, None] - ages


def at_ages(values: Array, place: Array) -> Array:
    """Values (..., n_ages, 3) read at places between the ages, in spacings: (..., n_places, 3)."""
    step, weight = lag_weights(place, values.shape[-2])
    return jnp.einsum("pk,...pkc->...pc", weight, values[..., step, :])


def lattice_displacement(free: FreeFilaments, state: FreeWakeState, ages: Array) -> Array:
    """Displacement of all filaments of the lattice at ages of its own.

    Parameters
    ----------
    free : FreeFilaments
        Filaments that move.
    state : FreeWakeState
        Where they are.
    ages : (n_nodes,) array
        Ages wanted, within those held [rad].

    Returns
    -------
    (m, ns + 1, n_nodes, 3) array
        Displacement, in axes of the blade when the node was shed [m].
    """
    of_moving = at_ages(state.displacement, ages / free.ages[1])
    return jnp.einsum("fg,mgac->mfac", free.to_lattice, of_moving)


def law_displacement(free: FreeFilaments, helix: Array, state: RotorState) -> Array:
    """Displacement that the prescribed law gives the filaments that move.

    Parameters
    ----------
    free : FreeFilaments
        Filaments that move.
    helix : (n_filaments, n_ages, 3) array
        Nodes of these filaments by the law, behind blade 1 [m].
    state : RotorState
        Rotation speed and flight speed of the rotor.

    Returns
    -------
    (n_filaments, n_ages, 3) array
        Displacement without that by the free stream, in axes of the blade at shedding [m].
    """
    shed = spun(helix, free.ages) - free.edge[:, None, :]
    return shed.at[..., 2].add(state.axial_speed * free.ages / state.rotation_speed)


def moved(
    free: FreeFilaments,
    state: FreeWakeState,
    velocity: Array,
    by_law: Array,
    of_step: tuple[Scalar, Scalar],
) -> FreeWakeState:
    """Move the wake by a step.

    Parameters
    ----------
    free : FreeFilaments
        Filaments that move.
    state : FreeWakeState
        Where they are, and their velocity a step ago.
    velocity : (m, n_filaments, n_ages, 3) array
        Velocity induced at the nodes, in axes of the blade when the node was shed [m/s].
    by_law : (n_filaments, n_ages, 3) array
        Displacement by the prescribed law, from whose slope its velocity follows [m].
    of_step : tuple of float
        Angle [rad] and time [s] of the step.

    Returns
    -------
    FreeWakeState
        Where they are after it.
    """
    (step, dt), spacing = of_step, free.ages[1]
    slope = jnp.diff(by_law, axis=1, append=2.0 * by_law[:, -1:] - by_law[:, -2:-1]) / spacing
    share = free.by_law[:, None]
    velocity = (1.0 - share) * velocity + share * slope * step / dt
    place = (free.ages - step) / spacing
    born = (place < -1e-9)[:, None]  # a step ago these were on the blade
    place = jnp.maximum(place, 0.0)
    before = jnp.where(born, velocity, at_ages(state.velocity, place))
    displacement = state.displacement + dt * (1.5 * velocity - 0.5 * before)
    displacement = at_ages(displacement, place)
    # Nodes younger than the step have been under way for their age alone.
    young = velocity[:, :, :1] * (free.ages[:, None] / step * dt)
    return FreeWakeState(jnp.where(born, young, displacement), velocity)


def induced_at_nodes(
    free: FreeFilaments,
    nodes: Array,
    strips: Array,
    lag: Array,
    bound: tuple[Array, Array, Array],
    state: RotorState,
    n_moving: int,
) -> Array:
    """Velocity that wake and blades induce at the nodes of the wake.

    Parameters
    ----------
    free : FreeFilaments
        Filaments that move.
    nodes : (n_filaments, n_blades, n_ages, 3) array
        Nodes of all blades, seen from blade 1 [m].
    strips : (n_lags, n_blades, ns) array
        Circulation of the lattice's strips, at present, a step ago and so on [m^2/s].
    lag : (n_ages - 1,) array
        Time since the rings between the nodes were shed, in steps.
    bound : tuple
        Start and end of the segments of all blades, (n, 3) [m], and their circulation, (n,).
    state : RotorState
        Rotation speed and air of the rotor.
    n_moving : int
        Blades, from blade 1 on, at whose wakes the velocity is wanted.

    Returns
    -------
    (n_moving, n_filaments, n_ages, 3) array
        Velocity, in axes of the blade when the node was shed [m/s].
    """
    n_blades = nodes.shape[1]
    coarse = jnp.einsum("ks,lbs->lbk", free.to_strips, strips)
    ring = read(jnp.broadcast_to(lag, (coarse.shape[2], lag.size)), coarse)

    sheets = aged_sheets(nodes, free.ages, state, free.core)
    # In lengths of the way from the axis to the tip, for single precision.
    length = jnp.linalg.norm(free.edge[-1, :2])
    start, end, circulation = bound
    lengths = sheets, start, end, jnp.full(circulation.size, free.core)
    flows = ring, coarse[0], circulation
    scaled = jax.tree.map(lambda x: (x / length).astype(SINGLE), (lengths, flows))
    (sheets, start, end, bound_core), (ring, present, circulation) = scaled

    def at_filament(points: Array) -> Array:
        by_wake = sheet_velocities(points, sheets, ring, present)
        return by_wake + summed_velocities(points, start, end, bound_core, circulation)

    points = sheets.nodes[:, :n_moving].swapaxes(0, 1).reshape(-1, free.ages.size, 3)
    velocity = jax.lax.map(at_filament, points).swapaxes(1, 2).astype(float)
    velocity = velocity.reshape(n_moving, -1, free.ages.size, 3)
    return spun(velocity, -_behind(free.ages, n_blades)[:n_moving])
