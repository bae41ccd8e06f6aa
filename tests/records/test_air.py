"""Air of the standard atmosphere against its tables, and what makes air that belongs together."""

from __future__ import annotations

import pytest

from propmdao.records.air import Air, require_known_air


@pytest.mark.parametrize(
    ("altitude", "temperature", "pressure", "density", "sound_speed"),
    [  # ISO 2533:1975, by geopotential altitude: m, K, Pa, kg/m^3, m/s
        (0.0, 288.150, 101325.0, 1.22500, 340.294),
        (1000.0, 281.650, 89874.6, 1.11164, 336.434),
        (5000.0, 255.650, 54019.9, 0.736116, 320.529),
        (11000.0, 216.650, 22632.0, 0.363918, 295.069),
    ],
)
def test_standard_air_is_that_of_the_tables(altitude, temperature, pressure, density, sound_speed):
    air = Air.standard(altitude)
    # half a unit of the last digit that is printed
    assert air.temperature == pytest.approx(temperature, abs=5e-4)
    assert air.pressure == pytest.approx(pressure, abs=0.06)
    assert air.density == pytest.approx(density, rel=5e-6)
    assert air.sound_speed == pytest.approx(sound_speed, abs=6e-4)


def test_air_by_default_is_standard_air_at_sea_level():
    default, standard = Air(), Air.standard()
    # 1.789e-5 Pa s is rounded to four digits.
    for name in ("density", "sound_speed", "dynamic_viscosity", "temperature", "pressure"):
        assert getattr(default, name) == pytest.approx(getattr(standard, name), rel=3e-4)
    assert default.relative_humidity == standard.relative_humidity
    assert default.kinematic_viscosity == pytest.approx(1.4607e-5, rel=3e-4)  # m^2/s, ISO 2533


def test_a_warmer_day_has_the_standards_pressure_and_thinner_air():
    hot, standard = Air.standard(1000.0, temperature_offset=20.0), Air.standard(1000.0)
    ratio = 301.65 / 281.65
    assert hot.temperature == pytest.approx(301.65) and hot.pressure == standard.pressure
    assert standard.density / hot.density == pytest.approx(ratio)
    assert hot.sound_speed / standard.sound_speed == pytest.approx(ratio**0.5)
    assert hot.dynamic_viscosity > standard.dynamic_viscosity


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"altitude": -1.0}, "altitude must be within 0 ... 11000 m; it is -1"),
        ({"altitude": 11001.0}, "altitude must be within 0 ... 11000 m; it is 11001"),
        ({"altitude": float("nan")}, "altitude must be within 0 ... 11000 m; it is nan"),
        ({"temperature_offset": -300.0}, "temperature must be positive; it is -11.85 K"),
    ],
)
def test_air_that_the_standard_does_not_describe(asked, message):
    with pytest.raises(ValueError) as error:
        Air.standard(**asked)
    assert str(error.value) == message


def test_absorption_is_known_up_to_the_tropopause_only_where_it_is_not_too_cold():
    require_known_air(Air.standard(5000.0))  # -17.5 degrees Celsius
    with pytest.raises(ValueError, match="temperature must be within -20 ... 50 degrees Celsius"):
        require_known_air(Air.standard(11000.0))
