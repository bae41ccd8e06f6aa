"""A one-component Problem around a Python function, for tests of the driver."""

import numpy as np
import openmdao.api as om
import pytest

from propmdao.components import DifferentialEvolutionDriver


class Recorded(om.ExplicitComponent):
    """f (1,) and g (n_g,) from a Python function of x (n,), and a log of every x."""

    def initialize(self):
        self.options.declare("function", recordable=False)
        self.options.declare("x0")
        self.options.declare("n_g", default=1)

    def setup(self):
        self.designs = []
        self.add_input("x", val=self.options["x0"])
        self.add_output("f")
        self.add_output("g", shape=self.options["n_g"])
        self.declare_partials("*", "*", method="fd")

    def compute(self, inputs, outputs):
        x = inputs["x"].copy()
        self.designs.append(x)
        outputs["f"], outputs["g"] = self.options["function"](x)


def _problem(function, lower, upper, n_g=1, x0=None, constraint=None, **options):
    options = {"seed": 1, "disp": False, "best_file": None, **options}
    prob = om.Problem(driver=DifferentialEvolutionDriver(**options), reports=False)
    x0 = (np.asarray(lower) + np.asarray(upper)) / 2 if x0 is None else x0
    prob.model.add_subsystem("comp", Recorded(function=function, x0=x0, n_g=n_g), promotes=["*"])
    prob.model.add_design_var("x", lower=lower, upper=upper)
    prob.model.add_objective("f")
    if constraint is not None:
        prob.model.add_constraint("g", **constraint)
    prob.setup()
    return prob


@pytest.fixture
def problem():
    """``problem(function, lower, upper, n_g, x0, constraint, **driver_options)``.

    ``function(x)`` returns objective and constraint; ``prob.model.comp.designs`` lists every x.
    """
    return _problem
