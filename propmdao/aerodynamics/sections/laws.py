"""Lift and drag of a blade's sections in viscous flow, to which the lattice is held.

Past stall, where cl falls with alpha, the equations of strips much narrower than their chord have
many solutions, in which neighbouring strips exchange lift. A polar is that of a section, which has
no meaning over less span than a chord: what the polar takes off the lift of thin-airfoil theory,
cl - cl_p, enters as its mean over the span nearby. That leaves one solution on any mesh.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.sections.polars.family import SectionPolars, blade_tables
from propmdao.aerodynamics.sections.polars.table import (
    PolarTable,
    SectionCurves,
    curve_coefficients,
    section_curves,
)
from propmdao.aerodynamics.sections.stall_delay import delay_factor, delayed_stall
from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar, record

_MIXING = 0.5  # standard deviation of the mean over the span, in chords


@record
class ViscousSections:
    """Polars of the sections of a blade, at any operating point.

    Attributes
    ----------
    polars : PolarTable
        Polars of the sections in the middle of the strips, ns rows.
    stall_delay : float
        Factor on the stall delay: 1 where rotation delays stall, 0 for two-dimensional polars.
    """

    polars: PolarTable
    stall_delay: Scalar


def viscous_sections(
    polars: SectionPolars,
    blade: Blade,
    section_radii: SpanInterpolation,
    stall_delay: Scalar = 1.0,
) -> ViscousSections:
    """Sections of a blade in viscous flow.

    Parameters
    ----------
    polars : SectionPolars
        Polars of the propeller's sections.
    blade : Blade
        Blade of the propeller, modified or not.
    section_radii : SpanInterpolation
        Interpolation from the blade's stations to the middle of the strips,
        `geometry.lattice.strip_interpolation`.
    stall_delay : float
        Factor on the stall delay: 1 where rotation delays stall, 0 for two-dimensional polars.

    Returns
    -------
    ViscousSections
        Polars to which the lattice is held.
    """
    table = blade_tables(polars, blade, section_radii)
    return ViscousSections(table, jnp.asarray(stall_delay, float))


@record
class SectionLaws:
    """Polars of the strips at an operating point.

    Attributes
    ----------
    curves : SectionCurves
        Two-dimensional lift and drag curves at the strips' Reynolds and Mach numbers.
    zero_lift_angle : (ns,) array
        Angle of attack at which thin-airfoil theory has no lift [rad].
    potential_zero_lift_angle, stall_delay : (ns,) arrays
        Angle of attack at which the potential flow that meets the attached polar has no lift [rad],
        and share of the lift missing to it that rotation gives back (0 without stall delay).
    mean : (ns, ns) array
        Matrix that takes the mean of strip values over the span near each strip.
    """

    curves: SectionCurves
    zero_lift_angle: Array
    potential_zero_lift_angle: Array
    stall_delay: Array
    mean: Array

    def thin(self, alpha: Array) -> Array:
        """Lift coefficient by thin-airfoil theory: (ns,)."""
        return 2.0 * jnp.pi * (alpha - self.zero_lift_angle)

    def beyond_thin(self, alpha: Array) -> tuple[Array, Array]:
        """Lift that the polars add to that of thin-airfoil theory, and drag: (ns,) each."""
        cl, cd, _ = curve_coefficients(self.curves, alpha)
        cl, cd = delayed_stall(cl, cd, alpha, self.potential_zero_lift_angle, self.stall_delay)
        return cl - self.thin(alpha), cd


def section_laws(
    strips: Strips,
    relative_speed: Array,
    turning_share: Scalar,
    air: Air,
    sections: ViscousSections,
) -> SectionLaws:
    """Polars of the strips at an operating point.

    Parameters
    ----------
    strips : Strips
        Sections of blade 1.
    relative_speed : (ns,) array
        Speed of the air relative to the sections [m/s].
    turning_share : float
        Rotational speed of the tip over its resultant with the axial speed, for the stall delay.
    air : Air
        The undisturbed air.
    sections : ViscousSections
        Polars of the strips at any operating point.

    Returns
    -------
    SectionLaws
        Lift and drag of the strips as functions of the angle of attack alone.
    """
    w = relative_speed
    reynolds = air.density * w * strips.chord / air.dynamic_viscosity
    curves = section_curves(sections.polars, reynolds, w / air.sound_speed)
    factor = delay_factor(strips.chord / strips.radius, strips.r_over_R, turning_share)
    delay = sections.stall_delay * factor
    thin, mean = strips.zero_lift_angle, _spanwise_mean(strips)
    return SectionLaws(curves, thin, _potential_zero_lift_angle(curves, thin), delay, mean)


def _potential_zero_lift_angle(curves: SectionCurves, thin: Array) -> Array:
    """Angle at which potential flow that agrees with the attached polars has no lift, (ns,) [rad].

    At half the zero-lift angle above the chord line sections work near their best, at any camber
    and its mirror image. The camber that the boundary layer takes off there is not lost to stall,
    so rotation does not give it back.
    """
    attached = -0.5 * thin
    cl = curve_coefficients(curves, attached)[0]
    return attached - jnp.arcsin(cl / (2.0 * jnp.pi))


def _spanwise_mean(strips: Strips) -> Array:
    """Means over the span near each strip, weighted by a Gaussian: (ns, ns), rows sum to 1."""
    apart = (strips.radius - strips.radius[:, None]) / (_MIXING * strips.chord[:, None])
    weight = strips.width * jnp.exp(-0.5 * apart**2)
    return weight / weight.sum(axis=1, keepdims=True)
