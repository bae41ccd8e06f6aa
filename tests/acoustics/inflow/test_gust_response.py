"""Closed forms of the gust response: limits, symmetries, smoothness."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy import special

from propmdao.acoustics.inflow import gust_response
from propmdao.acoustics.inflow.gust_response import fresnel, sears_squared

response_squared = jax.jit(gust_response.response_squared)
WITH_SLOPE = jax.jit(jax.value_and_grad(gust_response.response_squared))


def fresnel_of_scipy(x):
    sine, cosine = special.fresnel(np.sqrt(2 * np.asarray(x) / np.pi))
    return cosine - 1j * sine


def sears(k):
    """Sears' function by Bessel functions."""
    h0, h1 = special.hankel2(0, k), special.hankel2(1, k)
    theodorsen = h1 / (h1 + 1j * h0)
    return theodorsen * (special.j0(k) - 1j * special.j1(k)) + 1j * special.j1(k)


def decibels(power):
    return 10 * np.log10(np.asarray(power))


def reduced_frequency(kappa, mach, spanwise=0.0):
    beta2 = 1 - mach**2
    return kappa * beta2 / (mach * np.sqrt(1 - beta2 * spanwise**2))


def test_fresnel_integral_and_its_slope():
    x = np.geomspace(1e-8, 1e4, 300)
    value, slope = jax.jit(lambda x: jax.jvp(fresnel, (x,), (jnp.ones_like(x),)))(x)
    np.testing.assert_allclose(value, fresnel_of_scipy(x), atol=1e-7)
    exact = np.exp(-1j * x) / np.sqrt(2 * np.pi * x)
    np.testing.assert_allclose(slope[150:], exact[150:], atol=1e-5)


def test_sears_function():
    k = np.geomspace(1e-3, 1e3, 100)
    assert np.abs(decibels(sears_squared(k)) - decibels(np.abs(sears(k)) ** 2)).max() < 0.05


@pytest.mark.parametrize("mach", [0.05, 0.3, 0.6])
def test_slow_gusts_are_those_of_a_compact_dipole(mach):
    """Sears' lift with 1 / beta for compressibility, whatever the direction."""
    k, beta2 = reduced_frequency(0.01, mach), 1 - mach**2
    expected = decibels(np.abs(sears(k / beta2)) ** 2 / beta2)
    x, y = np.array([0.0, 0.7, -0.5]), np.array([0.0, 0.0, 0.6])
    np.testing.assert_allclose(decibels(response_squared(k, mach, x, y)), expected, atol=0.05)


@pytest.mark.parametrize("kappa", [0.6, 3.0, 40.0])
@pytest.mark.parametrize(("x", "y"), [(0.0, 0.0), (-0.6, 0.3), (0.5, -0.4)])
def test_fast_gusts_are_the_integral_of_the_pressure(kappa, x, y):
    """Leading edge of the half plane with one correction by the trailing edge, by quadrature."""
    mach = 0.3
    k, beta2 = reduced_frequency(kappa, mach, y), 1 - mach**2
    mu = mach * k / beta2
    nodes, weights = leggauss(300)
    u = (nodes + 1) / 2
    along, step = 2 * u**2 - 1, 2 * u * weights  # the root at the leading edge taken out
    phase = np.exp(-1j * (kappa - mu * mach) * (along + 1))
    pressure = 1 / np.sqrt(along + 1)
    pressure = pressure - (1 - (1 + 1j) * fresnel_of_scipy(2 * kappa * (1 - along))) / np.sqrt(2)
    pressure = pressure * phase / (np.pi * np.sqrt(np.pi * (k + beta2 * kappa)))
    lift = np.sum(pressure * np.exp(-1j * mu * along * (mach - x)) * step)
    got = float(response_squared(k, mach, x, y))
    assert got == pytest.approx(abs(lift) ** 2, rel=1e-5)


def test_oblique_gust_is_a_plane_one_at_another_mach_number():
    """Graham's rule: kappa for mu, K / beta^2 the same, |L|^2 beta^2 the same."""
    mach, y, k = 0.5, 0.6, 8.0
    beta2 = 1 - mach**2
    other = mach * np.sqrt(1 - beta2 * y**2)
    k_other = k * (1 - other**2) / beta2
    oblique = float(response_squared(k, mach, 0.0, y)) * beta2
    plane = float(response_squared(k_other, other, 0.0, 0.0)) * (1 - other**2)
    assert oblique == pytest.approx(plane, rel=1e-9)


@pytest.mark.parametrize("mach", [0.05, 0.3, 0.6])
def test_nothing_jumps_from_slow_to_fast(mach):
    def largest_step(kappa):
        k = reduced_frequency(kappa, mach)
        return np.abs(np.diff(decibels(response_squared(k, mach, 0.3, 0.1)))).max()

    fine = np.geomspace(0.05, 2.0, 2001)
    assert largest_step(fine) < 0.55 * largest_step(fine[::2])
    level = decibels(response_squared(reduced_frequency(fine, mach), mach, 0.0, 0.0))
    assert np.all(np.diff(level) < 0.0)  # faster gusts lift less, through the change as well


def test_directions_in_the_plate_are_finite_and_have_slopes():
    for x, y in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1 / np.sqrt(1 - 0.09))):
        value, slope = WITH_SLOPE(20.0, 0.3, x, y)
        assert np.isfinite(value) and value > 0.0 and np.isfinite(slope)
