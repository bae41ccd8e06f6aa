"""Order in time of a free wake: nodes in a flow whose paths are known."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import simpson

from propmdao.aerodynamics.wakes.free import FreeWakeState, free_filaments, moved

OMEGA = 10.0
# Axisymmetric, so that it is the same in axes of the blade at shedding: swirl, contraction, a
# descent that changes in time.
SWIRL, CONTRACTION, DESCENT, WAVE, STRETCH = 1.5, -0.8, 2.0, 7.0, 0.3
EDGE = np.array([[0.2, 0.05, 0.0], [0.5, 0.06, 0.01], [0.8, 0.07, 0.0], [1.0, 0.08, 0.0]])


def flow(nodes, time):
    x, y, z = jnp.moveaxis(nodes, -1, 0)
    down = STRETCH * z - DESCENT * (1.0 + 0.5 * jnp.sin(WAVE * time))
    return jnp.stack([CONTRACTION * x - SWIRL * y, SWIRL * x + CONTRACTION * y, down], axis=-1)


def exact(ages, time):
    """Displacement of nodes of some ages: the linear equations of their paths, solved."""
    age = ages[None, :] / OMEGA
    turn, shrink = np.exp(1j * SWIRL * age), np.exp(CONTRACTION * age)
    place = (EDGE[:, 0] + 1j * EDGE[:, 1])[:, None] * turn * shrink
    when = time - age + age * np.linspace(0.0, 1.0, 401)[:, None, None]
    down = -DESCENT * (1.0 + 0.5 * np.sin(WAVE * when)) * np.exp(STRETCH * (time - when))
    z = EDGE[:, 2:] * np.exp(STRETCH * age) + simpson(down, x=when, axis=0)
    nodes = np.stack([place.real, place.imag, np.broadcast_to(z, place.shape)], axis=-1)
    return nodes - EDGE[:, None, :]


def error_after_a_turn_and_a_half(step_deg, spacing_deg):
    spacing, step = np.radians(spacing_deg), np.radians(step_deg)
    ages = spacing * np.arange(round(360.0 / spacing_deg) + 1)
    free = free_filaments(jnp.asarray(EDGE), ages, 50.0, 0.03, 4)
    by_law = jnp.zeros((4, ages.size, 3))

    @jax.jit
    def go_on(state, time):
        velocity = flow(free.edge[:, None] + state.displacement, time)
        return moved(free, state, velocity, by_law, (step, step / OMEGA))

    state = FreeWakeState(by_law[None], by_law[None])
    n_steps = round(540.0 / step_deg)
    for number in range(n_steps):
        state = go_on(state, number * step / OMEGA)
    apart = np.asarray(state.displacement[0]) - exact(ages, n_steps * step / OMEGA)
    return np.abs(apart).max()


@pytest.mark.parametrize("steps_to_a_spacing", [1, 2])
def test_half_the_time_step_leaves_a_quarter_of_the_error(steps_to_a_spacing):
    coarse, fine = (
        error_after_a_turn_and_a_half(step, steps_to_a_spacing * step) for step in (10.0, 5.0)
    )
    assert fine < 5e-4  # of 1.3 turns' way down
    assert 1.8 < np.log2(coarse / fine) < 2.3


def test_with_nodes_that_stay_half_the_time_step_leaves_a_quarter_of_the_error():
    coarse, fine = (error_after_a_turn_and_a_half(step, 10.0) for step in (10.0, 5.0))
    assert 1.8 < np.log2(coarse / fine) < 2.3
