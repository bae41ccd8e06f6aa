"""Warning of what a file leaves out."""

from __future__ import annotations


class AssumedBladeWarning(UserWarning):
    """A file leaves out a part of the blade, for which something has been assumed."""
