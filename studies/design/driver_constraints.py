"""Drivers and constraints: small problems with known optima, solved by every driver.

A constraint that a driver does not enforce is worse than none, because the result looks valid. Here
every driver that comes with OpenMDAO and needs no other package meets vector, two-sided and
equality constraints and an analysis that fails on a part of the domain. A table says what it
returned: the objective above the known optimum where all constraints hold within the tolerance, or
by how much one is violated, or how the run ended; and how often it ran the model. An objective
below the optimum uses up the tolerance of a constraint (`equality_tolerance` of propmdao's driver).
"""

import argparse
import contextlib
import csv
import io
import os
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import openmdao.api as om
from openmdao.core.driver import Driver
from rich import box
from rich.console import Console
from rich.table import Table

from propmdao.components import DifferentialEvolutionDriver
from propmdao.runtime.output_files import replacing

TOLERANCE = 1e-3  # of a constraint, absolute; all are of order one
GENERATIONS, POPULATION, SEED = 100, 40, 1


class Case(NamedTuple):
    """A problem: objective and constraints of x, bounds, and the optimum that is known."""

    function: Callable[[np.ndarray], tuple[Any, Any]]  # a float and an array-like
    lower: list[float]
    upper: list[float]
    constraint: dict[str, Any]
    optimum: float


def failing(x: np.ndarray) -> tuple[Any, Any]:
    """Objective whose minimum would lie at 0.2 if the analysis did not fail below 0.3."""
    if x[0] < 0.3:
        raise om.AnalysisError("stalled below 0.3")
    return (x[0] - 0.2) ** 2 + 1.0, x[:1]


def g06(x: np.ndarray) -> tuple[Any, Any]:
    """Floudas and Pardalos 1987, divided by 1000; 0.003 % of the domain are feasible."""
    first = (100.0 - (x[0] - 5.0) ** 2 - (x[1] - 5.0) ** 2) / 100.0
    second = ((x[0] - 6.0) ** 2 + (x[1] - 5.0) ** 2 - 82.81) / 100.0
    return ((x[0] - 10.0) ** 3 + (x[1] - 20.0) ** 3) / 1000.0, [first, second]


CASES = {
    "vector, first element active": Case(
        lambda x: (x @ x, x), [-2.0] * 3, [2.0] * 3, {"lower": [1.0, -9.0, -9.0]}, 1.0
    ),
    "vector, last element active": Case(
        lambda x: (x @ x, x), [-2.0] * 3, [2.0] * 3, {"lower": [-9.0, -9.0, 1.0]}, 1.0
    ),
    "two-sided, upper side active": Case(
        lambda x: (3.0 - x[0], x), [-1.0], [1.0], {"lower": -0.25, "upper": 0.5}, 2.5
    ),
    "two-sided, lower side active": Case(
        lambda x: (3.0 + x[0], x), [-1.0], [1.0], {"lower": -0.25, "upper": 0.5}, 2.75
    ),
    "equality": Case(lambda x: (x @ x, x.sum()), [-1.0] * 2, [1.0] * 2, {"equals": 1.0}, 0.5),
    "g06, small feasible set": Case(g06, [13.0, 0.0], [100.0] * 2, {"upper": 0.0}, -6.96181388),
    "analysis fails below the optimum": Case(failing, [0.0], [1.0], {"upper": 2.0}, 1.01),
}


class Model(om.ExplicitComponent):
    """Objective f and constraints g of a case, which counts its runs."""

    def initialize(self) -> None:
        """Declare the case."""
        self.options.declare("case", recordable=False)

    def setup(self) -> None:
        """Start in the middle of the bounds, which is feasible in no case but the last."""
        case = self.options["case"]
        middle = 0.5 * (np.array(case.lower) + np.array(case.upper))
        self.runs = 0
        self.add_input("x", middle)
        self.add_output("f")
        self.add_output("g", shape=np.size(case.function(middle)[1]))
        self.declare_partials("*", "*", method="fd", form="central")

    def compute(self, inputs: Any, outputs: Any, *_: Any) -> None:
        """Run once."""
        self.runs += not self.under_approx  # steps of differences are not runs of a driver
        outputs["f"], outputs["g"] = self.options["case"].function(inputs["x"])


def drivers() -> dict[str, Driver]:
    """Make every driver, by its name in the table, all with about as many designs."""
    generations = {"max_gen": GENERATIONS, "pop_size": POPULATION}
    evolution = om.ScipyOptimizeDriver(optimizer="differential_evolution", disp=False)
    evolution.opt_settings.update(seed=SEED, maxiter=GENERATIONS, popsize=POPULATION // 2)
    others = {
        f"Scipy {name}": om.ScipyOptimizeDriver(optimizer=name, tol=1e-6, maxiter=1000, disp=False)
        for name in ("SLSQP", "COBYLA", "COBYQA", "trust-constr")
    }
    return {
        "propmdao DE": DifferentialEvolutionDriver(
            **generations, seed=SEED, tol=1e-8, best_file=None, disp=False
        ),
        "OpenMDAO DE": om.DifferentialEvolutionDriver(**generations),
        "SimpleGA": om.SimpleGADriver(**generations, bits={"x": 16}),
        "Scipy DE": evolution,
        **others,
    }


def solve(case: Case, driver: Driver) -> tuple[str, int]:
    """Solve a case with a driver: how it ends, and how often it ran the model."""
    prob = om.Problem(driver=driver, reports=False)
    prob.model.add_subsystem("comp", Model(case=case), promotes=["*"])
    prob.model.add_design_var("x", lower=case.lower, upper=case.upper)
    prob.model.add_constraint("g", **case.constraint)
    prob.model.add_objective("f")
    prob.setup()
    prob.set_solver_print(-1)
    try:
        prob.run_driver()
    except Exception as error:
        return f"ends by {type(error).__name__}", prob.model.comp.runs
    f, g = prob.get_val("f")[0], prob.get_val("g")
    if not np.isfinite(f):
        return "returns nan", prob.model.comp.runs
    equals = case.constraint.get("equals")
    low = case.constraint.get("lower", -np.inf) if equals is None else equals
    high = case.constraint.get("upper", np.inf) if equals is None else equals
    violation = np.max(np.maximum(low - g, g - high))
    if violation > TOLERANCE:
        return f"violated by {violation:.2g}", prob.model.comp.runs
    return f"{f - case.optimum:+.1e}", prob.model.comp.runs


def results() -> dict[str, dict[str, tuple[str, int]]]:
    """Outcomes of `solve`, by case and driver."""
    outcomes: dict[str, dict[str, tuple[str, int]]] = {}
    # OpenMDAO's own drivers take their seed from here.
    os.environ.setdefault("SimpleGADriver_seed", str(SEED))
    os.environ.setdefault("DifferentialEvolutionDriver_seed", str(SEED))
    for name, case in CASES.items():
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            outcomes[name] = {label: solve(case, driver) for label, driver in drivers().items()}
    return outcomes


def main() -> None:
    """Print the tables and write them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default="results", help="folder, default results")
    output = parser.parse_args().output
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        os.environ["OPENMDAO_WORKDIR"] = folder
        outcomes = results()
    names = list(next(iter(outcomes.values())))
    with (
        replacing(output / "driver_constraints.csv") as beside,
        beside.open("w", newline="", encoding="utf-8") as file,
    ):
        writer = csv.writer(file)
        writer.writerow(["case", "driver", "objective above the optimum, or what is wrong", "runs"])
        writer.writerows([case, name, *outcomes[case][name]] for case in outcomes for name in names)
    for half in (names[:4], names[4:]):
        table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
        table.add_column("objective above the optimum | runs")
        for name in half:
            table.add_column(name, justify="right")
        for case, row in outcomes.items():
            table.add_row(case, *(f"{row[name][0]} | {row[name][1]}" for name in half))
        Console(width=160).print(table)


if __name__ == "__main__":
    main()
