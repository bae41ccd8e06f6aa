"""Forward and reverse derivatives of the tones are exact, finite and small in memory."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.acoustics.sources.periodic import rotor_tones, tilted_tones
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.records.air import Air
from propmdao.records.loads import PeriodicLoads, PointLoads
from propmdao.records.panels import Panels
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

OBSERVERS = np.array([[1.2, 0.4, -1.3], [-0.5, 1.0, 0.7]])
N_HARMONICS = 4


def tone_function(rotor, n_harmonics=N_HARMONICS):
    """Make `tones` a function of all it can be differentiated by."""

    def function(panels, loads, rotation_speed, speed, density, sound_speed, observers):
        state = RotorState(rotation_speed, speed, Air(density=density, sound_speed=sound_speed))
        result = tones(panels, loads, rotor.n_blades, state, observers, n_harmonics)
        return result.parts["thickness"], result.parts["loading"]

    values = (rotor.panels, rotor.loads, rotor.rotation_speed, rotor.speed, rotor.density)
    values = (*values, rotor.sound_speed, jnp.asarray(OBSERVERS))
    return function, jax.tree.map(lambda q: jnp.asarray(q, float), values)


def direction(values, seed):
    """Change everything by about one part, so that no input hides behind another."""
    rng = np.random.default_rng(seed)
    return jax.tree.map(lambda q: q * rng.normal(size=q.shape), values)


@pytest.fixture(scope="module")
def rotor(slow_flyer):
    return slow_flyer.with_(rotation_speed=1300.0, speed=30.0)


@pytest.fixture(scope="module")
def forward(rotor):
    """Tones, and their derivatives along a direction."""
    function, _ = tone_function(rotor)
    return compiled(lambda values, way: jax.jvp(function, values, way), optimisation=0)


@pytest.mark.parametrize("index", range(7))
def test_forward_derivative_is_the_central_difference(rotor, forward, index):
    _, values = tone_function(rotor)
    only = jax.tree.map(jnp.zeros_like, values)
    only = (*only[:index], direction(values, 1)[index], *only[index + 1 :])
    actual = forward(values, only)[1]
    step = 1e-5
    ahead, _ = forward(jax.tree.map(lambda q, d: q + step * d, values, only), only)
    back, _ = forward(jax.tree.map(lambda q, d: q - step * d, values, only), only)
    for a, f, b in zip(actual, ahead, back, strict=True):
        difference = (f - b) / (2 * step)
        np.testing.assert_allclose(a, difference, rtol=1e-5, atol=1e-7 * np.abs(f).max())


def test_reverse_derivative_is_the_transpose_of_the_forward_one(rotor, forward):
    function, values = tone_function(rotor)
    rng = np.random.default_rng(2)
    shape = (len(OBSERVERS), N_HARMONICS)
    weights = tuple(rng.normal(size=shape) + 1j * rng.normal(size=shape) for _ in range(2))
    d = direction(values, 3)
    pull = compiled(lambda values, w: jax.vjp(function, *values)[1](w), optimisation=0)(
        values, tuple(jnp.asarray(w) for w in weights)
    )
    along = forward(values, d)[1]
    one = sum(np.sum(w * f).real for w, f in zip(weights, along, strict=True))
    other = sum(jax.tree.leaves(jax.tree.map(lambda g, q: jnp.sum(g * q), pull, d)))
    assert one == pytest.approx(float(other), rel=1e-11)


def test_jacobians_by_columns_and_by_rows_agree(rotor):
    """A component may ask for whole Jacobians, which maps the derivatives over many directions."""

    def levels(two):
        function, values = tone_function(rotor)
        thickness, loading = function(*values[:2], two[0], two[1], *values[4:])
        return oaspl_db(thickness + loading)

    two = jnp.array([1300.0, 30.0])
    columns, rows = compiled(
        lambda q: (jax.jacfwd(levels)(q), jax.jacrev(levels)(q)), optimisation=0
    )(two)
    assert columns.shape == (2, 2)
    np.testing.assert_allclose(columns, rows, rtol=1e-9)


@pytest.fixture(scope="module")
def level_slopes(rotor):
    """Derivatives of the level by everything."""
    function, _ = tone_function(rotor)
    return compiled(jax.grad(lambda q: oaspl_db(sum(function(*q))).sum()), optimisation=0)


@pytest.mark.parametrize("speed", [0.0, 30.0])
def test_a_rotor_at_rest_has_no_tones_and_finite_derivatives(rotor, forward, level_slopes, speed):
    _, values = tone_function(rotor.with_(rotation_speed=0.0, speed=speed))
    amplitudes, tangents = forward(values, direction(values, 4))
    for amplitude in amplitudes:
        assert not np.any(amplitude)
    gradient = level_slopes(values)
    for leaf in jax.tree.leaves((gradient, tangents)):
        assert np.all(np.isfinite(leaf))


def test_reverse_derivative_of_a_full_surface_at_nine_observers_needs_megabytes(slow_flyer):
    n = 5200
    surface = Panels(jnp.ones((n, 3)), jnp.ones((n, 3)))
    function, values = tone_function(slow_flyer, n_harmonics=10)
    values = (surface, PointLoads(jnp.ones((400, 3)), jnp.ones((400, 3))), *values[2:6])
    values = (*values, jnp.asarray(arc(1.905, np.linspace(-45, 45, 9))))

    def pull_back(values, weights):
        return jax.vjp(function, *values)[1](weights)

    weights = (jnp.ones((9, 10), complex),) * 2
    workspace = jax.jit(pull_back).lower(values, weights).compile().memory_analysis()
    assert workspace.temp_size_in_bytes < 64 * 2**20  # 14 MiB; one observer unrolled takes 64


@pytest.fixture(scope="module")
def changing(slow_flyer):
    """Loads that follow the sine and cosine of the azimuth."""
    psi = 2 * np.pi * np.arange(12) / 12
    change = 1 + 0.3 * np.cos(psi) - 0.2 * np.sin(2 * psi)
    force = jnp.asarray(change[:, None, None] * slow_flyer.loads.force)
    return PeriodicLoads(slow_flyer.loads.position, force)


def test_tones_that_can_be_traced_are_those_of_any_rotor(rotor, changing):
    n_blades, air = rotor.n_blades, Air()
    state = RotorState(rotor.rotation_speed, 20.0, air, np.radians(70.0))
    ours = tilted_tones(rotor.panels, changing, n_blades, state, OBSERVERS, N_HARMONICS)
    blades = Rotor(equally_spaced(n_blades), rotor.rotation_speed, rotor.panels, changing)
    velocity = float(state.edgewise_speed), 0.0, float(state.axial_speed)
    theirs = rotor_tones(blades, velocity, air, OBSERVERS, N_HARMONICS)
    np.testing.assert_allclose(ours.frequency_hz, theirs.frequency_hz, rtol=1e-12)
    for name, pressure in theirs.parts.items():
        largest = np.abs(pressure).max()
        np.testing.assert_allclose(ours.parts[name], pressure, rtol=0.0, atol=1e-12 * largest)
        assert largest > 0.0
    still = state.turning(0.0)
    quiet = tilted_tones(rotor.panels, changing, n_blades, still, OBSERVERS, N_HARMONICS)
    assert not np.any(quiet.total) and not np.any(quiet.frequency_hz)


@pytest.mark.slow  # half a minute of compilation
def test_derivatives_of_tones_at_an_incidence(rotor, changing):
    weights = np.random.default_rng(6).normal(size=(2, len(OBSERVERS), N_HARMONICS))

    def weighted(values):
        panels, loads, omega, speed, incidence, sound_speed, observers = values
        state = RotorState(omega, speed, Air(sound_speed=sound_speed), incidence)
        sound = tilted_tones(panels, loads, rotor.n_blades, state, observers, N_HARMONICS)
        parts = (sound.parts["thickness"] * 1e2, sound.parts["loading"])
        return sum((weights[0] * p.real + weights[1] * p.imag).sum() for p in parts)

    values = (rotor.panels, changing, rotor.rotation_speed, 20.0, 1.2, 340.0, OBSERVERS)
    values = jax.tree.map(lambda q: jnp.asarray(q, float), values)
    gradient = jax.jit(jax.grad(weighted))(values)
    value = jax.jit(weighted)
    for index in range(len(values)):
        only = jax.tree.map(jnp.zeros_like, values)
        only = (*only[:index], direction(values, 7)[index], *only[index + 1 :])
        along = sum(jax.tree.leaves(jax.tree.map(lambda g, q: jnp.sum(g * q), gradient, only)))
        # Of fourth order: the step may be large enough that no rounding shows, even along the
        # incidence, by which the weighted pressures change by a ten-thousandth of themselves.
        step = 1e-3
        near, far = (
            value(jax.tree.map(lambda q, d, h=h: q + h * d, values, only))
            - value(jax.tree.map(lambda q, d, h=h: q - h * d, values, only))
            for h in (step, 2.0 * step)
        )
        slope = (8.0 * near - far) / (12.0 * step)
        assert float(slope) == pytest.approx(float(along), rel=1e-6)
