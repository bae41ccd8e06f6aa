"""The report's formulas with their switches as printed, against the rounded ones of the product.

Numbers in the bounds are the rounding that the docstrings promise.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband import shedding_spectra, turbulent_spectra
from propmdao.acoustics.broadband.boundary_layer import boundary_layer

log10 = np.log10
RE = 10 ** np.linspace(4.3, 6.5, 4001)
DEGREES = np.linspace(0.21, 25.0, 4001)
X = np.linspace(-1.2, 1.2, 4001)


def piecewise(x, *pieces):
    """Take (upper end, values) in turn."""
    return np.select([x < end for end, _ in pieces[:-1]], [v for _, v in pieces[:-1]], pieces[-1])


@pytest.mark.parametrize("trip", ["none", "heavy"])
def test_suction_side_thickens_as_printed(trip):
    layer = boundary_layer(1.0, 1.0, np.radians(DEGREES), 1e-6, trip)
    flat = boundary_layer(1.0, 1.0, 1e-12, 1e-6, trip)
    a = DEGREES
    if trip == "none":
        delta = piecewise(
            a,
            (7.5, 10 ** (0.03114 * a)),
            (12.5, 0.0303 * 10 ** (0.2336 * a)),
            12 * 10 ** (0.0258 * a),
        )
        star = piecewise(
            a,
            (7.5, 10 ** (0.0679 * a)),
            (12.5, 0.0162 * 10 ** (0.3066 * a)),
            52.42 * 10 ** (0.0258 * a),
        )
        theta = piecewise(
            a,
            (7.5, 10 ** (0.0559 * a)),
            (12.5, 0.0633 * 10 ** (0.2157 * a)),
            14.977 * 10 ** (0.0258 * a),
        )
    else:
        delta = piecewise(
            a,
            (5.0, 10 ** (0.0311 * a)),
            (12.5, 0.3468 * 10 ** (0.1231 * a)),
            5.718 * 10 ** (0.0258 * a),
        )
        star = piecewise(
            a,
            (5.0, 10 ** (0.0679 * a)),
            (12.5, 0.381 * 10 ** (0.1516 * a)),
            14.296 * 10 ** (0.0258 * a),
        )
        theta = piecewise(
            a,
            (5.0, 10 ** (0.0559 * a)),
            (12.5, 0.6984 * 10 ** (0.0869 * a)),
            4.0846 * 10 ** (0.0258 * a),
        )
    at_zero = 10 ** np.array([-0.1 * 0.0311, -0.1 * 0.0679, -0.1 * 0.0559])  # |0| is 0.1 deg
    for got, zero, printed, shift in (
        (layer.thickness_suction, flat.thickness_suction, delta, at_zero[0]),
        (layer.displacement_suction, flat.displacement_suction, star, at_zero[1]),
        (layer.momentum_suction, flat.momentum_suction, theta, at_zero[2]),
    ):
        error = np.asarray(got) / (np.asarray(zero) * shift) / printed - 1
        assert np.abs(error).max() < 0.042
        away = (
            (np.abs(a - 5) > 0.3) & (np.abs(a - 7.5) > 0.3) & (np.abs(a - 12.5) > 0.3) & (a < 24.7)
        )
        assert np.abs(error[away]).max() < 0.006  # the report's own steps


def shape(x, low, high, factor):
    return low(np.abs(x)) + factor * (high(np.abs(x)) - low(np.abs(x)))


def a_min(x):
    arc = np.sqrt(np.maximum(67.552 - 886.788 * x**2, 0)) - 8.219
    tail = -142.795 * x**3 + 103.656 * x**2 - 57.757 * x + 6.006
    return piecewise(x, (0.204, arc), (0.244, -32.665 * x + 3.981), tail)


def a_max(x):
    arc = np.sqrt(np.maximum(67.552 - 886.788 * x**2, 0)) - 8.219
    tail = -4.669 * x**3 + 3.491 * x**2 - 16.699 * x + 1.149
    return piecewise(x, (0.13, arc), (0.321, -15.901 * x + 1.098), tail)


def b_min(x):
    arc = np.sqrt(np.maximum(16.888 - 886.788 * x**2, 0)) - 4.109
    tail = -817.81 * x**3 + 355.21 * x**2 - 135.024 * x + 10.619
    return piecewise(x, (0.13, arc), (0.145, -83.607 * x + 8.138), tail)


def b_max(x):
    arc = np.sqrt(np.maximum(16.888 - 886.788 * x**2, 0)) - 4.109
    tail = -80.541 * x**3 + 44.174 * x**2 - 39.381 * x + 2.344
    return piecewise(x, (0.10, arc), (0.187, -31.33 * x + 1.854), tail)


@pytest.mark.parametrize("reynolds", [2e4, 9e4, 1.1e5, 2e5, 5e5, 1e6])
def test_shapes_a_and_b(reynolds):
    # The shapes themselves are the report's; only the factor's lower corner is not, by 0.005 in a0.
    rest = (reynolds - 8.57e5) ** 2
    a0 = float(piecewise(reynolds, (9.52e4, 0.57), (8.57e5, -9.57e-13 * rest + 1.13), 1.13))
    b0 = float(piecewise(reynolds, (9.52e4, 0.30), (8.57e5, -4.48e-13 * rest + 0.56), 0.56))
    for low, high, x, product in (
        (a_min, a_max, a0, turbulent_spectra.SHAPE_A),
        (b_min, b_max, b0, turbulent_spectra.SHAPE_B),
    ):
        printed_factor = (-20 - low(x)) / (high(x) - low(x))
        got_factor = product.interpolation(jnp.asarray(reynolds))
        assert float(got_factor) == pytest.approx(printed_factor, abs=0.03)
        got = np.asarray(product.level(jnp.asarray(X), jnp.asarray(printed_factor)))
        assert np.abs(got - shape(X, low, high, printed_factor)).max() < 0.01


def test_amplitude_k1():
    x = log10(RE)
    printed = piecewise(RE, (2.47e5, -4.31 * x + 156.3), (8e5, -9 * x + 181.6), 128.5)
    assert np.abs(np.asarray(turbulent_spectra.amplitude_k1(x)) - printed).max() < 0.06


def test_pressure_side_correction():
    re = 10 ** np.linspace(1.5, 4.5, 2001)
    for degrees in (1.0, 5.0):
        printed = np.where(re < 5000, degrees * (1.43 * log10(re) - 5.29), 0.0)
        got = turbulent_spectra.pressure_side_correction(log10(re), degrees)
        assert np.abs(np.asarray(got) - printed).max() < 0.02 * degrees


@pytest.mark.parametrize("mach", [0.05, 0.1, 0.2, 0.4])
def test_separation_amplitude_within_the_ellipse(mach):
    gamma, gamma_0 = 27.094 * mach + 3.31, 23.43 * mach + 4.651
    beta, beta_0 = 72.65 * mach + 10.74, -34.19 * mach - 13.82
    a = np.linspace(gamma_0 - 0.985 * gamma, gamma_0 + 0.8 * gamma, 1001)
    printed = np.sqrt(beta**2 - (beta / gamma) ** 2 * (a - gamma_0) ** 2) + beta_0
    got = np.asarray(turbulent_spectra.separation_amplitude(jnp.asarray(mach), a))
    kept = printed > -11  # beyond the stall not below -12
    assert np.abs(got - printed)[kept | (a < gamma_0)].max() < 0.15
    far = turbulent_spectra.separation_amplitude(jnp.asarray(mach), gamma_0 + 1.2 * gamma)
    assert float(far) == -12.0
    at_the_step = turbulent_spectra.separation_amplitude(jnp.asarray(mach), gamma_0 - gamma)
    assert 0 < float(at_the_step) - beta_0 < 0.1 * beta
    assert float(at_the_step) < -14


def test_laminar_shapes():
    e = 10**X
    printed = piecewise(
        e,
        (0.5974, 39.8 * X - 11.12),
        (0.8545, 98.409 * X + 2.0),
        (1.17, -5.076 + np.sqrt(np.maximum(2.484 - 506.25 * X**2, 0))),
        (1.674, -98.409 * X + 2.0),
        -39.8 * X - 11.12,
    )
    assert np.abs(np.asarray(shedding_spectra.laminar_shape(X)) - printed).max() < 0.16
    for a in (0.5, 2.0, 5.0):
        d = log10(RE) - log10(10 ** (0.215 * a + 4.978) if a <= 3 else 10 ** (0.12 * a + 5.263))
        printed = piecewise(
            10**d,
            (0.3237, 77.852 * d + 15.328),
            (0.5689, 65.188 * d + 9.125),
            (1.7579, -114.052 * d**2),
            (3.0889, -65.188 * d + 9.125),
            -77.852 * d + 15.328,
        )
        got = np.asarray(shedding_spectra.laminar_reynolds_level(log10(RE), a))
        assert np.abs(got - printed).max() < 0.05
        peak = piecewise(RE, (1.3e5, 0.18), (4e5, 0.001756 * RE**0.3931), 0.28) * 10 ** (-0.04 * a)
        got = np.asarray(shedding_spectra.laminar_strouhal_peak(log10(RE), a))
        assert np.abs(10**got / peak - 1).max() < 0.004


def g5(eta, ratio):
    """Program of the report, page 133."""
    mu = piecewise(
        ratio,
        (0.25, 0.1211),
        (0.62, -0.2175 * ratio + 0.1755),
        (1.15, -0.0308 * ratio + 0.0596),
        0.0242,
    )
    m = piecewise(
        ratio,
        (0.02, 0.0),
        (0.5, 68.724 * ratio - 1.35),
        (0.62, 308.475 * ratio - 121.23),
        (1.15, 224.811 * ratio - 69.354),
        (1.2, 1583.28 * ratio - 1631.592),
        268.344,
    )
    eta_0 = -np.sqrt(m**2 * mu**4 / (6.25 + m**2 * mu**2))
    k = 2.5 * np.sqrt(1 - (eta_0 / mu) ** 2) - 2.5 - m * eta_0
    return np.select(
        [eta <= eta_0, eta <= 0, eta <= 0.03616],
        [
            m * eta + k,
            2.5 * np.sqrt(np.maximum(1 - (eta / mu) ** 2, 0)) - 2.5,
            np.sqrt(np.maximum(1.5625 - 1194.99 * eta**2, 0)) - 1.25,
        ],
        -155.543 * eta + 4.375,
    )


@pytest.mark.parametrize("edge_degrees", [0.0, 7.0, 14.0])
@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.45, 0.7, 1.0, 1.4, 3.0])
def test_bluntness_shape_and_levels(ratio, edge_degrees):
    eta = np.linspace(-0.3, 0.15, 2001)
    wedge, plate = g5(eta, ratio), g5(eta, 6.724 * ratio**2 - 4.019 * ratio + 1.107)
    printed = plate + 0.0714 * edge_degrees * (wedge - plate)
    printed = np.minimum(np.minimum(printed, 0.0), g5(eta, 0.25))
    got = shedding_spectra.blunt_shape(
        eta,
        shedding_spectra.blunt_curve(jnp.asarray(ratio)),
        shedding_spectra.blunt_curve(shedding_spectra.plate_ratio(jnp.asarray(ratio))),
        edge_degrees,
    )
    heard = printed > -30
    assert np.abs(np.asarray(got) - printed)[heard].max() < 0.4
    assert np.median(np.abs(np.asarray(got) - printed)[heard]) < 0.02

    inverse = 1 / ratio
    peak = (0.212 - 0.0045 * edge_degrees) / (1 + 0.235 * inverse - 0.0132 * inverse**2)
    if ratio < 0.2:
        peak = 0.1 * ratio + 0.095 - 0.00243 * edge_degrees
    got_peak = float(shedding_spectra.blunt_strouhal_peak(jnp.asarray(ratio), edge_degrees))
    assert got_peak == pytest.approx(peak, rel=1e-12)
    level = 17.5 * log10(ratio) + 157.5 - 1.114 * edge_degrees
    assert float(shedding_spectra.blunt_level(ratio, edge_degrees)) == pytest.approx(
        level, abs=0.05
    )
