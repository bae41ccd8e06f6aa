"""pyOptSparse, where it is installed: it finds the blade that SciPy finds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import openmdao.api as om
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import PropellerGroup
from propmdao.records.fidelity import Fidelity


def quietest(driver: om.Driver, fidelity: Fidelity) -> om.Problem:
    """Optimise twist and chord for the tones, with a limit of the torque."""
    prob = om.Problem(reports=False, driver=driver)
    group = PropellerGroup(
        propeller="apcsf_11x4.7_uiuc",
        observers=arc(1.905, -45.0),
        fidelity=fidelity,
        rpm_bounds=(2000.0, 9000.0),
        design_distributions={"beta": [0.15, 0.5, 1.0], "chord_over_R": [0.15, 0.5, 1.0]},
        control="increments",
    )
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    prob.model.set_input_defaults("speed", 8.0, units="m/s")
    prob.model.set_input_defaults("thrust_required", 1.2, units="N")
    prob.model.add_design_var("beta_cp", lower=-5.0, upper=5.0, units="deg", ref=5.0)
    prob.model.add_design_var("chord_over_R_cp", lower=0.9, upper=1.2)
    prob.model.add_objective("oaspl_db", ref=10.0)
    prob.model.add_constraint("torque", upper=0.042, units="N*m", ref=0.04)
    prob.setup()
    prob.run_driver()
    return prob


def test_slsqp_of_pyoptsparse_finds_the_blade_of_scipys(
    small: Fidelity, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pyoptsparse", reason="pyOptSparse, which has no wheel, is not installed")
    monkeypatch.chdir(tmp_path)  # it leaves a file of its search
    theirs = om.pyOptSparseDriver(optimizer="SLSQP", print_results=False)
    theirs.opt_settings["ACC"] = 1e-6
    found = quietest(theirs, small)
    scipys = quietest(om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-6, disp=False), small)
    assert found.driver.result.success and scipys.driver.result.success
    np.testing.assert_allclose(found.get_val("oaspl_db"), scipys.get_val("oaspl_db"), atol=1e-3)
    assert found.get_val("torque", units="N*m")[0] <= 0.042 * (1.0 + 1e-5)
