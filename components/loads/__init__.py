"""Loads of a rotor: steady, periodic or marched, at a rotation speed or for a thrust."""
