"""Boundary layers of a blade's own sections at the trailing edge."""
