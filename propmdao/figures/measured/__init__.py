"""Figures of measurements and what was computed at the same points."""
