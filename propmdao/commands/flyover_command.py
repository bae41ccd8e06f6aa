"""Command line: ``propmdao flyover``."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.observer_options import add_absorption, air_of
from propmdao.commands.options import (
    TURBULENCE_OPTIONS,
    add_asked,
    add_command,
    add_propeller,
    asked_of,
    number,
)
from propmdao.commands.output.json_output import print_json
from propmdao.commands.output.output_files import (
    require_matplotlib,
    require_output,
    require_output_folder,
    save_figures,
    write_csv,
)
from propmdao.commands.output.report_file import (
    add_report,
    origin_of,
    require_report,
    write_report,
)
from propmdao.commands.output.warning_lines import warning_lines

if TYPE_CHECKING:
    from propmdao.analysis.flights.flyover_results import Flyover

DESCRIPTION = """\
What a microphone on the ground hears of a propeller in level flight: loudest A-weighted level, SEL
and EPNL, level against time, sound. Its axis is along the path, or at an --incidence to it: a drone
that leans forward by 20 deg flies at 70.

Tones come as a pressure record with its Doppler shift, broadband self-noise in third octaves that
shift with it; hard ground reflects, air absorbs on the way. Steps are half seconds.
"""

EXAMPLES = """\
examples:
  propmdao flyover apcsf_11x4.7 --thrust 1.2 --speed 8 --height 20
  propmdao flyover apcsf_11x4.7 --rpm 4200 --speed 8 --height 20 --sideline 30 --trip heavy
  propmdao flyover apcsf_11x4.7 --rpm 4200 --speed 8 --height 50 --microphone 1.2 --wav over.wav
  propmdao flyover apcsf_11x4.7 --rpm 4200 --speed 8 --height 50 --report over.html
  propmdao flyover apcmr_8x4.5 --rpm 6000 --speed 10 --incidence 70 --height 20

Levels: dBA re 20 uPa; SEL re (20 uPa)^2 s; EPNL in EPNdB. Exit status: 0, or 2 with one line on
stderr.
"""


def add_flyover(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "flyover",
        _flyover,
        "level against time, SEL and EPNL on the ground",
        DESCRIPTION,
        EXAMPLES,
    )
    add_propeller(command)
    names = ("rpm", "thrust", "speed", "incidence_deg", "density", "twist_offset_deg", "viscous")
    add_asked(command, names)
    command.add_argument(
        "--height", type=number, required=True, metavar="M", help="of the propeller over ground [m]"
    )
    command.add_argument(
        "--sideline",
        type=number,
        default=0.0,
        metavar="M",
        help="distance of the microphone from the track [m], default 0; positive on the left",
    )
    command.add_argument(
        "--microphone",
        type=number,
        default=0.0,
        metavar="M",
        help="its height above the ground [m], default 0: flush with it; 1.2 in certification",
    )
    command.add_argument(
        "--duration",
        type=number,
        metavar="S",
        help="of what is heard [s]; default until six times the shortest distance, 20 s at least",
    )
    noise = ("trip", "layers", *TURBULENCE_OPTIONS)
    add_asked(command, ("n_crit", "trip_upper", "trip_lower", *noise))
    add_absorption(command)
    command.add_argument(
        "--no-absorption", action="store_true", help="without absorption, which is on by default"
    )
    command.add_argument("--json", action="store_true", help="print JSON instead of tables")
    command.add_argument(
        "--out", type=Path, metavar="FILE.csv", help="levels, distance and elevation of each step"
    )
    command.add_argument(
        "--figures", type=Path, metavar="FOLDER", help="level against time, as PNG"
    )
    add_report(command, "levels over time, a player for the sound, figures, inputs and versions")
    command.add_argument("--wav", type=Path, metavar="FILE.wav", help="what the microphone hears")
    command.add_argument(
        "--full-scale",
        type=number,
        metavar="PA",
        help="pressure of its largest number [Pa]; default the highest peak, rounded up",
    )


def _flyover(options: argparse.Namespace) -> None:
    if options.no_absorption and options.absorption is not None:
        raise ValueError("--no-absorption and --absorption do not go along")
    if options.full_scale is not None and options.wav is None:
        raise ValueError("--full-scale is of a sound file: add --wav FILE.wav")
    for option, path, ending in (("--out", options.out, ".csv"), ("--wav", options.wav, ".wav")):
        if path is not None:
            require_output(option, path, ending)
    if options.figures is not None:
        require_output_folder("--figures", options.figures)
    if not options.speed > 0.0:
        raise ValueError(f"--speed of a flyover must be positive [m/s]; it is {options.speed:g}")
    air = air_of(options)
    asked = asked_of(options) | air | {"broadband": True}
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.analysis.flights.flyover_results import Flight
    from propmdao.analysis.request import Request
    from propmdao.analysis.sounds import require_sound
    from propmdao.formats.propellers import load_propeller

    flight = Flight(
        options.height,
        options.sideline,
        options.microphone,
        options.duration,
        not options.no_absorption,
    )
    duration = flight.heard_for(options.speed)
    if options.wav is not None or options.report is not None:
        require_sound(1, duration, options.full_scale)
    Request.of(**asked)
    if options.figures is not None:
        require_matplotlib("--figures")
    require_report(options)
    from propmdao.analysis.flights.flyovers import fly_over
    from propmdao.analysis.single_point import analyze

    with warning_lines("flyover") as warned:
        propeller = load_propeller(options.propeller)
        analysis = analyze(propeller, **asked)
    is_heard = options.wav is not None or options.report is not None
    flyover = fly_over(analysis, flight, sound=is_heard)
    result = analysis.to_dict()
    for key in ("observers", "listening"):  # who listens is in the flight
        del result[key]
    result |= {"flight": dataclasses.asdict(flight)} | flyover.to_dict()
    nearest = flight.miss_distance / float(analysis.state.air.sound_speed)
    result |= _write(options, flyover, nearest)
    if options.report is not None:
        from propmdao.figures.pages.flyover_page import flyover_page

        origin = origin_of(options, warned)
        page = flyover_page(analysis, flight, flyover, result, origin)
        result["report"] = write_report(options, page)
    if options.json:
        print_json(result)
    else:
        from propmdao.commands import report

        report.print_flyover(result)


def _write(options: argparse.Namespace, flyover: Flyover, nearest: float) -> dict[str, Any]:
    """Write the files asked for; what was written."""
    written: dict[str, Any] = {}
    if options.out is not None:
        rows = flyover.to_dict()["history"]
        write_csv(options.out, rows[0], ([f"{row[key]:.4f}" for key in rows[0]] for row in rows))
    if options.wav is not None and flyover.pressure is not None:
        from propmdao.acoustics.sounds.recordings import common_full_scale
        from propmdao.formats.wav import write_wav

        full_scale = options.full_scale
        if full_scale is None:
            full_scale = common_full_scale(flyover.pressure)
        sound = write_wav(options.wav, flyover.pressure, full_scale)
        written["sound"] = sound._asdict() | {"path": str(sound.path)}
    if options.figures is not None:
        from propmdao.analysis.flights.flyover_results import STEP
        from propmdao.figures.histories import level_history

        label = f"A-weighted level of {STEP:g} s, dB re 20 µPa"
        levels = {part: flyover.level_dba(part) for part in flyover.mean_square}
        moments = {"heard from the nearest point": nearest}
        figure = level_history(flyover.time, levels, label, moments)
        written["figures"] = save_figures(options.figures, {"levels": figure})
    return written
