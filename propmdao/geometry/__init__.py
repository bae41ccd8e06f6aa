"""Blade geometry: sections, lattice and surface mesh."""
