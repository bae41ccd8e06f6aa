"""Quieter propellers by design: vortex lattice, Formulation 1A and OpenMDAO components."""

import jax

# Circulation and phase sums lose the digits that gradients need in single precision.
jax.config.update("jax_enable_x64", True)
