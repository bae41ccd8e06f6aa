"""Tonal noise by Formulation 1A and its levels."""

from propmdao.acoustics.formulation1a import Tones, require_subsonic_tip, tones
from propmdao.acoustics.observers import arc

__all__ = ["Tones", "arc", "require_subsonic_tip", "tones"]
