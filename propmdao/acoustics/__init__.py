"""Tonal and broadband noise of propellers, its levels and its way to the observer."""

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made
