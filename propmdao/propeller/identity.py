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
    description = json.dumps(dataclasses.asdict(propeller), default=lambda array: array.tolist())
    return f"{zlib.crc32(description.encode()):08x}"
