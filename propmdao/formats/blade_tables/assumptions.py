"""Propellers of files that leave a part of the blade out, and the warning that says so."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller


class AssumedBladeWarning(UserWarning):
    """A file leaves out a part of the blade, for which something has been assumed."""


def assumed_propeller(path: Path, assumed: str, **described: Any) -> Propeller:
    """Make the propeller of a file, for a reader that `load_propeller` calls from its table.

    Parameters
    ----------
    path : Path
        The file, after which the propeller is named.
    assumed : str
        What has been assumed, for the file does not say.
    **described
        Arguments of `Propeller`.

    Returns
    -------
    Propeller
        The propeller; an `AssumedBladeWarning` says what was assumed.

    Raises
    ------
    PropellerError
        If a value is out of range; the message begins with the file.
    """
    try:
        propeller = Propeller(name=path.stem, **described)
    except PropellerError as error:
        raise PropellerError(f"{path}: {error}") from error
    warnings.warn(
        f"{path}: assumed, for the file does not say: {assumed}",
        AssumedBladeWarning,
        stacklevel=5,  # past the reader, the table of readers and `load_propeller`
    )
    return propeller
