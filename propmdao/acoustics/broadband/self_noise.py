"""Self-noise of a section: six mechanisms of Brooks, Pope and Marcolini as mean-square pressures.

Symbols and equation numbers are those of NASA RP-1218 (1989). Sound adds as mean squares here; the
report's decibels are inside the functions only.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.acoustics.broadband import shedding_spectra as shedding
from propmdao.acoustics.broadband import turbulent_spectra as turbulent
from propmdao.acoustics.broadband.boundary_layer import (
    BoundaryLayer,
    Trip,
    absolute_degrees,
    nonzero_chord,
    nonzero_speed,
)
from propmdao.acoustics.broadband.directivity import Radiation
from propmdao.acoustics.broadband.smooth import ramp, smooth_step
from propmdao.acoustics.levels import REFERENCE_PRESSURE
from propmdao.records import record

#: Shape of the blade tip seen from above the blade.
Tip = Literal["rounded", "square"]

_STALL = 1.0  # half width of the change from attached to separated flow [deg]
_SHARP = 1e-9  # trailing-edge thickness over chord that a logarithm can take
_SILENCE = 1e-20  # of the reference mean square: -200 dB


@record
class Section:
    """Sections of a blade or wing and the flow over them; all arrays broadcast together.

    Attributes
    ----------
    chord : array
        Chord [m].
    span : array
        Length of the strip along the span [m].
    speed : array
        Speed of the flow normal to the span, induced velocities included [m/s].
    angle_of_attack : array
        Angle between this flow and the section's zero-lift direction [rad].
    trailing_edge_thickness : array
        Thickness h of the blunt trailing edge, 0 for a sharp one [m].
    trailing_edge_angle : array
        Angle Psi between upper and lower surface at the trailing edge [rad].
    """

    chord: Array
    span: Array
    speed: Array
    angle_of_attack: Array
    trailing_edge_thickness: Array
    trailing_edge_angle: Array


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


def band_level_db(mean_square: ArrayLike) -> Array:
    """Level of a mean-square pressure.

    Parameters
    ----------
    mean_square : array
        Mean-square pressure [Pa^2].

    Returns
    -------
    array
        Level [dB re 20 uPa], at least -200.
    """
    return 10 * jnp.log10(jnp.asarray(mean_square) / REFERENCE_PRESSURE**2 + _SILENCE)


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
    speed, chord = nonzero_speed(section.speed), nonzero_chord(section.chord)
    mach, reynolds = speed / sound_speed, speed * chord / kinematic_viscosity
    degrees, log_re = absolute_degrees(section.angle_of_attack), jnp.log10(reynolds)
    log_f, log_u = jnp.log10(frequency_hz), jnp.log10(speed)
    delta_p, delta_s = layer.displacement_pressure, layer.displacement_suction
    log_delta_p, log_delta_s = jnp.log10(delta_p), jnp.log10(delta_s)

    stalled = smooth_step(degrees - turbulent.stall_angle(mach), _STALL)
    edge = mach**5 * section.span
    high, low = (1 - stalled) * edge * radiated.high, stalled * edge * radiated.low

    st1, st1_mean, st2 = (jnp.log10(st) for st in turbulent.strouhal_peaks(mach, degrees))
    st_p, st_s = log_delta_p - log_u, log_delta_s - log_u  # 31, less the frequency
    k1 = turbulent.amplitude_k1(log_re)
    k2 = k1 + turbulent.separation_amplitude(mach, degrees)
    delta_k1 = turbulent.pressure_side_correction(
        log_delta_p + log_u - jnp.log10(kinematic_viscosity), degrees
    )
    a_r, b_r = turbulent.interpolation_a(reynolds), turbulent.interpolation_b(reynolds)
    a_r_stalled = turbulent.interpolation_a(3 * reynolds)
    a_p = turbulent.shape_a(log_f + (st_p - st1), a_r)
    a_s = turbulent.shape_a(log_f + (st_s - st1_mean), a_r)
    b = turbulent.shape_b(log_f + (st_s - st2), b_r)
    a_stalled = turbulent.shape_a(log_f + (st_s - st2), a_r_stalled)
    attached = high * delta_s

    pressure_side = high * delta_p * _power(a_p + (k1 - 3 + delta_k1))  # 25
    return EdgeNoise(
        pressure_side=pressure_side,
        suction_side=attached * _power(a_s + (k1 - 3)),  # 26
        separation=attached * _power(b + k2) + low * delta_s * _power(a_stalled + k2),  # 27, 30
        laminar_shedding=(
            edge * radiated.high * _laminar(log_f - log_u, log_re, degrees, layer)
            if trip == "none"
            else jnp.zeros_like(pressure_side)
        ),
        bluntness=(
            edge * jnp.sqrt(mach) * radiated.high * _blunt(log_f - log_u, section, chord, layer)
        ),
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


def _laminar(log_f_u: Array, log_re: Array, degrees: Array, layer: BoundaryLayer) -> Array:
    """Equation 53 without span, Mach number and directivity."""
    log_delta = jnp.log10(layer.thickness_pressure)
    g1 = shedding.laminar_shape(
        log_f_u + (log_delta - shedding.laminar_strouhal_peak(log_re, degrees))
    )
    g2 = shedding.laminar_reynolds_level(log_re, degrees)
    return layer.thickness_pressure * _power(g1 + (g2 + shedding.laminar_angle_level(degrees)))


def _blunt(log_f_u: Array, section: Section, chord: Array, layer: BoundaryLayer) -> Array:
    """Equation 70 without span, Mach number and directivity."""
    h = section.trailing_edge_thickness + _SHARP * chord
    mean = (layer.displacement_pressure + layer.displacement_suction) / 2  # 73
    ratio, edge_degrees = h / mean, jnp.rad2deg(section.trailing_edge_angle)
    peak = shedding.blunt_strouhal_peak(ratio, edge_degrees)
    eta = log_f_u + (jnp.log10(h) - jnp.log10(peak))  # 71, 77
    g5 = shedding.blunt_shape(eta, ratio, edge_degrees)
    return h * _power(g5 + shedding.blunt_level(ratio, edge_degrees))


def _power(level_db: Array) -> Array:
    """Mean-square pressure of a level."""
    return jnp.exp(np.log(10) / 10 * level_db + np.log(REFERENCE_PRESSURE**2))
