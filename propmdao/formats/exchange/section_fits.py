"""Polars of a blade's sections in the few numbers that other rotor programs take.

XROTOR and QPROP know a section by a line of lift between two stalls and a parabola of drag, which
scales with a power of the Reynolds number:

    cl = slope (alpha - zero_lift),  within cl_min ... cl_max,
    cd = (cd_min + curvature (cl - cl_of_cd_min)^2) (Re / re)^re_exponent.

The numbers fit best to the polars of `polars_for` at one Reynolds number for each section, that
which it has with a Mach number of 0.3 at the tip.
"""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from scipy.optimize import nnls

from propmdao.aerodynamics.sections.polars.family import SectionPolars, blade_tables
from propmdao.aerodynamics.sections.polars.high_angle import ALPHA, ATTACHED
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import section_curves
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.propeller.description import Propeller
from propmdao.records.air import Air

FloatArray = npt.NDArray[np.float64]

#: Mach number of the tip at which sections have their Reynolds numbers.
TIP_MACH = 0.3
#: Nodes of the polars from -14 to 20 degrees, within which both stalls lie.
_NODES = slice(12, -6)
#: Shares of the largest lift coefficient between which the line is fitted, and below which the
#: parabola is: a propeller works at lift, and below none the drag of a thin section is another one.
_LOW, _HIGH, _ATTACHED = 0.1, 0.8, 0.9
#: Lift coefficients tried for the least drag.
_TRIED = 81


@dataclasses.dataclass(frozen=True)
class SectionFit:
    """A section by few numbers.

    Attributes
    ----------
    zero_lift : float
        Angle of attack without lift [rad].
    slope : float
        Slope of the lift coefficient per angle [1/rad].
    cl_min, cl_max : float
        Lift coefficients at which the section stalls.
    cd_min, cl_of_cd_min : float
        Least drag coefficient, and lift coefficient at it.
    curvature : float
        Drag over the square of the lift, both from that point.
    re, re_exponent : float
        Reynolds number, and the power of it that drag goes with.
    moment : float
        Moment coefficient about the quarter chord, nose up.
    """

    zero_lift: float
    slope: float
    cl_min: float
    cl_max: float
    cd_min: float
    cl_of_cd_min: float
    curvature: float
    re: float
    re_exponent: float
    moment: float

    def at_reynolds(self, re: float) -> SectionFit:
        """Refer the same drag to another Reynolds number.

        Parameters
        ----------
        re : float
            Reynolds number.

        Returns
        -------
        SectionFit
            The same section.
        """
        factor = (re / self.re) ** self.re_exponent
        return dataclasses.replace(
            self, cd_min=factor * self.cd_min, curvature=factor * self.curvature, re=re
        )


def section_fits(propeller: Propeller, r_over_R: npt.ArrayLike) -> list[SectionFit]:
    """Fit the polars of a blade's sections.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    r_over_R : (n_sections,) array
        Radii of the sections over the tip radius, within the stations.

    Returns
    -------
    list of SectionFit
        A fit for each section, to its own polars in incompressible flow.

    Raises
    ------
    PolarError
        If the transition of the propeller takes NeuralFoil and it is not installed.
    """
    air, radii = Air(), np.asarray(r_over_R, dtype=float)
    span = span_interpolation(propeller.r_over_R, radii)
    chord = 0.5 * propeller.diameter * np.asarray(span.smooth @ propeller.c_over_R)
    speed = TIP_MACH * float(air.sound_speed) * radii
    re = speed * chord / float(air.kinematic_viscosity)
    polars = polars_for(propeller)
    cl, cd, cm = curves_of_sections(propeller, polars, radii, re)[..., ATTACHED][..., _NODES]
    least, most = (
        curves_of_sections(propeller, polars, radii, factor * re)[1, :, ATTACHED][:, _NODES].min(
            axis=1
        )
        for factor in (0.5, 2.0)
    )
    exponent = np.log(most / least) / np.log(4.0)
    alpha = ALPHA[ATTACHED][_NODES]
    return [_fit(alpha, *row) for row in zip(cl, cd, cm, re, exponent, strict=True)]


def curves_of_sections(
    propeller: Propeller, polars: SectionPolars, r_over_R: npt.ArrayLike, reynolds: npt.ArrayLike
) -> FloatArray:
    """Interpolate the polars of sections to their Reynolds numbers, in incompressible flow.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    polars : SectionPolars
        Polars of `polars_for`.
    r_over_R, reynolds : (n_sections,) arrays
        Radii of the sections over the tip radius, and Reynolds numbers on their chords.

    Returns
    -------
    (3, n_sections, n_alpha) array
        Coefficients of lift, drag and moment about the quarter chord at the angles
        `ALPHA` of `propmdao.aerodynamics.sections.polars.high_angle`.

    Raises
    ------
    ValueError
        If a radius is outside the blade.
    """
    span = span_interpolation(propeller.r_over_R, r_over_R)
    table = blade_tables(polars, Blade.from_propeller(propeller), span)
    curves = section_curves(table, jnp.asarray(reynolds, dtype=float)).values
    cl, log_cd, cm = np.asarray(curves).swapaxes(0, 1)
    return np.stack([cl, np.exp(log_cd), cm])


def _fit(
    alpha: FloatArray, cl: FloatArray, cd: FloatArray, cm: FloatArray, re: float, exponent: float
) -> SectionFit:
    """Numbers of one section."""
    start = int(np.argmin(np.abs(alpha)))
    top = start + int(np.argmax(cl[start:]))
    bottom = int(np.argmin(cl[: start + 1]))
    between = np.arange(bottom, top + 1)
    rising = between[(cl[between] > _LOW * cl[top]) & (cl[between] < _HIGH * cl[top])]
    slope, offset = np.polyfit(alpha[rising], cl[rising], 1)
    attached = between[(cl[between] >= 0.0) & (cl[between] < _ATTACHED * cl[top])]
    lift, drag = cl[attached], cd[attached]
    # One vertex after the other: a free one can leave the polar, with no drag or less at it.
    vertices = np.linspace(lift.min(), lift.max(), _TRIED)
    fits = [nnls(np.stack([np.ones_like(lift), (lift - v) ** 2], axis=1), drag) for v in vertices]
    best = int(np.argmin([error for _, error in fits]))
    cd_min, curvature = fits[best][0]
    return SectionFit(
        zero_lift=float(-offset / slope),
        slope=float(slope),
        cl_min=float(cl[bottom]),
        cl_max=float(cl[top]),
        cd_min=float(cd_min),
        cl_of_cd_min=float(vertices[best]),
        curvature=float(curvature),
        re=float(re),
        re_exponent=float(exponent),
        moment=float(cm[rising].mean()),
    )
