"""A blade of solid sections as a beam: fibres, elastic axis and torsion from its shape.

The elastic axis of a thin solid section, about which it turns without bending, lies where the
strips of its chord, each stiff in bending as its thickness cubed, balance; it is put on the camber
line. Torsion is Saint-Venant's for thin solid sections with the usual correction for their
thickness (Young and Budynas, Roark's Formulas for Stress and Strain, 2002, table 10.1): with I the
integral of t^3/12 over the chord and A the area, J_t = 4 I / (1 + 16 I / (A c^2)), 4 I = int t^3
dx / 3.
"""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array
from scipy.interpolate import CubicSpline

from propmdao.geometry.blade import Blade, SpanInterpolation, span_interpolation
from propmdao.geometry.section import section_shape
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION, chord_interpolation
from propmdao.records.pytrees import record
from propmdao.structures.beam import Beam, Material
from propmdao.structures.shapes import N_RADII, gauss

_N_CHORDWISE = 24
_ANGLE, _SHARE = (np.pi * values for values in gauss(_N_CHORDWISE))
_FRACTION = 0.5 * (1.0 - np.cos(_ANGLE))
_WIDTH = 0.5 * np.sin(_ANGLE) * _SHARE  # of the chord's strips, over the chord
_ON_CHORD = chord_interpolation(_ANGLE)


@record
class BeamRadii:
    """Interpolation from a blade's stations to the radii of its beam.

    Attributes
    ----------
    span : SpanInterpolation
        Interpolation to the radii of Gauss between root and tip.
    slope : (N_RADII, n_stations) array
        Derivative over r/R of the smooth interpolation.
    stations : SpanInterpolation
        Interpolation to the stations themselves.
    """

    span: SpanInterpolation
    slope: Array
    stations: SpanInterpolation


def beam_radii(station_r_over_R: npt.ArrayLike) -> BeamRadii:
    """Build the interpolation to the radii of a beam; call it outside ``jit``.

    Parameters
    ----------
    station_r_over_R : (n_stations,) array
        Radii of the blade's stations over the tip radius; at the first the blade is clamped.

    Returns
    -------
    BeamRadii
        Interpolation from the stations.
    """
    stations = np.asarray(station_r_over_R, dtype=float)
    radii = stations[0] + (stations[-1] - stations[0]) * gauss(N_RADII)[0]
    return BeamRadii(
        span_interpolation(stations, radii),
        jnp.asarray(CubicSpline(stations, np.eye(stations.size))(radii, 1)),
        span_interpolation(stations, stations),
    )


def elastic_axis(blade: Blade, span: SpanInterpolation) -> Array:
    """Locate the elastic axis from the quarter chord.

    Parameters
    ----------
    blade : Blade
        The blade.
    span : SpanInterpolation
        Interpolation to the n sections.

    Returns
    -------
    (n, 2) array
        Elastic axis from the quarter chord in the plane of the section, (y, z) over the tip radius.
    """
    camber, thickness = section_shape(blade, span, jnp.asarray(_ON_CHORD))
    x, z = _balance(camber.T, thickness.T)
    return _in_plane(blade, span, (x - 0.25)[:, None], z[:, None])[:, 0]


def filled(blade: Blade, area_over_c2: npt.ArrayLike) -> Blade:
    """Thicken the sections of a blade to given areas, for its stiffness and its mass.

    Parameters
    ----------
    blade : Blade
        The blade.
    area_over_c2 : (n_stations,) array
        Cross-sections over the chord squared.

    Returns
    -------
    Blade
        Blade of the same section shapes, as thick as the areas need.
    """
    own = jnp.trapezoid(blade.thickness_shape, jnp.asarray(CHORD_FRACTION), axis=1)
    return dataclasses.replace(blade, thickness_over_chord=jnp.asarray(area_over_c2) / own)


def beam_of(blade: Blade, radii: BeamRadii, material: Material) -> Beam:
    """Turn a blade into a beam.

    Parameters
    ----------
    blade : Blade
        The blade, of solid sections.
    radii : BeamRadii
        Interpolation from its stations.
    material : Material
        Material of all of it.

    Returns
    -------
    Beam
        The blade as fibres, clamped at its first station.
    """
    span = radii.span
    camber, thickness = (values.T for values in section_shape(blade, span, jnp.asarray(_ON_CHORD)))
    x, z = _balance(camber, thickness)
    quarter = jnp.stack([-blade.sweep_over_R, blade.rake_over_R], axis=-1)
    axis = quarter + elastic_axis(blade, radii.stations)
    # Two fibres per strip have its area and its moments, up to the third.
    apart = thickness / np.sqrt(12.0)
    fibres = [
        _in_plane(
            blade, span, jnp.asarray(_FRACTION) - x[:, None], camber + side * apart - z[:, None]
        )
        for side in (1.0, -1.0)
    ]
    chord = blade.radius * (span.smooth @ blade.chord_over_R)
    area, cubed = (thickness**power @ jnp.asarray(_WIDTH) for power in (1, 3))
    root, tip = radii.stations.r_over_R[0], radii.stations.r_over_R[-1]
    return Beam(
        root=blade.radius * root,
        length=blade.radius * (tip - root),
        axis=blade.radius * (span.smooth @ axis),
        axis_slope=radii.slope @ axis,
        twist_rate=radii.slope @ blade.beta / blade.radius,
        fibres=blade.radius * jnp.concatenate(fibres, axis=1),
        areas=0.5 * jnp.tile(_WIDTH * thickness, 2) * chord[:, None] ** 2,
        torsion_constant=chord**4 * cubed / 3.0 / (1.0 + 4.0 / 3.0 * cubed / area),
        material=material,
    )


def _balance(camber: Array, thickness: Array) -> tuple[Array, Array]:
    """Chord fraction and height of the elastic axis over chord, (n,) each."""
    weight = _WIDTH * thickness**3
    total = weight.sum(axis=1)
    return weight @ jnp.asarray(_FRACTION) / total, (weight * camber).sum(axis=1) / total


def _in_plane(blade: Blade, span: SpanInterpolation, aft: Array, up: Array) -> Array:
    """Vectors (y, z) over the tip radius from those along and across the chord, over chord."""
    chord = (span.smooth @ blade.chord_over_R)[:, None]
    beta = (span.smooth @ blade.beta)[:, None]
    cos, sin = jnp.cos(beta), jnp.sin(beta)
    return chord[..., None] * jnp.stack([-aft * cos - up * sin, -aft * sin + up * cos], axis=-1)
