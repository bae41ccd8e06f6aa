"""Records that pass between the disciplines: small frozen dataclasses that JAX sees as pytrees."""

from __future__ import annotations

import dataclasses
from typing import TypeVar, dataclass_transform

import jax

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made

T = TypeVar("T")

#: A number, traced or not.
Scalar = jax.Array | float


@dataclass_transform(frozen_default=True)
def record(cls: type[T]) -> type[T]:
    """Make a class a frozen dataclass whose every field is a JAX pytree leaf (or subtree).

    Parameters
    ----------
    cls : type
        Class with annotated fields, each an array, a scalar or another record.

    Returns
    -------
    type
        The same class, frozen and registered with JAX, so that instances pass through
        ``jit``, ``jvp`` and ``vjp``.
    """
    frozen = dataclasses.dataclass(frozen=True)(cls)
    return jax.tree_util.register_dataclass(frozen)
