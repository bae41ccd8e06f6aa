"""Self-noise of a section: six mechanisms of Brooks, Pope and Marcolini as mean-square pressures.

Symbols and equation numbers are those of NASA RP-1218 (1989). Sound adds as mean squares here; the
report's decibels are inside the functions only.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.acoustics.broadband import shedding_spectra, turbulent_spectra
from propmdao.acoustics.broadband.boundary_layer import (
    BoundaryLayer,
    absolute_degrees,
    nonzero_chord,
    nonzero_speed,
)
from propmdao.acoustics.broadband.directivity import Radiation
from propmdao.acoustics.broadband.section import (
    BluntStrip,
    LaminarStrip,
    Section,
    TurbulentStrip,
    blunt_strip,
    laminar_strip,
    turbulent_strip,
)
from propmdao.acoustics.broadband.smooth import ramp
from propmdao.acoustics.levels.bands import middle_hz
from propmdao.acoustics.levels.decibels import REFERENCE_PRESSURE
from propmdao.records.air import Air
from propmdao.records.models import Tip
from propmdao.records.pytrees import record


@record
class SelfNoise:
    """Mean-square pressures by mechanism in third-octave bands [Pa^2].

    Attributes
    ----------
    pressure_side, suction_side : array
        Turbulent boundary layers passing the trailing edge.
    separation : array
        Angle-dependent part of the turbulent noise; beyond the stall all of it.
    laminar_shedding : array
        Vortex shedding of a laminar boundary layer.
    bluntness : array
        Vortex shedding of a blunt trailing edge.
    tip : array
        Noise of the tip vortex.
    inflow_turbulence : array
        Noise of turbulence that flows in; no self-noise, but heard with it.
    """

    pressure_side: Array
    suction_side: Array
    separation: Array
    laminar_shedding: Array
    bluntness: Array
    tip: Array
    inflow_turbulence: Array

    @property
    def total(self) -> Array:
        """Mean square of all mechanisms: they are not correlated."""
        turbulent_edge = self.pressure_side + self.suction_side + self.separation
        shed = self.laminar_shedding + self.bluntness + self.tip
        return turbulent_edge + shed + self.inflow_turbulence


class EdgeNoise(NamedTuple):
    """The five mechanisms of a trailing edge, as in `SelfNoise` [Pa^2]."""

    pressure_side: Array
    suction_side: Array
    separation: Array
    laminar_shedding: Array
    bluntness: Array


class EdgeSources(NamedTuple):
    """Sources of the noise of trailing edges: all that knows neither frequency nor observer.

    Attributes
    ----------
    turbulent, laminar, blunt
        Spectra of the turbulent layers, of laminar shedding and of the blunt edge.
    mach : array
        Mach number of the flow over the section.
    edge : array
        ``M^5`` times the length of the edge [m].
    shedding : array
        Share of laminar vortex shedding.
    """

    turbulent: TurbulentStrip
    laminar: LaminarStrip
    blunt: BluntStrip
    mach: Array
    edge: Array
    shedding: Array


def third_octave_centers(lowest_hz: float = 100.0, highest_hz: float = 80e3) -> NDArray[np.float64]:
    """Exact mid-band frequencies of third octaves.

    Parameters
    ----------
    lowest_hz, highest_hz : float
        Any frequency in the lowest and any in the highest band [Hz].

    Returns
    -------
    (n_bands,) array
        Frequencies ``1000 * 10**(k/10)`` [Hz].
    """
    first, last = (round(10 * np.log10(f / 1000)) for f in (lowest_hz, highest_hz))
    return middle_hz(np.arange(first, last + 1))


def trailing_edge_noise(
    frequency_hz: ArrayLike,
    section: Section,
    layer: BoundaryLayer,
    radiated: Radiation,
    air: Air,
) -> EdgeNoise:
    """Third-octave mean squares of the mechanisms of a trailing edge.

    Parameters
    ----------
    frequency_hz : array
        Mid-band frequencies at the source, positive [Hz].
    section : Section
        Sections of the strips and the flow over them.
    layer : BoundaryLayer
        Boundary layer of the strips, by `boundary_layer` or `layer_of_sections`.
    radiated : Radiation
        Directivity toward the observers, by `radiation`.
    air : Air
        The air; the report's levels have no term for its density.

    Returns
    -------
    EdgeNoise
        Mean squares [Pa^2], of the shape to which frequency, section and radiation broadcast.

    Notes
    -----
    At the stall the report steps; here the turbulent mechanisms change over within the next half a
    degree. Beyond it the report has no pressure and suction side.
    """
    return noise_of_edges(frequency_hz, edge_sources(section, layer, air), radiated)


def edge_sources(section: Section, layer: BoundaryLayer, air: Air) -> EdgeSources:
    """Work out what the noise of trailing edges knows before frequency and observer.

    Parameters
    ----------
    section : Section
        Sections of the strips and the flow over them.
    layer : BoundaryLayer
        Boundary layer of the strips, by `boundary_layer` or `layer_of_sections`.
    air : Air
        The air.

    Returns
    -------
    EdgeSources
        Arrays of the shape of the sections, for `noise_of_edges`.
    """
    mach = nonzero_speed(section.speed) / air.sound_speed
    sources = EdgeSources(
        turbulent_strip(section, layer, air),
        laminar_strip(section, layer, air),
        blunt_strip(section, layer),
        mach,
        mach**5 * section.span,
        layer.shedding,
    )
    # What belongs to a strip alone is not worked out again for every frequency and observer, as
    # XLA would when it fuses all into one loop.
    apart: EdgeSources = jax.lax.optimization_barrier(sources)
    return apart


def noise_of_edges(frequency_hz: ArrayLike, sources: EdgeSources, radiated: Radiation) -> EdgeNoise:
    """Third-octave mean squares of trailing edges from their sources.

    Parameters
    ----------
    frequency_hz : array
        Mid-band frequencies at the source, positive [Hz].
    sources : EdgeSources
        Those of the strips, by `edge_sources`.
    radiated : Radiation
        Directivity toward the observers, by `radiation`.

    Returns
    -------
    EdgeNoise
        Mean squares [Pa^2].
    """
    strip, laminar, blunt, mach, edge, shedding = sources
    log_f = jnp.log10(frequency_hz)
    attached = (1 - strip.stalled) * edge * radiated.high
    separated = strip.stalled * edge * radiated.low
    a_p = turbulent_spectra.SHAPE_A.level(log_f + strip.log_st_p, strip.a_r)
    a_s = turbulent_spectra.SHAPE_A.level(log_f + strip.log_st_s, strip.a_r)
    b = turbulent_spectra.SHAPE_B.level(log_f + strip.log_st_alpha, strip.b_r)
    a_stalled = turbulent_spectra.SHAPE_A.level(log_f + strip.log_st_alpha, strip.a_r_stalled)
    separation = attached * _power(b + strip.level_alpha)  # 27
    separation += separated * _power(a_stalled + strip.level_alpha)  # 30
    g1 = shedding_spectra.laminar_shape(log_f + laminar.log_strouhal)
    g5 = shedding_spectra.blunt_shape(
        log_f + blunt.log_strouhal, blunt.wedge, blunt.plate, blunt.edge_degrees
    )
    shed = shedding * _power(g1 + laminar.level)
    return EdgeNoise(
        pressure_side=attached * _power(a_p + strip.level_p),  # 25
        suction_side=attached * _power(a_s + strip.level_s),  # 26
        separation=separation,
        laminar_shedding=edge * radiated.high * shed,  # 53
        bluntness=edge * jnp.sqrt(mach) * radiated.high * _power(g5 + blunt.level),  # 70
    )


def tip_noise(
    frequency_hz: ArrayLike, section: Section, radiated: Radiation, air: Air, tip: Tip = "rounded"
) -> Array:
    """Third-octave mean squares of the tip vortex.

    Parameters
    ----------
    frequency_hz : array
        Mid-band frequencies at the source, positive [Hz].
    section : Section
        Section near the tip, of which chord, speed and angle from zero lift, reduced by the tip's
        own inflow, count.
    radiated : Radiation
        Directivity of the tip toward the observers, by `radiation`; only `high` counts.
    air : Air
        The air.
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
    degrees = absolute_degrees(section.angle_of_attack)
    mach = nonzero_speed(section.speed) / air.sound_speed
    if tip == "rounded":
        over_chord = 0.008 * degrees  # 63
    else:
        over_chord = 0.0230 + 0.0169 * degrees - (0.0169 - 0.0095) * ramp(degrees - 2, 0.25)  # 67
    length = over_chord * nonzero_chord(section.chord)
    mach_max = mach * (1 + 0.036 * degrees)  # 64
    strouhal = jnp.asarray(frequency_hz) * length / (mach_max * air.sound_speed)  # 62, 65
    shape = 126 - 30.5 * (jnp.log10(strouhal) + 0.3) ** 2
    return mach**2 * mach_max**3 * length**2 * radiated.high * _power(shape)  # 61


def _power(level_db: Array) -> Array:
    """Mean-square pressure of a level."""
    return jnp.exp(np.log(10) / 10 * level_db + np.log(REFERENCE_PRESSURE**2))
