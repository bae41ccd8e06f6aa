"""Sections of a blade, and the part of each mechanism that knows no frequency or observer.

Symbols and equation numbers are those of Brooks, Pope and Marcolini, NASA RP-1218 (1989).
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from propmdao.acoustics.broadband import shedding_spectra, turbulent_spectra
from propmdao.acoustics.broadband.boundary_layer import (
    BoundaryLayer,
    absolute_degrees,
    nonzero_chord,
    nonzero_speed,
)
from propmdao.acoustics.broadband.shedding_spectra import BluntCurve
from propmdao.acoustics.broadband.smooth import smooth_step
from propmdao.records.air import Air
from propmdao.records.pytrees import record

_STALL = 0.25  # half width of the change from attached to separated flow [deg]
_SHARP = 1e-9  # trailing-edge thickness over chord that a logarithm can take


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


class TurbulentStrip(NamedTuple):
    """Trailing-edge noise of a strip before frequency and observer.

    Attributes
    ----------
    level_p, level_s, level_alpha : array
        Peak levels of pressure side, suction side and separation, with 10 log10 delta* [dB].
    log_st_p, log_st_s, log_st_alpha : array
        log10 of the Strouhal numbers of these three over the peak's, at 1 Hz.
    a_r, a_r_stalled, b_r : array
        Interpolation between the shapes at low and high Reynolds number.
    stalled : array
        Share of the separated flow: 0 attached, 1 separated.
    """

    level_p: Array
    level_s: Array
    level_alpha: Array
    log_st_p: Array
    log_st_s: Array
    log_st_alpha: Array
    a_r: Array
    a_r_stalled: Array
    b_r: Array
    stalled: Array


class LaminarStrip(NamedTuple):
    """Laminar vortex shedding of a strip before frequency and observer.

    Attributes
    ----------
    level : array
        Peak level, with 10 log10 delta_p [dB].
    log_strouhal : array
        log10 of the Strouhal number over the peak's, at 1 Hz.
    """

    level: Array
    log_strouhal: Array


class BluntStrip(NamedTuple):
    """Bluntness noise of a strip before frequency and observer.

    Attributes
    ----------
    level : array
        Peak level, with 10 log10 h [dB].
    log_strouhal : array
        log10 of the Strouhal number over the peak's, at 1 Hz.
    wedge, plate : BluntCurve
        Spectral curves of Psi = 14 and 0 deg, between which the trailing edge lies.
    edge_degrees : array
        Angle Psi between the surfaces at the trailing edge, within the model's bounds [deg].
    """

    level: Array
    log_strouhal: Array
    wedge: BluntCurve
    plate: BluntCurve
    edge_degrees: Array


def turbulent_strip(section: Section, layer: BoundaryLayer, air: Air) -> TurbulentStrip:
    """Trailing-edge noise of a strip: all that does not depend on frequency and observer.

    Parameters
    ----------
    section : Section
        Sections of the strips and the flow over them.
    layer : BoundaryLayer
        Boundary layer at the trailing edge of the strips.
    air : Air
        The undisturbed air.

    Returns
    -------
    TurbulentStrip
        Arrays of the shape of the section.
    """
    speed, degrees = nonzero_speed(section.speed), absolute_degrees(section.angle_of_attack)
    viscosity = air.kinematic_viscosity
    mach, reynolds = speed / air.sound_speed, speed * nonzero_chord(section.chord) / viscosity
    log_u = jnp.log10(speed)
    log_delta_p = jnp.log10(layer.displacement_pressure)
    log_delta_s = jnp.log10(layer.displacement_suction)
    st1, st1_mean, st2 = (jnp.log10(st) for st in turbulent_spectra.strouhal_peaks(mach, degrees))
    k1 = turbulent_spectra.amplitude_k1(jnp.log10(reynolds))
    k2 = k1 + turbulent_spectra.separation_amplitude(mach, degrees)
    delta_k1 = turbulent_spectra.pressure_side_correction(
        log_delta_p + log_u - jnp.log10(viscosity), degrees
    )
    return TurbulentStrip(
        level_p=k1 - 3 + delta_k1 + 10 * log_delta_p,
        level_s=k1 - 3 + 10 * log_delta_s,
        level_alpha=k2 + 10 * log_delta_s,
        log_st_p=log_delta_p - log_u - st1,  # 31
        log_st_s=log_delta_s - log_u - st1_mean,
        log_st_alpha=log_delta_s - log_u - st2,
        a_r=turbulent_spectra.SHAPE_A.interpolation(reynolds),
        a_r_stalled=turbulent_spectra.SHAPE_A.interpolation(3 * reynolds),
        b_r=turbulent_spectra.SHAPE_B.interpolation(reynolds),
        # Up to the report's switch all is the report's; the change lies beyond it.
        stalled=smooth_step(degrees - turbulent_spectra.stall_angle(mach) - _STALL, _STALL),
    )


def laminar_strip(section: Section, layer: BoundaryLayer, air: Air) -> LaminarStrip:
    """Laminar vortex shedding of a strip: all that does not depend on frequency and observer.

    Parameters
    ----------
    section : Section
        Sections of the strips and the flow over them.
    layer : BoundaryLayer
        Boundary layer at the trailing edge of the strips.
    air : Air
        The undisturbed air.

    Returns
    -------
    LaminarStrip
        Arrays of the shape of the section.
    """
    speed, degrees = nonzero_speed(section.speed), absolute_degrees(section.angle_of_attack)
    log_re = jnp.log10(speed * nonzero_chord(section.chord) / air.kinematic_viscosity)
    log_delta = jnp.log10(layer.thickness_pressure)
    g2 = shedding_spectra.laminar_reynolds_level(log_re, degrees)
    return LaminarStrip(
        level=g2 + shedding_spectra.laminar_angle_level(degrees) + 10 * log_delta,
        log_strouhal=(  # 54
            log_delta - jnp.log10(speed) - shedding_spectra.laminar_strouhal_peak(log_re, degrees)
        ),
    )


def blunt_strip(section: Section, layer: BoundaryLayer) -> BluntStrip:
    """Bluntness noise of a strip: all that does not depend on frequency and observer.

    Parameters
    ----------
    section : Section
        Sections of the strips and the flow over them.
    layer : BoundaryLayer
        Boundary layer at the trailing edge of the strips.

    Returns
    -------
    BluntStrip
        Arrays of the shape of the section.
    """
    h = section.trailing_edge_thickness + _SHARP * nonzero_chord(section.chord)
    ratio = 2 * h / (layer.displacement_pressure + layer.displacement_suction)  # 73
    edge_degrees = shedding_spectra.bounded_edge_angle(jnp.rad2deg(section.trailing_edge_angle))
    peak = shedding_spectra.blunt_strouhal_peak(ratio, edge_degrees)
    return BluntStrip(
        level=shedding_spectra.blunt_level(ratio, edge_degrees) + 10 * jnp.log10(h),
        log_strouhal=jnp.log10(h / (nonzero_speed(section.speed) * peak)),  # 71, 77
        wedge=shedding_spectra.blunt_curve(ratio),
        plate=shedding_spectra.blunt_curve(shedding_spectra.plate_ratio(ratio)),
        edge_degrees=edge_degrees,
    )
