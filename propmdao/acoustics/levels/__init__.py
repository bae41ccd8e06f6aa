"""Levels: decibels, weighting, bands, spectra, levels over time, perceived noise."""
