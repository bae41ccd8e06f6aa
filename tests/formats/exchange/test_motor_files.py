"""Motors from files of QPROP: what is read, what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from propmdao.formats.exchange.motor_files import load_motor
from propmdao.propeller.motors import MotorError, motors

# As QPROP's user guide has it.
GUIDE = """
Speed-400 3321 (6V) direct drive     ! name

 1        ! motor type  (1 = permanent-magnet brushed or brushless DC motor)

 0.31     ! motor parameter 1 ,  R  (Ohms)
 0.77     ! motor parameter 2 ,  Io (Amps)
 2760.0   ! motor parameter 3 ,  Kv (rpm/Volt)
"""


def test_the_guides_motor_is_that_of_the_catalogue(tmp_path: Path) -> None:
    path = tmp_path / "s400"
    path.write_text(GUIDE)
    motor, shipped = load_motor(path), load_motor("speed_400_6v")
    assert shipped is motors()["speed_400_6v"] and motor.name == "s400"
    for key in ("speed_constant", "resistance", "no_load_current"):
        assert getattr(motor, key) == getattr(shipped, key)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("\n 1 ", "\n 2 ", "motors of model 1 are read, not of model 2"),
        (" 2760.0 ", " fast ", "Kv: 'fast' is no number"),
        (" 0.77 ", " -0.77 ", "no_load_current of motor 'wrong' must be within 0"),
        (" 2760.0   !", " !", "there are 4 lines"),
    ],
)
def test_what_is_wrong_is_one_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in GUIDE
    path = tmp_path / "wrong"
    path.write_text(GUIDE.replace(old, new, 1))
    with pytest.raises(MotorError, match=message) as caught:
        load_motor(path)
    assert "\n" not in str(caught.value)


def test_no_such_motor_lists_those_near() -> None:
    with pytest.raises(MotorError, match="unknown motor 'speed400'; near: speed_400_"):
        load_motor("speed400")
