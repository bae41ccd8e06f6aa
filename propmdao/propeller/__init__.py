"""Propellers as users describe them: their checks, their airfoils, the catalogue."""
