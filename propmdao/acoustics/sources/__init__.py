"""Tonal noise: Formulation 1A for rotors in steady flight and in any motion."""
