"""Figures of an analysis: what its observers hear, and where the noise goes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from propmdao.acoustics.kinematics.observers import directions, on_map
from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.aerodynamics.solutions.result import TiltedLoads
from propmdao.analysis.results import Analysis
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.contents.palette import LEVEL, LEVEL_DBA, Floats
from propmdao.figures.contents.pressures import blade_passage
from propmdao.figures.contents.sound import (
    Sound,
    analysis_sound,
    mechanism_levels,
    source_levels,
)
from propmdao.figures.contents.subjects import observer_groups, operation
from propmdao.figures.directivity import directivity, hemisphere_map
from propmdao.figures.flow.disks import disk_of_loads
from propmdao.figures.flow.wakes import wake_picture
from propmdao.figures.pressure import pressure
from propmdao.figures.spectra import harmonic_spectrum, narrowband_spectrum, third_octaves
from propmdao.records.listening import Listening

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def analysis_figures(
    analysis: Analysis, observer: int | None = None, a_weighted: bool = False
) -> dict[str, Figure]:
    """Draw an analysis.

    Parameters
    ----------
    analysis : Analysis
        Analysis with one observer or more, or at an incidence.
    observer : int, optional
        Index of the observer of spectrum and pressure, by default that of the loudest tones.
    a_weighted : bool
        Whether levels over direction are A-weighted.

    Returns
    -------
    dict of str to Figure
        "spectrum" and "pressure" at one observer, "third_octaves" there with broadband noise,
        "directivity" of an arc of three observers or more, "hemisphere" of a hemisphere. Further
        ones are numbered: "directivity_2", "hemisphere_2" ... . Observers without groups count as
        an arc where all are at one distance and azimuth. At an incidence also "disk", the loads
        over the disk; of a march in time also "wake".

    Raises
    ------
    ValueError
        If there are no observers, no incidence and no march, no such observer, or the rotor stands
        still.
    """
    positions = analysis.listening.observers
    title = operation(analysis)
    flow, loads = {}, analysis.loads
    if isinstance(loads, TiltedLoads) and analysis.point.incidence_deg:
        flow["disk"] = disk_of_loads(loads, f"{title}; seen from the thrust's side")
    if isinstance(loads, MarchedLoads):
        radius = 0.5 * analysis.changed_propeller.diameter
        flow["wake"] = wake_picture(np.asarray(loads.wake), radius, title)
    if len(positions) == 0:
        if not flow:
            raise ValueError("figures need observers, an incidence or a march in time")
        return flow
    if observer is None:
        observer = int(np.argmax(np.asarray(oaspl_db(analysis.tones.total))))
    if not 0 <= observer < len(positions):
        raise ValueError(f"observer must be within 0 ... {len(positions) - 1}; it is {observer}")
    sound = analysis_sound(analysis)
    figures = flow | _at_observer(analysis, sound, observer)
    levels = source_levels(sound, a_weighted)
    label = f"OASPL, {LEVEL_DBA if a_weighted else LEVEL}"
    numbers = {"directivity": 0, "hemisphere": 0}
    for kind, members in observer_groups(analysis.listening):
        here = {source: level[members] for source, level in levels.items()}
        if kind == "arc":
            name, figure = "directivity", arc_diagram(positions[members], here, label, title)
        elif kind == "hemisphere":
            name, level = "hemisphere", here["total"]
            figure = _hemisphere(analysis.listening, members, level, label, title)
        else:
            continue
        if figure is not None:
            numbers[name] += 1
            figures[name if numbers[name] == 1 else f"{name}_{numbers[name]}"] = figure
    return figures


def _at_observer(analysis: Analysis, sound: Sound, observer: int) -> dict[str, Figure]:
    """Spectrum and pressure at one observer, and third octaves with broadband noise."""
    seen = directions(analysis.listening.observers[observer]).rounded()
    place = f"{seen.elevation_deg:.4g}°"
    # Straight below and above there is no azimuth.
    if abs(seen.elevation_deg) < 90.0 and seen.azimuth_deg != 0.0:
        place += f", azimuth {seen.azimuth_deg:.4g}°"
    title = f"{operation(analysis)}; observer {observer + 1}: {place}, {seen.radius:.4g} m"
    figures = {"pressure": pressure({title: blade_passage(sound.tones, observer)})}
    if sound.has_broadband:
        figures["spectrum"] = narrowband_spectrum({title: sound}, observer)
        figures["third_octaves"] = third_octaves(
            BANDS_HZ, mechanism_levels(analysis, observer), title=title
        )
    else:
        figures["spectrum"] = harmonic_spectrum({title: sound}, observer)
    return figures


def arc_diagram(
    positions: Floats, levels: Mapping[str, Floats], label: str, title: str
) -> Figure | None:
    """Polar diagram of an arc.

    Parameters
    ----------
    positions : (n, 3) array
        Observers of the arc [m].
    levels : mapping of str to (n,) array
        Levels by name [dB].
    label : str
        Name of the levels, with their unit.
    title : str
        Title, to which the distance is added.

    Returns
    -------
    Figure or None
        The figure; None of fewer than three elevations.
    """
    seen = directions(positions).rounded()
    elevation, rising = np.unique(seen.elevation_deg, return_index=True)
    if elevation.size < 3:
        return None
    return directivity(
        elevation,
        {name: level[rising] for name, level in levels.items()},
        label=label,
        title=f"{title}; {seen.radius[0]:.4g} m",
    )


def _hemisphere(
    listening: Listening, members: slice, level: Floats, label: str, title: str
) -> Figure:
    """Map of a hemisphere, whose observers are in the order of `observers.hemisphere`."""
    radius = directions(listening.observers[members.start]).radius
    title = f"{title}; {radius:.4g} m"
    if listening.surroundings.level_flight:
        title += "; azimuth from the nose"
    return hemisphere_map(*on_map(level), label=label, title=title)
