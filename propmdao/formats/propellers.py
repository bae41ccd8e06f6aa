"""Propellers by name or from files of any format that is read."""

from __future__ import annotations

import difflib
import os
from pathlib import Path

from propmdao.formats.endings import PROPELLER_READERS, described
from propmdao.formats.toml_files import propeller_from_text
from propmdao.propeller.catalog import catalog_names, propeller_file
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller


def load_propeller(name_or_path: str | os.PathLike[str]) -> Propeller:
    """Get a propeller from the catalogue or from a file.

    Parameters
    ----------
    name_or_path : str or path
        A name of `propmdao.propeller.catalog.catalog_names`, which has precedence over a file of
        that name, or the path of a file with an ending of
        `propmdao.formats.endings.PROPELLER_READERS`.

    Returns
    -------
    Propeller
        The propeller.

    Raises
    ------
    PropellerError
        If there is no propeller of that name (the message lists near names), or its file is wrong
        or has an ending that is not read.
    """
    known = catalog_names()
    name = os.fspath(name_or_path)
    if name in known:
        file = propeller_file(name)
        return propeller_from_text(file.read_text(encoding="utf-8"), file.name, None)
    path = Path(name)
    read = PROPELLER_READERS.get(path.suffix.lower())
    if read is not None:
        propeller: Propeller = read(path)
        return propeller
    readable = described(PROPELLER_READERS)
    if path.is_file():
        raise PropellerError(
            f"{path}: no propeller is read from a file with the ending '{path.suffix}'; there are "
            f"{readable}"
        )
    near = difflib.get_close_matches(name.lower(), known, cutoff=0.4) or known
    raise PropellerError(
        f"unknown propeller '{name}'; near: {', '.join(near)}; `propmdao list` shows the "
        f"catalogue, or give the path of a file: {readable}"
    )
