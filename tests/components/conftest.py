"""What tests of components share: small Problems, a small blade, a check of derivatives."""

import dataclasses

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.components import DifferentialEvolutionDriver, GeometryComp
from propmdao.formats.propellers import load_propeller
from propmdao.records.fidelity import Fidelity
from propmdao.records.quantities import ASKED
from propmdao.records.wake_law import WakeGrid

#: Changes of every input along which its derivatives are checked: large enough for differences,
#: small beside the input. An input that is missing here is an error of the check.
SCALES = {
    "rpm": 5.0,
    "thrust_required": 0.01,
    "speed": 0.03,
    "incidence": 0.1,
    "density": 1e-2,
    "sound_speed": 1.0,
    "turbulence_intensity": 1e-2,
    "turbulence_length_scale": 1e-3,
    "diameter": 1e-3,
    "chord_over_R": 1e-3,
    "beta": 1e-3,
    "sweep_over_R": 1e-3,
    "rake_over_R": 1e-3,
    "thickness_over_chord": 1e-3,
    "camber_over_chord": 1e-4,
    "design_lift_coefficient": 1e-2,
    "lattice_nodes": 1e-5,
    "surface_nodes": 1e-5,
    "section_polars": 1e-3,
    "section_thickness_over_chord": 1e-3,
    "load_position": 1e-5,
    "load_force": 1e-4,
    "section_speed": 0.1,
    "section_angle_of_attack": 1e-3,
    "section_lift_coefficient": 1e-3,
    "section_layers": 1e-3,
    "observer_position": 1e-2,
    "oaspl_db": 0.1,
    "oaspl_dba": 0.1,
}


def scales_of(names):
    """Scales of inputs by name; control points have that of their distribution."""
    return {name: SCALES[name.removesuffix("_cp")] for name in names}


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
def around(small):
    """The same with few azimuths and a short wake, for flight at an incidence."""
    return dataclasses.replace(small, n_azimuths=8, period_wake=WakeGrid(2.0, 2.0, 1.5, 40.0))


@pytest.fixture(scope="session")
def propeller():
    return load_propeller("apcsf_11x4.7_uiuc")


@pytest.fixture(scope="session")
def polars(propeller):
    return polars_for(propeller)


@pytest.fixture(scope="session")
def meshes(propeller, small, polars, problem_of):
    """Problem that holds the meshes of the small blade and its ``section_polars``."""
    prob = problem_of(GeometryComp(propeller=propeller, fidelity=small, polars=polars))
    prob.run_model()
    return prob


@pytest.fixture(scope="session")
def problem_of():
    """``problem_of(component, **values)``: its Problem, set up, where it is ``prob.model.comp``."""

    def problem_of(component, **values):
        prob = om.Problem(reports=False)
        prob.model.add_subsystem("comp", component, promotes=["*"])
        prob.setup(mode="rev")
        for name, value in values.items():
            prob.set_val(name, value)
        return prob

    return problem_of


@pytest.fixture(scope="session")
def point_inputs():
    """``point_inputs(group)``: names of its inputs that belong to an operating point."""

    def point_inputs(group):
        asked = {quantity.variable for quantity in ASKED.values() if quantity.per_node}
        inputs, outputs = (
            {meta["prom_name"] for meta in group.get_io_metadata(iotypes=kind).values()}
            for kind in ("input", "output")
        )
        return sorted(asked & inputs - outputs)

    return point_inputs


@pytest.fixture(scope="session")
def assert_partials():
    """``assert_partials(prob, tolerance)`` for all inputs of ``prob.model.comp``.

    Derivatives (of matrix-free components forward and reverse products) against central differences
    over steps at which they have converged; the error of a block of derivatives is relative to its
    largest.
    """

    def check(prob, tolerance):
        scales = scales_of(prob.model.comp.get_io_metadata(iotypes="input"))
        for name, scale in scales.items():
            prob.model.comp.set_check_partial_options(
                name, method="fd", form="central", step=0.1 * scale, step_calc="abs"
            )
        (blocks,) = prob.check_partials(out_stream=None).values()
        assert {of_wrt[1] for of_wrt in blocks} == set(scales)
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


@pytest.fixture(scope="session")
def assert_directional():
    """``assert_directional(prob, tolerance)`` for all inputs of ``prob.model.comp``.

    For large inputs: derivatives along a random direction, whose entries are of the input's scale,
    of every output weighted at random, by reverse products against central differences at the best
    of several steps. Curvature jumps in places, so that no one step suits every output. With
    ``forward=True`` forward products are held to the reverse ones, too, which compiles for long.
    """

    def check(prob, tolerance, forward=False):
        comp, rng = prob.model.comp, np.random.default_rng(3)
        inputs = {n: prob.get_val(n).copy() for n in comp.get_io_metadata(iotypes="input")}
        outputs = {n: prob.get_val(n).copy() for n in comp.get_io_metadata(iotypes="output")}
        scales = scales_of(inputs)
        weights = {of: rng.standard_normal(value.shape) for of, value in outputs.items()}
        along = {n: scale * rng.standard_normal(inputs[n].shape) for n, scale in scales.items()}
        slopes = {of: gradients(comp, inputs, of, weights[of]) for of in outputs}
        for name in scales:
            exact = {of: np.vdot(slopes[of][name], along[name]) for of in outputs}
            if forward:
                d_outputs = {of: np.zeros_like(value) for of, value in outputs.items()}
                comp.compute_jacvec_product(inputs, {name: along[name]}, d_outputs, "fwd")
                for of, value in d_outputs.items():
                    # A thrust that is held is the difference of equal terms, each of a lattice
                    # that is solved to some hundred roundings.
                    rounding = 1e-13 * np.abs(outputs[of]).max()
                    assert_allclose(
                        np.vdot(weights[of], value), exact[of], rtol=1e-8,
                        atol=max(1e-10 * np.abs(value).max(), rounding), err_msg=f"{of} by {name}",
                    )  # fmt: skip
            errors = {of: [] for of in outputs}
            for h in (1.0, 0.1, 0.01, 0.001):
                ends = []
                for sign in (1.0, -1.0):
                    prob.set_val(name, inputs[name] + sign * h * along[name])
                    prob.run_model()
                    ends.append({of: np.vdot(weights[of], prob.get_val(of)) for of in outputs})
                for of, value in outputs.items():
                    difference = (ends[0][of] - ends[1][of]) / (2.0 * h)
                    largest = max(abs(exact[of]), 1e-4 * np.abs(value).max(), 1e-12)
                    errors[of].append(float(abs(difference - exact[of]) / largest))
                if all(min(error) < tolerance for error in errors.values()):
                    break
            prob.set_val(name, inputs[name])
            for of, error in errors.items():
                assert min(error) < tolerance, f"{of} by {name}: {error}"

    def gradients(comp, inputs, of, weight):
        """Derivatives of one weighted output by every input."""
        d_inputs = {n: np.zeros_like(value) for n, value in inputs.items()}
        comp.compute_jacvec_product(inputs, d_inputs, {of: weight}, "rev")
        return d_inputs

    return check


@pytest.fixture(scope="session")
def assert_totals():
    """``assert_totals(prob, of, wrt, tolerances)``: totals of a Problem that has run.

    Along a random direction for each input, whose entries are of the input's scale, against
    differences of fourth order at the best of several steps: the curvature of polars and of the
    fits of broadband noise jumps in places, so that no one step suits all. The error is relative to
    the largest; tolerances are 1e-6 unless given by output.
    """

    def check(prob, of, wrt, tolerances=None):
        totals = prob.compute_totals(of=of, wrt=wrt)
        rng = np.random.default_rng(5)
        for name, scale in scales_of(wrt).items():
            start = prob.get_val(name).copy()
            along = scale * rng.standard_normal(start.shape)
            errors = {output: [] for output in of}
            allowed = {output: (tolerances or {}).get(output, 1e-6) for output in of}
            exact = {output: totals[output, name] @ along.ravel() for output in of}
            for step in (1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4):
                points = {}
                for k in (-2, -1, 1, 2):
                    prob.set_val(name, start + k * step * along)
                    prob.run_model()
                    points[k] = {output: prob.get_val(output).copy().ravel() for output in of}
                for output in of:
                    left2, left, right, right2 = (points[k][output] for k in (-2, -1, 1, 2))
                    slope = (8.0 * (right - left) - right2 + left2) / (12.0 * step)
                    size = 1e-6 * np.abs(prob.get_val(output)).max()
                    largest = max(np.abs(exact[output]).max(), size)
                    errors[output].append(np.abs(slope - exact[output]).max() / largest)
                if all(min(errors[output]) < allowed[output] for output in of):
                    break
            prob.set_val(name, start)
            for output in of:
                found = errors[output]
                assert min(found) < allowed[output], f"{output} by {name}: {found}"
        prob.run_model()

    return check
