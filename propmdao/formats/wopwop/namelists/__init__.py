"""Fortran namelists of PSU-WOPWOP: their text, their groups, and the keys that count."""
