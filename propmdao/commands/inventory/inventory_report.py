"""Tables for people: the catalogue, a propeller, this installation."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from propmdao.commands.output.tables import narrow_table, number_cell
from propmdao.propeller.description import Propeller
from propmdao.runtime.terminal import plain_console, print_line, printable


def print_catalog(propellers: Iterable[Propeller], motors: Iterable[str]) -> None:
    """Print a table of propellers: name, diameter, number of blades, airfoils; names of motors.

    Parameters
    ----------
    propellers : iterable of Propeller
        One line each.
    motors : iterable of str
        Names of the motors.
    """
    table = narrow_table()
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
    console.print(f"Motors, for analyze --motor: {', '.join(motors)}", highlight=False)


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
    table = narrow_table()
    for heading in columns:
        table.add_column(heading, justify="right")
    for station in range(len(described["r_over_R"])):
        table.add_row(
            *(number_cell(factor * v[station], form) for v, factor, form in columns.values())
        )
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
