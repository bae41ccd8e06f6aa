"""Checksums that tell propellers of one name apart."""

from __future__ import annotations

import dataclasses
import json
import zlib

from propmdao.propeller.description import TRANSITION, Propeller


def checksum(propeller: Propeller) -> str:
    """Checksum of a description, which changes with every number of it.

    Parameters
    ----------
    propeller : Propeller
        The described propeller.

    Returns
    -------
    str
        Eight hexadecimal digits.
    """
    fields = dataclasses.asdict(propeller)
    # A description that says nothing of transition has the checksum that it had before it could.
    said = {k: value for k, value in fields.items() if k not in TRANSITION or value is not None}
    description = json.dumps(said, default=lambda array: array.tolist())
    return f"{zlib.crc32(description.encode()):08x}"
