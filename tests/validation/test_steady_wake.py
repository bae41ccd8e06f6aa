"""Loads of the catalogue, hover to windmilling: the wake that is read against all its segments."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import propmdao as pm
from propmdao.aerodynamics.lattice.rings import BOUND_CORE
from propmdao.aerodynamics.lattice.steady_wake import WakeInfluence, wake_influence
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.lattice_loads import axial_onset, loads_with_wake
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes, strip_interpolation
from propmdao.propeller.catalog import catalog_names
from propmdao.records.states import RotorState

pytestmark = [pytest.mark.validation, pytest.mark.slow]
FIDELITY, TIP_SPEED = pm.Fidelity(), 130.0
ADVANCE_RATIOS = (0.0, 0.1, 0.3, 0.6, 0.9, 1.2)


@jax.jit
def in_the_whole_wake(case, w):
    flow = axial.flow_at(case)
    lattice, rotor, state = flow.lattice, flow.case.rotor, flow.case.state
    nodes = helical_wake(lattice.rings.corner[-1], case.wake, rotor, state, w)
    core = core_radius(middles(jnp.asarray(case.wake.ages)), state, BOUND_CORE * rotor.radius)
    wake = WakeInfluence(wake_influence(lattice.points, nodes, core))
    onset = axial_onset(lattice, state, w)
    loads = loads_with_wake(lattice, flow.blades, wake, onset, state.air, case.sections)
    return rotor.n_blades * jnp.stack([loads.thrust, loads.torque])


def test_loads_over_the_catalogue():
    errors = []
    for name in catalog_names():
        propeller = pm.load_propeller(name)
        blade, diameter = Blade.from_propeller(propeller), propeller.diameter
        span = lattice_interpolation(propeller.r_over_R, FIDELITY.n_spanwise)
        middle = strip_interpolation(propeller.r_over_R, FIDELITY.n_spanwise)
        nodes = lattice_nodes(blade, span, FIDELITY.n_chordwise)
        rotor = RotorGeometry(nodes, 0.5 * diameter, propeller.n_blades)
        sections = viscous_sections(polars_for(propeller), blade, middle)
        omega = 2.0 * TIP_SPEED / diameter
        n = omega / (2.0 * np.pi)
        for advance_ratio in ADVANCE_RATIOS:
            state = RotorState(omega, advance_ratio * n * diameter, pm.Air())
            case = RotorCase(rotor, state, sections).in_floats()
            loads = axial.solve(case)
            if not loads.converged:
                continue
            whole = in_the_whole_wake(case, loads.induced_velocity)
            read = np.array([loads.thrust, loads.torque])
            # Near no thrust, over a CT of 0.01 and a CQ of 0.001.
            least = pm.Air().density * n**2 * diameter**4 * np.array([0.01, 0.001 * diameter])
            errors.append((read - whole) / np.maximum(np.abs(whole), least))
    errors = np.abs(errors)
    assert len(errors) > 4 * len(catalog_names())
    assert errors.max() < 5e-4
    assert np.median(errors) < 1e-4
