"""Quieter propellers by design: vortex lattice, Formulation 1A and OpenMDAO components."""

__version__ = "0.1.0.dev0"
