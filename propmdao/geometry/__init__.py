"""The blade as arrays, and the two meshes of it."""

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made
