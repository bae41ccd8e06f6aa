"""Problems that workers import and build; as a script, a search that may be killed and resumed."""

import functools
import os
import signal
import sys
import time
from pathlib import Path

import numpy as np
import openmdao.api as om

from propmdao.components import DifferentialEvolutionDriver


class StrangeError(Exception):
    """Pickles, and does not unpickle."""

    def __init__(self, first, second):
        super().__init__(f"{first} and {second}")


class Disc(om.ExplicitComponent):
    """Rosenbrock's valley over a disc; it fails where x_0 < -1, and then does as it is told."""

    def initialize(self):
        self.options.declare("seconds")
        self.options.declare("trouble")
        self.options.declare("flag")

    def setup(self):
        self.add_input("x", np.array([0.5, 0.5]))
        self.add_input("radius", 1.0)
        self.add_output("f")
        self.add_output("g", shape=2)
        self.declare_partials("*", "*", method="fd")

    def compute(self, inputs, outputs):
        x, trouble = inputs["x"], self.options["trouble"]
        time.sleep(self.options["seconds"])
        if trouble == "compile" and not hasattr(self, "compiled"):
            time.sleep(1.6)
            self.compiled = True
        if x[0] < -1.0:
            raise om.AnalysisError("left of -1")
        if trouble not in ("", "compile") and x[1] > 1.2:
            if trouble == "value":
                raise ValueError("chord_over_R must be positive")
            if trouble == "hang":
                if self.options["flag"] is not None:
                    self.options["flag"].touch()
                time.sleep(1000.0)
            if trouble == "strange":
                raise StrangeError("this", "that")
            if not self.options["flag"].exists():
                self.options["flag"].touch()
                os.kill(os.getpid(), signal.SIGKILL)
        outputs["f"] = 100.0 * (x[1] - x[0] ** 2) ** 2 + (1.0 - x[0]) ** 2
        outputs["g"] = [x @ x - inputs["radius"][0] ** 2, x[0]]


def build(seconds=0.0, trouble="", flag=None, radius=1.0):
    """A Problem set up without a driver."""
    prob = om.Problem(reports=False)
    comp = Disc(seconds=seconds, trouble=trouble, flag=flag)
    prob.model.add_subsystem("disc", comp, promotes=["*"])
    prob.model.add_design_var("x", lower=-1.5, upper=1.5)
    prob.model.add_objective("f")
    prob.model.add_constraint("g", upper=[0.0, 2.0])
    prob.setup()
    prob.set_val("radius", radius)
    return prob


def problem(factory=build, **options):
    """The Problem of a factory with the driver."""
    prob = factory()
    defaults = {"seed": 4, "disp": False, "max_gen": 8, "pop_size": 8, "tol": 0.0}
    prob.driver = DifferentialEvolutionDriver(
        **{**defaults, "problem_factory": factory, "best_file": None, **options}
    )
    return prob


if __name__ == "__main__":
    # Workers know the functions of this module by its name, not as those of the script.
    import worker_models

    checkpoint, n_workers, seconds = Path(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    search = worker_models.problem(
        functools.partial(worker_models.build, seconds=seconds),
        checkpoint=checkpoint,
        n_workers=n_workers,
    )
    search.run_driver()
    print(search.get_val("x").tolist(), search.driver.history[-1].evaluations)
