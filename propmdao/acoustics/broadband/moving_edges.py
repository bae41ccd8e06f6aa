"""Self-noise of trailing edges in any motion, as observers at rest or on their way hear it.

`broadband.rotor` is the same for a rotor in steady flight and observers who fly along, and faster.
"""

from __future__ import annotations

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.acoustics.broadband.boundary_layer import boundary_layer
from propmdao.acoustics.broadband.directivity import moving_radiation
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import SelfNoise, tip_noise, trailing_edge_noise
from propmdao.acoustics.broadband.smooth import at_least
from propmdao.acoustics.kinematics.emission import emission_distance
from propmdao.records.air import Air
from propmdao.records.models import Tip, Trip
from propmdao.records.pytrees import record
from propmdao.runtime.compilation import compiled

_LEAST_STRETCH = 0.01  # of corners that overtake their own sound, as in `broadband.rotor`


@record
class MovingEdges:
    """Strips of a blade, and the flow over them, at evenly spaced times of a whole turn.

    Attributes
    ----------
    time : (n_times,) array
        Source times [s].
    position, velocity : (n_times, n, 3) arrays
        Middle of each strip's trailing edge on the ground [m] and its velocity [m/s]; from the last
        strip the tip vortex is heard.
    chord_direction, span_direction : (n_times, n, 3) arrays
        Unit vectors from leading to trailing edge, and along the edge.
    section : Section
        Sections and their flow; each array (n,), or (n_times, n) where the flow changes.
    tip : Section
        Section that feeds the tip vortex: arrays without the axis of the strips.
    """

    time: Array
    position: Array
    velocity: Array
    chord_direction: Array
    span_direction: Array
    section: Section
    tip: Section


@partial(compiled, static_argnames=("trip", "tip"))
def moving_self_noise(
    edges: MovingEdges,
    observer: Array,
    observer_velocity: Array,
    frequency_hz: Array,
    air: Air,
    trip: Trip = "none",
    tip: Tip = "rounded",
) -> SelfNoise:
    """Third-octave mean squares of one blade, while an observer hears the given source times.

    Parameters
    ----------
    edges : MovingEdges
        Strips of the blade, slower than sound.
    observer : (3,) array
        Position of the observer on the ground at time 0 [m].
    observer_velocity : (3,) array
        Velocity of the observer [m/s].
    frequency_hz : (n_bands,) array
        Mid-band frequencies as the observer hears them [Hz].
    air : Air
        The undisturbed air.
    trip : {"none", "light", "heavy"}
        Trip of the boundary layers, which have the report's fits (static).
    tip : {"rounded", "square"}
        Planform of the tip (static).

    Returns
    -------
    SelfNoise
        Mean squares of each mechanism, (n_bands,) [Pa^2]. Laminar vortices are those of untripped
        layers as thick as these: whether a tripped blade sheds them the caller has to say.

    Notes
    -----
    What a strip emits in dtau is heard in dt: the mean is over the time in which the turn is heard.
    """
    mach = observer_velocity / air.sound_speed
    there = observer + observer_velocity * edges.time[:, None, None]
    apart = there - edges.position
    d = emission_distance(apart @ mach, jnp.sum(apart * apart, -1), mach @ mach)
    sight = apart + mach * d[..., None]
    approach = 1 - jnp.sum(edges.velocity * sight, -1) / (air.sound_speed * d)
    stretch = at_least(approach / (1 - (sight @ mach) / d), _LEAST_STRETCH)
    normal = jnp.cross(edges.chord_direction, edges.span_direction)
    chordwise, spanwise, across = (
        jnp.sum(sight * axis, -1) for axis in (edges.chord_direction, edges.span_direction, normal)
    )
    radiated = moving_radiation(chordwise, spanwise, across, approach)
    emitted = frequency_hz[:, None, None] * stretch  # (band, time, strip)
    share = stretch / jnp.sum(stretch, axis=0)
    section = edges.section
    viscosity = air.kinematic_viscosity
    layer = boundary_layer(section.chord, section.speed, section.angle_of_attack, viscosity, trip)
    layer = dataclasses.replace(layer, shedding=jnp.ones_like(layer.shedding))
    noise = trailing_edge_noise(emitted, section, layer, radiated, air)
    radiated_last = jax.tree.map(lambda q: q[..., -1], radiated)
    vortex = tip_noise(emitted[..., -1], edges.tip, radiated_last, air, tip)
    return SelfNoise(
        **{name: jnp.sum(p * share, (1, 2)) for name, p in noise._asdict().items()},
        tip=vortex @ share[:, -1],
        inflow_turbulence=jnp.zeros(len(frequency_hz)),
    )
