"""Motor and battery: the numbers of QPROP, energy that is kept, limits, what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from propmdao.propeller.electric_drive import drive_result, driven_by, endurance
from propmdao.propeller.motors import Motor, MotorError, catalog_motor, motors
from propmdao.records.units import RAD_PER_S

MOTOR = Motor("motor", 1000.0, 0.1, 0.8)
IDEAL = Motor("ideal", 1000.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("torque", "volts", "amps", "efficiency", "watts"),
    [(0.08096, 9.014, 24.1687, 0.1634, 217.9), (0.07364, 8.358, 22.0527, 0.1757, 184.3)],
)
def test_the_numbers_of_qprop(
    torque: float, volts: float, amps: float, efficiency: float, watts: float
) -> None:
    """Output of QPROP 1.22 with its Speed-400 6 V at 4200 rpm, printed to four digits."""
    state = driven_by(catalog_motor("speed_400_6v"), 4200.0, torque)
    assert state.current == pytest.approx(amps, rel=1e-4)
    assert state.voltage == pytest.approx(volts, rel=1e-4)
    assert state.motor_efficiency == pytest.approx(efficiency, rel=5e-4)
    assert state.electrical_power == pytest.approx(watts, rel=5e-4)


def test_power_goes_to_the_shaft_the_winding_and_the_friction() -> None:
    rpm, torque = np.array([3000.0, 9000.0]), np.array([0.05, 0.12])
    state = driven_by(MOTOR, rpm, torque)
    shaft = rpm * RAD_PER_S * torque
    winding = state.current**2 * MOTOR.resistance
    friction = MOTOR.no_load_current * rpm / MOTOR.speed_constant
    np.testing.assert_allclose(state.electrical_power, shaft + winding + friction, rtol=1e-12)
    np.testing.assert_allclose(state.motor_efficiency, shaft / state.electrical_power, rtol=1e-12)


def test_limits() -> None:
    # Nothing is lost without resistance and friction.
    assert driven_by(IDEAL, 5000.0, 0.1).motor_efficiency == pytest.approx(1.0, rel=1e-12)
    # Standing still it takes what the winding turns to heat, or nothing.
    still = driven_by(MOTOR, 0.0, 0.0)
    assert still.motor_efficiency == 0.0 and still.electrical_power == pytest.approx(0.064)
    nothing = driven_by(IDEAL, 0.0, 0.0)
    assert nothing.motor_efficiency == 0.0 and nothing.electrical_power == 0.0
    # Without torque the current is that of no load, and without current the speed is Kv v.
    assert driven_by(MOTOR, 5000.0, 0.0).current == MOTOR.no_load_current
    assert driven_by(IDEAL, 5000.0, 0.0).voltage == pytest.approx(5.0)
    # The most efficient torque of a motor is near i = sqrt(v i0 / R) (Drela, 2007).
    torque = np.linspace(0.01, 0.4, 4000)
    rpm = MOTOR.speed_constant * (10.0 - MOTOR.resistance * (
        torque * MOTOR.speed_constant * RAD_PER_S + MOTOR.no_load_current))  # fmt: skip
    state = driven_by(MOTOR, rpm, torque)
    np.testing.assert_allclose(state.voltage, 10.0, rtol=1e-12)
    best = state.current[np.argmax(state.motor_efficiency)]
    assert best == pytest.approx(np.sqrt(10.0 * 0.8 / 0.1), rel=2e-3)


def test_a_propeller_that_drives_the_motor() -> None:
    state = driven_by(MOTOR, 5000.0, -0.1)
    assert state.electrical_power < 0.0 and -1.0 < state.motor_efficiency < 0.0
    result = drive_result(MOTOR, 5000.0, -0.1, battery_energy=10.0)
    assert result["endurance"] is None and result["electrical_power"] < 0.0


def test_a_battery_lasts_for_its_energy() -> None:
    assert endurance(40.0, 10.0, 0.8) == pytest.approx(720.0)
    np.testing.assert_allclose(endurance(np.array([10.0, 20.0]), 5.0, 1.0), [1800.0, 900.0])


@pytest.mark.parametrize(
    ("power", "energy", "share", "message"),
    [
        (0.0, 10.0, 0.8, "electrical_power must be above 0"),
        (-3.0, 10.0, 0.8, "it is -3 W"),
        (np.nan, 10.0, 0.8, "electrical_power must be above 0"),
        (10.0, -1.0, 0.8, "battery_energy must be within"),
        (10.0, 10.0, 1.2, "usable_share must be within 0.01 ... 1; it is 1.2"),
    ],
)
def test_what_no_battery_does(power: float, energy: float, share: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        endurance(power, energy, share)


def test_the_catalogue_has_motors_with_sources() -> None:
    assert len(motors()) >= 7
    assert all("QPROP" in motor.source and motor.resistance > 0.0 for motor in motors().values())
    with pytest.raises(MotorError, match=r"unknown motor 'axi_2204'; near: axi_2204_54"):
        catalog_motor("axi_2204")


@pytest.mark.parametrize("value", [0.0, -10.0, np.nan, "fast"])
def test_a_motor_has_constants_in_their_ranges(value: float) -> None:
    with pytest.raises(MotorError, match="speed_constant of motor 'wrong' must be"):
        Motor("wrong", value, 0.1, 0.5)
