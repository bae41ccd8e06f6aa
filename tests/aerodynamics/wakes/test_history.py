"""What the wake remembers: the weights on the circulation of the period."""

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.vortices.cores import middles
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.aerodynamics.wakes.history import history_weights, shedding_delay
from propmdao.records.wake_law import WakeGrid
from propmdao.runtime.compilation import compiled

N, B = 36, 3
DELAY = jnp.array([0.0, 0.07])
AGES = jnp.asarray(wake_azimuths(WakeGrid(1.5, 0.25, 1.25, 10.0)))


@pytest.fixture(scope="module")
def weights():
    weights = compiled(history_weights, static_argnums=(2, 3), optimisation=0)
    return weights(AGES, DELAY, N, B)


def test_constant_circulation_is_trailed_and_sheds_nothing(weights):
    trailing, shed = weights
    np.testing.assert_allclose(trailing.sum(axis=1), 1.0, atol=1e-13)
    np.testing.assert_allclose(shed.sum(axis=1), 0.0, atol=1e-13)


def test_trailing_segments_have_what_their_blade_had_when_it_shed_them(weights):
    azimuth = 2 * np.pi / N * np.arange(N)
    age = np.asarray(middles(AGES)) + np.asarray(DELAY)[:, None, None]
    then = 2 * np.pi / B * np.arange(B)[:, None] - age
    read = np.einsum("snc,n->sc", weights[0], np.cos(azimuth)).reshape(DELAY.size, B, -1)
    # The cubic's error on cos: 3/128 of the step to the fourth.
    np.testing.assert_allclose(read, np.cos(then), atol=1.1 * 3 / 128 * (2 * np.pi / N) ** 4)


def test_shed_circulation_adds_up_to_the_change_since_then(weights):
    circulation = np.random.default_rng(0).normal(size=N)
    ring, shed = (
        np.einsum("snc,n->sc", w, circulation).reshape(DELAY.size, B, -1) for w in weights
    )
    now = circulation[N // B * np.arange(B)]
    np.testing.assert_allclose(np.cumsum(shed, axis=-1), ring - now[:, None], atol=1e-12)


def test_a_wake_that_goes_on_with_the_step_of_the_lattice_is_half_a_panel_older():
    panel = jnp.array([0.02, 0.05])
    np.testing.assert_allclose(shedding_delay(panel, panel), 0.5 * panel, rtol=1e-12)


@pytest.mark.parametrize("fine", [1, 4, 64])
def test_a_constant_sheet_induces_nothing_at_the_last_collocation_point(fine):
    # Last bound vortex at -1/2, first shed one at 1/2, the others a step apart, up to x = 40.
    step = 1.0 / fine
    delay = float(shedding_delay(jnp.array([1.0]), jnp.array([step]))[0])
    behind = 0.5 + step * np.arange(1, int(39.5 * fine))
    end = behind[-1] + 0.5 * step
    upstream = -1.0 / 0.5 - (1.0 / (np.arange(1, 40) + 0.5)).sum()
    downstream = (delay + 0.5 * step) / 0.5 + (step / behind).sum()
    # The vortices upstream are those of a midpoint rule, whose own error is 0.03 of 2.
    assert upstream + downstream == pytest.approx(np.log(end / 40.0), abs=0.04)
