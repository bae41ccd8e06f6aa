"""What a search has tried: recorded without waiting for the disk, and read again."""

from pathlib import Path

import openmdao.api as om
from numpy.testing import assert_allclose

from propmdao.components.drivers.search_history import SearchRecorder, read_history


def test_cases_are_recorded_and_no_write_is_waited_for(tmp_path: Path) -> None:
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", om.ExecComp("f = (x - 2.0) ** 2"), promotes=["*"])
    prob.model.add_design_var("x", lower=-5.0, upper=5.0)
    prob.model.add_objective("f")
    prob.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", disp=False)
    recorder = SearchRecorder(tmp_path / "cases.sql")
    prob.driver.add_recorder(recorder)
    prob.setup()
    assert prob.run_driver().success
    assert recorder.connection.execute("PRAGMA synchronous").fetchone() == (0,)
    prob.cleanup()
    history = read_history(prob, tmp_path / "cases.sql")
    assert history.objective.size == prob.driver.iter_count
    assert_allclose(history.objective[-1], 0.0, atol=1e-12)
    assert not history.violation.any()
