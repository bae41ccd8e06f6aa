"""What pictures are of, in words: the operation of a rotor and groups of observers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from propmdao.acoustics.kinematics.observers import directions
from propmdao.analysis.results import Analysis
from propmdao.records.listening import Listening


def operation(analysis: Analysis) -> str:
    """Propeller, rotation speed and flight for titles.

    Parameters
    ----------
    analysis : Analysis
        The analysis.

    Returns
    -------
    str
        In words.
    """
    return f"{analysis.propeller.name}, {condition(analysis)}"


def condition(analysis: Analysis) -> str:
    """Rotation speed and flight for titles.

    Parameters
    ----------
    analysis : Analysis
        The analysis.

    Returns
    -------
    str
        In words.
    """
    speed, incidence = float(analysis.point.speed), analysis.point.incidence_deg
    flight = f"{speed:.4g} m/s" if speed else "hover"
    if incidence:
        flight += f" at an incidence of {incidence:.4g}°"
    return f"{analysis.rpm:.0f} rpm, {flight}"


def observer_groups(listening: Listening) -> Iterator[tuple[str, slice]]:
    """Kind and members of each group of observers.

    Parameters
    ----------
    listening : Listening
        Observers; without groups they count as an arc where all are at one distance and azimuth.

    Yields
    ------
    kind : str
        "arc", "point", "circle", "grid" or "hemisphere".
    members : slice
        Indices of the group's observers.
    """
    if not listening.groups:
        seen = directions(listening.observers)
        spread = max(np.ptp(seen.radius), np.ptp(seen.azimuth_deg))
        yield "arc" if spread < 1e-9 else "point", slice(0, len(listening.observers))
    start = 0
    for group in listening.groups:
        yield group.kind, slice(start, start + group.n)
        start += group.n
