"""Records that pass between the disciplines: small frozen dataclasses that JAX sees as pytrees."""

from __future__ import annotations

import dataclasses
from typing import Any, TypeVar, dataclass_transform

import jax

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made

T = TypeVar("T")

#: A number, traced or not.
Scalar = jax.Array | float


@dataclass_transform(frozen_default=True, field_specifiers=(dataclasses.field,))
def record(cls: type[T]) -> type[T]:
    """Make a class a frozen dataclass whose fields are JAX pytree leaves (or subtrees).

    Parameters
    ----------
    cls : type
        Class with annotated fields, each an array, a scalar or another record. A field made by
        ``static()`` is fixed at compile time instead: it must be hashable.

    Returns
    -------
    type
        Frozen class registered with JAX, so that instances pass through ``jit``, ``jvp`` and
        ``vjp``.
    """
    frozen = dataclasses.dataclass(frozen=True)(cls)
    return jax.tree_util.register_dataclass(frozen)


def static(default: Any = dataclasses.MISSING) -> Any:
    """Field of a record that is fixed at compile time.

    Parameters
    ----------
    default : object
        Value where none is given; without it one has to be.

    Returns
    -------
    dataclasses.Field
        Field to be written on the right side of an annotated name.
    """
    return dataclasses.field(default=default, metadata={"static": True})
