"""Figure of the polars that a blade's sections were held to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import jax.numpy as jnp
import numpy as np

from propmdao.aerodynamics.sections.polars.family import SectionPolars, blade_tables
from propmdao.aerodynamics.sections.polars.table import (
    PolarTable,
    curve_coefficients,
    section_curves,
)
from propmdao.analysis.results import Analysis
from propmdao.figures.contents.palette import LINE_STYLES, RUN_COLORS, Floats
from propmdao.figures.style import GRID, headline, page
from propmdao.geometry.blade import Blade, span_interpolation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_AT = (0.3, 0.5, 0.75, 0.95)  # r/R
_ANGLES_DEG = np.linspace(-10.0, 20.0, 121)


def section_polars(analysis: Analysis, polars: SectionPolars, title: str = "") -> Figure:
    """Draw lift over the angle of attack, and over drag, at four radii and their Reynolds numbers.

    Parameters
    ----------
    analysis : Analysis
        Analysis with viscous loads.
    polars : SectionPolars
        Polars with which it was made.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure: lines are the polars without stall delay, dots how the sections work, at an
        incidence in the mean over the turn.
    """
    propeller = analysis.changed_propeller
    radii = np.clip(_AT, propeller.r_over_R[0], 1.0)
    table = blade_tables(
        polars, Blade.from_propeller(propeller), span_interpolation(propeller.r_over_R, radii)
    )
    states, strips = analysis.loads.sections, analysis.loads.strips
    here = np.asarray(strips.r_over_R)

    def at(values: Any) -> Floats:
        return np.interp(radii, here, np.atleast_2d(np.asarray(values)).mean(axis=0))

    speed, chord = at(states.relative_speed), at(strips.chord)
    air = analysis.point.air
    reynolds, mach = speed * chord / air.kinematic_viscosity, speed / air.sound_speed
    lift, drag = (at(v) for v in (states.lift_coefficient, states.drag_coefficient))
    angle_deg = np.degrees(at(states.angle_of_attack))
    cl, cd = _curves(table, reynolds, mach)
    figure = page(6.5)
    left, right = figure.subplots(1, 2, sharey=True)
    for k, r in enumerate(radii):
        line = {"color": RUN_COLORS[k], "linestyle": LINE_STYLES[k]}
        label = f"r/R {r:.2f}, Re {reynolds[k] / 1e3:.0f} thousand"
        left.plot(_ANGLES_DEG, cl[:, k], label=label, linewidth=1.8, **line)
        right.plot(cd[:, k], cl[:, k], linewidth=1.8, **line)
        for axes, x in ((left, angle_deg[k]), (right, drag[k])):
            axes.plot([x], [lift[k]], "o", color=RUN_COLORS[k], markersize=8, mec="black")
    left.set(xlabel="angle of attack, deg", ylabel="lift coefficient")
    right.set(xlabel="drag coefficient", xlim=(0.0, 1.1 * max(0.08, float(drag.max()))))
    for axes in (left, right):
        axes.grid(**GRID)
    headline(figure, title)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _curves(table: PolarTable, reynolds: Floats, mach: Floats) -> tuple[Floats, Floats]:
    """Lift and drag coefficients at the angles, (n_angles, n_sections) each."""
    curves = section_curves(table, jnp.asarray(reynolds), jnp.asarray(mach))
    n = reynolds.size
    both = [curve_coefficients(curves, jnp.full(n, angle))[:2] for angle in np.radians(_ANGLES_DEG)]
    return np.asarray([cl for cl, _ in both]), np.asarray([cd for _, cd in both])
