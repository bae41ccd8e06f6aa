"""APC-SF 11x4.7 in hover against the microphones of an anechoic chamber, nothing fitted.

Zawodny, Boyd and Burley (AHS Forum 72, 2016), level of the tone at blade passage, three rotation
speeds and five elevations, read off a figure (+-0.3 dB). Aimed at: 1.5 dB in the mean, 3.0 dB at
most. Bands are two-sided around the errors found.
"""

import importlib.util

import numpy as np
import pytest

pytest.importorskip("matplotlib")  # which the study draws with
pytestmark = pytest.mark.validation


@pytest.fixture(scope="module")
def study(checkout):
    spec = importlib.util.spec_from_file_location(
        "hover_noise", checkout / "studies" / "validation" / "hover_noise.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def heard(study):
    return study.hover_tones()


def test_levels_at_blade_passage_are_within_a_decibel_in_the_mean(heard, drawn):
    error = heard.spl_db - heard.measured_db
    for rpm, computed, measured in zip(heard.rpm, heard.spl_db, heard.measured_db, strict=True):
        drawn(
            f"tone at blade passage, {rpm} rpm", ("elevation, deg", "dB re 20 µPa"),
            heard.elevation_deg, {"propmdao": computed}, {"anechoic chamber": measured},
        )  # fmt: skip
    assert 0.8 < np.abs(error).mean() < 1.05
    assert error.mean() == pytest.approx(-0.66, abs=0.15)
    assert 1.4 < np.abs(error).max() < 1.75


def test_loads_that_fall_short_are_a_third_of_that(heard):
    # Thrust and torque are 6 to 11 % short; with the measured ones the rest is this.
    short = heard.loads / heard.measured_loads - 1.0
    assert short[:, 0] == pytest.approx([-0.058, -0.076, -0.109], abs=0.01)
    assert short[:, 1] == pytest.approx([-0.058, -0.078, -0.105], abs=0.01)
    error = heard.scaled_db - heard.measured_db
    assert 0.5 < np.abs(error).mean() < 0.75
    assert 1.6 < np.abs(error).max() < 1.9


def test_twist_of_zero_thrust_in_flight_brings_as_much_back(heard):
    error = heard.turned_db - heard.measured_db
    assert 0.5 < np.abs(error).mean() < 0.75
    assert 2.0 < np.abs(error).max() < 2.3


def test_band_is_about_a_decibel_and_reaches_six_of_fifteen(study, heard):
    # A degree of blade angle makes 0.8 dB.
    for size in (-heard.below_db, heard.above_db):
        assert (0.65 < size).all() and (size < 1.3).all()
    assert study.within_band(heard) == 6


def test_measured_levels_are_not_those_of_a_smooth_law(study, heard):
    # Steady loads make a level that follows a power of rotation speed: no model reaches 1.6 dB.
    assert 1.5 < study.off_power_law_db(heard) < 1.7
    smooth = np.diff(heard.spl_db, axis=0) / np.diff(np.log(heard.rpm))[:, None]
    assert (np.abs(smooth[1] / smooth[0] - 1.0) < 0.2).all()
