"""Command line: ``propmdao bench``."""

from __future__ import annotations

import argparse
import importlib.util
import sys
from pathlib import Path
from typing import Any

from propmdao.commands.options import add_asked, add_command, add_propeller, asked_of, number
from propmdao.commands.output.output_files import require_output
from propmdao.commands.output.warning_lines import warning_lines
from propmdao.records.units import Range
from propmdao.runtime.terminal import print_line

DESCRIPTION = """\
A page in the browser on which a blade is bent by sliders and heard while it is.

Sliders change chord, blade angle, camber, thickness and sweep at five radii, diameter, number of
blades, rotation speed or thrust, flight speed and the place of the microphone. Thrust, power,
tones and broadband noise of the bent blade stand beside those of the described one at the same
operating point, and follow while a slider is dragged. Both can be heard, changes can be undone,
and the blade is saved as a propeller file. The page is served to this machine alone, until Ctrl-C.
Needs Starlette, Uvicorn and websockets: pip install 'propmdao[bench]'.
"""
EXAMPLES = """\
examples:
  propmdao bench apcsf_11x4.7
  propmdao bench my_blade.toml --thrust 3 --speed 8 --listen-at 2 -30 --save quieter.toml

Exit status: 0, or 2 with one line on stderr.
"""
ASKED_OPTIONS = ("rpm", "thrust", "speed", "density")
#: Tip Mach number at which a blade is shown where neither rotation speed nor thrust is asked for.
_TIP_MACH = 0.2
_DIAMETERS = 5.0  # from which it is heard where nothing else is asked for
_ELEVATION = Range(-90.0, 90.0, "deg")
_PORT = Range(0, 65535)
_LIBRARIES = ("starlette", "uvicorn", "websockets")


def add_bench(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "bench",
        _bench,
        "a page in the browser: bend a blade by sliders, and hear it",
        DESCRIPTION,
        EXAMPLES,
    )
    add_propeller(command)
    add_asked(command, ASKED_OPTIONS, required=False)
    command.add_argument(
        "--listen-at",
        nargs=2,
        type=number,
        metavar=("RADIUS", "ELEVATION"),
        help="microphone: distance from the rotor's centre [m] and elevation, negative below the"
        " rotor [deg]; default five diameters, -45",
    )
    command.add_argument(
        "--save", type=Path, metavar="FILE.toml", help="propeller file that the page saves in"
    )
    command.add_argument(
        "--port", type=int, default=0, metavar="N", help="port of the page; default any free one"
    )
    command.add_argument(
        "--no-browser", action="store_true", help="print the address, and open no browser"
    )


def _bench(options: argparse.Namespace) -> None:
    from propmdao.records.listening import DISTANCE  # imports NumPy, which help does without

    _PORT.require("--port", options.port)
    if options.save is not None:
        require_output("--save", options.save, ".toml")
    if options.listen_at is not None:
        DISTANCE.require("radius of --listen-at", options.listen_at[0])
        _ELEVATION.require("elevation of --listen-at", options.listen_at[1])
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.acoustics.kinematics.observers import point
    from propmdao.analysis.request import Request
    from propmdao.formats.propellers import load_propeller
    from propmdao.records.units import RAD_PER_S

    asked = asked_of(options)
    propeller = load_propeller(options.propeller)
    radius = 0.5 * propeller.diameter
    if asked["rpm"] is None and asked["thrust"] is None:
        sound_speed = Request.of(rpm=0.0).point.air.sound_speed
        asked["rpm"] = float(f"{_TIP_MACH * sound_speed / radius / RAD_PER_S:.2g}")
    if asked["rpm"] == 0.0:
        raise ValueError("--rpm 0: the rotor of a bench turns")
    microphone = options.listen_at or (float(f"{2 * _DIAMETERS * radius:.2g}"), -45.0)
    request = Request.of(broadband=True, observers=point(*microphone), **asked).completed(propeller)
    if not all(map(importlib.util.find_spec, _LIBRARIES)):
        raise ValueError(
            "bench needs Starlette, Uvicorn and websockets: pip install 'propmdao[bench]'"
        )
    from propmdao.commands.designs.bench.server import address, bound_socket, new_key, serve
    from propmdao.commands.designs.bench.workbench import Workbench

    opened, key = bound_socket(options.port), new_key()
    with opened:
        with warning_lines("bench"):
            bench = Workbench(propeller, request, microphone, options.save)
        print_line(f"{propeller.name}: {address(opened, key)} (Ctrl-C ends it)")
        sys.stdout.flush()
        serve(bench, opened, key, not options.no_browser)
