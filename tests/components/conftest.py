"""What tests of components share: small Problems, a small blade, a check of derivatives."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.components import DifferentialEvolutionDriver, GeometryComp
from propmdao.fidelity import Fidelity
from propmdao.propeller import load_propeller


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


@pytest.fixture(scope="session")
def small():
    """Meshes that are too coarse to mean much and quick to differentiate."""
    return Fidelity(n_chordwise=2, n_spanwise=4, n_contour=5, n_surface_span=4, n_harmonics=2)


@pytest.fixture(scope="session")
def propeller():
    return load_propeller("apcsf_11x4.7")


@pytest.fixture(scope="session")
def meshes(propeller, small):
    """Problem that holds ``lattice_nodes`` and ``surface_nodes`` of the small blade."""
    prob = om.Problem(reports=False)
    prob.model.add_subsystem(
        "comp", GeometryComp(propeller=propeller, fidelity=small), promotes=["*"]
    )
    prob.setup()
    prob.run_model()
    return prob


@pytest.fixture(scope="session")
def assert_partials():
    """``assert_partials(prob, {input: step}, tolerance)`` for ``prob.model.comp``.

    Derivatives (of matrix-free components forward and reverse products) against central differences
    over the given absolute steps, at which they have converged; the error of a block of derivatives
    is relative to its largest.
    """

    def check(prob, steps, tolerance):
        for name, step in steps.items():
            prob.model.comp.set_check_partial_options(
                name, method="fd", form="central", step=step, step_calc="abs"
            )
        (blocks,) = prob.check_partials(out_stream=None).values()
        assert {of_wrt[1] for of_wrt in blocks} == set(steps)
        for of_wrt, block in blocks.items():
            largest = np.abs(block["J_fd"]).max()
            for mode in {"J_fwd", "J_rev"} & set(block):
                assert_allclose(
                    block[mode],
                    block["J_fd"],
                    rtol=0.0,
                    atol=tolerance * max(largest, 1e-3),
                    err_msg=f"{mode} of {of_wrt}",
                )

    return check
