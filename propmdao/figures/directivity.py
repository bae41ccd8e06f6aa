"""Figures of where the noise goes: polar diagrams over elevation, maps of a hemisphere."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import (
    LEVEL,
    LINE_STYLES,
    LOWEST_LEVEL,
    MARKERS,
    Floats,
    Measured,
    line_colors,
    line_styles,
)
from propmdao.figures.style import half_circle, level_line, literal, page, say_silent

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

#: Levels in dB by name, or by name and then by noise source.
Levels = Mapping[str, npt.ArrayLike | Mapping[str, npt.ArrayLike]]


# Steps of contours [dB], the finest of which makes a dozen of them or less.
_CONTOUR_STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0)


_LABELS_AT = 157.5  # azimuth of the levels on the contours, between two lines of the grid [deg]
_APART = 5.0  # between two of these, and to the rim, in elevation [deg]


class _Line(NamedTuple):
    label: str
    color: str
    style: str
    level: Floats


def directivity(
    elevation_deg: npt.ArrayLike,
    levels: Levels,
    measured: Measured | None = None,
    label: str = "OASPL",
    microphone_deg: float | None = None,
    title: str = "",
) -> Figure:
    """Levels on an arc from below the rotor to above it, as a polar diagram.

    Parameters
    ----------
    elevation_deg : (n,) array
        Elevation from the rotor plane, rising, negative on the wake's side [deg].
    levels : mapping of str to (n,) array or to mapping of str to (n,) array
        Levels by name [dB], such as `sound.source_levels` gives for one sound. Where sounds are
        compared: levels by the name of the sound, a line style each, and then by noise source.
    measured : mapping of str to (elevation_deg, levels), optional
        Measured levels by the same names: dots.
    label : str
        Name of the level, which is in dB, or name and unit, such as "OASPL, dBA re 20 µPa".
    microphone_deg : float, optional
        Elevation to mark, that of the microphone of a study [deg].
    title : str
        Title.

    Returns
    -------
    Figure
        The figure; levels more than 40 dB below the loudest lie at its centre. Lines that are
        nowhere above -100 dB are not drawn.
    """
    measured = measured or {}
    lines = _lines(levels)
    drawn = [*(line.level for line in lines), *(known for _, known in measured.values())]
    loudest = max(float(np.max(level)) for level in drawn)
    figure, axes = half_circle(loudest, label if "," in label else f"{label}, {LEVEL}")
    lines = [line for line in lines if np.max(line.level) > LOWEST_LEVEL]
    floor, top = axes.get_ylim()
    angle = np.radians(np.asarray(elevation_deg, float))
    for number, line in enumerate(lines):
        axes.plot(
            angle, np.maximum(line.level, floor), color=line.color, linestyle=line.style,
            label=literal(line.label), **level_line(line.label),
        )  # fmt: skip
        if line.label in measured:
            elevation, known = (np.asarray(values, float) for values in measured[line.label])
            axes.plot(
                np.radians(elevation),
                known,
                MARKERS[number % len(MARKERS)],
                color=line.color,
                label=f"{literal(line.label)}, measured",
            )
    if microphone_deg is not None:
        axes.plot(
            np.radians([microphone_deg] * 2), [floor, top], color="#CC79A7", label="microphone",
            linewidth=2.0, zorder=1.5,
        )  # fmt: skip
    figure.text(0.02, 0.985, literal(title), va="top")
    if lines or measured:
        figure.legend(loc="upper right", bbox_to_anchor=(0.99, 0.965))
    else:
        say_silent(axes)
    return figure


def _lines(levels: Levels) -> list[_Line]:
    """Lines of a polar diagram: colours by source, styles by the sound that they belong to."""
    single = {name: level for name, level in levels.items() if not isinstance(level, Mapping)}
    compared = {name: level for name, level in levels.items() if isinstance(level, Mapping)}
    colors, styles = line_colors(single), line_styles(single)
    lines = [
        _Line(name, colors[name], styles[name], np.asarray(level, float))
        for name, level in single.items()
    ]
    for i, (name, sources) in enumerate(compared.items()):
        colors, style = line_colors(sources), LINE_STYLES[i % len(LINE_STYLES)]
        lines += [
            _Line(f"{name}, {source}", colors[source], style, np.asarray(level, float))
            for source, level in sources.items()
        ]
    return lines


def hemisphere_map(
    elevation_deg: npt.ArrayLike,
    azimuth_deg: npt.ArrayLike,
    level: npt.ArrayLike,
    label: str = f"OASPL, {LEVEL}",
    title: str = "",
) -> Figure:
    """Map of levels on the hemisphere below, seen from below: straight below in its middle.

    Parameters
    ----------
    elevation_deg : (n_elevations,) array
        Elevations from -90 to 0, rising [deg].
    azimuth_deg : (n_azimuths,) array
        Azimuths from 0 to 360, closed [deg]; 0 is drawn on top.
    level : (n_elevations, n_azimuths) array
        Levels, such as those that `observers.on_map` lays out [dB].
    label : str
        Name of the level, with its unit.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure, drawn down to 30 dB below the loudest; contours are at round levels and have
        them on their lines.
    """
    # Constrained layouts leave no room for the names of the directions.
    figure = page(8.5, layout=None)
    axes = cast("PolarAxes", figure.add_axes((0.08, 0.1, 0.7, 0.82), projection="polar"))
    azimuth, elevation = np.radians(np.asarray(azimuth_deg, float)), np.asarray(elevation_deg)
    figure.text(0.02, 0.98, literal(title), va="top")
    if silent := not np.max(level) > LOWEST_LEVEL:
        say_silent(axes)
    else:
        drawn = np.maximum(np.asarray(level, float), np.max(level) - 30.0)
        steps = _contours(drawn)
        filled = axes.contourf(azimuth, elevation, drawn, steps, cmap="viridis")
        # Its outermost levels are the ends of the scale, where no line is.
        axes.contour(azimuth, elevation, drawn, steps[1:-1], colors="black", linewidths=0.6)
        column = int(np.argmin(np.abs(azimuth - np.radians(_LABELS_AT))))
        for here, step in _crossings(elevation, drawn[:, column], steps[1:-1]):
            axes.text(
                azimuth[column], here, f"{step:g}", ha="center", va="center",
                bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "alpha": 0.8, "lw": 0},
            )  # fmt: skip
    axes.set(theta_zero_location="N", ylim=(-90.0, 0.0), yticks=[-60.0, -30.0, 0.0])
    # Seen from below, the azimuth about the upward axis turns clockwise.
    axes.set_theta_direction(-1)
    axes.set_yticklabels(["-60°", "-30°", ""], color="black" if silent else "white")
    axes.set_rlabel_position(22.5)
    axes.set_xlabel("azimuth around, elevation inward")
    axes.grid(color="0.8" if silent else "white", linewidth=0.5)
    if not silent:
        scale = figure.add_axes((0.87, 0.15, 0.03, 0.72))
        figure.colorbar(filled, cax=scale, label=label, format="%g", ticks=steps)
    return figure


def _crossings(elevation: Floats, level: Floats, steps: Floats) -> list[tuple[float, float]]:
    """Elevation and level of the contours along an azimuth, as far apart as their labels need."""
    crossings = []
    for i, (low, high) in enumerate(zip(level[:-1], level[1:], strict=True)):
        for step in steps[(steps > min(low, high)) & (steps <= max(low, high))]:
            share = (step - low) / (high - low)
            crossings.append(
                (float(elevation[i] + share * (elevation[i + 1] - elevation[i])), step)
            )
    apart: list[tuple[float, float]] = []
    for here, step in sorted(crossings):
        if here < -_APART and all(abs(here - other) >= _APART for other, _ in apart):
            apart.append((here, step))
    return apart


def _contours(level: Floats) -> Floats:
    """Round levels that enclose all of them, at most some fifteen."""
    low, high = float(np.min(level)), float(np.max(level))
    step = next((step for step in _CONTOUR_STEPS if high - low <= 12.0 * step), _CONTOUR_STEPS[-1])
    first = int(np.floor(low / step + 1e-9))
    return np.round(step * np.arange(first, int(np.floor(high / step)) + 2), 9)
