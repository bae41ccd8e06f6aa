"""An analysis at an incidence: what is asked, found, heard, and refused."""

import numpy as np
import pytest

import propmdao as pm
from propmdao.aerodynamics.solutions.edgewise import FastEdgewiseWarning
from propmdao.analysis.flights.flyovers import fly_over
from propmdao.analysis.single_point import analyze
from propmdao.records.fidelity import Fidelity
from propmdao.records.wake_law import WakeGrid

COARSE = Fidelity(
    n_chordwise=2,
    n_spanwise=5,
    n_contour=9,
    n_surface_span=6,
    n_harmonics=3,
    n_azimuths=8,
    period_wake=WakeGrid(2.0, 2.0, 1.5, 40.0),
)
PROPELLER = pm.load_propeller("apcsf_11x4.7")
OBSERVERS = pm.arc(1.905, [-90.0, -60.0])


def tilted(**asked):
    point = {"rpm": 4200.0, "speed": 8.0, "incidence_deg": 80.0}
    return analyze(PROPELLER, viscous=False, fidelity=COARSE, **{**point, **asked})


@pytest.fixture(scope="module")
def edgewise():
    return tilted(observers=OBSERVERS)


def test_hub_loads_and_those_of_the_azimuths_are_in_the_results(edgewise):
    result = edgewise.to_dict()
    assert result["point"]["incidence_deg"] == 80.0
    assert result["hub_force"][2] == pytest.approx(result["thrust"], rel=1e-12)
    assert result["hub_moment"][2] == pytest.approx(-result["torque"], rel=1e-12)
    azimuths = result["azimuths"]
    assert [place["azimuth_deg"] for place in azimuths] == list(np.arange(0.0, 360.0, 45.0))
    mean = np.mean([place["blade_force"] for place in azimuths], axis=0)
    np.testing.assert_allclose(2.0 * mean, result["hub_force"], rtol=1e-12)


def test_only_the_part_of_the_flight_along_the_shaft_is_propulsion(edgewise):
    numbers = edgewise.coefficients
    along = numbers.J * np.cos(np.radians(80.0))
    assert numbers.eta == pytest.approx(float(along * numbers.CT / numbers.CP), rel=1e-9)


def test_unsteady_loading_is_heard_on_the_axis(edgewise):
    axial = tilted(incidence_deg=0.0, observers=OBSERVERS)
    heard, silent = (analysis.to_dict()["observers"] for analysis in (edgewise, axial))
    # Steady loads have no tone on the axis at all.
    assert silent[0]["spl_bpf_db"] < -100.0 and heard[0]["spl_bpf_db"] > 40.0
    assert heard[1]["spl_bpf_db"] > silent[1]["spl_bpf_db"] + 10.0


def test_rotation_speed_for_a_thrust(edgewise):
    trimmed = tilted(rpm=None, thrust=float(edgewise.loads.thrust))
    assert trimmed.loads.converged
    assert trimmed.rpm == pytest.approx(4200.0, rel=1e-6)


def test_fast_edgewise_flight_is_warned_of():
    with pytest.warns(FastEdgewiseWarning, match=r"advance ratio .* 0\.32\d* is above 0\.3"):
        tilted(speed=20.0)


@pytest.mark.parametrize(
    ("asked", "complaint"),
    [
        ({"incidence_deg": 151.0}, "incidence_deg must be within 0 ... 150 deg; it is 151"),
        ({"incidence_deg": float("nan")}, "incidence_deg must be within 0 ... 150 deg; it is nan"),
        ({"broadband": True}, "incidence_deg must be 0 for broadband noise"),
        ({"surroundings": pm.Surroundings(ground=10.0)}, "incidence_deg must be 0 for sound over"),
    ],
)
def test_what_is_not_modelled_is_refused(asked, complaint):
    with pytest.raises(ValueError, match=complaint):
        tilted(observers=pm.arc(1.905, [-45.0]), **asked)


def test_a_flyover_is_of_axial_flight(edgewise):
    with pytest.raises(ValueError, match="incidence_deg must be 0 for a flyover"):
        fly_over(edgewise, pm.Flight(height=50.0))
