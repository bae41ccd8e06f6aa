"""The blade in the axes and by the distributions of OpenVSP's propeller component.

There thrust is toward -x, the first blade lies along +y and its trailing edge to +z. A section is
placed by its middle, x/c 0.5 of the construction line: turned by the twist about the blade, moved
by ``Rake`` and ``Skew`` across and along its own chord, then by ``Axial`` and ``Tangential`` along
x and z and outward by the radius, and turned by ``Sweep`` about the shaft; the whole blade is then
turned by the feather angle (class PropPositioner of OpenVSP 3.4x, and the descriptions of the
parameters of its PropGeom).
"""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.geometry.blade import Blade, design_lift_coefficient, span_interpolation
from propmdao.geometry.section import section_shape
from propmdao.propeller.airfoils.airfoil import chord_interpolation
from propmdao.propeller.description import Propeller

FloatArray = npt.NDArray[np.float64]

#: Middle of the chord behind the quarter chord, over chord.
_MIDDLE = 0.25
#: Points around a section: those of the shared grid of sections, so that none is interpolated.
_CONTOUR = 161


@dataclasses.dataclass(frozen=True, eq=False)
class VspBlade:
    """Distributions of a blade as OpenVSP has them; lengths are over the tip radius.

    Attributes
    ----------
    radius, chord : (n_sections,) arrays
        Radii and chords.
    twist : (n_sections,) array
        Blade angle without the feather angle [deg].
    rake, skew : (n_sections,) arrays
        Offset of the middle of the chord toward the lower side, perpendicular to the chord, and
        along the chord toward the trailing edge.
    sweep : (n_sections,) array
        Angle about the shaft, against the rotation [deg].
    thickness : (n_sections,) array
        Maximum thickness over chord.
    design_lift : (n_sections,) array
        Lift coefficient at the ideal angle of attack.
    axial, tangential : (n_sections,) arrays
        Offset against thrust and against the rotation.
    """

    radius: FloatArray
    chord: FloatArray
    twist: FloatArray
    rake: FloatArray
    skew: FloatArray
    sweep: FloatArray
    thickness: FloatArray
    design_lift: FloatArray
    axial: FloatArray
    tangential: FloatArray


def vsp_blade(propeller: Propeller, r_over_R: npt.ArrayLike) -> VspBlade:
    """Describe a blade as OpenVSP does.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    r_over_R : (n_sections,) array
        Radii of the sections over the tip radius, within the stations.

    Returns
    -------
    VspBlade
        The blade: sweep and rake of the quarter chord as tangential and axial offset, and the
        quarter of the chord from there to the middle as skew.
    """
    blade, span = Blade.from_propeller(propeller), span_interpolation(propeller.r_over_R, r_over_R)
    smooth, linear = np.asarray(span.smooth), np.asarray(span.linear)
    chord = smooth @ propeller.c_over_R
    shape = linear @ np.asarray(blade.camber_shape)
    camber = linear @ np.asarray(blade.camber_over_chord)
    nothing = np.zeros_like(chord)
    return VspBlade(
        radius=np.asarray(r_over_R, dtype=float),
        chord=chord,
        twist=smooth @ propeller.beta_deg,
        rake=nothing,
        skew=_MIDDLE * chord,
        sweep=nothing,
        thickness=linear @ np.asarray(blade.thickness_over_chord),
        design_lift=np.asarray(design_lift_coefficient(shape)) * camber,
        axial=-(smooth @ propeller.rake_over_R),
        tangential=smooth @ propeller.sweep_over_R,
    )


def quarter_chord(
    blade: VspBlade, feather_deg: float, cone_deg: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Place the quarter chord of a blade that OpenVSP describes.

    Parameters
    ----------
    blade : VspBlade
        The blade.
    feather_deg : float
        Angle by which the whole blade is turned about its own axis [deg].
    cone_deg : float
        Angle by which the whole blade is then turned toward thrust [deg].

    Returns
    -------
    radius, aft, up : (n_sections,) arrays
        Distance from the shaft along the blade, against the rotation and toward thrust, over the
        tip radius before the blade is turned.
    """
    twist, sweep = np.radians(blade.twist), np.radians(blade.sweep)
    feather, cone = np.radians(feather_deg), np.radians(cone_deg)
    along = blade.skew - _MIDDLE * blade.chord
    x = blade.axial + blade.rake * np.cos(twist) + along * np.sin(twist)
    z = blade.tangential - blade.rake * np.sin(twist) + along * np.cos(twist)
    y = blade.radius * np.cos(sweep) - z * np.sin(sweep)
    z = blade.radius * np.sin(sweep) + z * np.cos(sweep)
    x, z = x * np.cos(feather) + z * np.sin(feather), z * np.cos(feather) - x * np.sin(feather)
    x, y = x * np.cos(cone) - y * np.sin(cone), x * np.sin(cone) + y * np.cos(cone)
    return y, z, -x


def contours(propeller: Propeller, r_over_R: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Lay out the sections of a blade over unit chord.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    r_over_R : (n_sections,) array
        Radii of the sections over the tip radius, within the stations.

    Returns
    -------
    x : (161,) array
        Chord fraction of the points of a round from the trailing edge along the lower side to the
        nose, point 80, and back along the upper side.
    z : (n_sections, 161) array
        Height of the points above the chord, over chord.
    """
    angle = np.linspace(-np.pi, np.pi, _CONTOUR)
    span = span_interpolation(propeller.r_over_R, r_over_R)
    operator = jnp.asarray(chord_interpolation(np.abs(angle)))
    camber, thickness = section_shape(Blade.from_propeller(propeller), span, operator)
    side = np.sign(np.round(angle, 12))[:, None]
    z = np.asarray(camber) + 0.5 * side * np.asarray(thickness)
    return 0.5 * (1.0 - np.cos(angle)), z.T
