"""Self-noise of a rotor: the sections of its blades over azimuth, heard by observers flying along.

The shaft may stand at an angle to the flight, and the flow over the sections change over the turn.

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

from propmdao.acoustics.broadband.boundary_layer import BoundaryLayer, boundary_layer
from propmdao.acoustics.broadband.directivity import moving_radiation
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import (
    SelfNoise,
    edge_sources,
    noise_of_edges,
    tip_noise,
)
from propmdao.acoustics.broadband.smooth import at_least
from propmdao.acoustics.kinematics.emission import emission_distance
from propmdao.records.models import SelfNoiseModel
from propmdao.records.pytrees import record
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

# The corner of a trailing edge lies farther out than the tip and may move faster than sound where
# the tip does not: what it emits toward the observer is heard at once, but not before.
_LEAST_STRETCH = 0.01
_TIP_RADIUS = 0.96  # of the blade: where the section is taken that feeds the tip vortex


@record
class StripFlow:
    """Strips of blade 1 at azimuth 0 and the flow over them.

    Attributes
    ----------
    position : (n, 3) array
        Middle of each strip's trailing edge [m], from the inner to the outermost strip: from the
        last one the tip vortex is heard.
    chord_direction : (n, 3) array
        Unit vectors from leading to trailing edge.
    span_direction : (n, 3) array
        Unit vectors along the trailing edge, perpendicular to the chord.
    section : Section
        Sections and their flow; each array (n,), or (n_azimuths, n) where the flow changes over
        the turn.
    layer : BoundaryLayer or None
        Boundary layer of `layer_of_sections`, arrays like those of the sections; None for the fits
        of `boundary_layer`.
    """

    position: Array
    chord_direction: Array
    span_direction: Array
    section: Section
    layer: BoundaryLayer | None = None


@partial(compiled, static_argnames=("n_blades", "model", "n_azimuths"))
def rotor_self_noise(
    strips: StripFlow,
    n_blades: int,
    state: RotorState,
    observers: ArrayLike,
    frequency_hz: ArrayLike,
    model: SelfNoiseModel = SelfNoiseModel(),  # noqa: B008 - frozen
    n_azimuths: int = 24,
) -> SelfNoise:
    """Third-octave mean squares of a rotor's self-noise, averaged over the turn.

    Parameters
    ----------
    strips : StripFlow
        Strips of blade 1 at azimuth 0.
    n_blades : int
        Number of equal blades (static).
    state : RotorState
        Rotation speed Omega about +z, flight of the rotor and the observers, subsonic, and the air.
    observers : (n_observers, 3) array
        Positions from the rotor centre, moving with it [m].
    frequency_hz : (n_bands,) array
        Mid-band frequencies as the observers hear them, see `third_octave_centers` [Hz].
    model : SelfNoiseModel
        Trip of the boundary layers where the strips have none of their own: the report's fits, with
        one trip for all; planform of the tip (static).
    n_azimuths : int
        Number of equal steps in the turn (static): those of the sections where their flow changes.

    Returns
    -------
    SelfNoise
        Mean squares of each mechanism, (n_observers, n_bands) [Pa^2]; turbulence that flows in is
        none of them (`rotor_inflow_noise`).

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
    state = jax.tree.map(lambda q: jnp.asarray(q, float), state)
    section, layer, air = strips.section, strips.layer, state.air
    if layer is None:
        if isinstance(model.trip, tuple):
            raise ValueError("trips by station are known to whoever knows the stations: give layer")
        layer = boundary_layer(
            section.chord,
            section.speed,
            section.angle_of_attack,
            air.kinematic_viscosity,
            model.trip or "none",
        )
    frequency = jnp.asarray(frequency_hz, float)[:, None, None]
    tip, sources = tip_section(strips), edge_sources(section, layer, air)

    @jax.checkpoint  # the reverse derivative recomputes one observer at a time
    def noise_at(observer: Array) -> SelfNoise:
        sight, approach, stretch = emission(strips, observer, state, n_azimuths)
        radiated = moving_radiation(*sight, approach)
        emitted = frequency * stretch  # (band, azimuth, strip)
        edge = noise_of_edges(emitted, sources, radiated)
        radiated_last = jax.tree.map(lambda q: q[..., -1], radiated)
        vortex = tip_noise(emitted[..., -1], tip, radiated_last, air, model.tip)
        # Heard for dt = stretch dtau: that is its weight in the observer's time.
        share = n_blades / n_azimuths
        return SelfNoise(
            **{name: share * jnp.sum(p * stretch, (1, 2)) for name, p in edge._asdict().items()},
            tip=share * (vortex @ stretch[:, -1]),
            inflow_turbulence=jnp.zeros(len(frequency)),
        )

    return jax.lax.map(noise_at, jnp.asarray(observers, float))


def tip_section(strips: StripFlow) -> Section:
    """Section that feeds the tip vortex, at 0.96 R.

    Parameters
    ----------
    strips : StripFlow
        Strips of blade 1, from the inner to the outermost one.

    Returns
    -------
    Section
        Arrays without the axis of the strips.

    Notes
    -----
    The fits of NASA RP-1218 know the angle of a section near the tip. In a lattice the load falls
    to nothing at the tip: the angle of the outermost strip tells how narrow that strip is, and the
    noise falls by tens of decibels with it. At 0.95 to 0.97 R the load does not depend on it.
    """
    x, y, _ = strips.position.T
    radius = jnp.hypot(x, y)
    end = radius[-1] + 0.5 * jnp.ravel(strips.section.span)[-1]
    weights = jax.vmap(partial(jnp.interp, _TIP_RADIUS * end, radius))(jnp.eye(radius.size))

    def there(values: Array) -> Array:
        return jnp.broadcast_to(values, (*values.shape[:-1], radius.size)) @ weights

    return jax.tree.map(there, strips.section)


def emission(
    strips: StripFlow, observer: Array, state: RotorState, n_azimuths: int
) -> tuple[tuple[Array, Array, Array], Array, Array]:
    """Ways of the sound of strips of blade 1 to an observer who flies along.

    Parameters
    ----------
    strips : StripFlow
        Strips of blade 1 at azimuth 0.
    observer : (3,) array
        Position from the rotor centre, moving with it [m].
    state : RotorState
        How the rotor turns and flies.
    n_azimuths : int
        Number of equal steps in the turn.

    Returns
    -------
    sight : tuple of three arrays
        Components of the vectors from emission to reception along chord, span and normal of the
        strips [m]: the observer is turned back instead of the blade forward. Here and below each
        (n_azimuths, n).
    approach : array
        1 - M cos xi of the motion through the air.
    stretch : array
        dt / dtau: how long the observer hears what a strip emits.
    """
    azimuth = 2 * np.pi * np.arange(n_azimuths)[:, None] / n_azimuths
    cos, sin = np.cos(azimuth), np.sin(azimuth)

    def turned_back(vector: Array) -> tuple[Array, Array, Array]:
        return cos * vector[0] + sin * vector[1], cos * vector[1] - sin * vector[0], vector[2]

    m = state.velocity / state.air.sound_speed
    mx, my, mz = turned_back(m)
    x, y, z = strips.position.T
    sx, sy, sz = (q - p for q, p in zip(turned_back(observer), (x, y, z), strict=True))
    d = emission_distance(mx * sx + my * sy + mz * sz, sx**2 + sy**2 + sz**2, m @ m)
    rx, ry, rz = sx + mx * d, sy + my * d, sz + mz * d
    # Mach numbers toward the observer, of the rotation and of the flight
    turning = state.rotation_speed * (x * ry - y * rx) / (state.air.sound_speed * d)
    flying = (mx * rx + my * ry + mz * rz) / d
    approach = 1 - turning - flying
    normal = jnp.cross(strips.chord_direction, strips.span_direction)
    chordwise, spanwise, across = (
        rx * x + ry * y + rz * z
        for x, y, z in (axis.T for axis in (strips.chord_direction, strips.span_direction, normal))
    )
    stretch = at_least(approach / (1 - flying), _LEAST_STRETCH)
    return (chordwise, spanwise, across), approach, stretch
