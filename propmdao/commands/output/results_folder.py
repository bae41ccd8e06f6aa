"""A folder of results, with the inputs and versions that they were made of."""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import propmdao
from propmdao.runtime.output_files import make_folder, replacing

if TYPE_CHECKING:
    from propmdao.propeller.description import Propeller

RECORD = "record.json"
_LIBRARIES = ("jax", "numpy", "scipy", "openmdao")


def versions() -> dict[str, str]:
    """Versions of everything that numbers depend on.

    Returns
    -------
    dict of str to str
        propmdao, Python and the libraries by name.
    """
    from importlib import metadata  # slow to import

    known = {"propmdao": propmdao.__version__, "python": platform.python_version()}
    return known | {name: metadata.version(name) for name in _LIBRARIES}


def write_record(
    folder: Path,
    options: argparse.Namespace,
    propellers: Mapping[str, Propeller],
    **contents: Any,
) -> Path:
    """Write what was asked, with versions and propellers, so that it can be done again.

    Parameters
    ----------
    folder : Path
        Folder of the results, made where there is none.
    options : argparse.Namespace
        Options of the command, with the `arguments` that were typed.
    propellers : mapping of str to Propeller
        Propellers that were described, by name: written whole, with checksums.
    **contents
        JSON values that the command adds: its inputs and its results.

    Returns
    -------
    Path
        The file, ``record.json``.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    # Slow to import, and not wanted for --help.
    from propmdao.propeller.identity import checksum
    from propmdao.records.plain import to_plain

    record = {
        "command": shlex.join(["propmdao", *options.arguments]),
        "arguments": list(options.arguments),
        "written": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "versions": versions(),
        "propellers": {
            name: {"checksum": checksum(propeller), **to_plain(propeller)}
            for name, propeller in propellers.items()
        },
        **contents,
    }
    make_folder(folder)
    path = folder / RECORD
    with replacing(path) as file:
        file.write_text(json.dumps(record, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    return path


def file_name(name: str) -> str:
    """Make a name of a file of the name of a propeller.

    Parameters
    ----------
    name : str
        Name of a propeller, which may hold anything.

    Returns
    -------
    str
        Letters, digits, points, signs and underlines.
    """
    kept = "".join(sign if sign.isalnum() or sign in ".+-_" else "_" for sign in name)
    return kept.lstrip(".") or "_"
