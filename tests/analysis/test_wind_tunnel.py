"""Measurements are read whole, and compared as the documentation says."""

from __future__ import annotations

import dataclasses
import tomllib

import numpy as np
import pytest
from numpy.testing import assert_allclose
from shared_mesh import COARSE

from propmdao.analysis.single_point import analyze
from propmdao.analysis.sweeping.batches import analyze_each
from propmdao.analysis.wind_tunnel import (
    MeasurementError,
    Points,
    WindTunnel,
    calibrated_twist_deg,
    computed,
    errors,
    read_wind_tunnel,
    zero_thrust,
    zero_thrust_ratio,
    zero_thrust_twist_deg,
)
from propmdao.formats.propellers import load_propeller

FILE = """
source = "made up"
propellers = ["a", "a_uiuc"]
[static]
rpm = [2000, 4000]
CT = [0.10, 0.12]
CP = [0.04, 0.05]
[[run]]
rpm = 3000
J = [0.2, 0.4]
CT = [0.08, 0.05]
CP = [0.04, 0.03]
[[run]]
rpm = 4000
J = [0.6]
CT = [0.01]
CP = [0.02]
"""


def points(rpm, j, ct, cp) -> Points:
    return Points(*(np.array(values, float) for values in (rpm, j, ct, cp)))


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "measured.toml"
    path.write_text(FILE)
    return path


def test_runs_are_read_one_after_the_other(file):
    tunnel = read_wind_tunnel(file)
    assert tunnel.source == "made up" and tunnel.propellers == ("a", "a_uiuc")
    assert_allclose(tunnel.static.rpm, [2000, 4000])
    assert_allclose(tunnel.static.J, 0.0)
    assert_allclose(tunnel.dynamic.rpm, [3000, 3000, 4000])
    assert_allclose(tunnel.dynamic.J, [0.2, 0.4, 0.6])
    assert_allclose(tunnel.dynamic.eta, [0.4, 0.4 * 5 / 3, 0.3])


def test_points_are_chosen_by_slice_and_by_mask(file):
    dynamic = read_wind_tunnel(file).dynamic
    assert_allclose(dynamic[1:].J, [0.4, 0.6])
    assert_allclose(dynamic[dynamic.rpm == 4000].CT, [0.01])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("J = [0.6]\n", "", "'J' is missing"),
        ("CP = [0.02]", "CP = [0.02, 0.03]", "must have equally many numbers"),
        ("CT = [0.01]", 'CT = ["much"]', "could not convert string"),
        ("rpm = 3000", "rpm = ", "Invalid value"),
        ('source = "made up"', "", "'source' is missing"),
        ('propellers = ["a", "a_uiuc"]', "", "'propellers' is missing"),
    ],
)
def test_wrong_file_is_one_line_that_begins_with_the_file(file, old, new, message):
    file.write_text(FILE.replace(old, new))
    with pytest.raises(MeasurementError, match=message) as caught:
        read_wind_tunnel(file)
    assert str(caught.value).startswith(str(file))
    assert "\n" not in str(caught.value)


def test_file_that_is_not_there(tmp_path):
    with pytest.raises(MeasurementError, match="cannot be read: No such file"):
        read_wind_tunnel(tmp_path / "none.toml")


def test_errors_are_relative_in_hover_and_of_the_static_coefficient_in_flight(file):
    tunnel = read_wind_tunnel(file)
    more = points(tunnel.static.rpm, [0, 0], [0.11, 0.12], [0.03, 0.05])
    fast = points(tunnel.dynamic.rpm, tunnel.dynamic.J, [0.08, 0.061, -0.01], [0.04, 0.03, 0.0155])
    error = errors(tunnel, more, fast)
    assert_allclose(error.static_ct, [0.1, 0.0], atol=1e-12)
    assert_allclose(error.static_cp, [-0.25, 0.0], atol=1e-12)
    assert_allclose(error.low_ct, [0.0, 0.1], atol=1e-12)
    assert_allclose(error.low_cp, [0.0, 0.0], atol=1e-12)
    assert_allclose(error.high_ct, [-0.02 / 0.11])
    assert_allclose(error.high_cp, [-0.0045 / 0.045])
    assert error.trend == pytest.approx(0.5)  # 0.01 over 2000 rpm, 0.02 measured


def test_computed_is_the_analysis_of_every_point():
    propeller = load_propeller("apcsf_11x4.7_uiuc")
    asked = points([3000, 4000], [0.0, 0.4], [np.nan] * 2, [np.nan] * 2)
    result = computed(propeller, asked, 1.0, fidelity=COARSE)
    for i, speed in enumerate((0.0, 0.4 * 4000 / 60 * 0.2794)):
        alone = analyze(
            propeller, rpm=asked.rpm[i], speed=speed, twist_offset_deg=1.0, fidelity=COARSE
        ).coefficients
        assert_allclose((result.CT[i], result.CP[i]), (alone.CT, alone.CP), rtol=1e-12)
        assert_allclose(result.J[i], alone.J, atol=1e-12)


def test_point_without_convergence_is_nan(monkeypatch):
    def never(*args, **settings):
        for outcome in analyze_each(*args, **settings):
            loads = dataclasses.replace(outcome.result.loads, converged=np.asarray(False))
            yield outcome._replace(result=dataclasses.replace(outcome.result, loads=loads))

    monkeypatch.setattr("propmdao.analysis.wind_tunnel.analyze_each", never)
    asked = points([3000], [0.0], [0.1], [0.04])
    result = computed(load_propeller("apcsf_11x4.7_uiuc"), asked, fidelity=COARSE)
    assert np.isnan([result.CT, result.CP]).all()


def thrust_grows_with_twist(propeller, points, twist_deg):
    """A propeller with CT 0.1 and 0.01 more for every degree, and a bend in it."""
    ct = 0.1 + 0.01 * twist_deg + 1e-4 * twist_deg**2
    return dataclasses.replace(points, CT=np.full_like(points.rpm, ct))


def test_calibration_brings_the_mean_relative_error_to_zero():
    static = points([2000, 4000], [0, 0], [0.11, 0.13], [0.04, 0.05])
    twist = calibrated_twist_deg(None, static, thrust_grows_with_twist)
    ct = thrust_grows_with_twist(None, static, twist).CT
    assert np.mean(ct / static.CT - 1.0) == pytest.approx(0.0, abs=1e-4)


@pytest.mark.filterwarnings("ignore:Tolerance of 1.0 reached:RuntimeWarning")
def test_calibration_that_cannot_be_is_refused():
    static = points([2000], [0], [0.11], [0.04])

    def stuck(propeller, points, twist_deg):
        return dataclasses.replace(points, CT=np.full_like(points.rpm, 0.1))

    with pytest.raises(MeasurementError, match="no twist offset .* 'apcsf_11x4.7_uiuc'"):
        calibrated_twist_deg(load_propeller("apcsf_11x4.7_uiuc"), static, stuck)


def test_zero_thrust_lies_between_neighbouring_points_of_a_run():
    through = [4000] * 3, [0.6, 0.4, 0.7], [0.01, 0.05, -0.03], [0.02, 0.03, 0.012]
    far = [3000] * 4, [0.1, 0.2, 0.3, 0.4], [0.09, 0.08, 0.07, 0.06], [0.03] * 4
    braking = [2000] * 2, [0.7, 0.8], [-0.01, -0.02], [0.01] * 2
    rows = [np.concatenate(columns) for columns in zip(through, far, braking, strict=True)]
    crossing = zero_thrust(points(*rows))
    assert_allclose(crossing.rpm, [4000])
    assert_allclose((crossing.J[0], crossing.CT[0], crossing.CP[0]), (0.625, 0.0, 0.018))
    with pytest.raises(MeasurementError, match="no run goes through zero thrust"):
        zero_thrust(points(*far))
    with pytest.raises(MeasurementError, match="no run goes through zero thrust"):
        zero_thrust(points(*braking))


def test_run_that_ends_just_short_of_zero_thrust_is_continued():
    j = np.array([0.1, 0.5, 0.52, 0.54, 0.56])
    run = points([5000] * 5, j, [0.1, *0.05 * (0.585 - j[1:])], [0.04, *0.1 * (0.6 - j[1:])])
    ends = zero_thrust(run)
    assert_allclose((ends.J[0], ends.CP[0]), (0.585, 0.0015), rtol=1e-9)
    with pytest.raises(MeasurementError, match="no run goes through zero thrust"):
        zero_thrust(run[:4])  # 2.25 % of the largest CT are left


def thrust_falls_with_advance(propeller, asked, twist_deg):
    """A propeller without thrust at J 0.6 with no twist, 0.03 more for every degree."""
    return dataclasses.replace(asked, CT=0.2 * (0.6 + 0.03 * twist_deg - asked.J))


def test_twist_and_ratio_of_zero_thrust():
    measured = points([4000, 6000], [0.64, 0.68], [0.0, 0.0], [0.01, 0.01])
    twist = zero_thrust_twist_deg(None, measured, thrust_falls_with_advance)
    assert twist == pytest.approx(2.0, abs=1e-6)
    ratio = zero_thrust_ratio(None, measured, thrust_falls_with_advance)
    assert ratio == pytest.approx(0.6 / 0.66, abs=1e-6)


@pytest.mark.filterwarnings("ignore:Tolerance of .* reached:RuntimeWarning")
def test_zero_thrust_that_cannot_be_is_refused():
    measured = points([4000], [0.6], [0.0], [0.01])

    def stuck(propeller, asked, twist_deg):
        return dataclasses.replace(asked, CT=np.full_like(asked.rpm, 0.1))

    propeller = load_propeller("apcsf_11x4.7")
    with pytest.raises(MeasurementError, match="no twist offset brings the thrust of 'apcsf_11x4"):
        zero_thrust_twist_deg(propeller, measured, stuck)
    with pytest.raises(MeasurementError, match="no advance ratio of 'apcsf_11x4.7' gives zero"):
        zero_thrust_ratio(propeller, measured, stuck)


def test_measurements_that_ship_are_complete(checkout):
    files = sorted((checkout / "studies" / "validation" / "measurements").glob("uiuc_*.toml"))
    assert len(files) == 17
    for path in files:
        tunnel = read_wind_tunnel(path)
        assert isinstance(tunnel, WindTunnel)
        assert path.stem == f"uiuc_{tunnel.propellers[0]}"
        assert tunnel.source.startswith("UIUC Propeller Data Site, volume ")
        assert 13 <= tunnel.static.rpm.size <= 21 and (np.diff(tunnel.static.rpm) > 0.0).all()
        runs = tomllib.loads(path.read_text())["run"]
        assert tunnel.dynamic.rpm.size == sum(len(run["J"]) for run in runs)
        assert (tunnel.static.CT > 0.07).all() and (tunnel.static.CP > 0.02).all()
        assert np.isfinite([*tunnel.dynamic.CT, *tunnel.dynamic.CP]).all()
        # Efficiency is below 1 and a run falls with J: no column is shifted.
        assert (tunnel.dynamic.eta < 0.85).all()
        for rpm in np.unique(tunnel.dynamic.rpm):
            run = tunnel.dynamic[tunnel.dynamic.rpm == rpm]
            assert np.corrcoef(run.J, run.CT)[0, 1] < -0.95
        assert 0.5 < zero_thrust(tunnel.dynamic).J.mean() < 0.95
