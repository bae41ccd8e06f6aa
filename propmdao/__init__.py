"""Quieter propellers by design: vortex lattice, Formulation 1A and OpenMDAO components."""

import jax

__version__ = "0.1.0.dev0"

# Circulation and phase sums lose the digits that gradients need in single precision.
jax.config.update("jax_enable_x64", True)
