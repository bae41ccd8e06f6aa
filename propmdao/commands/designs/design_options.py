"""Options of ``propmdao optimise``, from the tables of what may be designed."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.observer_options import add_observers
from propmdao.commands.options import add_asked, add_propeller, number
from propmdao.propeller.design_choices import BASELINE, FREE, OBJECTIVES, RESPONSES, Free

if TYPE_CHECKING:
    from propmdao.records.states import OperatingPoint

#: What may be asked of the model.
ASKED_OPTIONS = (
    "blade_element",
    "n_crit",
    "trip_upper",
    "trip_lower",
    "stall_delay",
    "trip",
    "layers",
)
_THICKNESS = "thickness"


def add_design_options(command: argparse.ArgumentParser) -> None:
    """Add the options that describe a design problem.

    Parameters
    ----------
    command : argparse parser
        What they are added to.
    """
    add_propeller(command)
    add_asked(command, ("thrust", "speed", "incidence_deg", "density"))
    command.add_argument(
        "--also-at",
        nargs="+",
        type=number,
        action="append",
        default=[],
        metavar=("THRUST SPEED", "INCIDENCE"),
        help="another operating point of the same blade [N, m/s, deg], the incidence 0 where none"
        " is given; may be repeated. An incidence anywhere takes some hundred times as long",
    )
    command.add_argument(
        "--free",
        type=_words,
        default=["chord", "twist"],
        metavar="WORD,WORD",
        help=f"what of the blade is free, of {', '.join(FREE)}; default chord,twist",
    )
    command.add_argument(
        "--minimise",
        choices=OBJECTIVES,
        default="dba",
        help="; ".join(f"{word}: {RESPONSES[word].meaning}" for word in OBJECTIVES)
        + ". Levels are of the mean square over observers and operating points; default dba",
    )
    command.add_argument(
        "--control-points",
        type=int,
        default=5,
        metavar="N",
        help="control points of each free distribution, evenly from root to tip, default 5",
    )
    limits = command.add_argument_group(
        "limits",
        f"A number, or the word {BASELINE} for what the described blade has there.",
    )
    for word, response in RESPONSES.items():
        unit = f" [{response.allowed.unit}]" if response.allowed.unit else ""
        limits.add_argument(
            f"--{word}-max",
            dest=_limit(word),
            type=_number_or_baseline,
            metavar="LIMIT",
            help=f"most {response.meaning}{unit}",
        )
    limits.add_argument(
        f"--{_THICKNESS}-min",
        dest=_limit(_THICKNESS),
        type=number,
        metavar="M",
        help="least thickness of the sections [m], or what the described blade has where that is"
        " less",
    )
    for word, free in FREE.items():
        low, high = free.default
        limits.add_argument(
            f"--{word}",
            dest=_range(word),
            type=_low_high,
            metavar="LOW:HIGH",
            help=f"range of a free {word}, {free.meaning}{_unit(free)}; default {low:g}:{high:g}",
        )
    add_asked(command, ASKED_OPTIONS)
    add_observers(command)


def add_search_options(command: argparse.ArgumentParser) -> None:
    """Add the options of how is searched, and of what is written.

    Parameters
    ----------
    command : argparse parser
        What they are added to.
    """
    group = command.add_argument_group("search and results")
    group.add_argument(
        "--iterations",
        type=int,
        default=100,
        metavar="N",
        help="most iterations of the search by derivatives (SLSQP), default 100",
    )
    group.add_argument(
        "--de",
        action="store_true",
        help="differential evolution first, which needs no good start, then derivatives",
    )
    group.add_argument(
        "--generations", type=int, metavar="N", help="generations of --de, default 25"
    )
    group.add_argument(
        "--population", type=int, metavar="N", help="designs in a generation of --de, default 40"
    )
    group.add_argument("--workers", type=int, metavar="N", help="processes of --de, default 1")
    group.add_argument(
        "--seed", type=int, metavar="N", help="of --de, default 1; same seed, same search"
    )
    group.add_argument(
        "--name",
        dest="new_name",
        metavar="NAME",
        help="of the new propeller, default the old one's with _quiet",
    )
    group.add_argument(
        "--results",
        type=Path,
        required=True,
        metavar="FOLDER",
        help="the new propeller as NAME.toml, history.csv, figures, sounds and record.json. A"
        " folder with an unfinished search of the same inputs is gone on with",
    )


def points_of(options: argparse.Namespace) -> list[OperatingPoint]:
    """Operating points of the design.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed.

    Returns
    -------
    list of OperatingPoint
        That of --thrust, and those of --also-at.

    Raises
    ------
    ValueError
        If there is no thrust, a point has too few values or too many, or one is out of range.
    """
    from propmdao.records.air import Air
    from propmdao.records.states import OperatingPoint

    if options.thrust is None:
        raise ValueError("--thrust is required: a design is for a thrust")
    for values in options.also_at:
        if len(values) not in (2, 3):
            raise ValueError(
                "--also-at takes THRUST, SPEED and perhaps INCIDENCE, as in --also-at 2 10 70; it"
                f" has {len(values)} {'value' if len(values) == 1 else 'values'}"
            )
    conditions = [(options.thrust, options.speed, options.incidence_deg), *options.also_at]
    air = Air(density=options.density)
    names = "thrust", "speed", "incidence_deg"
    return [
        OperatingPoint(air=air, **dict(zip(names, values, strict=False))) for values in conditions
    ]


def free_of(options: argparse.Namespace) -> dict[str, tuple[float, float]]:
    """What is free, with its ranges.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed.

    Returns
    -------
    dict of str to (float, float)
        Ranges by word; words that there are not as they were typed.

    Raises
    ------
    ValueError
        If a range is given of what is not free.
    """
    ranges = {}
    for word in options.free:
        typed = getattr(options, _range(word), None)
        ranges[word] = typed or (FREE[word].default if word in FREE else (0.0, 0.0))
    for word in FREE:
        if getattr(options, _range(word)) is not None and word not in ranges:
            raise ValueError(f"--{word} is the range of a free {word}: add it to --free")
    return ranges


def limits_of(options: argparse.Namespace) -> dict[str, float | str]:
    """Limits as `propmdao.components.design_problem` takes them.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed.

    Returns
    -------
    dict of str to float or str
        Limits by word.
    """
    typed = {word: getattr(options, _limit(word)) for word in (*RESPONSES, _THICKNESS)}
    return {word: limit for word, limit in typed.items() if limit is not None}


def _limit(word: str) -> str:
    return f"limit_{word.replace('-', '_')}"


def _range(word: str) -> str:
    return f"range_{word}"


def _unit(free: Free) -> str:
    return f" [{free.unit}]" if free.unit else ""


def _words(text: str) -> list[str]:
    return list(dict.fromkeys(word.strip() for word in text.split(",") if word.strip()))


def _number_or_baseline(text: str) -> float | str:
    return text if text == BASELINE else number(text)


def _low_high(text: str) -> tuple[float, float]:
    parts = text.split(":")
    if len(parts) != 2:
        raise argparse.ArgumentTypeError(f"{text!r} is not a range LOW:HIGH")
    low, high = map(number, parts)
    if not low < high:
        raise argparse.ArgumentTypeError(f"{text!r}: LOW must be below HIGH")
    return low, high


def search_of(options: argparse.Namespace) -> dict[str, Any]:
    """How is searched, with defaults filled in.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed.

    Returns
    -------
    dict
        ``method`` "slsqp" with iterations, or "evolution" with generations, population, seed and
        workers.

    Raises
    ------
    ValueError
        If a number is out of range, or an option of evolution is given without it.
    """
    defaults = {"generations": 25, "population": 40, "seed": 1, "workers": 1}
    lowest = {"generations": 0, "population": 5, "seed": 0, "workers": 1, "iterations": 1}
    typed = {name: getattr(options, name) for name in defaults}
    if not options.de:
        of_evolution = next((name for name, value in typed.items() if value is not None), None)
        if of_evolution is not None:
            raise ValueError(f"--{of_evolution} is of differential evolution: add --de")
        search = {"method": "slsqp", "iterations": options.iterations}
    else:
        filled = {k: defaults[k] if value is None else value for k, value in typed.items()}
        search = {"method": "evolution", **filled}
    for name, low in lowest.items():
        if name in search and search[name] < low:
            raise ValueError(f"--{name} must be at least {low}; it is {search[name]}")
    return search
