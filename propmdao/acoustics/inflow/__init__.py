"""Noise of turbulence that flows into a rotor or past an airfoil (Amiet)."""
