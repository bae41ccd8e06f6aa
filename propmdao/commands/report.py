"""Tables for people: the catalogue, operating points, noise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from propmdao.commands.broadband_report import print_mechanisms, trip_words
from propmdao.propeller.description import Propeller
from propmdao.records.listening import Surroundings
from propmdao.runtime.terminal import plain_console, print_line, printable

# What the numbers leave out stands below them, where it is read.
INVISCID = "Inviscid lattice: no profile drag, so torque and power are low and eta is high."
BAND = (
    "First line: with the input at its upper end, second: at its lower end. Band: root of the sum"
    " of their squares, what raises a number apart from what lowers it."
)
_TWIST_AT = 0.75  # r/R at which an elastic blade's twist is told
TONES_ONLY = "Tones only: with broadband noise (--broadband) it is louder, above all in dBA."

# Results of a band: label, formats of the number and of its changes.
_BAND_ROWS = {
    "rpm": ("rpm", ".1f", "+.1f"),
    "thrust": ("thrust, N", "#.4g", "+.3g"),
    "shaft_power": ("power, W", "#.4g", "+.3g"),
}


def print_catalog(propellers: Iterable[Propeller]) -> None:
    """Print a table of propellers: name, diameter, number of blades, airfoils.

    Parameters
    ----------
    propellers : iterable of Propeller
        One line each.
    """
    table = _table()
    table.add_column("name", no_wrap=True)
    table.add_column("diameter m", justify="right")
    table.add_column("blades", justify="right")
    table.add_column("airfoils, hub to tip")
    for propeller in propellers:
        airfoils = printable(", ".join(name for _, name in propeller.airfoils))
        table.add_row(
            printable(propeller.name),
            f"{propeller.diameter:.4g}",
            str(propeller.n_blades),
            airfoils,
        )
    console = plain_console()
    console.print(table)
    console.print("Where the numbers come from, and what is assumed: propmdao list --json")


def print_propeller(described: dict[str, Any]) -> None:
    """Print the stations of a propeller, its sections and its sources.

    Parameters
    ----------
    described : dict
        With the keys of ``propmdao show --json``.
    """
    console = plain_console()
    console.print(
        printable(
            f"{described['name']}: {described['n_blades']} blades, diameter"
            f" {described['diameter']:.4g} m, checksum {described['checksum']}"
        ),
        highlight=False,
    )
    millimetres = 500.0 * described["diameter"]
    columns = {
        "r/R": (described["r_over_R"], 1.0, ".3f"),
        "radius\nmm": (described["r_over_R"], millimetres, ".2f"),
        "chord\nmm": (described["c_over_R"], millimetres, ".2f"),
        "blade\nangle\ndeg": (described["beta_deg"], 1.0, ".2f"),
        "thick-\nness\n%": (described["thickness_over_chord"], 100.0, ".2f"),
        "camber\n%": (described["camber_over_chord"], 100.0, ".2f"),
        "sweep\nmm": (described["sweep_over_R"], millimetres, ".2f"),
        "rake\nmm": (described["rake_over_R"], millimetres, ".2f"),
    }
    table = _table()
    for heading in columns:
        table.add_column(heading, justify="right")
    for station in range(len(described["r_over_R"])):
        table.add_row(*(_format(factor * v[station], form) for v, factor, form in columns.values()))
    console.print(table)
    for r, airfoil in described["airfoils"]:
        print_line(f"r/R {r:g}: {airfoil}, polars: {described['polars'][airfoil]}")
    if described["source"]:
        print_line(f"Source: {described['source']}")


def print_installation(installation: dict[str, Any]) -> None:
    """Print what an installation has.

    Parameters
    ----------
    installation : dict
        With the keys of ``propmdao doctor --json``.
    """
    for name, version in installation["versions"].items():
        print_line(f"{name} {version}")
    print_line(f"{installation['platform']}, {installation['processor cores']} processor cores")
    print_line(f"devices: {', '.join(installation['devices'])}")
    for name in ("compiled code", "polars"):
        cache = installation[name]
        where = cache["folder"] or "nowhere: no folder can be written"
        print_line(f"cache of {name}: {where}, {cache['files']} files, {cache['megabytes']} MB")
    for name, is_there in installation["extras"].items():
        missing = f"missing: pip install 'propmdao[{name}]'"
        print_line(f"extra {name}: {'installed' if is_there else missing}")
    check = installation["check"]
    print_line(
        f"check: {check['propeller']} at {check['rpm']:g} rpm on coarse meshes, thrust"
        f" {check['thrust']:.3f} N, {check['seconds']:g} s with imports and compilation"
    )


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
        console.print(f"Levels: {_around(first)}{trip}.", highlight=False)
        if broadband is None:
            console.print(TONES_ONLY)
        print_mechanisms(console, analyses)
    else:
        console.print("No observers: --arc RADIUS ELEVATION... adds their noise.\n")
    print_doubts(analyses)
    _print_bands(console, analyses)
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
    table = _table()
    for heading in ("", "loudest\ndBA", "SEL\ndBA", "EPNL\nEPNdB"):
        table.add_column(heading, justify="right" if heading else "left")
    for part, level in result["levels"].items():
        shown = [_level(level[key], ".1f") for key in ("lamax_dba", "sel_dba")]
        epnl = result["epnl"] if part == "total" else None
        table.add_row(part, *shown, "" if epnl is None else f"{epnl:.1f}")
    console.print(table)
    if result["epnl_failure"]:
        console.print(printable(f"No EPNL: {result['epnl_failure']}."), highlight=False)
    loudest = max(history, key=lambda step: float(step["total_dba"]))
    console.print(
        f"Loudest {loudest['time']:+.1f} s from overhead, heard over {loudest['distance']:.1f} m"
        f" from elevation {loudest['elevation_deg']:+.0f} deg of the rotor plane; half seconds,"
        f" {len(history)} of them. Blades {trip_words(result['model'])}.",
        highlight=False,
    )
    print_files(result)


def _flight(result: dict[str, Any]) -> str:
    """Words for speed and incidence."""
    incidence = result["point"]["incidence_deg"]
    tilted = f" at an incidence of {incidence:g} deg" if incidence else ""
    return f"speed {result['speed']:.4g} m/s{tilted}"


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
    for result in results:
        if not result["converged"]:
            console.print(
                printable(
                    f"NOT CONVERGED at {result['rpm']:.1f} rpm, do not use these numbers: "
                    f"{result['failure']}."
                )
            )
    if not results[0]["model"]["loads"]["viscous"]:
        console.print(INVISCID)


def print_files(result: dict[str, Any]) -> None:
    """Print which files of sound, figures and surfaces were written.

    Parameters
    ----------
    result : dict
        With "sound", of `formats.wav.Recording`, "tables", "figures" and "vtk", names of files; or
        without.
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
    if "vtk" in result:
        print_line(" ".join(["For ParaView:", *result["vtk"]]))


def _print_bands(console: Console, analyses: Sequence[dict[str, Any]]) -> None:
    """Print what inputs that are not known for sure do to the numbers, where it was asked."""
    bands = [analysis for analysis in analyses if analysis.get("band")]
    for analysis in bands:
        console.print(f"Band at {analysis['rpm']:.1f} rpm: changes of the numbers", highlight=False)
        console.print(_band(analysis))
        for effect in analysis["band"]["effects"]:
            if effect["left_out"]:
                text = f"The band lacks {effect['name']}: {effect['left_out']}."
                console.print(printable(text), highlight=False)
    if bands:
        console.print(BAND)


def _band(analysis: dict[str, Any]) -> Table:
    """Changes of every number: by each input, at its upper and its lower end, and by all."""
    band, observers = analysis["band"], analysis["observers"]
    rows, numbers = [], dict[str, Any]()
    for key in band["above"]:
        if key == "spl_bpf_db":
            rows += [(f"BPF dB, {place}", ".1f", "+.2f") for place in _places(observers)]
            numbers[key] = [observer[key] for observer in observers]
        else:
            rows.append(_BAND_ROWS[key])
            numbers[key] = analysis[key]
    columns, table = [], _table()
    for heading in ("", "value"):
        table.add_column(heading, justify="right" if heading else "left", no_wrap=True)
    for effect in band["effects"]:
        low, high = effect["ends"]
        # Word below word, so that the table fits a terminal of 80 characters.
        words = [*effect["name"].split(), f"{low:g} to", f"{high:g} {effect['unit']}".rstrip()]
        table.add_column("\n".join(words), justify="right", no_wrap=True)
        columns.append((effect["changes"][1], effect["changes"][0]))
    table.add_column("band", justify="right")
    columns.append((band["above"], band["below"]))
    flat = [tuple(None if end is None else _flat(end) for end in ends) for ends in columns]
    for k, ((label, form, change), value) in enumerate(zip(rows, _flat(numbers), strict=True)):
        cells = (
            "\n".join("-" if end is None else _format(end[k], change) for end in ends)
            for ends in flat
        )
        table.add_row(label, _format(value, form), *cells)
    return table


def _flat(values: dict[str, Any]) -> list[float]:
    """Numbers of a band's results in one list, those of the observers one after the other."""
    return [
        number
        for value in values.values()
        for number in (value if isinstance(value, list) else [value])
    ]


def _places(observers: Sequence[dict[str, Any]]) -> list[str]:
    """What tells observers from each other in few characters."""
    keys = {"elevation_deg": "{:+.4g} deg", "azimuth_deg": "az. {:.4g}", "radius": "{:.4g} m"}
    differ = [
        key
        for key in keys
        if key == "elevation_deg" or len({observer[key] for observer in observers}) > 1
    ]
    return [", ".join(keys[key].format(observer[key]) for key in differ) for observer in observers]


def _operating_points(analyses: Sequence[dict[str, Any]]) -> Table:
    gives = analyses[0]["deflection"] is not None
    # With the twist of an elastic blade there are nine columns, which have to fit a terminal of 80.
    table = _table(padding=0 if gives else 1)
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
        row = [_format(analysis[key], form) for key, (_, form) in columns.items()]
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
    table = _table(padding=1 if len(columns) < 9 else 0)
    table.add_column("rpm", justify="right")
    for heading, _ in columns.values():
        table.add_column(heading, justify="right")
    for analysis in analyses:
        for observer in analysis["observers"]:
            table.add_row(
                f"{analysis['rpm']:.1f}",
                *(_level(observer[key], form) for key, (_, form) in columns.items()),
            )
    return table


def _table(padding: int = 1) -> Table:
    return Table(box=box.SIMPLE, pad_edge=False, collapse_padding=True, padding=(0, padding))


def _level(value: float, form: str) -> str:
    # Silence is -200 dB.
    return _format(value, form) if value > -199.0 else "-"


def _format(value: float, form: str) -> str:
    # A zero that has a sign is still zero.
    return format(value + 0.0, form)
