"""One decorator for functions called alone, within others, and by transformations of JAX."""

import threading
import time
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.runtime.compilation import compile_ahead, compiled


@partial(compiled, static_argnames="power")
def raised(x, power):
    """x to a power."""
    assert isinstance(x, jax.core.Tracer)  # compiled, not evaluated
    return x**power


def test_alone_within_and_transformed():
    assert raised(3.0, power=2) == raised(3.0, 2) == 9.0  # static by name and by place
    assert jax.jit(lambda x: raised(x, 2) + raised(2.0, 2))(3.0) == 13.0
    assert jax.grad(raised)(3.0, 2) == 6.0
    assert jax.vmap(partial(raised, power=3))(jnp.arange(3.0)).tolist() == [0.0, 1.0, 8.0]
    assert jax.lax.scan(lambda c, x: (raised(c, 2), x), 2.0, jnp.zeros(3))[0] == 256.0
    assert raised.__doc__ == "x to a power." and raised.__name__ == "raised"


def test_compiled_once():
    traced = []

    @compiled
    def f(x):
        traced.append(x)
        return 2.0 * x

    for x in range(5):
        assert f(float(x)) == 2.0 * x
    assert len(traced) == 1


def test_numbers_and_arrays_share_what_is_compiled():
    traced = []

    @partial(compiled, static_argnames="power")
    def f(pair, power):
        traced.append(power)
        return pair["x"] * pair["y"] ** power

    half = jnp.asarray(0.5)
    for x, y in ((3.0, 2.0), (np.float64(3.0), 2.0), (3.0 * half * 2.0, jnp.asarray(2.0))):
        assert f({"x": x, "y": y}, 2.0) == 12.0
    assert traced == [2.0]
    assert f({"x": 3.0, "y": 2.0}, power=2.0) == 12.0
    assert {type(power) for power in traced} == {float}  # what is static stays as it is


def test_ahead_is_compiled_once_and_waited_for():
    traced, shapes = [], []

    @partial(compiled, static_argnums=(1,))
    def f(x, power):
        traced.append(threading.current_thread())
        time.sleep(0.2)  # so that the call below comes too early
        return {"y": x**power}

    for _ in range(2):
        compile_ahead(f, jax.ShapeDtypeStruct((3,), float), 2, then=shapes.append)
    assert f(np.array([1.0, 2.0, 3.0]), 2)["y"].tolist() == [1.0, 4.0, 9.0]
    assert len(traced) == 1 and traced[0] is not threading.current_thread()
    assert [shape["y"].shape for shape in shapes] == [(3,)]
    f(np.ones(3), 3), f(np.ones(4), 2)  # of other kinds
    assert len(traced) == 3


def test_what_fails_ahead_fails_where_it_is_called():
    @compiled
    def f(x):
        raise ValueError("no such thing")

    compile_ahead(f, 1.0)
    with pytest.raises(ValueError, match="no such thing"):
        f(1.0)
