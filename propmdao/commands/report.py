"""Tables for people: operating points and noise."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from propmdao.commands.broadband_report import print_mechanisms, trip_words
from propmdao.commands.output.band_tables import print_bands
from propmdao.commands.output.drives import drive_lines
from propmdao.commands.output.marches import march_lines
from propmdao.commands.output.tables import level_cell, narrow_table, number_cell
from propmdao.figures.contents.doubts import TONES_ONLY, doubts
from propmdao.records.listening import Surroundings
from propmdao.runtime.terminal import plain_console, print_line, printable

_TWIST_AT = 0.75  # r/R at which an elastic blade's twist is told


def print_analyses(analyses: Sequence[dict[str, Any]]) -> None:
    """Print the operating points of one propeller and the levels at their observers.

    Parameters
    ----------
    analyses : sequence of dict
        Results with the keys of ``propmdao analyze --json``.
    """
    console = plain_console()
    first = analyses[0]
    _print_propeller(console, first, f"{_flight(first)}, air {first['rho']:.4g} kg/m3")
    console.print(_operating_points(analyses))
    if any(analysis["observers"] for analysis in analyses):
        console.print(_levels(analyses))
        broadband = first["model"]["noise"]["broadband"]
        trip = "" if broadband is None else f", blades {trip_words(first['model'])}"
        console.print(f"Levels: {_around(first)}{trip}{_turbulence(first)}.", highlight=False)
        if broadband is None:
            console.print(TONES_ONLY)
        print_mechanisms(console, analyses)
    else:
        console.print("No observers: --arc RADIUS ELEVATION... adds their noise.\n")
    for line in [*march_lines(analyses), *drive_lines(analyses)]:
        print_line(line)
    print_doubts(analyses)
    print_bands(console, analyses)
    print_files(first)


def print_flyover(result: dict[str, Any]) -> None:
    """Print the levels of a flyover.

    Parameters
    ----------
    result : dict
        With the keys of ``propmdao flyover --json``.
    """
    console = plain_console()
    flight, history = result["flight"], result["history"]
    _print_propeller(
        console,
        result,
        f"{result['rpm']:.1f} rpm, thrust {result['thrust']:.4g} N, {_flight(result)},"
        f" {flight['height']:g} m above the ground",
    )
    print_doubts([result])
    table = narrow_table()
    for heading in ("", "loudest\ndBA", "SEL\ndBA", "EPNL\nEPNdB"):
        table.add_column(heading, justify="right" if heading else "left")
    for part, level in result["levels"].items():
        shown = [level_cell(level[key], ".1f") for key in ("lamax_dba", "sel_dba")]
        epnl = result["epnl"] if part == "total" else None
        table.add_row(part, *shown, "" if epnl is None else f"{epnl:.1f}")
    console.print(table)
    if result["epnl_failure"]:
        console.print(printable(f"No EPNL: {result['epnl_failure']}."), highlight=False)
    loudest = max(history, key=lambda step: float(step["total_dba"]))
    console.print(
        f"Loudest {loudest['time']:+.1f} s from overhead, heard over {loudest['distance']:.1f} m"
        f" from elevation {loudest['elevation_deg']:+.0f} deg of the rotor plane; half seconds,"
        f" {len(history)} of them. Blades {trip_words(result['model'])}{_turbulence(result)}.",
        highlight=False,
    )
    print_files(result)


def _flight(result: dict[str, Any]) -> str:
    """Words for speed and incidence."""
    incidence = result["point"]["incidence_deg"]
    tilted = f" at an incidence of {incidence:g} deg" if incidence else ""
    return f"speed {result['speed']:.4g} m/s{tilted}"


def _turbulence(result: dict[str, Any]) -> str:
    """Words for turbulence that flows in, where there is any."""
    intensity, length = result["point"]["turbulence"].values()
    return f", turbulence of {intensity:g} m/s and {length:g} m flows in" if intensity else ""


def _around(result: dict[str, Any]) -> str:
    """Words for ground and air, and where a tilted flight goes whose shaft is upright."""
    around = Surroundings(**result["listening"]["surroundings"])
    incidence = result["point"]["incidence_deg"]
    if not incidence or around.level_flight or around.ground in (None, "flush"):
        return str(around)
    climb = 90.0 - incidence
    course = f"{'climbing' if climb > 0.0 else 'descending'} at {abs(climb):g} deg"
    return f"{around}, shaft upright, {course if climb else 'flight along the ground'}"


def _print_propeller(console: Console, result: dict[str, Any], condition: str) -> None:
    """Print what was analysed, and at what condition."""
    propeller, change = result["propeller"], result["change"]
    console.print(
        printable(
            f"{propeller['name']}: {propeller['n_blades']} blades, diameter"
            f" {propeller['diameter']:.4g} m, {condition}"
        ),
        highlight=False,
    )
    # A calibrated blade is not the published one.
    if change["twist_offset_deg"]:
        console.print(
            f"Twist offset {change['twist_offset_deg']:+.4g} deg: not the geometry as described."
        )
    from propmdao.records.models import Transition  # slow to import

    loads = result["model"]["loads"]
    transition = Transition(**loads["transition"]).completed()
    if loads["viscous"] and transition != Transition().completed():
        console.print(f"Transition: {transition}.", highlight=False)


def print_doubts(results: Sequence[dict[str, Any]]) -> None:
    """Print what keeps numbers from being used.

    Parameters
    ----------
    results : sequence of dict
        Results of one propeller with the keys of ``propmdao analyze --json``.
    """
    console = Console()
    for doubt in doubts(results):
        console.print(printable(doubt))


def print_files(result: dict[str, Any]) -> None:
    """Print which files of sound, figures and surfaces were written.

    Parameters
    ----------
    result : dict
        With "sound", of `formats.wav.Recording`, "tables", "figures", "report" and "vtk", names of
        files; or without.
    """
    if "sound" in result:
        sound = result["sound"]
        print_line(
            f"Sound: {sound['path']}, {sound['duration']:.3f} s, full scale"
            f" {sound['full_scale']:g} Pa, peak {sound['peak']:.4g} Pa"
        )
    if "tables" in result:
        print_line(" ".join(["Tables:", *result["tables"]]))
    if "figures" in result:
        print_line(" ".join(["Figures:", *result["figures"]]))
    if "report" in result:
        print_line(f"Report: {result['report']}")
    if "vtk" in result:
        print_line(" ".join(["For ParaView:", *result["vtk"]]))


def _operating_points(analyses: Sequence[dict[str, Any]]) -> Table:
    gives = analyses[0]["deflection"] is not None
    # With the twist of an elastic blade there are nine columns, which have to fit a terminal of 80.
    table = narrow_table(padding=0 if gives else 1)
    columns = {
        "rpm": ("rpm", ".1f"),
        "J": ("J", ".4f"),
        "thrust": ("thrust\nN", "#.4g"),
        "torque": ("torque\nN m", "#.4g"),
        "shaft_power": ("power\nW", "#.4g"),
        "CT": ("CT", ".5f"),
        "CQ": ("CQ", ".5f"),
        "CP": ("CP", ".5f"),
        "eta": ("eta", ".3f"),
    }
    if not analyses[0]["speed"]:  # eta is 0 in hover
        del columns["eta"]
        columns["figure_of_merit"] = ("figure\nof merit", ".3f")
    for heading, _ in columns.values():
        table.add_column(heading, justify="right")
    if gives:
        table.add_column(f"twist at\n{_TWIST_AT} R\ndeg", justify="right")
    for analysis in analyses:
        row = [number_cell(analysis[key], form) for key, (_, form) in columns.items()]
        if gives:
            deflection = analysis["deflection"]
            twist = np.interp(_TWIST_AT, deflection["r_over_R"], deflection["twist_deg"])
            row.append(f"{twist:+.2f}")
        table.add_row(*row)
    return table


def _levels(analyses: Sequence[dict[str, Any]]) -> Table:
    columns = {
        "radius": ("radius\nm", ".4g"),
        "elevation_deg": ("elev.\ndeg", ".4g"),
        "azimuth_deg": ("azim.\ndeg", ".4g"),
        "spl_bpf_db": ("BPF\ndB", ".1f"),
        "oaspl_db": ("tones\ndB", ".1f"),
        "oaspl_thickness_db": ("thick-\nness\ndB", ".1f"),
        "oaspl_loading_db": ("load-\ning\ndB", ".1f"),
        "oaspl_broadband_db": ("broad-\nband\ndB", ".1f"),
        "oaspl_total_db": ("total\ndB", ".1f"),
        "oaspl_dba": ("tones\ndBA", ".1f"),
        "oaspl_total_dba": ("total\ndBA", ".1f"),
    }
    observers = [observer for analysis in analyses for observer in analysis["observers"]]
    if not any(observer["azimuth_deg"] for observer in observers):
        del columns["azimuth_deg"]
    columns = {key: column for key, column in columns.items() if key in observers[0]}
    # With broadband noise there are up to twelve columns, which have to fit a terminal of 80.
    table = narrow_table(padding=1 if len(columns) < 9 else 0)
    table.add_column("rpm", justify="right")
    for heading, _ in columns.values():
        table.add_column(heading, justify="right")
    for analysis in analyses:
        for observer in analysis["observers"]:
            table.add_row(
                f"{analysis['rpm']:.1f}",
                *(level_cell(observer[key], form) for key, (_, form) in columns.items()),
            )
    return table
