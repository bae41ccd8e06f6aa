"""Linear systems; where there are many, a processor factorises them one by one.

JAX hands a batch of matrices to LAPACK in tasks for the threads that its programs run on, and the
thread that does so waits for them. As many such calls at once as there are threads wait for each
other for ever: on two cores, two factorisations of a batch of which neither needs the other. Here
no batch reaches LAPACK: where these functions are mapped, by ``jax.vmap`` or within a function that
is, a processor takes one matrix after the other.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made


class Factorised(NamedTuple):
    """A matrix with its LU factors: what a matrix that meets several right-hand sides is kept as.

    Attributes
    ----------
    matrix : array, shape (n, n)
        Real or complex matrix, by which solutions are differentiated.
    factors : array, shape (n, n)
        L and U in one matrix.
    order : integer array, shape (n,)
        Order of the rows.
    """

    matrix: Array
    factors: Array
    order: Array

    def solve(self, right: Array) -> Array:
        """Solve the system of the matrix.

        Parameters
        ----------
        right : array, shape (n,) or (n, k)
            Right-hand sides.

        Returns
        -------
        array, shape of right
            Solution, with exact derivatives by matrix and right-hand sides.
        """
        columns = right.reshape(len(self.matrix), -1)
        factors, order = jax.lax.stop_gradient((self.factors, self.order))
        solution = jax.lax.custom_linear_solve(
            lambda x: self.matrix @ x,
            columns,
            lambda _, b: _upper(factors, _lower(factors, b[order])),
            lambda _, b: _lower_transposed(factors, _upper_transposed(factors, b))[
                jnp.argsort(order)
            ],
        )
        return solution.reshape(right.shape)


def factorised(matrix: Array) -> Factorised:
    """Factorise a matrix, with pivots.

    Parameters
    ----------
    matrix : array, shape (n, n)
        Real or complex matrix.

    Returns
    -------
    Factorised
        The matrix with its factors.
    """
    return Factorised(matrix, *_factorised(jax.lax.stop_gradient(matrix)))


def solve(matrix: Array, right: Array) -> Array:
    """Solve a system of linear equations, by LU factorisation with pivots.

    Parameters
    ----------
    matrix : array, shape (n, n)
        Real or complex matrix.
    right : array, shape (n,) or (n, k)
        Right-hand sides.

    Returns
    -------
    array, shape of right
        Solution, with exact derivatives by both arguments.
    """
    kind = jnp.result_type(matrix, right)
    return factorised(matrix.astype(kind)).solve(right.astype(kind))


def inverse(matrices: Array) -> Array:
    """Invert matrices, as `solve` solves.

    Parameters
    ----------
    matrices : array, shape (..., n, n)
        Real or complex matrices.

    Returns
    -------
    array, shape (..., n, n)
        Inverses of the matrices.
    """
    identity = jnp.eye(matrices.shape[-1])
    return jnp.vectorize(lambda matrix: solve(matrix, identity), signature="(n,n)->(n,n)")(matrices)


def eigenvalues(matrix: Array) -> Array:
    """Eigenvalues of a symmetric matrix, without their derivatives.

    Parameters
    ----------
    matrix : array, shape (n, n)
        Real symmetric matrix.

    Returns
    -------
    array, shape (n,)
        Eigenvalues in rising order.
    """
    return _eigenvalues(jax.lax.stop_gradient(matrix))


@cache
def load_lapack() -> None:
    """Load the library that programs factorise with, where none is traced: JAX does so then."""
    jax.jit(jax.lax.linalg.lu).lower(jax.ShapeDtypeStruct((1, 1), float))


def _one_by_one(function: Callable[..., Any]) -> Any:
    """Return a function of matrices that is mapped by a loop on a processor."""
    alone = jax.custom_batching.custom_vmap(function)

    @alone.def_vmap
    def mapped(size: int, in_batch: list[bool], *arguments: Array) -> tuple[Any, Any]:
        if jax.default_backend() != "cpu":
            axes = [0 if batched else None for batched in in_batch]
            results = jax.vmap(function, in_axes=axes, axis_size=size)(*arguments)
        else:

            def one(batched: list[Array]) -> Any:
                given = iter(batched)
                rest = zip(arguments, in_batch, strict=True)
                return alone(*(next(given) if batched else a for a, batched in rest))

            batched = [a for a, batched in zip(arguments, in_batch, strict=True) if batched]
            results = jax.lax.map(one, batched)
        return results, jax.tree.map(lambda _: True, results)

    return alone


def _triangular(*, lower: bool, transposed: bool) -> Any:
    """Return the solution of a system with one of the factors of a matrix, L or U.

    Many right-hand sides of one matrix are columns of one call.
    """
    function = partial(
        jax.lax.linalg.triangular_solve,
        left_side=True,
        lower=lower,
        unit_diagonal=lower,
        transpose_a=transposed,
    )
    matrices = _one_by_one(function)
    alone = jax.custom_batching.custom_vmap(lambda factors, right: matrices(factors, right))

    @alone.def_vmap
    def mapped(size: int, in_batch: list[bool], factors: Array, right: Array) -> tuple[Array, bool]:
        if in_batch[0]:
            axes = [0 if batched else None for batched in in_batch]
            return jax.vmap(matrices, in_axes=axes, axis_size=size)(factors, right), True
        n = len(factors)
        columns = alone(factors, jnp.moveaxis(right, 0, 1).reshape(n, -1))
        return jnp.moveaxis(columns.reshape(n, size, -1), 1, 0), True

    return alone


_lower = _triangular(lower=True, transposed=False)
_upper = _triangular(lower=False, transposed=False)
_lower_transposed = _triangular(lower=True, transposed=True)
_upper_transposed = _triangular(lower=False, transposed=True)


@_one_by_one
def _factorised(matrix: Array) -> tuple[Array, Array]:
    """L and U in one matrix, and the order of the rows."""
    factors, _, order = jax.lax.linalg.lu(matrix)
    return factors, order


@_one_by_one
def _eigenvalues(matrix: Array) -> Array:
    return jnp.linalg.eigvalsh(matrix)
