"""Tonal noise by Formulation 1A and its levels."""
