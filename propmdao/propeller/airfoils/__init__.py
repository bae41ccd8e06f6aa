"""Airfoils: camber and thickness over the chord, their library, files of coordinates."""
