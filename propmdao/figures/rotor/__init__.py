"""Figures of the rotor itself: blade, loads over span, polars, maps of its performance."""
