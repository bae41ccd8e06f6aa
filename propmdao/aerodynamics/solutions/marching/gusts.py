"""A gust along the shaft: air that for a while meets the rotor faster, or slower, than it flies.

The gust is the same over the whole rotor, one that is long against the radius,

    u(psi) = U/2 (1 - cos(2 pi s))  that comes and goes (1-cos),
    u(psi) = U/2 (1 - cos(pi s))    that comes and stays,        s = (psi - start) / length, 0 ... 1

with the azimuth psi of blade 1, turns counted. It adds to the axial part of the flight where the
blades meet it, and carries the wake along: what is older than the gust has its whole way, what is
younger less. The limit of one that stays is the rotor in faster flight.
"""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
from jax import Array

from propmdao.records.fidelity import Marching
from propmdao.records.pytrees import Scalar, record
from propmdao.records.states import RotorState


@record
class Gust:
    """A gust, uniform over the rotor.

    Attributes
    ----------
    speed : float
        Largest speed, positive against the thrust, as the air of faster flight along the shaft
        [m/s].
    start, length : float
        Azimuth of blade 1 at which it begins, and by which it turns until it is over or has come
        [rad].
    half_waves : float
        Half waves of its cosine: 2 of one that comes and goes, 1 of one that comes and stays.
    """

    speed: Scalar
    start: Scalar
    length: Scalar
    half_waves: Scalar

    def speed_at(self, azimuth: Scalar) -> Array:
        """Speed of the gust at an azimuth of blade 1, turns counted [m/s]."""
        s = jnp.clip((azimuth - self.start) / self.length, 0.0, 1.0)
        return 0.5 * self.speed * (1.0 - jnp.cos(self.half_waves * jnp.pi * s))

    def way_at(self, azimuth: Scalar | Array) -> Array:
        """Integral of the speed over the azimuth as far as here [m/s rad]."""
        x = azimuth - self.start
        s = jnp.clip(x / self.length, 0.0, 1.0)
        wave = self.half_waves * jnp.pi
        while_it_comes = 0.5 * self.length * (s - jnp.sin(wave * s) / wave)
        since = (2.0 - self.half_waves) * jnp.maximum(x - self.length, 0.0)
        return self.speed * (while_it_comes + since)


def gust_of(schedule: Marching) -> Gust:
    """The gust of a march; one of no speed where there is none."""
    turn = 2.0 * jnp.pi
    start, length = turn * schedule.gust_start, turn * schedule.gust_length
    half_waves = {"cosine": 2.0, "step": 1.0}[schedule.gust_shape]
    return Gust(*(jnp.asarray(x) for x in (schedule.gust_speed, start, length, half_waves)))


def in_gust(state: RotorState, speed: Array) -> RotorState:
    """State of a rotor that meets a gust: it flies as much faster along its shaft.

    Parameters
    ----------
    state : RotorState
        State in air at rest.
    speed : float
        Speed of the gust [m/s].

    Returns
    -------
    RotorState
        State in the gust; in axial flight with the speed along the shaft, which may be negative.
    """
    axial, edgewise = state.axial_speed + speed, state.edgewise_speed
    tilted = edgewise != 0.0
    return dataclasses.replace(
        state,
        speed=jnp.where(tilted, jnp.hypot(axial, edgewise), axial),
        incidence=jnp.where(tilted, jnp.arctan2(edgewise, axial), 0.0),
    )


def mean_of_turn(gust: Gust, state: RotorState, azimuth: Scalar) -> RotorState:
    """State of the rotor in the mean of the gust over the last revolution."""
    turn = 2.0 * jnp.pi
    return in_gust(state, (gust.way_at(azimuth) - gust.way_at(azimuth - turn)) / turn)


def downstream(gust: Gust, state: RotorState, ages: Array, azimuth: Scalar) -> Array:
    """Way along the shaft by which the stream has carried what blade 1 has shed.

    Parameters
    ----------
    gust : Gust
        The gust.
    state : RotorState
        State in air at rest.
    ages : (n,) array
        Azimuths since it was shed [rad].
    azimuth : float
        Azimuth of blade 1, turns counted [rad].

    Returns
    -------
    (n,) array
        Way against the thrust [m].
    """
    by_gust = gust.way_at(azimuth) - gust.way_at(azimuth - ages)
    return (state.axial_speed * ages + by_gust) / state.rotation_speed
