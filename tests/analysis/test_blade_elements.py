"""Analyses by blade elements, whole."""

import numpy as np
import pytest
from shared_mesh import COARSE

import propmdao as pm
from propmdao.analysis.request import Request
from propmdao.analysis.sweeping.batches import analyze_each
from propmdao.propeller.catalog import catalog_names

PROPELLER = pm.load_propeller("apcsf_11x4.7")
TILTED = pm.Fidelity(n_chordwise=2, n_spanwise=6, n_azimuths=12)
POINT = {"rpm": 4200.0, "speed": 4.0, "fidelity": COARSE}


def test_an_analysis_by_blade_elements_has_loads_and_noise():
    """Near those of the lattice: up to a fifth more thrust on this wide blade, a decibel or two."""
    observers = pm.arc(1.905, [-30.0])
    asked = {"observers": observers, "broadband": True, **POINT}
    elements, lattice = (
        pm.analyze(PROPELLER, blade_element=chosen, **asked) for chosen in (True, False)
    )
    assert bool(elements.loads.converged)
    ratio = float(elements.loads.thrust / lattice.loads.thrust)
    assert 1.0 < ratio < 1.2
    for level in ("oaspl_db", "oaspl_broadband_db"):
        of_elements, of_lattice = (
            analysis.to_dict()["observers"][0][level] for analysis in (elements, lattice)
        )
        assert abs(of_elements - of_lattice) < 2.5
    assert Request.from_dict(elements.to_dict()).model == elements.model


@pytest.mark.slow  # batches of trimmed blade elements are tested, too
def test_a_thrust_is_reached():
    analysis = pm.analyze(PROPELLER, thrust=1.5, speed=4.0, blade_element=True)
    np.testing.assert_allclose(float(analysis.loads.thrust), 1.5, rtol=1e-8)


@pytest.mark.slow
def test_at_an_incidence_they_have_loads_around_the_turn_and_noise():
    """A drone that leans forward by 20 deg, at its thrust; sweeps have the same numbers."""
    asked = {"thrust": 1.5, "speed": 8.0, "incidence_deg": 70.0, "fidelity": TILTED}
    observers = pm.arc(1.905, [-90.0])
    analysis = pm.analyze(PROPELLER, **asked, observers=observers, blade_element=True)
    loads = analysis.loads
    assert bool(loads.converged)
    np.testing.assert_allclose(float(loads.thrust), 1.5, rtol=1e-8)
    assert loads.circulation.shape == (12, 1, 6)
    # The side that advances carries more; below the hub only loads that change are heard.
    assert float(loads.hub_moment[0]) < 0.0
    assert analysis.to_dict()["observers"][0]["oaspl_loading_db"] > 30.0
    mixed = [{**asked, "incidence_deg": i, "blade_element": True} for i in (0.0, 70.0)]
    swept = [outcome.result for outcome in analyze_each(PROPELLER, mixed)]
    assert swept[1].rpm == pytest.approx(analysis.rpm, rel=1e-9)
    assert swept[0].rpm != pytest.approx(analysis.rpm, rel=1e-3)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"unsteady": True}, "blade elements have no wake to march"),
    ],
)
def test_what_blade_elements_cannot_do_is_refused(asked, words):
    with pytest.raises(ValueError, match=words):
        pm.analyze(PROPELLER, blade_element=True, **POINT, **asked)


def test_the_difference_of_both_grows_with_the_chord():
    """What the annuli leave out is the curvature of the flow over a wide blade."""
    ratios = []
    for chord_factor in (0.3, 1.0):
        asked = {"chord_factor": chord_factor, **POINT}
        thrusts = [
            float(pm.analyze(PROPELLER, blade_element=chosen, **asked).loads.thrust)
            for chosen in (True, False)
        ]
        ratios.append(thrusts[0] / thrusts[1])
    assert 0.97 < ratios[0] < ratios[1]


@pytest.mark.parametrize("name", catalog_names())
def test_every_propeller_of_the_catalogue_has_loads(name):
    """Swept tips, too, whose quarter line ends beyond the tip radius."""
    loads = pm.analyze(
        pm.load_propeller(name), rpm=4000.0, blade_element=True, fidelity=COARSE
    ).loads
    assert bool(loads.converged)
    assert float(loads.thrust) > 0.0
