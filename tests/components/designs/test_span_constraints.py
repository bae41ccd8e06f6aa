"""Chord between stations: a cubic spline swings, and its factor on the described chord says so."""

from __future__ import annotations

import numpy as np
import openmdao.api as om
from numpy.testing import assert_allclose
from openmdao.utils.assert_utils import assert_check_partials
from scipy.interpolate import CubicSpline

from propmdao.components.designs.span_constraints import LinearComp, chord_factors

STATIONS = np.array([0.2, 0.4, 0.6, 0.8, 1.0])
CHORD = np.array([0.12, 0.2, 0.22, 0.18, 0.05])


def test_a_scaled_chord_has_its_factor_everywhere():
    assert_allclose(chord_factors(STATIONS, CHORD) @ (1.3 * CHORD), 1.3)


def test_positive_chords_that_swing_below_zero_are_seen():
    swinging = np.array([0.3, 0.004, 0.3, 0.004, 0.3])
    between = np.linspace(0.2, 1.0, 401)
    assert CubicSpline(STATIONS, swinging)(between).min() < 0.0 < swinging.min()
    assert (chord_factors(STATIONS, CHORD) @ swinging).min() < 0.0


def test_the_product_has_its_derivatives():
    matrix = np.arange(6.0).reshape(2, 3)
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("product", LinearComp(matrix=matrix), promotes=["*"])
    prob.setup()
    prob.set_val("distribution", [1.0, 2.0, 3.0])
    prob.run_model()
    assert_allclose(prob.get_val("values"), matrix @ [1.0, 2.0, 3.0])
    assert_check_partials(prob.check_partials(out_stream=None, method="fd"))
