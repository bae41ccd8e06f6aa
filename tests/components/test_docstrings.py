"""What the docstrings of components say they take and give is what they declare."""

import inspect
import re

import openmdao.api as om
import pytest
from openmdao.core.system import System

from propmdao import components
from propmdao.acoustics.kinematics.observers import arc
from propmdao.aerodynamics.sections.edge_layers.propeller_layers import layers_for

OBSERVERS = arc(1.905, [-45.0, 0.0])
#: Sections of a docstring, as numpydoc underlines them.
SECTION = re.compile(r"^(\w+)\n-+\n(.*?)(?=\n\n\w+\n-+\n|\Z)", re.M | re.S)
#: Line of names, at the margin: "rpm, speed : float".
NAMES = re.compile(r"^(\w+(?:, \w+)*)(?: :.*)?$", re.M)
#: Reference to other components: "The other inputs are those of `AerodynamicsComp` without `rpm`."
REFERENCE = re.compile(r"^The other \w+ are those of ([^.]+?)(?:\s+without\s+([^.]+))?\.$", re.M)


def described(component, section):
    """Names in a section of the docstring, with those of the components that it refers to."""
    (text,) = (body for name, body in SECTION.findall(inspect.getdoc(component)) if name == section)
    names = {name for line in NAMES.findall(text) for name in line.split(", ")}
    for others, exceptions in REFERENCE.findall(text):
        for other in re.findall(r"`(\w+)`", others):
            names |= described(getattr(components, other), section)
        names -= set(re.findall(r"`(\w+)`", exceptions))
    return names


@pytest.fixture
def systems(propeller, small, polars):
    """Systems of a class with options that differ in what they declare."""
    lattice = {"n_blades": 2, "fidelity": small}
    noise = {"observers": OBSERVERS, "fidelity": small}
    both = [lattice, {**lattice, "polars": polars}]
    tilted = {**lattice, "tilted": True}
    geometry = {"propeller": propeller, "fidelity": small}
    options = {
        "GeometryComp": [
            {**geometry, "polars": polars, "layers": layers_for(propeller)},
            {**geometry, "camber": "design_lift_coefficient"},
        ],
        "AerodynamicsComp": [*both, tilted],
        "MarchedAerodynamicsComp": both,
        "TrimmedAerodynamicsComp": [*both, tilted],
        "RotationSpeedComp": both,
        "AcousticsComp": [{**noise, "n_blades": 2, "n_loads": 3, "n_azimuths": 8}],
        "BroadbandComp": [
            {
                **noise,
                "propeller": propeller,
                "n_azimuths": 8,
                "turbulent_inflow": True,
                "layers": layers_for(propeller),
            }
        ],
        "MotorComp": [{"motor": "axi_2204_54", "battery": True}],
        "NoiseObjectiveComp": [{"shape": 3}],
        "PropellerGroup": [
            {**noise, "propeller": propeller, "broadband": True, "turbulent_inflow": True},
            {**geometry, "trim": "rpm", "camber": "design_lift_coefficient"},
            {**geometry, "trim_method": "two_point", "viscous": False},
            {**geometry, "tilted": True},
            {**geometry, "trim": "rpm", "unsteady": True},
        ],
    }

    def systems(name):
        made = [getattr(components, name)(**chosen) for chosen in options[name]]
        for system in made:
            prob = om.Problem(reports=False)
            prob.model.add_subsystem("system", system)
            prob.setup()
            prob.final_setup()
        return made

    return systems


def names_of(system):
    """Promoted names of inputs and outputs of a system; no input that an output of its feeds."""
    inputs, outputs = (
        {meta["prom_name"] for meta in system.get_io_metadata(iotypes=iotype).values()}
        for iotype in ("input", "output")
    )
    return inputs - outputs, outputs


SYSTEMS = sorted(
    name
    for name in components.__all__
    if isinstance(member := getattr(components, name), type) and issubclass(member, System)
)


@pytest.mark.parametrize("name", SYSTEMS)
def test_inputs_outputs_and_options_are_those_that_are_described(systems, name):
    component, made = getattr(components, name), systems(name)
    inputs, outputs = (set().union(*names) for names in zip(*map(names_of, made), strict=True))
    assert described(component, "Inputs") == inputs
    assert described(component, "Outputs") == outputs
    meanings = {
        meta["prom_name"]: meta["desc"]
        for system in made
        for meta in system.get_io_metadata(metadata_keys=["desc"]).values()
    }
    assert [variable for variable, meaning in meanings.items() if not meaning] == []
    inherited = set(om.ExplicitComponent().options) | set(om.Group().options)
    assert described(component, "Options") == set(made[0].options) - inherited
