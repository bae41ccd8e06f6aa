"""Samples of OpenMDAO's generators into a table: rows, failures, resuming, workers."""

import csv
import functools
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import openmdao.api as om
import pytest
from openmdao.drivers.analysis_generator import CSVGenerator, ProductGenerator
from openmdao.drivers.sampling.pyDOE_generators import LatinHypercubeGenerator

from propmdao.components import SweepDriver


def run(models, samples, path, factory=None, **options):
    """The Problem of worker_models, x and radius sampled, f and g in the table."""
    prob = (factory or models.build)()
    prob.driver = SweepDriver(samples, table=path, problem_factory=factory, **options)
    prob.run_driver()
    return prob


def samples_of(*designs):
    return [{"x": {"val": np.array(design)}} for design in designs]


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_row_is_the_sample_and_what_the_model_says(models, tmp_path):
    path = tmp_path / "new" / "sweep.csv"
    run(models, samples_of([0.1, 0.2], [1.0, 1.0]), path)
    first, second = rows_of(path)
    assert list(first) == "x[0],x[1],f,g[0],g[1],status,reason".split(",")
    assert float(first["f"]) == 100.0 * (0.2 - 0.1**2) ** 2 + 0.9**2
    assert float(second["g[0]"]) == 1.0 and second["status"] == "ok"


def test_failed_samples_are_rows_with_the_reason_and_cases_marked(models, tmp_path):
    path = tmp_path / "sweep.csv"
    prob = models.build(trouble="value")
    prob.driver = SweepDriver(samples_of([-1.2, 0.0], [0.5, 0.5], [0.0, 1.3]), table=path)
    prob.driver.add_recorder(om.SqliteRecorder(tmp_path / "cases.sql"))
    result = prob.run_driver()
    assert result.success  # one of them has not failed
    reasons = [row["reason"] for row in rows_of(path)]
    assert reasons[0] == "'disc' <class Disc>: Error calling compute(), left of -1"
    assert reasons[1] == ""
    assert "ValueError" in reasons[2] and "chord_over_R must be positive" in reasons[2]
    assert [row["f"] == "" for row in rows_of(path)] == [True, False, True]
    assert prob.driver.failures == [reasons[0], reasons[2]]
    prob.cleanup()
    cases = om.CaseReader(tmp_path / "cases.sql").get_cases("driver")
    assert [case.success for case in cases] == [0, 1, 0]
    assert cases[1]["x"].tolist() == [0.5, 0.5] and cases[1]["f"] == float(rows_of(path)[1]["f"])


def test_a_nan_is_a_failure(tmp_path):
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", om.ExecComp("y = log(x)"), promotes=["*"])
    prob.driver = SweepDriver([{"x": {"val": v}} for v in (1.0, np.nan)], table=tmp_path / "t.csv")
    prob.driver.add_response("y")
    prob.setup()
    prob.run_driver()
    assert [row["reason"] for row in rows_of(tmp_path / "t.csv")] == ["", "y is nan"]


def test_all_failed_is_no_success(models, tmp_path):
    prob = models.build()
    prob.driver = SweepDriver(samples_of([-1.2, 0.0]), table=tmp_path / "t.csv")
    assert not prob.run_driver().success


def test_a_sweep_goes_on_and_takes_more_samples(models, tmp_path, monkeypatch):
    designs = np.random.default_rng(0).uniform(-1.5, 1.5, (12, 2)).tolist()
    straight, path = tmp_path / "straight.csv", tmp_path / "sweep.csv"
    run(models, samples_of(*designs), straight)
    run(models, samples_of(*designs[:5]), path)
    path.write_bytes(path.read_bytes()[:-20])  # as a kill leaves it
    prob = run(models, samples_of(*designs), path)
    assert prob.driver.iter_count == 8  # and one run more, of a sample that the table has
    assert path.read_bytes() == straight.read_bytes()


def test_rows_of_another_model_are_not_gone_on_with(models, tmp_path):
    path = tmp_path / "t.csv"
    samples = samples_of([-1.2, 0.0], [0.1, 0.2], [0.3, 0.4])
    run(models, samples[:2], path)
    before = path.read_bytes()
    with pytest.raises(ValueError, match=r"of another model: at {'x\[0\]': 0.1.* g\[0\] was -0.95"):
        run(models, samples, path, functools.partial(models.build, radius=2.0))
    assert path.read_bytes() == before


def test_a_sample_that_is_given_twice_is_one_row(models, tmp_path):
    run(models, samples_of([0.1, 0.2], [0.3, 0.4], [0.1, 0.2]), tmp_path / "t.csv")
    assert [row["x[0]"] for row in rows_of(tmp_path / "t.csv")] == ["0.1", "0.3"]


def test_generators_of_openmdao(models, tmp_path):
    grid = ProductGenerator({"radius": {"val": [100.0, 200.0], "units": None}, "x": {
        "val": [0.1, 0.2, 0.3], "indices": [1]}})  # fmt: skip
    run(models, grid, tmp_path / "grid.csv")
    rows = rows_of(tmp_path / "grid.csv")
    assert [(float(row["radius"]), float(row["x"])) for row in rows] == [
        (radius, x) for radius in (100.0, 200.0) for x in (0.1, 0.2, 0.3)
    ]
    assert float(rows[0]["g[0]"]) == pytest.approx(0.5**2 + 0.1**2 - 100.0**2)
    (tmp_path / "samples.csv").write_text("radius\n0.5\n2\n")
    run(models, CSVGenerator(tmp_path / "samples.csv"), tmp_path / "listed.csv")
    assert [row["radius"] for row in rows_of(tmp_path / "listed.csv")] == ["0.5", "2.0"]


@pytest.mark.filterwarnings("ignore:Passing a seed")  # OpenMDAO, of pydoe
def test_latin_hypercube_of_openmdao(models, tmp_path):
    pytest.importorskip("pydoe", reason="pydoe, an extra, is not installed")
    hypercube = LatinHypercubeGenerator(
        {"x": {"lower": [-1.0, 0.0], "upper": [1.0, 1.0]}}, samples=10, seed=1
    )
    run(models, hypercube, tmp_path / "t.csv")
    first = sorted(float(row["x[0]"]) for row in rows_of(tmp_path / "t.csv"))
    assert (np.floor((np.array(first) + 1.0) * 5.0) == np.arange(10)).all()


def test_units_of_samples_and_responses(tmp_path):
    prob = om.Problem(reports=False)
    prob.model.add_subsystem(
        "comp", om.ExecComp("y = 2 * x", x={"units": "m"}, y={"units": "m"}), promotes=["*"]
    )
    samples = [{"x": {"val": 5.0, "units": "cm"}}]
    prob.driver = SweepDriver(samples, table=tmp_path / "t.csv")
    prob.driver.add_response("y", units="mm")
    prob.setup()
    prob.run_driver()
    (row,) = rows_of(tmp_path / "t.csv")
    assert float(row["x"]) == 5.0 and float(row["y"]) == pytest.approx(100.0)


def test_workers_make_the_same_table(models, tmp_path):
    designs = np.random.default_rng(1).uniform(-1.5, 1.5, (20, 2)).tolist()
    factory = functools.partial(models.build, trouble="value", radius=2.0)
    run(models, samples_of(*designs), tmp_path / "1.csv", factory)
    with ThreadPoolExecutor(2) as executor:
        run(models, samples_of(*designs), tmp_path / "2.csv", factory, executor=executor)
    assert (tmp_path / "2.csv").read_text() == (tmp_path / "1.csv").read_text()
    assert {row["status"] for row in rows_of(tmp_path / "1.csv")} == {"ok", "failed"}


def test_a_factory_that_fails_is_an_error_and_no_row(models, tmp_path):
    with ThreadPoolExecutor(1) as executor, pytest.raises(ValueError, match="has been set up"):
        prob = models.build()
        prob.driver = SweepDriver(
            samples_of([0.0, 0.0]), table=tmp_path / "t.csv", executor=executor,
            problem_factory=om.Problem,
        )  # fmt: skip
        prob.run_driver()
    assert rows_of(tmp_path / "t.csv") == []


def test_parquet_beside_csv(models, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow, an extra, is not installed")
    run(models, samples_of([0.1, 0.2], [-1.2, 1.0]), tmp_path / "t.parquet")
    assert parquet.read_table(tmp_path / "t.parquet")["x[0]"].to_pylist() == [0.1, -1.2]
    assert len(rows_of(tmp_path / "t.csv")) == 2


def test_wrong_set_ups(models, tmp_path):
    path = tmp_path / "t.csv"
    with pytest.raises(ValueError, match="sampled 'f' is no independent variable"):
        run(models, [{"f": {"val": 1.0}}], path)
    with pytest.raises(ValueError, match="a table ends in .csv or .parquet"):
        run(models, samples_of([0.0, 0.0]), tmp_path / "t.xlsx")
    with pytest.raises(ValueError, match="there are no samples"):
        run(models, ProductGenerator({"radius": {"val": []}}), path)
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", om.ExecComp("y = x"), promotes=["*"])
    prob.driver = SweepDriver([{"x": {"val": 1.0}}], table=path)
    prob.setup()
    with pytest.raises(ValueError, match="needs a response; add_responses names them"):
        prob.run_driver()
    run(models, samples_of([0.0, 0.0]), path)
    with pytest.raises(ValueError, match="holds something else than this sweep"):
        run(models, [{"radius": {"val": 1.0}}], path)


def test_an_interrupted_sweep_keeps_its_rows_and_marks_the_case(models, tmp_path, monkeypatch):
    compute = models.Disc.compute

    def interrupted(self, inputs, outputs):
        if inputs["x"][0] == 0.3:
            raise KeyboardInterrupt
        compute(self, inputs, outputs)

    monkeypatch.setattr(models.Disc, "compute", interrupted)
    prob = models.build()
    samples = samples_of([0.1, 0.0], [0.3, 0.0], [0.5, 0.0])
    prob.driver = SweepDriver(samples, table=tmp_path / "t.csv")
    prob.driver.add_recorder(om.SqliteRecorder(tmp_path / "cases.sql"))
    with pytest.raises(KeyboardInterrupt):
        prob.run_driver()
    prob.cleanup()
    assert [row["x[0]"] for row in rows_of(tmp_path / "t.csv")] == ["0.1"]
    cases = om.CaseReader(tmp_path / "cases.sql").get_cases("driver")
    assert [case.success for case in cases] == [1, 0]
