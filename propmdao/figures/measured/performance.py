"""Figures of measurements and of results computed at the same points: dots and lines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from propmdao.analysis.wind_tunnel import Errors, Points
from propmdao.figures.contents.palette import LEVEL, LINE_STYLES, RUN_COLORS
from propmdao.figures.style import GRID, literal, page, run_dots, run_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Errors shown of many propellers, and their axis.
_ERRORS = {
    "static_ct": "static CT, %",
    "static_cp": "static CP, %",
    "low_ct": "CT to J 0.5,\n% of static CT",
    "low_cp": "CP to J 0.5,\n% of static CP",
}
_SET_COLORS = ("#E69F00", "#0072B2")
_LEAST_THRUST = 0.005  # CT below which an efficiency is that of a brake


def performance(measured: Points, computed: Mapping[str, Points]) -> Figure:
    """CT, CP and eta over advance ratio, every rotation speed in its colour.

    Parameters
    ----------
    measured : Points
        Measured points with flight speed; runs near the same multiple of 500 rpm belong together.
    computed : mapping of str to Points
        Computed results at the same points, by name: a column of axes each.

    Returns
    -------
    Figure
        The figure.
    """
    figure = page(11.0)
    grid: Any = figure.subplots(3, len(computed), sharex=True, sharey="row", squeeze=False)
    for column, (name, points) in enumerate(computed.items()):
        grid[0, column].set_title(literal(name), fontsize="medium")
        for number, speed, run in _runs(measured):
            _draw_run(grid[:, column], measured[run], points[run], number, speed)
        grid[-1, column].set_xlabel("advance ratio J")
    for row, label in zip(grid, ("CT", "CP", "efficiency eta"), strict=True):
        row[0].set_ylabel(label)
        for axes in row:
            axes.grid(**GRID)
            axes.axhline(0.0, color="0.6", linewidth=0.8)
    grid[-1, 0].set_ylim(0.0, 0.8)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside upper center", ncols=len(labels),
        title="measured (dots) and computed (lines)",
    )  # fmt: skip
    return figure


def _draw_run(
    rows: Sequence[Any], measured: Points, points: Points, number: int, label: str
) -> None:
    line, dots = run_line(number), run_dots(number)
    for axes, name in zip(rows, ("CT", "CP", "eta"), strict=True):
        shown = []
        for values in (measured, points):
            y = getattr(values, name)
            shown.append(np.where(values.CT > _LEAST_THRUST, y, np.nan) if name == "eta" else y)
        axes.plot(measured.J, shown[0], markersize=4, mfc="none", **dots)
        axes.plot(points.J, shown[1], linewidth=1.8, label=literal(label), **line)


def static_performance(measured: Points, computed: Mapping[str, Points]) -> Figure:
    """CT and CP without flight speed over rotation speed.

    Parameters
    ----------
    measured : Points
        Measured points without flight speed.
    computed : mapping of str to Points
        Computed results at the same points, by name: a line each.

    Returns
    -------
    Figure
        The figure.
    """
    figure = page(5.5)
    both: Any = figure.subplots(1, 2)
    for axes, name in zip(both, ("CT", "CP"), strict=True):
        axes.grid(**GRID)
        axes.plot(measured.rpm, getattr(measured, name), "o", color="black", label="measured",
                  markersize=5, mfc="none")  # fmt: skip
        for i, (label, points) in enumerate(computed.items()):
            axes.plot(points.rpm, getattr(points, name), color=RUN_COLORS[i], label=literal(label),
                      linewidth=1.8, linestyle=LINE_STYLES[i % len(LINE_STYLES)])  # fmt: skip
        axes.set(xlabel="rotation speed, rpm", ylabel=f"static {name}")
    handles, labels = both[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


def over_rpm_and_advance_ratio(
    static: Points,
    dynamic: Points,
    values: Mapping[str, tuple[npt.ArrayLike, npt.ArrayLike]],
) -> Figure:
    """Quantities over rotation speed without flight speed, and over advance ratio with it.

    Parameters
    ----------
    static, dynamic : Points
        Points without and with flight speed.
    values : mapping of str to (static values, dynamic values)
        Values at both, by the label of their axis: a row of axes each.

    Returns
    -------
    Figure
        The figure; runs near the same multiple of 500 rpm share a colour.
    """
    figure = page(1.0 + 3.5 * len(values))
    grid: Any = figure.subplots(len(values), 2, sharex="col", sharey="row", squeeze=False)
    for row, (label, (still, moving)) in zip(grid, values.items(), strict=True):
        row[0].set_ylabel(label)
        row[0].plot(static.rpm, np.asarray(still), "o-", color="black", markersize=4)
        for number, name, run in _runs(dynamic):
            line = run_dots(number) | run_line(number)
            row[1].plot(
                dynamic.J[run], np.asarray(moving)[run], markersize=4, label=literal(name), **line
            )
        for axes in row:
            axes.grid(**GRID)
    grid[-1, 0].set_xlabel("rotation speed without flight speed, rpm")
    grid[-1, 1].set_xlabel("advance ratio J")
    grid[0, 1].legend(loc="best")
    return figure


def errors_by_propeller(errors: Mapping[str, Mapping[str, Errors]]) -> Figure:
    """Errors of thrust and power of many propellers, a row for each.

    Parameters
    ----------
    errors : mapping of str to mapping of str to Errors
        By the name of the propeller and, the same ones for each, of the set.

    Returns
    -------
    Figure
        The figure: dots are means over the points of a propeller, lines reach from the least to the
        largest.
    """
    sets = list(next(iter(errors.values())))
    figure = page(2.0 + 0.36 * len(errors))
    columns: Any = figure.subplots(1, len(_ERRORS), sharey=True)
    for axes, (name, label) in zip(columns, _ERRORS.items(), strict=True):
        axes.grid(**GRID)
        axes.axvline(0.0, color="0.3", linewidth=1.0)
        axes.set_xlabel(label)
        for row, by_set in enumerate(errors.values()):
            for k, (color, key) in enumerate(zip(_SET_COLORS, sets, strict=False)):
                values = 100.0 * getattr(by_set[key], name)
                values = values[np.isfinite(values)]
                if values.size:
                    y = row + 0.36 * ((k + 0.5) / len(sets) - 0.5)
                    axes.plot([values.min(), values.max()], [y, y], color=color, linewidth=1.5)
                    axes.plot([values.mean()], [y], "o", color=color, markersize=5)
    for color, key in zip(_SET_COLORS, sets, strict=False):
        columns[0].plot([], [], "o-", color=color, label=key)
    columns[0].set_yticks(range(len(errors)), list(errors))
    columns[0].invert_yaxis()
    handles, labels = columns[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside upper center", ncols=len(labels),
        title="computed over measured: mean of the points (dots), least to largest (lines)",
    )  # fmt: skip
    return figure


def tone_directivity(
    elevation_deg: npt.ArrayLike,
    computed: Mapping[str, npt.ArrayLike],
    measured_at_deg: npt.ArrayLike,
    measured: Mapping[str, npt.ArrayLike],
) -> Figure:
    """Level of a tone over elevation, computed lines and measured dots of the same colour.

    Parameters
    ----------
    elevation_deg : (n,) array
        Elevations of the computed levels [deg].
    computed : mapping of str to (n,) array
        Computed SPL by name [dB].
    measured_at_deg : (n_microphones,) array
        Elevations of the microphones [deg].
    measured : mapping of str to (n_microphones,) array
        Measured SPL by the same names [dB].

    Returns
    -------
    Figure
        The figure.
    """
    figure = page(6.0)
    axes = figure.add_subplot()
    axes.grid(**GRID)
    for number, (name, level) in enumerate(computed.items()):
        axes.plot(elevation_deg, level, label=literal(name), **run_line(number))
        axes.plot(measured_at_deg, measured[name], **run_dots(number))
    axes.set(
        xlabel="elevation from the rotor plane, deg (negative: wake side)",
        ylabel=f"SPL at blade passage, {LEVEL}",
    )
    axes.set_xticks(np.arange(-67.5, 68.0, 22.5))
    axes.legend(title="measured (dots) and computed (lines)", loc="lower center")
    return figure


def _runs(points: Points) -> Iterator[tuple[int, str, npt.NDArray[np.intp]]]:
    """Number, name and positions, by rising J, of the runs of a rotation speed."""
    speeds = 500.0 * np.round(points.rpm / 500.0)
    for number, speed in enumerate(np.unique(speeds)[: len(RUN_COLORS)]):
        run = np.flatnonzero(speeds == speed)
        yield number, f"{speed:.0f} rpm", run[np.argsort(points.J[run])]
