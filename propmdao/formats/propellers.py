"""Propellers by name or from files: the formats that `load_propeller` reads."""

from __future__ import annotations

import difflib
import os
from pathlib import Path

from propmdao.formats.toml_files import propeller_from_text, read_toml
from propmdao.propeller.catalog import catalog_names, propeller_file
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller


def load_propeller(name_or_path: str | os.PathLike[str]) -> Propeller:
    """Get a propeller from the catalogue or from a file.

    Parameters
    ----------
    name_or_path : str or path
        A name of `propmdao.propeller.catalog.catalog_names`, or the path of a TOML file.

    Returns
    -------
    Propeller
        The propeller.

    Raises
    ------
    PropellerError
        If there is none of that name (the message lists near ones) or its file is wrong.
    """
    known = catalog_names()
    name = os.fspath(name_or_path)
    if name in known:
        file = propeller_file(name)
        return propeller_from_text(file.read_text(encoding="utf-8"), file.name, None)
    if name.endswith(".toml") or Path(name).is_file():
        return read_toml(name)
    near = difflib.get_close_matches(name.lower(), known, cutoff=0.4) or known
    raise PropellerError(
        f"unknown propeller '{name}'; near: {', '.join(near)}; `propmdao list` shows the "
        "catalogue, or give the path of a .toml file"
    )
