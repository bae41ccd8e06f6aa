"""Linear systems, alone and in batches."""

import re
import subprocess
import sys

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.runtime import linear_algebra

RNG = np.random.default_rng(14)
N = 6


def matrices(*shape, kind=float):
    """Return well-conditioned matrices, whose rows have to be exchanged."""
    values = RNG.standard_normal((*shape, N, N))
    if kind is complex:
        values = values + 1j * RNG.standard_normal((*shape, N, N))
    return jnp.asarray(values + 4.0 * np.eye(N)[::-1])


@pytest.mark.parametrize("kind", [float, complex])
@pytest.mark.parametrize("columns", [(), (3,)])
def test_solves(kind, columns):
    """The solution is that of NumPy, for vectors and for columns."""
    matrix, right = matrices(kind=kind), jnp.asarray(RNG.standard_normal((N, *columns)))
    expected = np.linalg.solve(matrix, right)
    np.testing.assert_allclose(linear_algebra.solve(matrix, right), expected, rtol=1e-12)


@pytest.mark.parametrize("axes", [(0, 0), (0, None), (None, 0)])
def test_mapped(axes):
    """Mapped over either argument, or both, and twice, each system is solved."""
    matrix = matrices(*([5] if axes[0] == 0 else []))
    right = jnp.asarray(RNG.standard_normal((*([5] if axes[1] == 0 else []), N)))
    solutions = jax.jit(jax.vmap(linear_algebra.solve, axes))(matrix, right)
    solutions = np.asarray(solutions)
    products = np.einsum("...ij,...j", matrix, solutions)
    np.testing.assert_allclose(products, np.broadcast_to(right, products.shape), atol=1e-13)
    many = np.stack([matrix, 2.0 * matrix])
    twice = jax.jit(jax.vmap(jax.vmap(linear_algebra.solve, axes), (0, None)))(many, right)
    np.testing.assert_allclose(twice, [solutions, 0.5 * solutions], rtol=1e-11)


def test_inverse():
    """A batch of inverses is that of NumPy."""
    batch = matrices(3, 2, kind=complex)
    np.testing.assert_allclose(linear_algebra.inverse(batch), np.linalg.inv(batch), atol=1e-13)


def test_eigenvalues():
    """Eigenvalues of a batch are those of NumPy."""
    batch = matrices(3)
    batch = batch + np.swapaxes(batch, -1, -2)
    values = jax.jit(jax.vmap(linear_algebra.eigenvalues))(batch)
    np.testing.assert_allclose(values, np.linalg.eigvalsh(batch), atol=1e-12)


def test_derivatives():
    """First and second derivatives in both directions are those of JAX's own solution."""
    matrix, right = matrices(), jnp.asarray(RNG.standard_normal(N))

    def derivatives(solve):
        def length(a, b):
            return (solve(a, b) ** 2).sum()

        kinds = (jax.jacfwd, jax.grad, jax.hessian)
        at_once = jax.jit(lambda a, b: [kind(length, argnums=(0, 1))(a, b) for kind in kinds])
        return jax.tree.leaves(at_once(matrix, right))

    own, theirs = derivatives(linear_algebra.solve), derivatives(jnp.linalg.solve)
    for value, expected in zip(own, theirs, strict=True):
        np.testing.assert_allclose(value, expected, rtol=1e-9, atol=1e-12)


def test_derivatives_of_a_batch():
    """The gradient of a mapped solution is mapped, too."""
    batch, right = matrices(4), jnp.asarray(RNG.standard_normal((4, N)))
    of_all = jax.jit(jax.grad(lambda a, b: jax.vmap(linear_algebra.solve)(a, b).sum()))
    of_one = jax.jit(jax.grad(lambda a, b: linear_algebra.solve(a, b).sum()))
    each = np.asarray(of_all(batch, right))
    for one, a, b in zip(each, np.asarray(batch), np.asarray(right), strict=True):
        np.testing.assert_allclose(one, of_one(a, b), atol=1e-13)


def test_no_batch_reaches_lapack():
    """Neither a mapped solution nor its gradient calls LAPACK with more than one matrix."""

    def total(batch, right):
        return jax.vmap(linear_algebra.solve)(batch, right).sum()

    text = jax.jit(jax.grad(total)).lower(matrices(3), jnp.ones((3, N))).as_text()
    calls = re.findall(r"@lapack_d\w+\(.*?\) .*?: \(tensor<([\dx]+)x", text)
    assert calls
    assert all(shape == f"{N}x{N}" for shape in calls), calls


def test_batches_at_once_end():
    """Batches that do not need each other end on one core, where JAX's own wait for ever."""
    program = (
        "import jax, jax.numpy as jnp\n"
        "from propmdao.runtime.linear_algebra import inverse\n"
        "a = jax.random.normal(jax.random.key(0), (4, 12, 48, 48))\n"
        "f = jax.jit(lambda a: [inverse(jnp.sin(part)).sum() for part in a])\n"
        "for _ in range(5): jax.block_until_ready(f(a))\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=120)
