"""The guard names quantity, place and operating point of the first number that is none."""

import numpy as np
import pytest

from propmdao.runtime.finite import NotFiniteError, require_finite


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, complex(0.0, np.nan)])
def test_what_is_no_number_is_named_with_its_place(value):
    values = np.ones((2, 3), np.asarray(value).dtype)
    values[1, 2] = value
    message = r"^spl_db of observer 2, 400 Hz is .*(nan|inf).*, at 4200 rpm and 8 m/s$"
    with pytest.raises(NotFiniteError, match=message):
        require_finite(
            "spl_db", values, "observer", ["100 Hz", "200 Hz", "400 Hz"],
            where=", at 4200 rpm and 8 m/s",
        )  # fmt: skip


def test_numbers_alone_and_axes_without_a_word():
    with pytest.raises(NotFiniteError, match="^thrust is nan$"):
        require_finite("thrust", np.nan)
    with pytest.raises(NotFiniteError, match="^speed is inf$"):
        require_finite("speed", [np.inf])
    with pytest.raises(NotFiniteError, match="^load_force of load 1, entry 2 is nan$"):
        require_finite("load_force", [[0.0, np.nan], [np.nan, 0.0]], "load")


def test_finite_numbers_pass():
    require_finite("loads", np.array([[1e308, -0.0]]), "observer")
    require_finite("counts", [1, 2])
    require_finite("nothing", np.zeros((0, 3)))
