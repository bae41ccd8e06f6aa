"""Command line: ``propmdao list`` and ``propmdao show``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.options import add_command, add_propeller
from propmdao.commands.output.json_output import print_json
from propmdao.commands.output.output_files import (
    require_matplotlib,
    require_output_folder,
    save_figures,
)
from propmdao.commands.output.warning_lines import warning_lines

if TYPE_CHECKING:
    from propmdao.propeller.description import Propeller

SHOW_DESCRIPTION = """\
A propeller as it is read: stations, sections, where the numbers and the polars come from.
"""
SHOW_EXAMPLES = """\
examples:
  propmdao show apcsf_11x4.7
  propmdao show my_blade.toml --figures my_blade

Exit status: 0, or 2 with one line on stderr.
"""


def add_list(commands: argparse._SubParsersAction[Any]) -> None:
    """Add ``list`` to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "list",
        _list,
        "the propellers and motors that ship with propmdao",
        "The propellers and motors that ship with propmdao, by the names that analyze takes.",
        "examples:\n  propmdao list\n  propmdao list --json",
    )
    command.add_argument("--json", action="store_true", help="print JSON instead of a table")


def add_show(commands: argparse._SubParsersAction[Any]) -> None:
    """Add ``show`` to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands, "show", _show, "one propeller: stations, sections, sources",
        SHOW_DESCRIPTION, SHOW_EXAMPLES,
    )  # fmt: skip
    add_propeller(command)
    command.add_argument("--json", action="store_true", help="print JSON instead of a table")
    command.add_argument(
        "--figures", type=Path, metavar="FOLDER", help="distributions, sections and blades, as PNG"
    )


def _list(options: argparse.Namespace) -> None:
    from propmdao.formats.propellers import load_propeller
    from propmdao.propeller.catalog import catalog_names

    propellers = [load_propeller(name) for name in catalog_names()]
    if options.json:
        keys = ("name", "diameter", "n_blades", "source")
        print_json([{key: getattr(propeller, key) for key in keys} for propeller in propellers])
    else:
        from propmdao.commands.inventory.inventory_report import print_catalog
        from propmdao.propeller.motors import motors

        print_catalog(propellers, motors())


def _show(options: argparse.Namespace) -> None:
    if options.figures is not None:
        require_output_folder("--figures", options.figures)
        require_matplotlib("--figures")
    from propmdao.formats.propellers import load_propeller

    with warning_lines("show"):
        propeller = load_propeller(options.propeller)
        described = _described(propeller)
    if options.figures is not None:
        described["figures"] = _draw(options.figures, propeller)
    if options.json:
        print_json(described)
        return
    from propmdao.commands.inventory.inventory_report import print_propeller
    from propmdao.commands.report import print_files

    print_propeller(described)
    print_files(described)


def _described(propeller: Propeller) -> dict[str, Any]:
    """Describe a propeller in plain numbers, with what follows from its airfoils filled in."""
    import numpy as np

    from propmdao.aerodynamics.sections.polars.sources import polar_sources
    from propmdao.geometry.blade import Blade
    from propmdao.propeller.identity import checksum
    from propmdao.records.plain import to_plain

    blade = Blade.from_propeller(propeller)
    plain = to_plain(propeller)
    for name in ("thickness_over_chord", "camber_over_chord"):
        plain[name] = np.asarray(getattr(blade, name)).tolist()
    polars = polar_sources(propeller, None, propeller.transition)
    return {**plain, "checksum": checksum(propeller), "polars": polars}


def _draw(folder: Path, propeller: Propeller) -> list[str]:
    from propmdao.figures.rotor.blade_view import blade_view
    from propmdao.figures.rotor.blades import blade_comparison

    radii = [max(r, float(propeller.r_over_R[0])) for r in (0.3, 0.75, 0.95)]
    title = f"{propeller.name}, {propeller.n_blades} blades, {propeller.diameter:.4g} m"
    distributions = blade_comparison({propeller.name: propeller}, radii, title)
    return save_figures(
        folder, {"distributions": distributions, "blade": blade_view(propeller, title)}
    )
