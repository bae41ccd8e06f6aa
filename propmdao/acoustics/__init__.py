"""Tonal noise by Formulation 1A and its levels."""

from propmdao.acoustics.formulation1a import Tones, require_subsonic_tip, tones
from propmdao.acoustics.levels import (
    a_weighting,
    oaspl_db,
    oaspl_dba,
    pressure_history,
    spl_db,
    third_octave,
)
from propmdao.acoustics.observers import arc

__all__ = [
    "Tones",
    "a_weighting",
    "arc",
    "oaspl_db",
    "oaspl_dba",
    "pressure_history",
    "require_subsonic_tip",
    "spl_db",
    "third_octave",
    "tones",
]
