"""Figures: convergence of a search, blades, and what they sound like.

Every function returns a `matplotlib.figure.Figure` of 1200 pixels' width that needs no display;
``figure.savefig("name.png")`` writes it. Thickness, loading and total noise have one colour each
everywhere. What is compared comes as a dictionary of names, drawn in its order: the first dashed,
the others solid.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import jax
import numpy as np
import numpy.typing as npt

from propmdao.acoustics.levels.decibels import oaspl_db, pressure_history, spl_db
from propmdao.acoustics.signals import Tones
from propmdao.figures.style import (
    BLADE_COLORS,
    GRID,
    LINE_STYLES,
    PART_COLORS,
    half_circle,
    page,
    rows_of_axes,
)
from propmdao.geometry.blade import span_interpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION
from propmdao.propeller.description import Propeller

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def convergence(
    objective: npt.ArrayLike,
    feasible: npt.ArrayLike,
    label: str,
    references: Mapping[str, float] | None = None,
) -> Figure:
    """All designs that a search has tried, and the best feasible one so far.

    Parameters
    ----------
    objective : (n_evaluations,) array
        Minimised, in the order of evaluation; nan where the analysis failed.
    feasible : (n_evaluations,) bool array
        Whether all constraints hold.
    label : str
        Objective with its unit, for the axis.
    references : mapping of str to float, optional
        Values of the objective to compare with, by name.

    Returns
    -------
    Figure
        The figure.
    """
    objective, feasible = np.asarray(objective, float), np.asarray(feasible, bool)
    evaluation = np.arange(1, objective.size + 1)
    failed = np.isnan(objective)
    best = np.fmin.accumulate(np.where(feasible, objective, np.nan))
    figure = page(6.0)
    axes = figure.add_subplot()
    axes.grid(**GRID)
    for chosen, marker, color, name in (
        (feasible & ~failed, "o", "#56B4E9", "feasible"),
        (~feasible & ~failed, "x", "#D55E00", "violates a constraint"),
    ):
        axes.scatter(
            evaluation[chosen], objective[chosen], s=14, marker=marker, color=color,
            linewidths=1.0, label=f"{name} ({chosen.sum()})",
        )  # fmt: skip
    if failed.any():
        axes.plot(
            evaluation[failed], np.full(failed.sum(), 0.015), "^", color="#CC79A7", markersize=5,
            transform=axes.get_xaxis_transform(), label=f"analysis failed ({failed.sum()})",
        )  # fmt: skip
    axes.step(evaluation, best, where="post", color="black", linewidth=2.0, label="best feasible")
    for (name, value), style in zip((references or {}).items(), LINE_STYLES, strict=False):
        axes.axhline(value, color="0.4", linestyle=style, label=f"{name}, {value:.2f}")
    axes.set(xlabel="designs evaluated", ylabel=label, xlim=(0, objective.size + 1))
    axes.legend(loc="upper right", framealpha=0.95)
    return figure


def blades(propellers: Mapping[str, Propeller], section_r_over_R: Sequence[float]) -> Figure:
    """Compare blades: distributions over span, planform and sections.

    Parameters
    ----------
    propellers : mapping of str to Propeller
        Up to four, by name.
    section_r_over_R : sequence of float
        Where the sections are drawn.

    Returns
    -------
    Figure
        The figure.
    """
    figure = page(8.0)
    grid = figure.add_gridspec(1, 2, width_ratios=(1.15, 1.0))
    spans: Any = grid[0].subgridspec(5, 1).subplots(sharex=True)
    sections: Any = grid[1].subgridspec(len(section_r_over_R), 1)
    sections = sections.subplots(sharex=True, sharey=True, squeeze=False)[:, 0]
    for i, (name, propeller) in enumerate(propellers.items()):
        # The first on top: its dashes let what is equal shine through.
        line = {"color": BLADE_COLORS[i], "linestyle": LINE_STYLES[i], "zorder": 4 - i}
        _draw_spans(spans, propeller, linewidth=2.0, label=name, **line)
        _draw_sections(sections, propeller, section_r_over_R, linewidth=2.0, **line)
    for axes in (*spans, *sections):
        axes.grid(**GRID)
    spans[-1].set_xlabel("r/R")
    sections[-1].set_xlabel("x/c")
    figure.align_ylabels(spans)
    figure.legend(*spans[0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure


def spectrum(tones: Mapping[str, Tones], observer: int = 0) -> Figure:
    """Levels of the harmonics at an observer, by noise source.

    Parameters
    ----------
    tones : mapping of str to Tones
        By name, one below the other.
    observer : int
        Which of their observers.

    Returns
    -------
    Figure
        The figure. Stems start 80 dB below the loudest tone; what is quieter is not drawn.
    """
    figure, rows = rows_of_axes(len(tones))
    loudest = max(float(np.max(spl_db(heard.total[observer]))) for heard in tones.values())
    top = 5.0 * np.ceil(loudest / 5.0 + 1.0)
    floor = top - 80.0
    for axes, (name, heard) in zip(rows, tones.items(), strict=True):
        frequency = np.asarray(heard.frequency_hz)
        for i, (part, amplitude) in enumerate(_parts(heard, observer).items()):
            level = np.asarray(spl_db(amplitude))
            drawn = level > floor
            at = frequency[drawn] + (i - 1) * 0.05 * frequency[0]  # side by side
            stems = axes.stem(at, level[drawn], bottom=floor, basefmt=" ", label=part)
            stems.markerline.set(color=PART_COLORS[part], markersize=5, marker="osD"[i])
            stems.stemlines.set(color=PART_COLORS[part], linewidth=2.0)
        axes.set_title(f"{name}: BPF {frequency[0]:.1f} Hz", fontsize="medium", loc="left")
        axes.set(ylabel="SPL, dB re 20 µPa", ylim=(floor, top))
    rows[-1].set_xlabel("frequency, Hz (sources side by side)")
    rows[-1].set_xlim(left=0.0)
    rows[0].legend(loc="upper right", ncols=3, framealpha=0.95)
    return figure


def directivity(
    tones: Mapping[str, Tones], elevation_deg: npt.ArrayLike, mark_deg: float | None = None
) -> Figure:
    """Overall level on an arc from below the rotor to above it, by noise source.

    Parameters
    ----------
    tones : mapping of str to Tones
        By name, all at the same observers.
    elevation_deg : (n_observers,) array
        Where they are: elevation from the rotor plane, negative on the wake's side [deg].
    mark_deg : float, optional
        Elevation of the microphone of a study.

    Returns
    -------
    Figure
        The figure; levels more than 40 dB below the loudest lie at its centre.
    """
    angle = np.radians(np.asarray(elevation_deg, float))
    levels = {
        (name, part): np.asarray(oaspl_db(amplitude))
        for name, heard in tones.items()
        for part, amplitude in _parts(heard).items()
    }
    loudest = max(float(level.max()) for level in levels.values())
    figure, axes = half_circle(loudest, 15.0, "OASPL, dB re 20 µPa")
    floor, top = axes.get_ylim()
    styles = dict(zip(tones, LINE_STYLES, strict=False))
    for (name, part), level in levels.items():
        axes.plot(
            angle, np.maximum(level, floor), color=PART_COLORS[part], linestyle=styles[name],
            linewidth=2.0, label=f"{name}, {part}",
        )  # fmt: skip
    if mark_deg is not None:
        axes.plot(
            np.radians([mark_deg] * 2),
            [floor, top],
            color="#CC79A7",
            label="microphone",
            linewidth=2.0,
            zorder=1.5,
        )
    figure.legend(loc="center right", bbox_to_anchor=(0.97, 0.8))
    return figure


def pressure(tones: Mapping[str, Tones], observer: int = 0) -> Figure:
    """Sound pressure at an observer over one blade passage, by noise source.

    Parameters
    ----------
    tones : mapping of str to Tones
        By name, one below the other.
    observer : int
        Which of their observers.

    Returns
    -------
    Figure
        The figure.
    """
    figure, rows = rows_of_axes(len(tones))
    for axes, (name, heard) in zip(rows, tones.items(), strict=True):
        for part, amplitude in _parts(heard, observer).items():
            time, p = pressure_history(heard.frequency_hz, amplitude, 256)
            axes.plot(1e3 * time, 1e3 * p, color=PART_COLORS[part], linewidth=2.0, label=part)
        axes.set_title(name, fontsize="medium", loc="left")
        axes.set_ylabel("pressure, mPa")
        axes.margins(x=0.0)
    rows[-1].set_xlabel("time since blade 1 was at azimuth 0, ms")
    figure.legend(*rows[0].get_legend_handles_labels(), loc="outside upper right", ncols=3)
    return figure


def _parts(heard: Tones, observer: int | slice = slice(None)) -> dict[str, jax.Array]:
    """Amplitudes by noise source, in the order in which they are drawn."""
    return {part: getattr(heard, part)[observer] for part in PART_COLORS}


def _draw_spans(spans: Sequence[Axes], propeller: Propeller, **line: Any) -> None:
    """Distributions over span, and at last the planform."""
    r = np.linspace(propeller.r_over_R[0], 1.0, 200)
    at = span_interpolation(propeller.r_over_R, r)
    chord, beta_deg, sweep = (
        np.asarray(at.smooth) @ values
        for values in (propeller.c_over_R, propeller.beta_deg, propeller.sweep_over_R)
    )
    camber, thickness = (np.asarray(at.linear) @ shape for shape in _sections(propeller))
    largest = np.take_along_axis(camber, np.abs(camber).argmax(axis=1)[:, None], axis=1)
    # Seen from ahead: the leading edge is toward +y, a quarter of the chord from the sweep line.
    projected = chord * np.cos(np.radians(beta_deg))
    edges = np.append(0.25 * projected - sweep, (-0.75 * projected - sweep)[::-1])
    for axes, label, values in zip(
        spans,
        ("chord c/R", "blade angle, deg", "thickness t/c", "camber f/c", "planform y/R"),
        (chord, beta_deg, thickness.max(axis=1), largest[:, 0], edges),
        strict=True,
    ):
        axes.plot(r if values.size == r.size else np.append(r, r[::-1]), values, **line)
        axes.set_ylabel(label)


def _draw_sections(
    sections: Sequence[Axes], propeller: Propeller, r_over_R: Sequence[float], **line: Any
) -> None:
    """Contours of unit chord, one on each axes."""
    linear = np.asarray(span_interpolation(propeller.r_over_R, r_over_R).linear)
    camber, thickness = (linear @ shape for shape in _sections(propeller))
    x = np.append(CHORD_FRACTION[::-1], CHORD_FRACTION)
    for axes, r, f, t in zip(sections, r_over_R, camber, thickness, strict=True):
        axes.plot(x, np.append((f + 0.5 * t)[::-1], f - 0.5 * t), **line)
        axes.set_title(f"section at r/R {r:g}", fontsize="medium")
        axes.set_ylabel("z/c, stretched")


def _sections(propeller: Propeller) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Camber and thickness over chord, (n_stations, n_chord), as the blade has them."""
    camber, thickness = propeller.sections()
    if propeller.thickness_over_chord is not None:
        scale = propeller.thickness_over_chord / thickness.max(axis=1)
        thickness = thickness * scale[:, None]
    return camber, thickness
