"""The formats of propellers and polars by the ending of a file's name.

A new format is a module with a function that reads or writes it, and a line in a table here.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class FileFormat:
    """A format of files, to be called like the function that reads or writes one.

    Attributes
    ----------
    contents : str
        Description of a file of this format in help texts and messages.
    function : str
        Function as ``module:name``. It is imported when a file is read or written, for help texts
        show these tables too, and what readers and writers need takes seconds to import.
    """

    contents: str
    function: str

    def __call__(self, *arguments: Any) -> Any:
        """Read or write a file."""
        return pkgutil.resolve_name(self.function)(*arguments)


@dataclass(frozen=True)
class PropellerWriter(FileFormat):
    """A format that propellers are written in; its function returns the number of its items.

    Attributes
    ----------
    items : str
        Name of the items that are counted: stations, triangles.
    takes : tuple of str
        Arguments of the function after path and propeller: "section", the r/R of the one section
        that the file holds; "reynolds", its Reynolds number; "units", the unit of length; "hub",
        diameter and height of a hub, or None.
    """

    items: str = "stations"
    takes: tuple[str, ...] = ()


@dataclass(frozen=True)
class PolarReader(FileFormat):
    """A format of polars; its function takes the files of one section.

    Attributes
    ----------
    several : bool
        True if a section may have several files, one for each Reynolds number.
    """

    several: bool = False


_QPROP = FileFormat("propeller file of QPROP or QMIL", "propmdao.formats.exchange.qprop:read_qprop")
_UIUC = FileFormat(
    "geometry file of UIUC, named like apcsf_9x4.7_geom.txt",
    "propmdao.formats.blade_tables.uiuc:read_named_uiuc_geometry",
)

#: Readers of propellers: functions of a path that return a `Propeller`.
PROPELLER_READERS = {
    ".toml": FileFormat("propeller file", "propmdao.formats.toml_files:read_toml"),
    ".pe0": FileFormat("geometry file of APC", "propmdao.formats.blade_tables.pe0:read_pe0"),
    ".bem": FileFormat("BEM file of OpenVSP", "propmdao.formats.exchange.bem:read_bem"),
    ".qprop": _QPROP,
    ".prop": _QPROP,
    ".xrotor": FileFormat("rotor file of XROTOR", "propmdao.formats.exchange.xrotor:read_xrotor"),
    ".bld": FileFormat(
        "blade file of QBlade", "propmdao.formats.exchange.qblade.blade_file:read_bld"
    ),
    ".csv": FileFormat(
        "table of a blade with heads", "propmdao.formats.blade_tables.csv_table:read_csv"
    ),
    ".txt": _UIUC,
    ".dat": _UIUC,
}

#: Units of STL files: the name of each, and how many of it are a metre.
STL_UNITS = {"m": ("metres", 1.0), "mm": ("millimetres", 1000.0)}

_STEP = PropellerWriter(
    "solid blades for CAD in millimetres, with section curves, and --hub (extra cad)",
    "propmdao.formats.exchange.step:export_step",
    "solids",
    ("hub",),
)

#: Writers of propellers: functions of a path and a `Propeller`.
PROPELLER_WRITERS = {
    ".stl": PropellerWriter(
        "closed surface of all blades, outward, binary (no hub), in --units",
        "propmdao.formats.exchange.blades:export_stl",
        "triangles",
        ("units",),
    ),
    ".step": _STEP,
    ".stp": _STEP,
    ".toml": PropellerWriter(
        "propeller file, as propmdao reads it", "propmdao.formats.toml_files:write_toml"
    ),
    ".csv": PropellerWriter(
        "chord, blade angle, thickness, camber, sweep and rake at the stations",
        "propmdao.formats.exchange.blades:export_csv",
    ),
    ".dat": PropellerWriter(
        "section at --section, x and z over chord in Selig's order",
        "propmdao.formats.exchange.blades:export_section",
        "points",
        ("section",),
    ),
    ".txt": PropellerWriter(
        "polar of the section at --section and --reynolds, as XFOIL, XFLR5, QBlade and JBLADE have"
        " it",
        "propmdao.formats.exchange.section_polar:export_polar",
        "angles",
        ("section", "reynolds"),
    ),
    ".bem": PropellerWriter(
        "BEM file of OpenVSP, in metres", "propmdao.formats.exchange.bem:write_bem", "sections"
    ),
    ".qprop": PropellerWriter(
        "propeller file of QPROP", "propmdao.formats.exchange.qprop:write_qprop"
    ),
    ".xrotor": PropellerWriter(
        "rotor file of XROTOR", "propmdao.formats.exchange.xrotor:write_xrotor"
    ),
    ".bld": PropellerWriter(
        "blade file of QBlade, and a folder of its polars and contours beside it",
        "propmdao.formats.exchange.qblade.blade_file:write_bld",
    ),
    ".vspscript": PropellerWriter(
        "script that builds the blade in OpenVSP with its own sections",
        "propmdao.formats.exchange.vspscript:write_vspscript",
        "sections",
    ),
}

#: Readers of polars: functions of paths that return a `PolarTable`. The empty ending stands for any
#: that is not in the table, for XFOIL lets its users name polars as they like.
POLAR_READERS = {
    ".c81": PolarReader("C81 file", "propmdao.formats.c81:read_c81"),
    ".plr": PolarReader(
        "polar file of QBlade", "propmdao.formats.exchange.qblade.polar_file:read_plr"
    ),
    "": PolarReader(
        "polar of XFOIL or XFLR5, one for each Reynolds number",
        "propmdao.formats.polars:read_polars",
        several=True,
    ),
}


def described(formats: Mapping[str, FileFormat]) -> str:
    """List formats for a help text or a message.

    Parameters
    ----------
    formats : mapping of str to FileFormat
        Formats by ending, one of the tables of this module.

    Returns
    -------
    str
        Endings and contents, as in ".toml (propeller file), .txt or .dat (...)".
    """
    endings: dict[str, list[str]] = {}
    for ending, form in formats.items():
        endings.setdefault(form.contents, []).append(ending or "any other ending")
    return ", ".join(f"{' or '.join(names)} ({contents})" for contents, names in endings.items())
