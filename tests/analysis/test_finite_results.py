"""No result that is no number leaves an analysis: it is a failure with a name, row or line."""

from __future__ import annotations

import csv
import dataclasses
import json
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis import single_point
from propmdao.analysis.flights import flyovers
from propmdao.analysis.flights.flyover_results import Flight
from propmdao.analysis.single_point import analyze
from propmdao.analysis.sweeping.sweeps import sweep
from propmdao.analysis.wopwop import foreign_case
from propmdao.commands.output.json_output import print_json
from propmdao.formats.propellers import load_propeller
from propmdao.runtime.finite import NotFiniteError

PROPELLER = load_propeller("apcsf_11x4.7_uiuc")
ASKED: dict[str, Any] = {
    "rpm": 4200.0,
    "speed": 8.0,
    "fidelity": COARSE,
    "observers": arc(1.905, [-45.0, 0.0]),
}


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> Any:
    """``broken(module, name, place)``: what a function returns has a nan there in every array."""

    def broken(module: Any, name: str, *place: int) -> None:
        function = getattr(module, name)

        def with_nan(*values: Any, **named: Any) -> Any:
            return jax.tree.map(
                lambda x: jnp.asarray(x).at[place].set(jnp.nan) if jnp.ndim(x) == len(place) else x,
                function(*values, **named),
            )

        monkeypatch.setattr(module, name, with_nan)

    return broken


def test_tones_that_are_no_numbers_are_named_with_observer_and_harmonic(broken: Any) -> None:
    broken(single_point, "tones", 1, 0)
    message = "^loading noise of observer 2, harmonic 1 is .*nan.*, at 4200 rpm and 8 m/s$"
    with pytest.raises(NotFiniteError, match=message):
        analyze(PROPELLER, **ASKED)


def test_broadband_noise_is_named_with_mechanism_observer_and_band(broken: Any) -> None:
    broken(single_point, "self_noise", 0, 3)
    message = r"^broadband \w+ of observer 1, 100 Hz is nan, at 4200 rpm and 8 m/s$"
    with pytest.raises(NotFiniteError, match=message):
        analyze(PROPELLER, **ASKED, broadband=True)


def test_loads_are_named_with_their_section(monkeypatch: pytest.MonkeyPatch) -> None:
    solve = single_point._solve

    def with_nan(*values: Any) -> Any:
        loads, state = solve(*values)
        strip_thrust = loads.strip_thrust.at[2].set(jnp.nan)
        return dataclasses.replace(loads, strip_thrust=strip_thrust), state

    monkeypatch.setattr(single_point, "_solve", with_nan)
    message = r"^strip_thrust of r/R 0\.\d\d is nan, at 4200 rpm and 8 m/s$"
    with pytest.raises(NotFiniteError, match=message):
        analyze(PROPELLER, **ASKED)


def test_a_sweep_has_a_failed_row(broken: Any, tmp_path: Any) -> None:
    broken(single_point, "tones", 1, 0)
    asked = {name: value for name, value in ASKED.items() if name not in ("rpm", "speed")}
    table = tmp_path / "table.csv"
    _, failures = sweep(PROPELLER, [{"rpm": 4200.0}], table, **asked)
    assert len(failures) == 1 and "loading noise of observer 2" in failures[0]
    with table.open(newline="") as stream:
        (row,) = csv.DictReader(stream)
    assert failures[0] in row.values()
    assert not any(value == "nan" for value in row.values())


def test_a_flyover_names_source_time_and_band(broken: Any) -> None:
    analysis = analyze(PROPELLER, **ASKED, broadband=True)
    broken(flyovers, "_broadband", 1, 3)
    message = r"^broadband noise of -?\d+\.\d s, 100 Hz is nan, at 4200 rpm and 8 m/s$"
    with pytest.raises(NotFiniteError, match=message):
        flyovers.fly_over(analysis, Flight(20.0, duration=2.0))


def test_a_case_names_source_observer_time_and_file(
    make_case: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    source_history = foreign_case.source_history

    def with_nan(*values: Any) -> Any:
        return np.where(np.arange(128) == 64, np.nan, source_history(*values))

    monkeypatch.setattr(foreign_case, "source_history", with_nan)
    with pytest.raises(NotFiniteError, match=r"noise of observer 1, 0\.0\d+ s is nan, in .*case"):
        foreign_case.run_case(make_case())


def test_json_has_numbers_only(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(NotFiniteError, match="^oaspl_db is nan$"):
        print_json({"observers": [{"oaspl_db": float("nan")}]})
    assert capsys.readouterr().out == ""
    print_json({"failure": None, "zero": -0.0})
    assert json.loads(capsys.readouterr().out) == {"failure": None, "zero": 0.0}
