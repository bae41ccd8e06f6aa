"""Quieter propellers by design: vortex lattice, Formulation 1A and OpenMDAO components."""

from propmdao import _jax_setup

__version__ = "0.1.0.dev0"

_jax_setup.use_64_bit_floats()
_jax_setup.keep_compiled_code()
_jax_setup.factorise_on_one_thread()
