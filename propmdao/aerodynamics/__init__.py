"""Vortex lattice aerodynamics and the trim of the rotation speed."""

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made
