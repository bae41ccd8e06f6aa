"""Bands: how changes combine, what cannot be solved is said, nothing is compiled anew."""

from __future__ import annotations

import dataclasses
import logging
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import arc
from propmdao.aerodynamics.sections.polars.family import with_drag
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import PolarError
from propmdao.analysis import uncertainty
from propmdao.analysis.results import Analysis
from propmdao.analysis.single_point import analyze
from propmdao.analysis.uncertainty import Band, Uncertainties, band
from propmdao.formats.propellers import load_propeller

PROPELLER = load_propeller("apcsf_11x4.7")
NONE = Uncertainties(twist_deg=0.0, chord=0.0, n_crit=(5.0, 5.0), drag=0.0)


@pytest.fixture(scope="module")
def hover() -> Analysis:
    return analyze(PROPELLER, rpm=4200.0, observers=arc(1.905, [-45.0, 0.0]), fidelity=COARSE)


def linear(analysis: Analysis, **fails: Exception | bool) -> Callable[..., Any]:
    """In place of `analyze`: 0.3 N and 2 dB per degree, 40 N per chord, 5 N per ln of drag.

    ``up`` is raised, or not converged, where the blade is turned up.
    """
    base = float(polars_for(PROPELLER).values[0, 0, 0, 1, 0, 0])

    def analyze(propeller: Any, *, polars: Any, change: Any, **asked: Any) -> Any:
        drag = 0.0 if polars is None else float(polars.values[0, 0, 0, 1, 0, 0]) - base
        twist = change.twist_offset_deg
        if twist > 0.0 and isinstance(fails.get("up"), Exception):
            raise fails["up"]
        thrust = float(analysis.loads.thrust)
        thrust += 0.3 * twist + 40.0 * (change.chord_factor - 1.0) + 5.0 * drag
        loads = dataclasses.replace(analysis.loads, thrust=thrust)
        if twist > 0.0 and fails.get("up"):
            loads = dataclasses.replace(loads, converged=np.asarray(False))
        levels = analysis.spl_bpf_db() + 2.0 * twist
        return SimpleNamespace(
            loads=loads, point=analysis.point, rpm=analysis.rpm, spl_bpf_db=lambda: levels
        )

    return analyze


def test_changes_combine_as_root_of_the_sum_of_squares(
    hover: Analysis, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uncertainty, "analyze", linear(hover))
    found = band(hover, Uncertainties(twist_deg=2.0, chord=0.01, n_crit=(5.0, 5.0), drag=0.2))
    assert_allclose(found.above["thrust"], np.sqrt(0.6**2 + 0.4**2 + (5.0 * np.log(1.2)) ** 2))
    # 20 % less drag is more of a change than 20 % more.
    assert_allclose(found.below["thrust"], -np.sqrt(0.6**2 + 0.4**2 + (5.0 * np.log(0.8)) ** 2))
    assert_allclose(found.above["spl_bpf_db"], [4.0, 4.0])
    assert_allclose(found.below["spl_bpf_db"], [-4.0, -4.0])
    assert found.values["thrust"] == float(hover.loads.thrust)
    assert found.left_out == [] and "rpm" not in found.values


@pytest.mark.parametrize(
    ("up", "message"),
    [
        (ValueError("thrust 9 N is out of reach"), "no solution at 1, thrust 9 N is out of reach"),
        (True, "no solution at 1, it has not converged"),
    ],
)
def test_what_cannot_be_solved_is_said_and_the_other_end_counts(
    hover: Analysis, monkeypatch: pytest.MonkeyPatch, up: Exception | bool, message: str
) -> None:
    monkeypatch.setattr(uncertainty, "analyze", linear(hover, up=up))
    found = band(hover, dataclasses.replace(NONE, twist_deg=1.0))
    assert found.left_out == [f"blade angle: {message}"]
    low, high = found.effects[0].changes
    assert low is not None and high is None
    assert_allclose(found.below["thrust"], -0.3)
    assert found.above["thrust"] == 0.0


def test_transition_without_polars_is_left_out_whole(
    hover: Analysis, monkeypatch: pytest.MonkeyPatch
) -> None:
    def shipped(propeller: Any, own: Any = None, transition: Any = None) -> Any:
        if transition.n_crit == 9.0:
            raise PolarError("there are none at n_crit 9")
        return polars_for(propeller, own)

    monkeypatch.setattr(uncertainty, "polars_for", shipped)
    monkeypatch.setattr(uncertainty, "analyze", linear(hover))
    found = band(hover)
    assert found.left_out == ["n_crit: there are none at n_crit 9"]
    assert found.effects[2].changes == (None, None)
    assert found.effects[0].changes[1] is not None


def test_inviscid_flow_and_given_polars_leave_out_what_does_not_apply(hover: Analysis) -> None:
    inviscid = analyze(PROPELLER, rpm=4200.0, viscous=False, fidelity=COARSE)
    found = band(inviscid, dataclasses.replace(NONE, chord=0.03))
    assert found.left_out == [
        "n_crit: inviscid flow has no polars",
        "section drag: inviscid flow has no polars",
    ]
    assert found.values["spl_bpf_db"] == found.above["spl_bpf_db"] == []
    given = polars_for(PROPELLER)
    own = analyze(PROPELLER, rpm=4200.0, polars=given, fidelity=COARSE)
    with pytest.raises(ValueError, match="was given polars of its own: give them to band"):
        band(own, NONE)
    assert band(own, NONE, given).left_out == [
        "n_crit: the polars given are at the transition they were made at"
    ]


def test_band_of_nothing_is_zero_and_what_has_not_converged_has_none(hover: Analysis) -> None:
    found = band(hover, NONE)
    for side in (found.above, found.below):
        numbers = np.concatenate([np.atleast_1d(value) for value in side.values()])
        assert_allclose(numbers, 0.0, atol=1e-12)
    loads = dataclasses.replace(hover.loads, converged=np.asarray(False))
    with pytest.raises(ValueError, match=r"no band at 4200.0 rpm: .* has not converged"):
        band(dataclasses.replace(hover, loads=loads))


def test_band_compiles_nothing_and_has_the_signs_of_physics(
    hover: Analysis, caplog: pytest.LogCaptureFixture
) -> None:
    size = dataclasses.replace(Uncertainties(), n_crit=(5.0, 5.0))
    band(hover, NONE)
    with jax.log_compiles(), caplog.at_level(logging.WARNING):
        found = band(hover, size)
    assert [line for line in caplog.messages if "XLA compilation" in line] == []
    twist, chord, _, drag = found.effects
    for low, high in (twist.changes, chord.changes):
        assert low is not None and high is not None
        for key in ("thrust", "shaft_power"):
            assert low[key] < 0.0 < high[key]
    low, high = drag.changes
    assert low is not None and high is not None
    assert low["shaft_power"] < 0.0 < high["shaft_power"]
    assert abs(high["thrust"]) < 0.01 * found.values["thrust"]


def test_drag_is_multiplied_and_lift_kept() -> None:
    polars = polars_for(PROPELLER)
    more = with_drag(polars, 1.2)
    ratio = np.asarray(more.values) - np.asarray(polars.values)
    assert_allclose(ratio[:, :, :, 1], np.log(1.2), rtol=1e-9)
    assert_allclose(ratio[:, :, :, [0, 2]], 0.0, atol=1e-15)


def test_plain_numbers_say_how_they_combine(hover: Analysis) -> None:
    plain = Band({"thrust": 1.0}, (), {"thrust": -0.1}, {"thrust": 0.2}).to_dict()
    assert plain["below"] == {"thrust": -0.1} and plain["above"] == {"thrust": 0.2}
    assert plain["rule"].startswith("root of the sum of squares") and plain["effects"] == []


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"twist_deg": -1.0}, "twist_deg must be within 0 ... 30 deg; it is -1"),
        ({"chord": 1.0}, "chord must be within 0 ... 0.9; it is 1"),
        ({"drag": float("nan")}, "drag must be within 0 ... 0.9; it is nan"),
        ({"n_crit": (9.0, 3.0)}, "n_crit must rise from least to largest; it is 9 and 3"),
        ({"n_crit": (0.0, 3.0)}, "n_crit must be within 0.1 ... 30; it is 0"),
    ],
)
def test_sizes_that_mean_nothing_are_refused(asked: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError) as caught:
        Uncertainties(**asked)
    assert str(caught.value) == message
