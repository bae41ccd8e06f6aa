"""Geometry tables of makers and databases, read as propellers."""
