"""Blade sections in viscous flow: polars, stall delay, and how the lattice is held to them."""
