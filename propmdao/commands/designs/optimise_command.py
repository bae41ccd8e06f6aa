"""Command line: ``propmdao optimise``."""

from __future__ import annotations

import argparse
import functools
import json
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.designs.design_options import (
    ASKED_OPTIONS,
    add_design_options,
    add_search_options,
    free_of,
    limits_of,
    points_of,
    search_of,
)
from propmdao.commands.observer_options import listening_of
from propmdao.commands.options import add_command
from propmdao.commands.output.output_files import require_matplotlib, require_output_folder
from propmdao.commands.output.progress import progress
from propmdao.commands.output.report_file import add_report, require_report
from propmdao.commands.output.results_folder import RECORD, write_record
from propmdao.commands.output.warning_lines import warning_lines
from propmdao.propeller.design_choices import RESPONSES
from propmdao.runtime.output_files import make_folder

if TYPE_CHECKING:
    from propmdao.propeller.description import Propeller
    from propmdao.records.states import OperatingPoint

DESCRIPTION = """\
A better blade at the same thrust: quieter, or with less torque or power.

The rotation speed follows from the thrust in every design. What is free are changes of the
described chord, twist, camber, thickness or sweep, at control points over the span with smooth
curves between them, within ranges; the described blade is the start. The search goes by exact
derivatives (SLSQP) and finds the optimum near the start in some ten to fifty analyses; with --de
differential evolution looks everywhere within the ranges first.

The same problem in a script: propmdao.components.design_problem.
"""

EXAMPLES = """\
examples:
  propmdao optimise apcsf_11x4.7 --thrust 2 --arc 1.9 -60 -30 --torque-max baseline --results quiet
  propmdao optimise my_blade.toml --thrust 6 --arc 2 -75:-15:15 --free chord,twist,camber \\
      --minimise dba --torque-max baseline --thickness-min 0.001 --results quiet
  propmdao optimise my_blade.toml --thrust 6 --also-at 2 12 --minimise power --free twist,chord \\
      --tip-mach-max 0.4 --chord 0.8:1.3 --results efficient
  propmdao optimise apcmr_8x4.5 --thrust 2.9 --speed 10 --incidence 70 --also-at 2.5 0 \
      --arc 1.9 -60 -30 --results drone
  propmdao optimise apcsf_11x4.7 --thrust 2 --arc 1.9 -75:-15:15 --results quiet --report quiet.html

Exit status: 0, or 2 with one line on stderr, also when no design meets the limits.
"""


def add_optimise(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "optimise",
        _optimise,
        "a quieter or more efficient blade at the same thrust",
        DESCRIPTION,
        EXAMPLES,
    )
    add_design_options(command)
    add_search_options(command)
    add_report(
        command,
        "both blades beside each other, players for the sounds, the search, inputs and versions",
    )


def _optimise(options: argparse.Namespace) -> None:
    search = search_of(options)
    free, limits = free_of(options), limits_of(options)
    observers = listening_of(options).observers
    points = points_of(options)
    folder: Path = options.results
    require_output_folder("--results", folder)
    require_matplotlib("--results")
    require_report(options)
    # OpenMDAO and JAX take seconds to import, and OpenMDAO warns of itself.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from openmdao.api import OMDeprecationWarning

        from propmdao.components.designs.problem_in_words import design_problem, require_words
    from propmdao.formats.propellers import load_propeller

    n_control, n_heard = options.control_points, len(observers)
    require_words(points, free, options.minimise, limits, n_control, n_heard)
    _require_broadband(options, (options.minimise, *limits))
    with warning_lines("optimise"):
        propeller = load_propeller(options.propeller)
    new_name = options.new_name or f"{propeller.name}_quiet"
    if new_name == propeller.name:
        raise ValueError(f"--name {new_name} is that of the described propeller: give another one")
    words: dict[str, Any] = {
        "free": free,
        "minimise": options.minimise,
        "limits": limits,
        "n_control": n_control,
        **{name: getattr(options, name) for name in ASKED_OPTIONS},
    }
    inputs = _inputs(points, observers.tolist(), words, search)
    _require_same(folder, inputs, propeller)
    factory = functools.partial(design_problem, propeller, points, observers, **words)
    progress(f"analysing {propeller.name}")
    with warning_lines("optimise"):
        warnings.filterwarnings("ignore", category=OMDeprecationWarning)
        prob = factory()
    make_folder(folder)
    described = {"described": propeller}
    write_record(folder, options, described, search=inputs)
    from propmdao.commands.designs.design_results import write_results
    from propmdao.commands.designs.design_search import run_search
    from propmdao.components.designs.problem_in_words import designed_blade
    from propmdao.runtime.locks import locked

    with locked(folder / RECORD):
        history = run_search(prob, folder, search, options.minimise, factory)
        designed = designed_blade(prob, new_name)
        results = write_results(folder, options, (propeller, designed), points, history)
        write_record(folder, options, described | {"designed": designed}, search=inputs, **results)


def _require_broadband(options: argparse.Namespace, words: tuple[str, ...]) -> None:
    """Refuse a model of broadband noise where the search hears none."""
    from propmdao.records.quantities import ASKED

    broadband = [word for word, response in RESPONSES.items() if response.has_broadband]
    for name in ("trip", "layers"):
        value = getattr(options, name)
        if value != ASKED[name].default and not set(words).intersection(broadband):
            raise ValueError(
                f"--{name} {value} is about broadband noise: minimise or limit"
                f" {' or '.join(broadband)}"
            )


def _inputs(
    points: list[OperatingPoint],
    observers: list[list[float]],
    words: dict[str, Any],
    search: dict[str, Any],
) -> dict[str, Any]:
    """What determines a search, as JSON gives it back."""
    from propmdao.records.plain import to_plain

    inputs = {
        "points": [to_plain(point) for point in points],
        "observers": observers,
        **words,
        # How long and by how many is no part of what is looked for.
        "how": {k: v for k, v in search.items() if k not in ("iterations", "workers")},
    }
    return dict(json.loads(json.dumps(inputs)))


def _require_same(folder: Path, inputs: dict[str, Any], propeller: Propeller) -> None:
    """Refuse a folder that holds another search."""
    path = folder / RECORD
    if not path.exists():
        return
    from propmdao.propeller.identity import checksum

    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        there = dict(record["search"], propeller=record["propellers"]["described"]["checksum"])
    except (ValueError, LookupError, TypeError, OSError):
        raise ValueError(
            f"--results {folder}: its {RECORD} is of no search; name another folder"
        ) from None
    here = {**inputs, "propeller": checksum(propeller)}
    for name, value in here.items():
        if there.get(name) != value:
            raise ValueError(
                f"--results {folder} holds another search: {name} is {there.get(name)} there and"
                f" {value} here; name another folder"
            )
