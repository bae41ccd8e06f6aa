"""Self-noise of a section: six mechanisms of Brooks, Pope and Marcolini as mean-square pressures.

Symbols and equation numbers are those of NASA RP-1218 (1989). Sound adds as mean squares here; the
report's decibels are inside the functions only.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.acoustics.broadband import shedding_spectra, turbulent_spectra
from propmdao.acoustics.broadband.boundary_layer import (
    BoundaryLayer,
    Trip,
    absolute_degrees,
    nonzero_chord,
    nonzero_speed,
)
from propmdao.acoustics.broadband.directivity import Radiation
from propmdao.acoustics.broadband.section import (
    Section,
    blunt_strip,
    laminar_strip,
    turbulent_strip,
)
from propmdao.acoustics.broadband.smooth import ramp
from propmdao.acoustics.levels.decibels import REFERENCE_PRESSURE
from propmdao.records.pytrees import record

#: Shape of the blade tip seen from above the blade.
Tip = Literal["rounded", "square"]


@record
class SelfNoise:
    """Mean-square pressures by mechanism in third-octave bands [Pa^2].

    Attributes
    ----------
    pressure_side, suction_side : array
        Turbulent boundary layers passing the trailing edge.
    separation : array
        Angle-dependent part; beyond the stall all of the turbulent noise.
    laminar_shedding : array
        Vortex shedding of a laminar boundary layer.
    bluntness : array
        Vortex shedding of a blunt trailing edge.
    tip : array
        Tip vortex.
    """

    pressure_side: Array
    suction_side: Array
    separation: Array
    laminar_shedding: Array
    bluntness: Array
    tip: Array

    @property
    def total(self) -> Array:
        """Mean square of all mechanisms: they are not correlated."""
        turbulent_edge = self.pressure_side + self.suction_side + self.separation
        return turbulent_edge + self.laminar_shedding + self.bluntness + self.tip


class EdgeNoise(NamedTuple):
    """The five mechanisms of a trailing edge, as in `SelfNoise` [Pa^2]."""

    pressure_side: Array
    suction_side: Array
    separation: Array
    laminar_shedding: Array
    bluntness: Array


def third_octave_centers(lowest_hz: float = 100.0, highest_hz: float = 80e3) -> NDArray[np.float64]:
    """Exact mid-band frequencies of third octaves.

    Parameters
    ----------
    lowest_hz, highest_hz : float
        The bands that hold these and all between [Hz].

    Returns
    -------
    (n_bands,) array
        Frequencies ``1000 * 10**(k/10)`` [Hz].
    """
    first, last = (round(10 * np.log10(f / 1000)) for f in (lowest_hz, highest_hz))
    centers: NDArray[np.float64] = 1000 * 10 ** (np.arange(first, last + 1) / 10)
    return centers


def trailing_edge_noise(
    frequency_hz: ArrayLike,
    section: Section,
    layer: BoundaryLayer,
    radiated: Radiation,
    sound_speed: ArrayLike,
    kinematic_viscosity: ArrayLike,
    trip: Trip = "none",
) -> EdgeNoise:
    """Third-octave mean squares of the mechanisms of a trailing edge.

    Parameters
    ----------
    frequency_hz : array
        Mid-band frequencies at the source, positive [Hz].
    section : Section
        The strips.
    layer : BoundaryLayer
        Their boundary layer, by `boundary_layer` or by another model.
    radiated : Radiation
        Toward the observers, by `radiation`.
    sound_speed, kinematic_viscosity : float
        Of the air [m/s], [m^2/s].
    trip : {"none", "light", "heavy"}
        A tripped boundary layer has no laminar vortex shedding (static).

    Returns
    -------
    EdgeNoise
        Of the shape to which frequency, section and radiation broadcast.

    Notes
    -----
    Around the stall the turbulent mechanisms change over within 1 deg to either side, where the
    report steps. Beyond it the report has no pressure and suction side.
    """
    strip = turbulent_strip(section, layer, sound_speed, kinematic_viscosity)
    laminar = laminar_strip(section, layer, kinematic_viscosity)
    blunt = blunt_strip(section, layer)
    # What belongs to a strip alone is not worked out again for every frequency and observer, as
    # XLA would when it fuses all into one loop.
    strip, laminar, blunt = jax.lax.optimization_barrier((strip, laminar, blunt))

    mach = nonzero_speed(section.speed) / sound_speed
    log_f, edge = jnp.log10(frequency_hz), mach**5 * section.span
    attached = (1 - strip.stalled) * edge * radiated.high
    separated = strip.stalled * edge * radiated.low
    a_p = turbulent_spectra.shape_a(log_f + strip.log_st_p, strip.a_r)
    a_s = turbulent_spectra.shape_a(log_f + strip.log_st_s, strip.a_r)
    b = turbulent_spectra.shape_b(log_f + strip.log_st_alpha, strip.b_r)
    a_stalled = turbulent_spectra.shape_a(log_f + strip.log_st_alpha, strip.a_r_stalled)
    separation = attached * _power(b + strip.level_alpha)  # 27
    separation += separated * _power(a_stalled + strip.level_alpha)  # 30
    g1 = shedding_spectra.laminar_shape(log_f + laminar.log_strouhal)
    g5 = shedding_spectra.blunt_shape(
        log_f + blunt.log_strouhal, blunt.wedge, blunt.plate, blunt.edge_degrees
    )
    shed = _power(g1 + laminar.level) if trip == "none" else jnp.zeros_like(separation)
    return EdgeNoise(
        pressure_side=attached * _power(a_p + strip.level_p),  # 25
        suction_side=attached * _power(a_s + strip.level_s),  # 26
        separation=separation,
        laminar_shedding=edge * radiated.high * shed,  # 53
        bluntness=edge * jnp.sqrt(mach) * radiated.high * _power(g5 + blunt.level),  # 70
    )


def tip_noise(
    frequency_hz: ArrayLike,
    chord: ArrayLike,
    speed: ArrayLike,
    angle_of_attack: ArrayLike,
    radiated_high: ArrayLike,
    sound_speed: ArrayLike,
    tip: Tip = "rounded",
) -> Array:
    """Third-octave mean squares of the tip vortex.

    Parameters
    ----------
    frequency_hz : array
        Mid-band frequencies at the source, positive [Hz].
    chord, speed, angle_of_attack : array
        At the tip [m], [m/s], [rad]; the angle from zero lift, reduced by the tip's own inflow.
    radiated_high : array
        High-frequency directivity over squared distance [1/m^2].
    sound_speed : float
        Of the air [m/s].
    tip : {"rounded", "square"}
        Planform of the tip (static).

    Returns
    -------
    array
        Mean-square pressure [Pa^2].

    References
    ----------
    Equations 61 to 67; at 2 deg the two lines of a square tip are rounded within 0.25 deg.
    """
    degrees, mach = absolute_degrees(angle_of_attack), nonzero_speed(speed) / sound_speed
    if tip == "rounded":
        over_chord = 0.008 * degrees  # 63
    else:
        over_chord = 0.0230 + 0.0169 * degrees - (0.0169 - 0.0095) * ramp(degrees - 2, 0.25)  # 67
    length = over_chord * nonzero_chord(chord)
    mach_max = mach * (1 + 0.036 * degrees)  # 64
    strouhal = jnp.asarray(frequency_hz) * length / (mach_max * sound_speed)  # 62, 65
    shape = 126 - 30.5 * (jnp.log10(strouhal) + 0.3) ** 2
    return mach**2 * mach_max**3 * length**2 * radiated_high * _power(shape)  # 61


def _power(level_db: Array) -> Array:
    """Mean-square pressure of a level."""
    return jnp.exp(np.log(10) / 10 * level_db + np.log(REFERENCE_PRESSURE**2))
