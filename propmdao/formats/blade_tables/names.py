"""Diameter and blades that the name of a file says: apcsf_9x4.7_geom, da4022_9x6.75_3b."""

from __future__ import annotations

import re

# Diameter and pitch, then the number of blades where it is not two.
_NAME = re.compile(r"_(\d+(?:\.\d+)?)x\d+(?:\.\d+)?(?=_|$)(?:.*_(\d)b(?=_|$))?")
#: Propellers of the UIUC data set have 2.2 to 19 inches. A larger number is no inches: five of its
#: names are in millimetres (pl_57x20), some have lost a decimal point (ancf_125x75).
LARGEST = 30.0  # inches


def inches_of_name(stem: str) -> float | None:
    """Diameter that a file's name says.

    Parameters
    ----------
    stem : str
        Name of the file without its ending.

    Returns
    -------
    float or None
        Diameter [inches]; None where the name says none, or none up to `LARGEST`.
    """
    name = _NAME.search(stem)
    inches = float(name[1]) if name else 0.0
    return inches if 0.0 < inches <= LARGEST else None


def blades_of_name(stem: str) -> int | None:
    """Number of blades that a file's name says.

    Parameters
    ----------
    stem : str
        Name of the file without its ending.

    Returns
    -------
    int or None
        Number of blades; None where the name says none.
    """
    name = _NAME.search(stem)
    return int(name[2]) if name and name[2] else None
