"""Command line: ``propmdao analyze``."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.observer_options import (
    add_observers,
    add_surroundings,
    air_of,
    listening_of,
)
from propmdao.commands.options import (
    TURBULENCE_OPTIONS,
    add_asked,
    add_command,
    add_propeller,
    asked_of,
    number,
)
from propmdao.commands.output import report_file
from propmdao.commands.output.drives import add_drive, add_drive_results, motor_of
from propmdao.commands.output.json_output import print_json
from propmdao.commands.output.output_files import (
    require_matplotlib,
    require_output,
    require_output_folder,
    save_figures,
)
from propmdao.commands.output.progress import progress_line
from propmdao.commands.output.warning_lines import warning_lines
from propmdao.formats.endings import POLAR_READERS, described
from propmdao.records.quantities import ASKED

if TYPE_CHECKING:
    from propmdao.aerodynamics.sections.polars.family import SectionPolars
    from propmdao.aerodynamics.sections.polars.table import PolarTable
    from propmdao.analysis.results import Analysis

DESCRIPTION = """\
Thrust, torque and noise of a propeller in hover (speed 0), axial flight or at an incidence.

Steady vortex lattice held to the polars of the blade's sections, with a wake carried by the flow it
induces, then tones by Farassat's Formulation 1A: thickness and loading noise of the full blade
surface, heard by observers that fly along. At an --incidence the loads change around the turn: the
lattice is solved for all azimuths together, in a wake that is carried off sideways. With --unsteady
it is marched in time, in that wake or in a free one.
With --broadband also the self-noise of the blades (Brooks, Pope and Marcolini). Ground may reflect
the sound, and air absorb it.

The polars that ship are of E63, Clark-Y, their blends and NACA 4-digit sections at n_crit 3 to 9,
and tripped at 0.05 c on both sides at n_crit 5; others are given with --polar, or made where
NeuralFoil is installed, once on a machine.
"""

EXAMPLES = """\
examples:
  propmdao analyze apcsf_11x4.7 --rpm 4200 --speed 8
  propmdao analyze apcsf_11x4.7 --rpm 6000 --speed 10 --incidence 70 --arc 1.905 -60 --json
  propmdao analyze apcsf_11x4.7 --rpm 6000 --speed 10 --incidence 70 --figures results --vtk results
  propmdao analyze apcsf_11x4.7 --rpm 6000 --speed 10 --incidence 70 --unsteady --wake free
  propmdao analyze apcsf_11x4.7 --thrust 1.5 --speed 8 --arc 1.905 -45 --broadband --wav cruise.wav
  propmdao analyze my_blade.toml --rpm 3000:5000:500 --arc 1.905 -45 0 45 --json
  propmdao analyze apcsf_11x4.7 --thrust 3 --motor axi_2204_54 --battery-wh 12
  propmdao analyze apcsf_11x4.7 --rpm 4200 --arc 1.905 -90:90:15 --broadband --report hover.html
  propmdao analyze apcsf_11x4.7 --rpm 4200 --ground 10 --grid 0:40:5 0 -10 --absorption
  propmdao analyze apcsf_11x4.7 --rpm 4200 --speed 8 --level --hemisphere 20 10 --figures results
  propmdao analyze apcsf_11x4.7 --rpm 4200 --trip-upper 0.05 --trip-lower 0.05
  propmdao analyze my_blade.toml --rpm 6000 --elastic --youngs-modulus 11e9 --material-density 1700
  propmdao analyze my_blade.toml --rpm 4200 --polar sg6042 sg6042_re50k.txt sg6042_re100k.txt

CT = T/(rho n^2 D^4), CQ = Q/(rho n^2 D^5), CP = 2 pi CQ, J = V/(n D), eta = J CT/CP, n in rev/s.
Levels are in dB re 20 uPa, rms. SI units throughout. Exit status: 0, or 2 with one line on stderr.
"""


#: What may be asked of the flow: of a rotor as it is described, which sweeps change.
ASKED_OPTIONS = tuple(
    name
    for name, quantity in ASKED.items()
    if quantity.option
    and not quantity.record.startswith("model.noise")
    and name not in ("chord_factor", "diameter", "n_blades", *TURBULENCE_OPTIONS)
)


def add_analyze(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "analyze",
        _analyze,
        "thrust, torque and noise at given rpm or thrust",
        DESCRIPTION,
        EXAMPLES,
    )
    add_propeller(command)
    add_asked(command, ASKED_OPTIONS, several_rpm=True)
    command.add_argument(
        "--polar",
        action="append",
        nargs="+",
        default=[],
        metavar=("AIRFOIL", "FILE"),
        help="polars of an airfoil of the propeller, in files with the endings"
        f" {described(POLAR_READERS)}; may be repeated for other airfoils",
    )
    add_asked(command, ("broadband", "trip", "layers", *TURBULENCE_OPTIONS))
    command.add_argument(
        "--band",
        action="store_true",
        help="what inputs that are not known for sure do to thrust or rpm, power and the tone at"
        " blade passage: blade angle +-1 deg, chord +-3 %%, n_crit 3 to 9, section drag +-17 %%;"
        " eight solutions more",
    )
    command.add_argument("--json", action="store_true", help="print JSON instead of tables")
    add_drive(command)
    add_observers(command)
    add_surroundings(command)
    tables = command.add_argument_group("tables", "CSV files with units in their heads.")
    tables.add_argument(
        "--out",
        type=Path,
        metavar="FILE.csv",
        help="operating points and levels, a row for each observer of each point",
    )
    tables.add_argument(
        "--spectra",
        type=Path,
        metavar="FILE.csv",
        help="tones, bins of 5 Hz and third octaves at every observer, in dB and in dBA",
    )
    group = command.add_argument_group("sound and figures", "Of one operating point.")
    group.add_argument(
        "--wav",
        type=Path,
        metavar="FILE.wav",
        help="sound of the observers, a channel for each, 64 at most, to be repeated without a"
        " click",
    )
    group.add_argument(
        "--seconds", type=number, default=5.0, metavar="S", help="its length [s], default 5"
    )
    group.add_argument(
        "--full-scale",
        type=number,
        metavar="PA",
        help="pressure of its largest number [Pa]: give two blades the same one to compare them by"
        " ear; default the highest peak, rounded up",
    )
    group.add_argument(
        "--figures",
        type=Path,
        metavar="FOLDER",
        help="blade, loads over span and polars; where there are observers spectrum, third octaves"
        " and pressure at that of the loudest tones, directivity of an arc, map of a hemisphere; at"
        " an incidence the loads over the disk and with --unsteady the wake; as PNG",
    )
    group.add_argument(
        "--figure-at",
        type=int,
        metavar="N",
        help="spectrum, third octaves and pressure at the N-th observer, counted from 1",
    )
    group.add_argument(
        "--figure-dba",
        action="store_true",
        help="directivity and map of a hemisphere A-weighted",
    )
    report_file.add_report(
        group, "numbers, players for the sounds, figures to turn and zoom, inputs and versions"
    )
    group.add_argument(
        "--vtk",
        type=Path,
        metavar="FOLDER",
        help="blades with pressure difference and forces of their panels, and wake with its"
        " circulation, as files of VTK for ParaView; at an incidence at every azimuth, with"
        " --unsteady at the end",
    )


def _analyze(options: argparse.Namespace) -> None:
    _check(options)
    motor = motor_of(options)
    listening = listening_of(options, options.incidence_deg)
    _check_observers(options, len(listening.observers))
    asked = asked_of(options) | air_of(options)
    points = [asked | {"rpm": rpm} for rpm in _rpm_values(options.rpm)]
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.analysis.request import Request

    requests = [Request.of({"listening": listening}, **point) for point in points]
    transition = requests[0].model.loads.transition
    from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
    from propmdao.aerodynamics.sections.polars.sources import polar_sources
    from propmdao.analysis.sweeping.batches import analyze_each
    from propmdao.formats.propellers import load_propeller

    with warning_lines("analyze"):
        propeller = load_propeller(options.propeller)
    own = _own_polars(options.polar)
    names = [name for _, name in propeller.airfoils]
    for airfoil in own:
        if not any(_key(name, [airfoil]) for name in names):
            raise ValueError(
                f"--polar {airfoil}: {propeller.name} has no such airfoil; it has"
                f" {', '.join(dict.fromkeys(names))}"
            )
    with warning_lines("analyze") as warned:
        drag = options.measured_drag
        polars = polars_for(propeller, own, transition, drag) if options.viscous else None
        shown: dict[str, Any] = {"progress": progress_line()} if options.unsteady else {}
        outcomes = analyze_each(propeller, requests, polars=polars, **shown)
        analyses = [outcome.said() for outcome in outcomes]
    if polars is not None:
        files = {airfoil: ", ".join(names) for airfoil, *names in options.polar}
        sources = polar_sources(propeller, own, transition, drag)
        sources |= {name: files[key] for name in sources if (key := _key(name, files))}
        analyses = [dataclasses.replace(analysis, polars=sources) for analysis in analyses]
    results = [analysis.to_dict() for analysis in analyses]
    add_drive_results(results, motor, options)
    if options.band:
        from propmdao.analysis.uncertainty import band

        for result, analysis in zip(results, analyses, strict=True):
            result["band"] = None  # what has not converged has none, and says why
            if result["converged"]:
                result["band"] = band(analysis, polars=polars if own else None).to_dict()
    results[0] |= _write(options, analyses[0], polars)
    if options.report is not None:
        from propmdao.figures.pages.analysis_page import analysis_page

        origin = report_file.origin_of(options, warned)
        page = analysis_page(analyses[0], results[0], origin, options.seconds)
        results[0]["report"] = report_file.write_report(options, page)
    _write_tables(options, results)
    if options.figures is not None:
        from propmdao.commands.output.results_folder import write_record

        write_record(options.figures, options, {propeller.name: propeller}, results=results)
    if options.json:
        print_json(results if _is_list(options.rpm) else results[0])
    else:
        from propmdao.commands import report

        report.print_analyses(results)


def _key(airfoil: str, keys: Iterable[str]) -> str | None:
    """Key of what is given for an airfoil: its name, or its file's without folder and ending."""
    return next((key for key in keys if key in (airfoil, Path(airfoil).stem)), None)


def _check(options: argparse.Namespace) -> None:
    """Refuse options that do not go together, before the work."""
    of_sections = options.stall_delay and options.measured_drag and not options.polar
    if not options.viscous and not of_sections:
        raise ValueError(
            "--inviscid has no sections: --polar, --no-stall-delay and --computed-drag do not go"
            " along"
        )
    placed = [*options.arc, *options.point, *options.circle, *options.hemisphere, *options.grid]
    for option, value in (
        ("--wav", options.wav),
        ("--figures", options.figures),
        ("--report", options.report),
        ("--vtk", options.vtk),
    ):
        if value is not None and _is_list(options.rpm):
            raise ValueError(f"{option} is of one operating point: give one --rpm")
    if options.blade_element and options.vtk is not None:
        raise ValueError("--vtk draws the lattice and its wake, which --blade-element has not")
    for option, value in (("--wav", options.wav), ("--spectra", options.spectra)):
        if value is not None and not placed:
            raise ValueError(f"{option} needs observers, as with --arc 1.905 -45")
    if options.full_scale is not None and options.wav is None:
        raise ValueError("--full-scale is of a sound file: add --wav FILE.wav")
    if options.figures is None and (options.figure_at is not None or options.figure_dba):
        raise ValueError("--figure-at and --figure-dba are of figures: add --figures FOLDER")
    for option, path, ending in (
        ("--wav", options.wav, ".wav"),
        ("--out", options.out, ".csv"),
        ("--spectra", options.spectra, ".csv"),
    ):
        if path is not None:
            require_output(option, path, ending)
    for option, folder in (("--figures", options.figures), ("--vtk", options.vtk)):
        if folder is not None:
            require_output_folder(option, folder)


def _check_observers(options: argparse.Namespace, n_observers: int) -> None:
    """Refuse more observers than a sound file holds and a figure of none, before the work."""
    if options.figure_at is not None and not 1 <= options.figure_at <= n_observers:
        raise ValueError(
            f"--figure-at must be within 1 ... {n_observers}, the observers in the order of the"
            f" table; it is {options.figure_at}"
        )
    from propmdao.analysis.sounds import require_sound

    if options.wav is not None:
        require_sound(n_observers, options.seconds, options.full_scale)
    if options.report is not None and n_observers:
        require_sound(1, options.seconds)
    if options.figures is not None:
        require_matplotlib("--figures")
    report_file.require_report(options)


def _write_tables(options: argparse.Namespace, results: list[dict[str, Any]]) -> None:
    """Write levels and spectra, and tell of them in the first result."""
    from propmdao.commands.output.level_files import write_levels, write_spectra

    tables = (("out", write_levels), ("spectra", write_spectra))
    written = {name: write for name, write in tables if getattr(options, name) is not None}
    for name, write in written.items():
        write(getattr(options, name), results)
    if written:
        results[0]["tables"] = [str(getattr(options, name)) for name in written]


def _write(
    options: argparse.Namespace, analysis: Analysis, polars: SectionPolars | None
) -> dict[str, Any]:
    """Write sound, figures and files for ParaView; what was written."""
    written: dict[str, Any] = {}
    if options.wav is not None:
        from propmdao.analysis.sounds import write_sound

        sound = write_sound(options.wav, analysis, options.seconds, options.full_scale)
        written["sound"] = sound._asdict() | {"path": str(sound.path)}
    if options.figures is not None:
        from propmdao.figures.of_analysis import analysis_figures
        from propmdao.figures.rotor.of_rotor import rotor_figures

        figures = rotor_figures(analysis, polars)
        if len(analysis.listening.observers) or options.incidence_deg or options.unsteady:
            observer = None if options.figure_at is None else options.figure_at - 1
            figures |= analysis_figures(analysis, observer, options.figure_dba)
        written["figures"] = save_figures(options.figures, figures)
    if options.vtk is not None:
        from propmdao.figures.flow.scenes import write_scenes

        written["vtk"] = write_scenes(options.vtk, analysis)
    return written


def _own_polars(options: Sequence[Sequence[str]]) -> dict[str, PolarTable]:
    """Tables of the files of every ``--polar``, by airfoil."""
    from propmdao.formats.polars import load_polars

    tables = {}
    for airfoil, *files in options:
        if not files:
            raise ValueError(f"--polar {airfoil} has no file")
        if airfoil in tables:
            raise ValueError(f"--polar {airfoil} is given twice: name all of its files at once")
        tables[airfoil] = load_polars(*files)
    return tables


def _rpm_values(values: list[float | list[float]] | None) -> list[float | None]:
    """All rpm in the order values; one None where thrust is given instead."""
    listed = [item if isinstance(item, list) else [item] for item in values or ()]
    return [rpm for item in listed for rpm in item] or [None]


def _is_list(values: list[float | list[float]] | None) -> bool:
    return values is not None and (len(values) > 1 or isinstance(values[0], list))
