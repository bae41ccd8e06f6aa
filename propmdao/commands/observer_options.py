"""Options that commands share: observers, ground and air."""

from __future__ import annotations

import argparse
import itertools
import math
from typing import TYPE_CHECKING, Any

from propmdao.commands.options import number, number_or_range

if TYPE_CHECKING:
    from propmdao.records.listening import Listening


def add_observers(command: argparse.ArgumentParser) -> None:
    """Add the options that place observers; `listening_of` reads them.

    Parameters
    ----------
    command : argparse parser
        What they are added to.
    """
    group = command.add_argument_group(
        "observers",
        "They fly along with the rotor. Distances are from the hub [m], elevations from the\n"
        "rotor plane, negative below it (wake side), azimuths about the axis [deg]. Every option\n"
        "may be repeated; in --arc, --point and --grid a value may be a range START:STOP:STEP.",
    )
    many: dict[str, Any] = {"action": "append", "default": [], "type": number_or_range}
    group.add_argument(
        "--arc",
        nargs="+",
        metavar=("RADIUS", "ELEVATION"),
        help="at RADIUS and each ELEVATION, at azimuth 0",
        **many,
    )
    group.add_argument(
        "--point",
        nargs=3,
        metavar=("RADIUS", "ELEVATION", "AZIMUTH"),
        help="one observer",
        **many,
    )
    group.add_argument(
        "--grid",
        nargs=3,
        metavar=("X", "Y", "Z"),
        help="every combination of coordinates [m], Z up, X ahead with --level: a line on the"
        " ground is --grid -20:20:5 0 -10",
        **many,
    )
    many["type"] = number
    group.add_argument(
        "--circle",
        nargs=3,
        metavar=("RADIUS", "ELEVATION", "N"),
        help="N observers evenly around the axis",
        **many,
    )
    group.add_argument(
        "--hemisphere",
        nargs=2,
        metavar=("RADIUS", "STEP"),
        help="below the rotor, or below the aircraft with --level, every STEP deg of elevation and"
        " azimuth; STEP divides 90",
        **many,
    )


def add_surroundings(command: argparse.ArgumentParser) -> None:
    """Add the options of ground and air; `listening_of` and `air_of` read them.

    Parameters
    ----------
    command : argparse parser
        What they are added to.
    """
    group = command.add_argument_group("ground and air")
    group.add_argument(
        "--ground",
        type=_height,
        metavar="HEIGHT",
        help="height of the hub over hard ground [m], which reflects sound (the flow knows of no"
        " ground); or the word flush: all microphones lie flush on hard ground, 6 dB",
    )
    group.add_argument(
        "--level",
        action="store_true",
        help="level flight: the axis lies along the ground, azimuth 0 is down; at an incidence it"
        " leans forward by 90 deg less that; by default it stands upright: hover, climb",
    )
    add_absorption(group)


def add_absorption(group: argparse._ActionsContainer) -> None:
    """Add the option of air that absorbs; `air_of` reads it.

    Parameters
    ----------
    group : argparse parser or group
        What it is added to.
    """
    group.add_argument(
        "--absorption",
        nargs="*",
        type=number,
        metavar=("DEG_C", "PERCENT"),
        help="air absorbs sound (ISO 9613-1): temperature [deg C], relative humidity [%%] and"
        " pressure [Pa], by default 15 70 101325. The speed of sound stays that of 15 deg C",
    )


def listening_of(options: argparse.Namespace, incidence_deg: float = 0.0) -> Listening:
    """Observers, ground and air of a command line.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed, with the options of `add_observers` and perhaps of `add_surroundings`.
    incidence_deg : float
        Angle between the shaft and the direction of flight [deg]: it says where the ground is.

    Returns
    -------
    Listening
        Observers in groups by the option that made them.

    Raises
    ------
    ValueError
        When an option is incomplete or out of range, or there are too many observers.
    """
    # Slow to import, so only once the arguments are known to be good.
    import numpy as np

    from propmdao.acoustics.kinematics.observers import circle, grid, hemisphere, point
    from propmdao.records.listening import (
        MOST_OBSERVERS,
        Listening,
        ObserverGroup,
        Surroundings,
        require_number_of_observers,
    )

    surroundings = Surroundings(
        getattr(options, "ground", None),
        getattr(options, "level", False),
        getattr(options, "absorption", None) is not None,
    )
    positions: list[np.ndarray] = []
    groups: list[ObserverGroup] = []

    def add(kind: Any, placed: np.ndarray) -> None:
        same = sum(group.kind == kind for group in groups)
        groups.append(ObserverGroup(f"{kind} {same + 1}" if same else kind, kind, len(placed)))
        positions.append(placed)
        require_number_of_observers(sum(group.n for group in groups))

    for values in options.arc:
        (radius, *others), *elevations = map(_values, values)
        if others or not elevations:
            raise ValueError(
                f"--arc {radius:g} needs one radius and then at least one elevation, as in"
                " --arc 1.905 -45 0"
            )
        add("arc", point(radius, [elevation for some in elevations for elevation in some]))
    for place in options.point:
        values = [_values(value) for value in place]
        require_number_of_observers(math.prod(map(len, values)))
        add("point", point(*np.transpose(list(itertools.product(*values)))))
    for radius, elevation, n in options.circle:
        if n != int(n) or not 1 <= n <= MOST_OBSERVERS:
            raise ValueError(
                f"--circle needs a whole number N of observers, 1 ... {MOST_OBSERVERS}; it is {n:g}"
            )
        add("circle", circle(radius, int(n), elevation))
    # What is named by the ground is turned into the rotor's axes.
    for coordinates in options.grid:
        add("grid", surroundings.from_ground_axes(grid(*coordinates), incidence_deg))
    for radius, step in options.hemisphere:
        add("hemisphere", surroundings.from_ground_axes(hemisphere(radius, step), incidence_deg))
    observers = np.concatenate([np.zeros((0, 3)), *positions])
    return Listening(observers, surroundings, tuple(groups))


def air_of(options: argparse.Namespace) -> dict[str, float]:
    """Air that absorbs, of a command line.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed, with the option of `add_absorption`.

    Returns
    -------
    dict
        Temperature [K], relative humidity and pressure [Pa] by the names of `propmdao.analyze`, as
        far as they are given.

    Raises
    ------
    ValueError
        When there are too many values, or absorption is not known in such air.
    """
    values: list[float] = options.absorption or []
    if len(values) > 3:
        raise ValueError(
            "--absorption takes temperature, humidity and pressure at most; it has"
            f" {len(values)} values"
        )
    names = ("temperature", "relative_humidity", "pressure")
    air = dict(zip(names, values, strict=False))
    if "temperature" in air:
        air["temperature"] += 273.15
    if "relative_humidity" in air:
        air["relative_humidity"] /= 100.0
    if options.absorption is not None:
        from propmdao.records.air import Air, require_known_air

        require_known_air(Air(**air))
    return air


def _values(value: float | list[float]) -> list[float]:
    """Numbers of a range or a number."""
    return value if isinstance(value, list) else [value]


def _height(text: str) -> float | str:
    return text if text == "flush" else number(text)
