"""The fast sums against the plain ones."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.sources.harmonic_sums import cos_sin, harmonic_sums

RNG = np.random.default_rng(0)


def test_cosine_and_sine_to_the_last_digits():
    quarters = np.arange(-40, 41) * np.pi / 4
    angle = np.concatenate([RNG.uniform(-100, 100, 10000), quarters, quarters + 1e-9])
    cosine, sine = cos_sin(jnp.asarray(angle))
    np.testing.assert_allclose(cosine, np.cos(angle), rtol=0, atol=4e-16)
    np.testing.assert_allclose(sine, np.sin(angle), rtol=0, atol=4e-16)


def test_cosine_and_sine_of_a_distant_observer():
    angle = RNG.uniform(0, 1e6, 10000)
    cosine, sine = cos_sin(jnp.asarray(angle))
    np.testing.assert_allclose(cosine, np.cos(angle), rtol=0, atol=4e-16)
    np.testing.assert_allclose(sine, np.sin(angle), rtol=0, atol=4e-16)


def test_derivative_of_cosine_and_sine():
    angle = jnp.asarray(RNG.uniform(-9, 9, 50))
    d_cosine, d_sine = jax.jvp(cos_sin, (angle,), (jnp.full(50, 2.0),))[1]
    np.testing.assert_allclose(d_cosine, -2 * np.sin(angle), atol=1e-15)
    np.testing.assert_allclose(d_sine, 2 * np.cos(angle), atol=1e-15)


@pytest.fixture
def sources():
    return tuple(jnp.asarray(RNG.normal(size=(3, 40))) for _ in range(2))


def plain(strength, angle):
    turns = [strength * jnp.exp(1j * m * angle) for m in (1, 2, 3)]
    return jnp.stack([jnp.sum(turn, axis=-1) for turn in turns], axis=-1)


def test_sums_are_the_plain_sums(sources):
    np.testing.assert_allclose(harmonic_sums(*sources, 3), plain(*sources), rtol=1e-12)


def test_forward_and_reverse_derivatives_are_those_of_the_plain_sums(sources):
    tangents = tuple(jnp.asarray(RNG.normal(size=(3, 40))) for _ in range(2))
    weights = jnp.asarray(RNG.normal(size=(3, 3)) + 1j * RNG.normal(size=(3, 3)))

    def fast(*q):
        return harmonic_sums(*q, 3)

    np.testing.assert_allclose(
        jax.jvp(fast, sources, tangents)[1], jax.jvp(plain, sources, tangents)[1], rtol=1e-11
    )
    for a, b in zip(
        jax.vjp(fast, *sources)[1](weights), jax.vjp(plain, *sources)[1](weights), strict=True
    ):
        np.testing.assert_allclose(a, b, rtol=1e-11, atol=1e-12)


def test_mapped_over_an_axis_of_some_arguments(sources):
    strength, angle = sources
    mapped = jax.vmap(lambda a: harmonic_sums(strength[0], a, 3), in_axes=1)(angle.T)
    for row in range(3):
        np.testing.assert_allclose(
            mapped[row], harmonic_sums(strength[0], angle[row], 3), rtol=1e-12
        )
