"""One function at several things: on threads for all cores, in one call for all devices."""

from __future__ import annotations

import threading

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.runtime import linear_algebra
from propmdao.runtime import side_by_side as module
from propmdao.runtime.compilation import compiled, memory_of
from propmdao.runtime.side_by_side import (
    at_all,
    filled_size,
    free_memory,
    n_cores,
    side_by_side,
    stacked,
)


@pytest.fixture
def two_cores(monkeypatch):
    monkeypatch.setenv("PJRT_NPROC", "2")


@pytest.mark.usefixtures("two_cores")
def test_two_run_at_the_same_time_and_results_keep_their_order():
    together = threading.Barrier(2)

    def function(i):
        together.wait(timeout=60.0)  # broken, and an error, unless a second one comes
        return -i

    assert side_by_side(function, range(6)) == [0, -1, -2, -3, -4, -5]


@pytest.mark.usefixtures("two_cores")
def test_the_first_failure_is_raised_and_the_rest_left_out():
    begun = []

    def function(i):
        begun.append(i)
        if i in (1, 2):
            raise ValueError(f"no result of {i}")
        return i

    with pytest.raises(ValueError, match="no result of 1"):
        side_by_side(function, range(1000))
    assert len(begun) < 1000


def test_workers_have_one_core(monkeypatch):
    monkeypatch.setenv("PJRT_NPROC", "1")
    assert n_cores() == 1
    assert side_by_side(lambda _: threading.current_thread(), range(3)) == (
        [threading.current_thread()] * 3
    )


def test_there_is_a_core(monkeypatch):
    monkeypatch.delenv("PJRT_NPROC", raising=False)
    assert n_cores() >= 1


def root(matrix, point):
    """Solution of a system, and after how many halvings a number is below 1."""
    x, n = jax.lax.while_loop(
        lambda s: s[0] > 1.0, lambda s: (0.5 * s[0], s[1] + 1.0), (point["x"], 0.0)
    )
    return {"y": linear_algebra.solve(matrix + x * jnp.eye(3), jnp.ones(3)), "n": n}


@compiled
def roots(matrix, points):
    return at_all(root, matrix, points)


def computed():
    """Results at five points, in a call for six or more."""
    points = [{"x": x} for x in (3.0, 0.5, 100.0, 7.0, 1e6)]
    values = roots(np.diag([1.0, 2.0, 3.0]), stacked(points, 6))
    return {
        "devices": len(values["n"].sharding.device_set),
        "size": len(values["n"]),
        "n": np.asarray(values["n"])[:5].tolist(),
        "y": np.asarray(values["y"])[:5].tolist(),
    }


def test_four_devices_give_what_one_gives(on_devices):
    here, there = computed(), on_devices(4, __file__, "computed")
    assert (here["devices"], here["size"]) == (1, 6)
    assert (there["devices"], there["size"]) == (4, 8)  # a multiple of the devices
    assert here["n"] == there["n"] == [2.0, 0.0, 7.0, 3.0, 20.0]
    np.testing.assert_allclose(there["y"], here["y"], rtol=1e-14)


def test_a_call_is_filled_up():
    assert filled_size(5) == 5  # of one device
    points = stacked([{"x": 1.0}, {"x": 2.0}], 4)
    np.testing.assert_array_equal(points["x"], [1.0, 2.0, 2.0, 2.0])


def test_memory_is_of_arguments_results_and_what_is_between():
    few, many = (memory_of(roots, np.eye(3), stacked([{"x": 1.0}], n)) for n in (10, 1000))
    per_point = (many - few) / 990
    assert 5 * 8 <= per_point <= 5000  # x, n and y at least; a handful of 3 x 3 matrices beside


def test_memory_of_a_processor_is_that_of_the_machine():
    assert 2**28 < free_memory() < 2**50


def test_an_accelerator_says_what_it_has_left(monkeypatch):
    class Device:
        def memory_stats(self):
            return {"bytes_limit": 1000, "bytes_in_use": 300}

    monkeypatch.setattr(module.jax, "local_devices", lambda: [Device()])
    assert free_memory() == 700
