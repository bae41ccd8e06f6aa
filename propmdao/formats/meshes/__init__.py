"""Surfaces for other programs: STL, VTK."""
