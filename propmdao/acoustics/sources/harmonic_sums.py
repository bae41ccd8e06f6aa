"""The arithmetic behind the tones: harmonics of many sources in one pass over memory.

A rotor of 5,200 panels at 56 azimuths asks for 10 harmonics of 290,000 phases per observer, and the
form decides between 5 and 150 ms (two cores, 64 bit). Three things make it fast on a processor:

- `harmonic_sums` adds up all harmonics in one reduction with many operands. As separate sums XLA
  would compute the whole chain of powers again for each of them.
- `cos_sin` is plain arithmetic that the compiler vectorises; XLA calls the library's scalar sine
  and cosine for 64-bit numbers, 10 ns each, more than everything else together.
- what fills the arrays stays behind a barrier: XLA would fuse that work into the reduction, whose
  inner loop is scalar.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.extend.core import Primitive
from jax.interpreters import ad, batching, mlir

from propmdao.runtime.compilation import compiled


@jax.custom_jvp
def cos_sin(angle: Array) -> tuple[Array, Array]:
    """Cosine and sine, each to 4e-16.

    Parameters
    ----------
    angle : array
        Angles of any shape, below 1e6 in size [rad].

    Returns
    -------
    cosine, sine : arrays
        Cosine and sine, of the shape of the angles.
    """
    turn = jnp.round(angle * (2 / np.pi))
    # pi/2 in two parts (Cody and Waite): the first has 33 bits, so that its multiples are exact
    x = (angle - turn * 1.57079632673412561417) - turn * 6.07710050650619224932e-11
    x2 = x * x
    cosine, sine = jnp.zeros_like(x), jnp.zeros_like(x)
    for k in range(8, -1, -1):  # Taylor series; the next term at pi/4 is 2e-18
        cosine = cosine * x2 + (-1) ** k / math.factorial(2 * k)
        sine = sine * x2 + (-1) ** k / math.factorial(2 * k + 1)
    sine = sine * x
    quarter = turn - 4 * jnp.floor(turn / 4)
    odd = (quarter == 1) | (quarter == 3)
    cosine, sine = jnp.where(odd, sine, cosine), jnp.where(odd, cosine, sine)
    cosine = jnp.where((quarter == 1) | (quarter == 2), -cosine, cosine)
    return cosine, jnp.where(quarter >= 2, -sine, sine)


@cos_sin.defjvp
def _cos_sin_jvp(primals: tuple[Array], tangents: tuple[Array]) -> tuple[Any, Any]:
    cosine, sine = cos_sin(*primals)
    return (cosine, sine), (-sine * tangents[0], cosine * tangents[0])


@partial(jax.custom_jvp, nondiff_argnums=(2,))
def harmonic_sums(strength: Array, angle: Array, n_harmonics: int) -> Array:
    """Sum ``strength * exp(1j m angle)`` over the last axis, for m = 1 ... n_harmonics.

    Parameters
    ----------
    strength, angle : (..., n) arrays
        Real strength of each source; its angle, below 1e6 in size [rad].
    n_harmonics : int
        Number of harmonics (static).

    Returns
    -------
    (..., n_harmonics) complex array
        Sums for m = 1 ... n_harmonics.
    """
    strength, cosine, sine = _apart(strength, angle)
    real, imag = strength * cosine, strength * sine
    terms = []
    for _ in range(n_harmonics):
        terms += [real, imag]
        real, imag = real * cosine - imag * sine, real * sine + imag * cosine
    return _sum_each(terms)


@harmonic_sums.defjvp
def _harmonic_sums_jvp(
    n_harmonics: int, primals: tuple[Array, Array], tangents: tuple[Array, Array]
) -> tuple[Array, Array]:
    """Sum ``(d strength + 1j m strength d angle) exp(1j m angle)`` in a second pass.

    Step by step through the powers, a reverse derivative would keep every one of them.
    """
    strength, cosine, sine = _apart(*primals)
    d_strength, d_angle = tangents
    d_turn = strength * d_angle
    real, imag = cosine, sine
    terms = []
    for m in range(1, n_harmonics + 1):
        terms += [d_strength * real - d_turn * (m * imag), d_strength * imag + d_turn * (m * real)]
        real, imag = real * cosine - imag * sine, real * sine + imag * cosine
    return harmonic_sums(*primals, n_harmonics), _sum_each(terms)


def _apart(strength: Array, angle: Array) -> tuple[Array, Array, Array]:
    """Strength, cosine and sine, not to be fused into the sums."""
    apart: tuple[Array, Array, Array] = jax.lax.optimization_barrier((strength, *cos_sin(angle)))
    return apart


def _sum_each(terms: list[Array]) -> Array:
    """Sum real and imaginary terms over the last axis, each in the same pass."""
    sums = _sum_each_p.bind(*jnp.broadcast_arrays(*terms))
    return jnp.stack(sums[::2], -1) + 1j * jnp.stack(sums[1::2], -1)


# A primitive, because JAX can neither transpose a reduction with many operands nor differentiate
# it cheaply, although it is linear. The four rules below say what a sum is.
_sum_each_p = Primitive("sum_each")
_sum_each_p.multiple_results = True


def _sums(*arrays: Array) -> Any:
    def add(a: Any, b: Any) -> Any:
        return tuple(x + y for x, y in zip(a, b, strict=True))

    zeros = tuple(np.zeros((), a.dtype) for a in arrays)
    return jax.lax.reduce(arrays, zeros, add, (arrays[0].ndim - 1,))


def _transpose(cotangents: Any, *arrays: Any) -> Any:
    return [
        None if isinstance(ct, ad.Zero) else jnp.broadcast_to(ct[..., None], a.aval.shape)
        for ct, a in zip(cotangents, arrays, strict=True)
    ]


def _batch(arrays: Any, axes: Any) -> Any:
    size = next(a.shape[axis] for a, axis in zip(arrays, axes, strict=True) if axis is not None)
    front = [batching.bdim_at_front(a, axis, size) for a, axis in zip(arrays, axes, strict=True)]
    return _sum_each_p.bind(*front), [0] * len(front)


_sum_each_p.def_impl(compiled(_sums))
_sum_each_p.def_abstract_eval(
    lambda *arrays: [jax.core.ShapedArray(a.shape[:-1], a.dtype) for a in arrays]
)
mlir.register_lowering(_sum_each_p, mlir.lower_fun(_sums, multiple_results=True))
ad.deflinear2(_sum_each_p, _transpose)
batching.primitive_batchers[_sum_each_p] = _batch
