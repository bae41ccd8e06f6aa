"""Points that share a blade, analysed together: the numbers of single analyses, and failures."""

from __future__ import annotations

from typing import Any

import jax
import numpy as np
import pytest
from shared_mesh import COARSE

import propmdao as pm
from propmdao.aerodynamics import calls
from propmdao.aerodynamics.solutions import axial
from propmdao.analysis.request import Request
from propmdao.analysis.results import Analysis
from propmdao.analysis.sweeping import batches
from propmdao.analysis.sweeping.batches import analyze_each

PROPELLER = pm.load_propeller("apcsf_11x4.7_uiuc")
SMALL: dict[str, Any] = {"fidelity": COARSE}
ELEMENTS: dict[str, Any] = {"blade_element": True, **SMALL}


def counted_blades(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What blades are made ready of from now on."""
    made: list[Any] = []
    of = batches.ModelledBlade.of

    def counted(*values: Any) -> Any:
        made.append(values)
        return of(*values)

    monkeypatch.setattr(batches.ModelledBlade, "of", counted)
    return made


def numbers(analysis: Any) -> list[float]:
    assert isinstance(analysis, Analysis)
    results = analysis.to_dict()
    return [results[name] for name in ("rpm", "thrust", "torque", "J", "CT", "CQ", "eta")]


@pytest.mark.parametrize("drive", ["rpm", pytest.param("thrust", marks=pytest.mark.slow)])
def test_blade_elements_in_batches_are_those_of_single_points(drive: str) -> None:
    """Two blades, one batch each, in the order that was asked."""
    values = {"rpm": (3000.0, 5000.0), "thrust": (1.0, 2.0)}[drive]
    asked: list[Any] = [
        {drive: value, "speed": speed, "twist_offset_deg": offset, **ELEMENTS}
        for speed in (0.0, 6.0)
        for offset in (0.0, 2.0)
        for value in values
    ]
    together = [numbers(outcome.result) for outcome in analyze_each(PROPELLER, asked)]
    alone = [numbers(pm.analyze(PROPELLER, **one)) for one in asked]
    np.testing.assert_allclose(together, alone, rtol=1e-8)


def test_failures_are_of_their_points() -> None:
    """More points than fit into one call, of which some cannot be."""
    asked: list[Any] = [
        {"thrust": thrust, "speed": speed, **ELEMENTS}
        for thrust, speed in ((1.0, 4.0), (500.0, 4.0), (1.0, 310.0), (-1.0, 4.0), (2.0, 4.0))
    ]
    asked += [asked[0]] * calls.MANY
    outcomes = list(analyze_each(PROPELLER, asked))
    said = [str(o.result) if isinstance(o.result, Exception) else "" for o in outcomes]
    assert said[0] == said[4] == ""
    assert said[1].startswith("thrust 500 N is out of reach at 4 m/s: ")
    assert said[2].startswith("speed must be below 306.265 m/s to trim")
    assert said[3].startswith("thrust must be within")
    last = outcomes[-1].result
    assert isinstance(last, Analysis) and float(last.loads.thrust) == pytest.approx(1.0)
    fast: Any = {"rpm": 4e5, "speed": 0.0, **ELEMENTS}
    (outcome,) = analyze_each(PROPELLER, [fast])
    assert "tip Mach number must be below 1" in str(outcome.result)


def test_a_call_that_fails_fails_its_points(monkeypatch: pytest.MonkeyPatch) -> None:
    def out_of_memory(*_: Any) -> Any:
        raise MemoryError("no room")

    monkeypatch.setattr(batches, "_solve_all", out_of_memory)
    asked: list[Any] = [{"rpm": 3000.0, **ELEMENTS}, {"rpm": -1.0, **ELEMENTS}]
    first, second = analyze_each(PROPELLER, asked)
    assert isinstance(first.result, MemoryError)
    assert isinstance(second.result, ValueError)


def test_rotation_speeds_and_thrusts_may_be_mixed() -> None:
    """And requests with single values; each in the call of its kind."""
    asked: list[Any] = [
        {"thrust": 1.0, "speed": 4.0, **ELEMENTS},
        Request.of(rpm=4000.0, **ELEMENTS),
        {"thrust": 2.0, "speed": 4.0, **ELEMENTS},
    ]
    first, second, third = (outcome.said() for outcome in analyze_each(PROPELLER, asked))
    assert [float(a.loads.thrust) for a in (first, third)] == pytest.approx([1.0, 2.0])
    assert second.rpm == 4000.0


def trimmed() -> list[list[float]]:
    """Numbers of a blade at three thrusts by blade elements, and how many devices had them."""
    asked: list[Any] = [{"thrust": thrust, "speed": 4.0, **ELEMENTS} for thrust in (1.0, 1.5, 2.0)]
    found = [numbers(outcome.result) for outcome in analyze_each(PROPELLER, asked)]
    return [*found, [float(jax.local_device_count())]]


@pytest.mark.slow  # another process compiles all of it again
def test_two_devices_have_the_points_of_one(on_devices: Any) -> None:
    *there, two = on_devices(2, __file__, "trimmed")
    *here, one = trimmed()
    assert (two, one) == ([2.0], [1.0])
    np.testing.assert_allclose(there, here, rtol=1e-9)


@pytest.mark.slow  # it compiles the lattice twice
@pytest.mark.parametrize(
    "drive", [{"rpm": (3000.0, 5000.0, 4e5)}, {"thrust": (1.0, 2.0, 500.0)}], ids=["rpm", "thrust"]
)
def test_the_lattice_goes_in_calls_of_several_points(
    monkeypatch: pytest.MonkeyPatch, drive: dict[str, tuple[float, ...]]
) -> None:
    """With the numbers and the failures of points that are solved for alone."""
    ((name, values),) = drive.items()
    asked: list[Any] = [{name: value, "speed": 4.0, **SMALL} for value in values]
    solvers = []
    for solve in ("_solve_all", "_trim_all"):
        function = getattr(batches, solve)
        monkeypatch.setattr(
            batches, solve, lambda *args, f=function: (solvers.append(args[0]), f(*args))[1]
        )
    alone = [next(analyze_each(PROPELLER, [one])) for one in asked]
    assert not solvers  # the code of one point is compiled already
    made = counted_blades(monkeypatch)
    together = list(analyze_each(PROPELLER, asked))
    assert solvers == [axial] and len(made) == 1
    for one, other in zip(together[:2], alone[:2], strict=True):
        np.testing.assert_allclose(numbers(one.result), numbers(other.result), rtol=1e-8)
    assert str(together[2].result) == str(alone[2].result) != ""
    monkeypatch.setattr(calls, "is_accelerated", lambda: True)
    monkeypatch.setattr(calls, "MANY", 4)  # the code of which is compiled
    (on_accelerator,) = analyze_each(PROPELLER, asked[:1])
    assert solvers == [axial, axial]  # whatever their number
    np.testing.assert_allclose(numbers(on_accelerator.result), numbers(alone[0].result), rtol=1e-8)


def test_a_blade_is_made_ready_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the lattice, too; of two points, for which no code of several is compiled."""
    made = counted_blades(monkeypatch)
    asked: list[Any] = [{"rpm": rpm, **SMALL} for rpm in (3000.0, 5000.0)]
    outcomes = list(analyze_each(PROPELLER, asked))
    assert len(made) == 1
    alone = pm.analyze(PROPELLER, **asked[1])
    np.testing.assert_allclose(numbers(outcomes[1].result), numbers(alone), rtol=1e-12)


def test_a_blade_that_cannot_be_fails_at_all_its_points() -> None:
    wide: list[Any] = [{"rpm": rpm, "chord_factor": 100.0, **ELEMENTS} for rpm in (3e3, 4e3)]
    first, second = analyze_each(PROPELLER, wide)
    assert isinstance(first.result, ValueError)
    assert str(first.result) == str(second.result)
