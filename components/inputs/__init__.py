"""Inputs and options that several components share: operating points, rotors, observers, models."""
