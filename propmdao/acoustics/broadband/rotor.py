"""Self-noise of a rotor: the sections of its blades over azimuth, heard by observers flying along.

Every strip at every azimuth is an airfoil in steady flow; what the observer hears of it is shifted
by Doppler and counts as long as it is heard (Brooks and Burley). Strips, azimuths and blades are
not correlated: their mean squares add.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.boundary_layer import BoundaryLayer, Trip, boundary_layer
from propmdao.acoustics.broadband.directivity import radiation
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import (
    SelfNoise,
    Tip,
    tip_noise,
    trailing_edge_noise,
)
from propmdao.records.pytrees import record
from propmdao.runtime.compilation import compiled


@record
class StripFlow:
    """Strips of blade 1 at azimuth 0 and the flow over them.

    Attributes
    ----------
    position : (n, 3) array
        Middle of each strip's trailing edge [m], from the inner to the outermost strip: the last
        one carries the tip vortex.
    chord_direction : (n, 3) array
        Unit vectors from leading to trailing edge.
    span_direction : (n, 3) array
        Unit vectors along the trailing edge, perpendicular to the chord.
    section : Section
        Sections and their flow; each array (n,), or (n_azimuths, n) where the flow changes over
        the turn.
    """

    position: Array
    chord_direction: Array
    span_direction: Array
    section: Section


@partial(compiled, static_argnames=("n_blades", "n_azimuths", "trip", "tip"))
def rotor_self_noise(
    strips: StripFlow,
    n_blades: int,
    rotation_speed: ArrayLike,
    speed: ArrayLike,
    sound_speed: ArrayLike,
    kinematic_viscosity: ArrayLike,
    observers: ArrayLike,
    frequency_hz: ArrayLike,
    n_azimuths: int = 24,
    trip: Trip = "none",
    tip: Tip = "rounded",
    layer: BoundaryLayer | None = None,
) -> SelfNoise:
    """Third-octave mean squares of a rotor's self-noise, averaged over the turn.

    Parameters
    ----------
    strips : StripFlow
        Blade 1 at azimuth 0.
    n_blades : int
        Number of equal blades (static).
    rotation_speed : float
        Omega about +z [rad/s].
    speed : float
        Speed V of the rotor and the observers along +z, subsonic [m/s].
    sound_speed, kinematic_viscosity : float
        Of the air [m/s], [m^2/s].
    observers : (n_observers, 3) array
        Positions from the rotor centre, moving with it [m].
    frequency_hz : (n_bands,) array
        Mid-band frequencies heard, see `third_octave_centers` [Hz].
    n_azimuths : int
        Equal steps of the turn (static).
    trip : {"none", "light", "heavy"}
        How the boundary layer is tripped (static).
    tip : {"rounded", "square"}
        Planform of the tip (static).
    layer : BoundaryLayer, optional
        Boundary layer of the strips by another model, arrays like those of the sections; without
        it the fits of `boundary_layer`.

    Returns
    -------
    SelfNoise
        Each mechanism (n_observers, n_bands) [Pa^2].

    Notes
    -----
    The default number of azimuths is within 0.1 dB at 20 deg below the rotor plane and lower. In
    and slightly above the plane the directivity has a narrow peak where a strip's chord points at
    the observer, nose first, a direction for which the report does not vouch: 24 azimuths were up
    to 1.7 dB off in single bands there.

    The levels are those of the report's air, at sea level: it has no term for the density.

    References
    ----------
    T. F. Brooks, D. S. Pope, M. A. Marcolini, NASA RP-1218 (1989). T. F. Brooks, C. L. Burley,
    Rotor broadband noise prediction with comparison to model data, AIAA 2001-2210.
    """
    section = strips.section
    if layer is None:
        layer = boundary_layer(
            section.chord, section.speed, section.angle_of_attack, kinematic_viscosity, trip
        )
    frequency = jnp.asarray(frequency_hz, float)[:, None, None]
    omega, sound_speed = jnp.asarray(rotation_speed, float), jnp.asarray(sound_speed, float)

    @jax.checkpoint  # the reverse derivative recomputes one observer at a time
    def hear(observer: Array) -> SelfNoise:
        sight, stretch = _emission(strips.position, observer, omega, speed, sound_speed, n_azimuths)
        chordwise, spanwise, normal = (
            sight[0] * x + sight[1] * y + sight[2] * z for x, y, z in (e.T for e in _axes(strips))
        )
        radiated = radiation(chordwise, spanwise, normal, section.speed / sound_speed)
        emitted = frequency * stretch  # (band, azimuth, strip)
        edge = trailing_edge_noise(
            emitted, section, layer, radiated, sound_speed, kinematic_viscosity, trip
        )
        vortex = tip_noise(
            emitted[..., -1],
            section.chord[..., -1],
            section.speed[..., -1],
            section.angle_of_attack[..., -1],
            radiated.high[..., -1],
            sound_speed,
            tip,
        )
        # Heard for dt = stretch dtau: that is its weight in the observer's time.
        share = n_blades / n_azimuths
        return SelfNoise(
            **{name: share * jnp.sum(p * stretch, (1, 2)) for name, p in edge._asdict().items()},
            tip=share * (vortex @ stretch[:, -1]),
        )

    return jax.lax.map(hear, jnp.asarray(observers, float))


def _axes(strips: StripFlow) -> tuple[Array, Array, Array]:
    """Chord, span and normal directions."""
    normal = jnp.cross(strips.chord_direction, strips.span_direction)
    return strips.chord_direction, strips.span_direction, normal


def _emission(
    position: Array,
    observer: Array,
    omega: Array,
    speed: ArrayLike,
    sound_speed: Array,
    n_azimuths: int,
) -> tuple[tuple[Array, Array, Array], Array]:
    """Lines of sight from emission to reception, in the blade's frame, and dt / dtau.

    The observer is turned back instead of the blade forward; each (azimuth, strip).
    """
    azimuth = 2 * np.pi * np.arange(n_azimuths)[:, None] / n_azimuths
    cos, sin = np.cos(azimuth), np.sin(azimuth)
    x, y, z = position.T
    sx = cos * observer[0] + sin * observer[1] - x
    sy = cos * observer[1] - sin * observer[0] - y
    sz = observer[2] - z
    # The observer flies on while the sound is under way: d = |s + M d e_z|.
    m = jnp.asarray(speed, float) / sound_speed
    s2 = sx**2 + sy**2 + sz**2
    d = (sz * m + jnp.sqrt((sz * m) ** 2 + (1 - m**2) * s2)) / (1 - m**2)
    rz = sz + m * d
    towards = omega * (x * sy - y * sx) / (sound_speed * d)  # Mach number of the rotation
    axial = m * rz / d
    return (sx, sy, rz), (1 - towards - axial) / (1 - axial)
