"""A plate in turbulence against closed forms, and against itself in other words."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.inflow import plate as plates
from propmdao.acoustics.inflow.plate import upwash_spectrum
from propmdao.records.air import Air, Turbulence, require_turbulence

inflow_noise = jax.jit(plates.inflow_noise)
AIR = Air(density=1.225, sound_speed=340.0)
PLATE = Section(*(jnp.asarray(v, float) for v in (0.1, 0.3, 40.0, 0.0, 0.0, 0.0)))
GRID = Turbulence(1.8, 0.01)
BANDS = third_octave_centers(100.0, 20e3)


def noise(plate=PLATE, turbulence=GRID, sight=(0.0, 0.0, 1.5), approach=1.0, bands=BANDS):
    return np.asarray(inflow_noise(bands, plate, turbulence, sight, approach, AIR))


def decibels(power):
    return 10 * np.log10(np.asarray(power))


def test_spectrum_holds_the_energy_and_the_length_of_the_turbulence():
    k = np.geomspace(1e-3, 1e8, 4001)
    of_k = np.asarray(upwash_spectrum(0.0, k, GRID))
    energy = np.trapezoid(2 * np.pi * k * of_k, k)  # all directions of the plane
    assert energy == pytest.approx(1.8**2, rel=1e-3)
    # One-dimensional spectrum of the normal velocity at no wavenumber: half the length / pi.
    assert 2 * np.trapezoid(of_k, k) == pytest.approx(1.8**2 * 0.01 / (2 * np.pi), rel=1e-3)


def test_fast_gusts_are_those_of_amiets_simple_formula():
    """SPL = 10 log[L d M^5 (u / U)^2 K^3 (1 + K^2)^(-7/3) / z^2] + 181.3 in a third octave.

    R. K. Amiet (1975), with the semi-span d and K = kx / ke: overhead, both edges apart. Ripples of
    the chord's interference, of 2 dB, are over and below it.
    """
    plate = dataclasses.replace(PLATE, chord=jnp.asarray(0.5))
    bands = third_octave_centers(5e3, 80e3)
    wavenumber = 2 * np.pi * bands / 40.0 * 0.01 / 0.7468
    shape = wavenumber**3 * (1 + wavenumber**2) ** (-7 / 3)
    simple = decibels(0.01 * 0.15 * (40 / 340) ** 5 * (1.8 / 40) ** 2 * shape / 1.5**2) + 181.3
    error = decibels(noise(plate, bands=bands) / 4e-10) - simple
    assert abs(error.mean()) < 0.3 and np.abs(error).max() < 2.0


def test_compact_plate_in_slow_gusts_is_a_dipole_of_its_lift():
    """Quasi-steady lift pi rho U c w per span, of all eddies along it, as a point dipole."""
    band, span = np.array([5.0]), 0.3
    omega, u = 2 * np.pi * band, 40.0
    spectrum = np.asarray(upwash_spectrum(omega / u, 0.0, GRID)) * 2 * np.pi  # over all ky
    lift = (np.pi * 1.225 * u * 0.1) ** 2 * spectrum * span / u  # two-sided in omega
    pressure = (omega / (4 * np.pi * 340.0 * 1.5)) ** 2 * lift / (1 - (u / 340) ** 2) ** 3
    expected = decibels(4 * np.pi * pressure * band * (10**0.05 - 10**-0.05))
    sears = decibels(1 / (2 * np.pi * 0.0393 + 1 / (1 + 2.4 * 0.0393)))
    got = decibels(noise(bands=band, approach=np.sqrt(1 - (u / 340) ** 2)))
    assert got == pytest.approx(expected + sears, abs=0.05)


def test_twice_the_span_distance_and_intensity():
    np.testing.assert_allclose(
        noise(dataclasses.replace(PLATE, span=jnp.asarray(0.6))), 2 * noise(), rtol=1e-12
    )
    np.testing.assert_allclose(noise(sight=(0.6, 0.4, 2.0)) * 4, noise(sight=(0.3, 0.2, 1.0)))
    np.testing.assert_allclose(noise(turbulence=Turbulence(3.6, 0.01)), 4 * noise(), rtol=1e-12)


def test_suction_and_pressure_side_hear_the_same_and_the_plane_hears_nothing():
    for up, down in (((0.5, 0.2, 1.0), (0.5, 0.2, -1.0)), ((0.5, 0.2, 1.0), (0.5, -0.2, 1.0))):
        np.testing.assert_allclose(noise(sight=up), noise(sight=down), rtol=1e-12)
    assert not np.any(noise(sight=(0.5, 0.2, 0.0)))


def test_without_turbulence_there_is_silence_even_without_a_length_and_at_rest():
    assert not np.any(noise(turbulence=Turbulence()))
    still = dataclasses.replace(PLATE, speed=jnp.asarray(0.0), chord=jnp.asarray(0.0))
    assert np.all(np.isfinite(noise(still)))


def test_derivatives_are_those_of_the_values():
    def loudness(chord, speed, intensity, length, height):
        plate = dataclasses.replace(PLATE, chord=chord, speed=speed)
        sight = 0.3, 0.4, height
        turbulence = Turbulence(intensity, length)
        power = plates.inflow_noise(BANDS[::3], plate, turbulence, sight, 1.02, AIR)
        return jnp.sum(jnp.log(power))

    at = np.array([0.1, 40.0, 1.8, 0.01, 1.5])
    value = jax.jit(lambda q: loudness(*q))
    slopes = jax.jit(jax.grad(lambda q: loudness(*q)))(at)
    for i, step in enumerate(1e-6 * at):
        change = np.eye(5)[i] * step
        difference = (float(value(at + change)) - float(value(at - change))) / (2 * step)
        assert float(slopes[i]) == pytest.approx(difference, rel=1e-5)


@pytest.mark.parametrize(
    ("turbulence", "words"),
    [
        (Turbulence(-1.0, 0.1), "turbulence_intensity must be within 0 ... 100 m/s; it is -1"),
        (Turbulence(1.0, -0.1), "turbulence_length_scale must be 0 or within 1e-05 ... 10000 m"),
        (Turbulence(1.0), "turbulence_length_scale must be above 0 m where there is"),
    ],
)
def test_turbulence_that_there_is_not(turbulence, words):
    with pytest.raises(ValueError, match=words):
        require_turbulence(turbulence)
