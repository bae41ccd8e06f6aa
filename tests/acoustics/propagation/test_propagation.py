"""Absorption by the air against the standard's table; the ground as a mirror."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.test_util import check_grads

from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.acoustics.propagation.absorption import absorb, absorb_tones, absorption_db_per_m
from propmdao.acoustics.propagation.reflection import mirrored, on_hard_ground
from propmdao.acoustics.signals import Tones
from propmdao.records.air import Air

# ISO 9613-1:1993, table 1: degrees Celsius, relative humidity in %, nominal frequency, dB/km
TABLE_1 = """
-20 10 50 5.89e-1, -20 70 50 1.25e-1, -20 100 50 9.92e-2, -20 10 125 1.20, -20 15 125 1.43,
-20 30 125 1.28, -20 70 125 5.14e-1, -20 100 125 3.44e-1, -20 10 1000 1.65, -20 15 1000 2.34,
-20 50 1000 9.14, -20 70 1000 1.15e1, -20 100 1000 1.11e1, -20 10 4000 3.86, -20 50 4000 1.32e1,
-20 70 4000 2.02e1, -20 100 4000 3.14e1, -20 10 8000 1.09e1, -20 70 8000 2.78e1,
-20 100 8000 4.11e1, -15 10 1000 2.67, -15 50 1000 1.32e1, -15 70 1000 1.21e1, -15 10 4000 4.92,
-15 70 4000 3.79e1, -10 10 125 1.86, -10 70 125 3.32e-1, -10 10 1000 4.65, -10 50 1000 1.29e1,
-10 100 1000 5.91, -10 10 8000 1.42e1, -10 70 8000 8.62e1, -5 10 1000 8.29,
-5 50 1000 9.68, -5 70 1000 6.38, -5 10 4000 1.11e1, -5 70 4000 6.50e1, 0 10 125 1.30,
0 30 125 4.69e-1, 0 70 125 3.90e-1, 0 100 125 3.54e-1, 0 10 1000 1.40e1, 0 15 1000 1.83e1,
0 20 1000 1.77e1, 0 50 1000 6.83, 0 70 1000 4.64, 0 100 1000 3.37, 0 10 4000 1.90e1,
0 10 8000 2.64e1, 5 10 1000 2.00e1, 5 50 1000 5.08, 5 70 1000 3.80, 10 10 125 7.88e-1,
10 70 125 4.11e-1, 10 10 1000 2.16e1, 10 20 1000 1.10e1, 10 50 1000 4.26, 10 70 1000 3.66,
10 100 1000 3.55, 10 10 4000 5.73e1, 10 70 4000 3.28e1, 10 100 4000 2.35e1, 10 10 8000 6.94e1,
15 10 1000 1.84e1, 15 70 1000 4.08, 15 10 4000 8.73e1, 15 70 4000 2.64e1, 20 10 50 2.70e-1,
20 80 50 5.01e-2, 20 100 50 4.03e-2, 20 10 100 6.22e-1, 20 50 100 2.94e-1,
20 100 100 1.58e-1, 20 10 125 7.76e-1, 20 50 125 4.45e-1, 20 70 125 3.39e-1, 20 100 125 2.47e-1,
20 10 160 9.65e-1, 20 70 160 5.18e-1, 20 10 200 1.22, 20 70 200 7.76e-1, 20 100 200 5.91e-1,
20 10 1000 1.41e1, 20 70 1000 4.98, 20 80 1000 5.15, 20 100 1000 5.42, 20 10 4000 1.09e2,
20 100 4000 1.94e1, 20 15 6300 1.75e2, 20 80 10000 1.05e2, 25 10 1000 1.07e1, 25 70 1000 6.19,
25 100 1000 6.47, 30 10 125 9.58e-1, 30 70 125 2.56e-1, 30 10 1000 8.67, 30 50 1000 7.03,
30 70 1000 7.41, 30 100 1000 7.17, 30 10 4000 9.60e1, 30 70 4000 2.31e1, 30 100 4000 2.40e1,
35 10 1000 7.71, 35 70 1000 8.30, 40 10 1000 7.68, 40 70 1000 8.66, 50 10 100 5.84e-1,
50 70 100 9.13e-2, 50 10 1000 9.95, 50 50 1000 1.00e1, 50 70 1000 8.03, 50 100 1000 6.05,
50 10 4000 4.64e1, 50 70 4000 4.82e1, 50 10 8000 1.55e2, 50 70 8000 8.03e1,
-20 100 10000 4.70e1, 0 100 6300 8.80e1,
0 20 2000 3.46e1, 10 50 4000 4.67e1, 15 100 10000 1.05e2, 20 50 1000 4.66, 20 50 2000 9.86,
25 100 2000 1.14e1, 30 50 4000 2.45e1, 45 50 800 7.16, 50 50 2000 2.48e1
"""


# ISO 9613-2:1996, table 2: degrees Celsius, relative humidity in %, dB/km at 63 ... 8000 Hz
TABLE_2 = {
    (10, 70): (0.1, 0.4, 1.0, 1.9, 3.7, 9.7, 32.8, 117),
    (20, 70): (0.1, 0.3, 1.1, 2.8, 5.0, 9.0, 22.9, 76.6),
    (30, 70): (0.1, 0.3, 1.0, 3.1, 7.4, 12.7, 23.1, 59.3),
    (15, 20): (0.3, 0.6, 1.2, 2.7, 8.2, 28.2, 88.8, 202),
    (15, 50): (0.1, 0.5, 1.2, 2.2, 4.2, 10.8, 36.2, 129),
}

RNG = np.random.default_rng(4)
TONES = Tones(
    150.0 * jnp.arange(1, 5),
    {
        name: jnp.asarray(RNG.normal(size=(2, 4)) + 1j * RNG.normal(size=(2, 4)))
        for name in ("thickness", "loading")
    },
)


def exact(nominal_hz):
    """Exact mid-band frequencies, at which the table is computed (its note 5)."""
    return 1000 * 10 ** (np.round(10 * np.log10(np.asarray(nominal_hz) / 1000)) / 10)


def test_absorption_is_the_standards_table_to_its_last_digit():
    celsius, humidity, nominal, printed = np.array(
        [row.split() for row in TABLE_1.split(",")], float
    ).T
    air = Air(temperature=273.15 + celsius, relative_humidity=humidity / 100)
    half_a_digit = 0.5 * 10 ** (np.floor(np.log10(printed)) - 2)
    off = np.abs(1000 * absorption_db_per_m(exact(nominal), air) - printed)
    assert np.all(off <= 1.0001 * half_a_digit)


@pytest.mark.parametrize("weather", TABLE_2)
def test_absorption_is_the_engineering_method_s_table(weather):
    celsius, humidity = weather
    printed = np.array(TABLE_2[weather])
    bands = exact([63, 125, 250, 500, 1000, 2000, 4000, 8000])
    air = Air(temperature=273.15 + celsius, relative_humidity=humidity / 100)
    got = 1000 * absorption_db_per_m(bands, air)
    np.testing.assert_array_less(np.abs(got - printed), np.where(printed < 100, 0.0501, 0.501))


def test_thinner_air_absorbs_as_frequency_over_pressure():
    """Every term of alpha/p depends on f/p and on the molar concentration of water vapour."""
    low = Air(temperature=280.0, relative_humidity=0.2, pressure=101325.0)
    high = Air(temperature=280.0, relative_humidity=0.1, pressure=101325.0 / 2)
    f = np.array([100.0, 1000.0, 5000.0])
    np.testing.assert_allclose(
        absorption_db_per_m(f / 2, high), absorption_db_per_m(f, low) / 2, rtol=1e-12
    )


def test_tones_and_bands_lose_the_same():
    way, air = jnp.array([300.0, 2000.0]), Air()
    absorbed = absorb_tones(TONES, way, air)
    lost = np.outer(way, absorption_db_per_m(TONES.frequency_hz, air))
    np.testing.assert_allclose(spl_db(TONES.total) - spl_db(absorbed.total), lost, atol=1e-9)
    np.testing.assert_allclose(jnp.angle(absorbed.total), jnp.angle(TONES.total))
    kept = absorb(jnp.ones((2, 4)), TONES.frequency_hz, way, air)
    np.testing.assert_allclose(-10 * np.log10(kept), lost)


@pytest.mark.parametrize(("lost", "louder"), [(15.0, 0.27), (30.0, 1.22)])
def test_a_band_is_somewhat_louder_than_its_middle(lost, louder):
    f = exact(8000) * 10 ** np.linspace(-0.05, 0.05, 2001)
    alpha = np.asarray(absorption_db_per_m(f, Air()))
    band = np.mean(10 ** (-0.1 * lost * alpha / alpha[1000]))
    assert 10 * np.log10(band) + lost == pytest.approx(louder, rel=0.03)


def test_absorption_has_derivatives():
    @jax.jit
    def level(temperature, humidity, way):
        air = Air(temperature=temperature, relative_humidity=humidity, pressure=1e5)
        absorbed = absorb_tones(TONES, way * jnp.ones(2), air)
        return oaspl_db(absorbed.total)[0]

    check_grads(level, (285.0, 0.5, 900.0), order=1, rtol=1e-5)


def test_the_image_is_as_far_below_the_ground():
    np.testing.assert_allclose(
        mirrored([[3.0, 1.0, -1.5], [0.0, 0.0, -2.0]], 2.0), [[3.0, 1.0, -2.5], [0.0, 0.0, -2.0]]
    )
    flying = mirrored([[-28.8, 5.0, 7.0]], 30.0, up=(1.0, 0.0, 0.0))
    np.testing.assert_allclose(flying, [[-31.2, 5.0, 7.0]])


def test_flush_with_the_ground_pressure_is_twice_as_high():
    louder = spl_db(on_hard_ground(TONES).total) - spl_db(TONES.total)
    np.testing.assert_allclose(louder, 20 * np.log10(2), rtol=1e-12)


def test_above_the_ground_two_ways_interfere():
    """A monopole over a hard plane: silent where the ways differ by half a wave."""
    height, microphone = 20.0, 1.2
    k = 2 * np.pi / 340 * np.array([60.0, 500.0, 3000.0])

    def monopole(position):
        d = jnp.linalg.norm(position, axis=-1)[:, None]
        p = jnp.exp(1j * k * d) / d
        return Tones(k * 340 / (2 * np.pi), {"thickness": p})

    observers = np.array([[25.0, 0.0, microphone - height], [8.0, 3.0, microphone - height]])
    tones = monopole(observers) + monopole(mirrored(observers, height))
    across = np.hypot(*observers[:, :2].T)
    for i, d in enumerate(across):
        direct, image = np.hypot(d, height - microphone), np.hypot(d, height + microphone)
        expected = np.exp(1j * k * direct) / direct + np.exp(1j * k * image) / image
        np.testing.assert_allclose(tones.total[i], expected, rtol=1e-12)
    quiet = 340 / 2 / (image - direct)
    k = 2 * np.pi / 340 * np.array([quiet])
    trough = monopole(observers) + monopole(mirrored(observers, height))
    assert float(jnp.abs(trough.total[1, 0])) == pytest.approx(1 / direct - 1 / image, rel=1e-9)


def test_reflection_has_derivatives():
    def level(height):
        d = jnp.linalg.norm(mirrored(jnp.array([[5.0, 1.0, -3.0]]), height), axis=-1)
        return jnp.sum(d)

    assert float(jax.grad(level)(4.0)) == pytest.approx(2 * 5.0 / np.sqrt(51.0))
