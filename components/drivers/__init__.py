"""Drivers: differential evolution, sweeps, and what they share."""
