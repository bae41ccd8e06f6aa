"""Slow flyers at the incidence at which they flew: hover and flight agree in one blade.

The twist is that with which thrust is zero where it was measured to be, so nothing of what is
compared here is fitted. A lattice, a wake or polars that were wrong in hover or in flight would
show, whatever the described blade angle.
"""

import importlib.util
import sys

import numpy as np
import pytest

pytest.importorskip("matplotlib")  # which the study draws with
pytestmark = [
    pytest.mark.validation,
    pytest.mark.slow,
    # The tip is slower than the polars reach.
    pytest.mark.filterwarnings(
        "ignore::propmdao.aerodynamics.sections.polars.table.PolarRangeWarning"
    ),
]
SLOW_FLYERS = ("apcsf_9x4.7", "apcsf_10x4.7", "apcsf_10x7", "apcsf_11x4.7")


@pytest.fixture(scope="module")
def study(checkout):
    path = checkout / "studies" / "validation" / "aerodynamic_validation.py"
    spec = importlib.util.spec_from_file_location("aerodynamic_validation", path)
    module = importlib.util.module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, spec.name, module)  # where its dataclasses look
        spec.loader.exec_module(module)
        yield module


def test_thrust_of_slow_flyers_in_hover_and_flight(study):
    rows = study.summary([study.compared((name, True)) for name in SLOW_FLYERS])
    turned = study.TURNED
    assert [row[f"{turned}: not converged"] for row in rows] == [0] * len(rows)
    static, flight = (
        np.array([row[f"{turned}: {name}"] for row in rows])
        for name in ("static CT", "CT to J 0.5")
    )
    # Found: +1.8 and +0.9 % with photographed blade angles, +4 and +1 with the maker's.
    assert abs(static.mean()) < 6.0 and np.abs(static).max() < 12.0
    assert abs(flight.mean()) < 4.0 and np.abs(flight).max() < 6.0
    # One offset for the blade: it is of the size to which blade angles are known.
    assert np.abs([row["twist"] for row in rows]).max() < 3.0
