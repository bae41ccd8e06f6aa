"""Checksums that tell propellers of one name apart."""

from __future__ import annotations

import dataclasses
import json
import zlib

from propmdao.propeller.description import Propeller


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
    # A description has the checksum that it had before it could say more.
    said = {k: v for k, v in fields.items() if k == "thickness_over_chord" or v is not None}
    description = json.dumps(said, default=lambda array: array.tolist())
    return f"{zlib.crc32(description.encode()):08x}"
