"""Noise of a march in time: in axial flight that of the steady solution."""

from __future__ import annotations

import pytest

import propmdao as pm


@pytest.mark.slow
def test_noise_of_a_march_is_that_of_the_steady_solution():
    asked = {
        "rpm": 4200.0,
        "speed": 4.0,
        "observers": pm.arc(1.905, [-45.0]),
        "broadband": True,
        "fidelity": pm.Fidelity(
            n_chordwise=2, n_spanwise=8, n_contour=21, n_surface_span=12, n_harmonics=3
        ),
    }
    propeller = pm.load_propeller("apcsf_11x4.7")
    steady = pm.analyze(propeller, **asked).to_dict()
    march = {"unsteady": True, "revolutions": 2, "average": 1, "timestep_deg": 15.0}
    marched = pm.analyze(propeller, **march, **asked).to_dict()
    # The far wake of a march has half as many filaments.
    assert marched["thrust"] == pytest.approx(steady["thrust"], rel=5e-3)
    heard, expected = marched["observers"][0], steady["observers"][0]
    for name in ("oaspl_db", "oaspl_broadband_db", "oaspl_total_dba"):
        assert heard[name] == pytest.approx(expected[name], abs=0.1)
