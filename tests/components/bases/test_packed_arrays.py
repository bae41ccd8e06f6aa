"""Many small arrays in one, and back to the last bit."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.components.bases.packed_arrays import packed

ARRAYS = {
    "number": np.float64(0.1),
    "none": np.zeros((0, 3)),
    "small": [np.linspace(0.0, 1.0, 12).reshape(3, 4), np.full((1, 1, 1), -2.5)],
    "large": np.arange(5000.0).reshape(50, 100),
    "whole": np.arange(3),
    "true": np.array([True, False]),
}
WITHOUT_SMALL = {"large": ARRAYS["large"], "whole": ARRAYS["whole"]}


@pytest.mark.parametrize("arrays", [ARRAYS, WITHOUT_SMALL])
def test_what_is_packed_comes_back(arrays):
    arrays = jax.tree.map(jnp.asarray, arrays)
    together = jax.jit(packed)(arrays)
    back = jax.jit(lambda together: together.unpacked())(together)
    assert jax.tree.structure(back) == jax.tree.structure(arrays)
    for mine, theirs in zip(jax.tree.leaves(back), jax.tree.leaves(arrays), strict=True):
        assert mine.dtype == theirs.dtype
        np.testing.assert_array_equal(mine, theirs, strict=True)


def test_small_arrays_go_together():
    together = packed(jax.tree.map(jnp.asarray, ARRAYS))
    assert together.row.size == 1 + 12 + 1
    assert [array.size for array in together.others] == [5000, 2, 3]  # sorted by name
