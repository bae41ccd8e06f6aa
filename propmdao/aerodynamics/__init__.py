"""Vortex lattice aerodynamics and the trim of the rotation speed."""
