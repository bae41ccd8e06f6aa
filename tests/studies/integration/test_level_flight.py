"""Level flight with the incidence as a control: exact derivatives, less energy than the guess."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import pytest

pytest.importorskip("dymos")

pytestmark = pytest.mark.slow  # the periodic lattice with its derivatives, at eight nodes


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("level_flight")


def test_totals_of_the_phase_against_differences(study, around, assert_phase_totals):
    prob = study.level_flight(segments=2, fidelity=around)
    prob.run_model()
    assert_phase_totals(prob, {"incidence", "thrust_required", "speed"})


def test_the_drone_leans_forward_and_back_at_its_weight(study, around):
    prob = study.level_flight(segments=2, fidelity=around)
    assert prob.run_driver().success

    def series(name):
        return prob.get_val(f"trajectory.flight.timeseries.{name}")[:, 0]

    share = series("lift") / study.WEIGHT  # never less, and hardly more than the weight
    assert 1.0 - 1e-5 < share.min() and share.max() < 1.001
    assert series("distance")[-1] == pytest.approx(study.DISTANCE, rel=1e-5)
    assert series("speed")[-1] == pytest.approx(study.START, rel=1e-4)
    incidence = series("incidence")  # in deg, as the control
    assert incidence[0] < 88.0 < 92.0 < incidence[-1]
