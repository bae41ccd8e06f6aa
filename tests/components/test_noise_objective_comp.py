"""NoiseObjectiveComp: mean square, maximum, bounds between them, derivatives."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose
from openmdao.utils.assert_utils import assert_check_partials

from propmdao.acoustics.levels.decibels import energy_sum_db
from propmdao.components import NoiseObjectiveComp

LEVELS = np.array([52.0, 58.5, 40.0, 57.0])


def problem(levels, **options):
    prob = om.Problem(reports=False)
    shape = np.shape(levels)
    prob.model.add_subsystem("comp", NoiseObjectiveComp(shape=shape, **options), promotes=["*"])
    prob.setup(force_alloc_complex=True)
    prob.set_val("level_db", levels)
    prob.run_model()
    return prob


def soft_maximum(levels, **options):
    return problem(levels, **options).get_val("soft_maximum_db")[0]


def test_exponent_one_is_the_level_of_the_mean_square():
    assert_allclose(
        soft_maximum(LEVELS, exponent=1), energy_sum_db(LEVELS) - 10.0 * np.log10(LEVELS.size)
    )


@pytest.mark.parametrize("exponent", [1, 8.0, 40.0])
def test_equal_levels_give_that_level(exponent):
    assert_allclose(soft_maximum(np.full(5, 47.3), exponent=exponent), 47.3, rtol=1e-14)


def test_it_rises_to_the_maximum_with_the_exponent():
    exponent = np.array([1.0, 2.0, 4.0, 8.0, 16.0, 1e3, 1e6])
    levels = np.array([soft_maximum(LEVELS, exponent=p) for p in exponent])
    assert (np.diff(levels) > 0.0).all()
    assert (LEVELS.max() - levels <= 10.0 * np.log10(LEVELS.size) / exponent + 1e-9).all()
    assert_allclose(levels[-1], LEVELS.max(), atol=1e-5)


def test_adding_a_decibel_to_all_adds_a_decibel():
    assert_allclose(soft_maximum(LEVELS + 1.0) - soft_maximum(LEVELS), 1.0, rtol=1e-12)


def test_silence_and_thunder_overflow_nothing():
    assert_allclose(soft_maximum([-200.0, -200.0], exponent=100.0), -200.0)
    assert_allclose(soft_maximum([190.0, -200.0], exponent=100.0), 190.0, atol=0.1)


def test_operating_points_by_microphones_are_one_set():
    table = LEVELS.reshape(2, 2)
    assert soft_maximum(table) == soft_maximum(LEVELS)


@pytest.mark.parametrize("exponent", [1.0, 8.0])
def test_partials_are_exact_where_two_microphones_are_equally_loud(exponent):
    prob = problem([[58.0, 58.0], [57.9, 30.0]], exponent=exponent)
    data = prob.check_partials(method="cs", compact_print=True, out_stream=None)
    assert_check_partials(data, atol=1e-13, rtol=1e-12)


def test_an_exponent_below_one_is_refused():
    with pytest.raises(ValueError, match="exponent must be at least 1 and finite; it is 0.5"):
        problem(LEVELS, exponent=0.5)
