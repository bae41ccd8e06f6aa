"""Polars packed as whole numbers: within half a unit, whatever overflows on the way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.attached import (
    COARSE,
    FINE,
    AttachedPolars,
    packed,
    unpacked,
)
from propmdao.aerodynamics.sections.polars.high_angle import ATTACHED_DEG, FloatArray


@pytest.fixture
def polars() -> AttachedPolars:
    """Random numbers over the whole range that 16 bits have, which no polar is as wild as."""
    random = np.random.default_rng(1)
    shape = (2, 3, 4, ATTACHED_DEG.size)
    cl, log_cd = random.uniform(-6.5, 6.5, (2, *shape))
    cm = random.uniform(-0.65, 0.65, shape)
    low, high = random.integers(0, 53, (2, *shape[:-1]))
    return AttachedPolars(np.stack([cl, np.exp(log_cd), cm], axis=2), low, high)


@pytest.mark.parametrize("unit", [FINE, COARSE])
def test_packed_polars_come_back_within_half_a_unit(
    polars: AttachedPolars, unit: FloatArray
) -> None:
    back = unpacked(packed("a b", polars, unit), "a b")
    differences = np.abs(back.coefficients - polars.coefficients)
    differences[:, :, 1] = np.abs(np.log(back.coefficients / polars.coefficients)[:, :, 1])
    assert (differences <= 0.5 * (1.0 + 1e-9) * unit[:, None, None]).all()
    np.testing.assert_array_equal(back.low, polars.low)
    np.testing.assert_array_equal(back.high, polars.high)


@pytest.mark.parametrize("wrong", [1.0, np.nan])
def test_what_does_not_fit_is_refused(polars: AttachedPolars, wrong: float) -> None:
    coefficients = polars.coefficients.copy()
    coefficients[1, 2, 2, 3, 5] = wrong  # of moment, whose unit is the smallest
    with pytest.raises(ValueError, match="coefficients of 'a b' are too large to be packed"):
        packed("a b", dataclasses.replace(polars, coefficients=coefficients), FINE)
