"""Options that commands share: observers, broadband noise, ground and air."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING, Any

from propmdao.commands.options import number, number_or_range

if TYPE_CHECKING:
    from propmdao.records.air import Air
    from propmdao.records.listening import Surroundings

MAX_OBSERVERS = 20_000


def add_observers(command: argparse.ArgumentParser) -> None:
    """Add the options that place observers; `observers_of` reads them.

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


def add_broadband(command: argparse.ArgumentParser) -> None:
    """Add the options of broadband noise; `require_broadband` checks them.

    Parameters
    ----------
    command : argparse parser
        What they are added to.
    """
    command.add_argument(
        "--broadband", action="store_true", help="add the broadband self-noise to the tones"
    )
    add_trip(command)


def add_trip(command: argparse.ArgumentParser) -> None:
    """Add the option of tripped boundary layers.

    Parameters
    ----------
    command : argparse parser
        What it is added to.
    """
    command.add_argument(
        "--trip",
        choices=("none", "light", "heavy"),
        default="none",
        help="tripped boundary layers in the broadband noise, default none. Untripped ones shed"
        " vortices, which rule at the small angles of cruise; a rough or dusty blade sheds none",
    )


def require_broadband(options: argparse.Namespace) -> None:
    """Refuse tripped boundary layers where there is no broadband noise.

    Parameters
    ----------
    options : argparse.Namespace
        With the options of `add_broadband`.

    Raises
    ------
    ValueError
        If there is none.
    """
    if options.trip != "none" and not options.broadband:
        raise ValueError(f"--trip {options.trip} is about broadband noise: add --broadband")


def add_surroundings(command: argparse.ArgumentParser) -> None:
    """Add the options of ground and air; `surroundings_of` reads them.

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
        help="level flight: the axis lies along the ground, azimuth 0 is down; by default it stands"
        " upright: hover, climb",
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


def observers_of(options: argparse.Namespace) -> list[tuple[float, float, float]]:
    """Observers of a command line.

    Parameters
    ----------
    options : argparse.Namespace
        With the options of `add_observers`.

    Returns
    -------
    list of (radius, elevation_deg, azimuth_deg)
        Those of --hemisphere last.

    Raises
    ------
    ValueError
        When one is incomplete or out of range, or they are too many.
    """
    # Slow to import, so only once the arguments are known to be good.
    import numpy as np

    from propmdao.acoustics.kinematics.observers import circle, directions, grid, hemisphere
    from propmdao.records.listening import Surroundings

    found: list[tuple[float, float, float]] = []
    for values in options.arc:
        (radius, *others), *elevations = map(_values, values)
        if others or not elevations:
            raise ValueError(
                f"--arc {radius:g} needs one radius and then at least one elevation, as in"
                " --arc 1.905 -45 0"
            )
        found += [(radius, elevation, 0.0) for some in elevations for elevation in some]
    for place in options.point:
        found += [
            (radius, elevation, azimuth)
            for radius in _values(place[0])
            for elevation in _values(place[1])
            for azimuth in _values(place[2])
        ]
    positions = []
    for radius, elevation, n in options.circle:
        if n != int(n) or not 1 <= n <= MAX_OBSERVERS:
            raise ValueError(f"--circle needs a whole number N of observers; it is {n:g}")
        positions.append(circle(radius, int(n), elevation))
    # What is named by the ground is turned into the rotor's axes.
    axes = Surroundings(level_flight=getattr(options, "level", False))
    for coordinates in options.grid:
        n = math.prod(len(_values(q)) for q in coordinates)
        if n > MAX_OBSERVERS:
            raise ValueError(f"--grid has {n} observers, at most {MAX_OBSERVERS} are allowed")
        positions.append(axes.from_ground_axes(grid(*coordinates)))
    for radius, step in options.hemisphere:
        if 0.0 < step < 1.0:
            raise ValueError(f"--hemisphere needs a STEP of 1 deg or more; it is {step:g}")
        positions.append(axes.from_ground_axes(hemisphere(radius, step)))
    for placed in positions:
        # Rounding leaves 1e-15 deg where zero is meant.
        seen = (np.round(q, 9).tolist() for q in directions(placed))
        found += list(zip(*seen, strict=True))
    if len(found) > MAX_OBSERVERS:
        raise ValueError(f"{len(found)} observers are more than the {MAX_OBSERVERS} allowed")
    return found


def surroundings_of(options: argparse.Namespace) -> Surroundings:
    """Ground and air of a command line.

    Parameters
    ----------
    options : argparse.Namespace
        With the options of `add_surroundings`.

    Returns
    -------
    Surroundings
        Ground and air.

    Raises
    ------
    ValueError
        When a value is out of range.
    """
    from propmdao.records.listening import Surroundings

    return Surroundings(options.ground, options.level, air_of(options))


def air_of(options: argparse.Namespace) -> Air | None:
    """Air that absorbs, of a command line.

    Parameters
    ----------
    options : argparse.Namespace
        With the option of `add_absorption`.

    Returns
    -------
    Air or None
        None where it is not asked for.

    Raises
    ------
    ValueError
        When there are too many values.
    """
    from propmdao.records.air import Air

    given: list[float] | None = options.absorption
    if given is None:
        return None
    if len(given) > 3:
        raise ValueError(
            "--absorption takes temperature, humidity and pressure at most; it has"
            f" {len(given)} values"
        )
    celsius, percent, pressure = given + [15.0, 70.0, 101325.0][len(given) :]
    return Air(273.15 + celsius, percent / 100.0, pressure)


def _values(value: float | list[float]) -> list[float]:
    """Numbers of a range or a number."""
    return value if isinstance(value, list) else [value]


def _height(text: str) -> float | str:
    return text if text == "flush" else number(text)
