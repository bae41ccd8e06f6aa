"""The band of small uncertainties is what the group's exact derivatives say."""

import numpy as np
import openmdao.api as om
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.single_point import analyze
from propmdao.analysis.uncertainty import Uncertainties, band
from propmdao.components import PropellerGroup

OBSERVERS = arc(1.905, [-45.0, 0.0])
TWIST, CHORD = 0.02, 2e-4  # deg, fraction


def test_small_bands_are_derivatives(propeller, small):
    prob = om.Problem(reports=False)
    group = PropellerGroup(propeller=propeller, observers=OBSERVERS, fidelity=small)
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    prob.model.set_input_defaults("speed", 8.0, units="m/s")
    prob.model.set_input_defaults("thrust_required", 1.2, units="N")
    prob.setup()
    prob.run_model()
    names = ["rpm", "shaft_power", "spl_bpf_db"]
    totals = prob.compute_totals(of=names, wrt=["beta", "chord_over_R"])

    analysis = analyze(propeller, thrust=1.2, speed=8.0, observers=OBSERVERS, fidelity=small)
    size = Uncertainties(twist_deg=TWIST, chord=CHORD, n_crit=(5.0, 5.0), drag=0.0)
    found = band(analysis, size)
    assert found.left_out == []
    turn, widen = np.radians(TWIST), CHORD * propeller.c_over_R
    for name in names:
        by_twist = totals[name, "beta"].sum(axis=1) * turn
        by_chord = totals[name, "chord_over_R"] @ widen
        for effect, exact in zip(found.effects, (by_twist, by_chord), strict=False):
            low, high = (np.atleast_1d(end[name]) for end in effect.changes)
            assert_allclose(0.5 * (high - low), exact, rtol=1e-3, err_msg=f"{name}, {effect.name}")
        both = np.hypot(by_twist, by_chord)
        assert_allclose(np.atleast_1d(found.above[name]), both, rtol=5e-3)
        assert_allclose(np.atleast_1d(found.below[name]), -both, rtol=5e-3)
