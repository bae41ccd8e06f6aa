"""The Problem of benchmarks, in a module that workers can import."""

from __future__ import annotations

import openmdao.api as om

import propmdao as pm
from propmdao.components import PropellerGroup


def low_noise() -> om.Problem:
    """Problem of low noise at 8 m/s and 1.2 N by twist and chord, at full resolution."""
    three_points = [0.15, 0.5, 1.0]
    prob = om.Problem(reports=False)
    prob.model.add_subsystem(
        "propeller",
        PropellerGroup(
            propeller="apcsf_11x4.7_uiuc",
            observers=pm.arc(1.905, -45.0),
            design_distributions={"beta": three_points, "chord_over_R": three_points},
            control="values",
            rpm_bounds=(3000.0, 6000.0),
        ),
        promotes=["*"],
    )
    prob.setup(mode="rev")
    prob.set_val("speed", 8.0)
    prob.set_val("thrust_required", 1.2)
    return prob
