"""Blade distributions to vortex lattice, surface mesh and section polars."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.aerodynamics.sections.edge_layers.tables import blade_layers
from propmdao.aerodynamics.sections.polars.family import blade_tables
from propmdao.components.bases.array_function import Arrays, evaluate
from propmdao.components.bases.jax_component import JaxComponent
from propmdao.components.bases.nodes_comp import STATIC
from propmdao.components.inputs.model_options import declare_model
from propmdao.components.inputs.noise_inputs import declare_layers
from propmdao.components.inputs.rotor_inputs import declare_polars, require_diameter
from propmdao.geometry.blade import Blade, design_lift_coefficient
from propmdao.geometry.meshes import blade_meshes, mesh_radii
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity

CAMBER_INPUTS = ("camber_over_chord", "design_lift_coefficient")


def declare_camber(options: OptionsDictionary) -> None:
    """Declare the input that gives the camber.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    options.declare(
        "camber", CAMBER_INPUTS[0], values=CAMBER_INPUTS, desc="input that gives the camber"
    )


def blade_distributions(propeller: Propeller, camber: str) -> dict[str, Any]:
    """Values at the propeller's stations of all distributions that `GeometryComp` takes.

    Parameters
    ----------
    propeller : Propeller
        The described propeller.
    camber : str
        ``"camber_over_chord"`` or ``"design_lift_coefficient"``.

    Returns
    -------
    dict of (n_stations,) arrays
        Distributions by input name; `beta` in radians.
    """
    blade = Blade.from_propeller(propeller)
    names = ("chord_over_R", "beta", "sweep_over_R", "rake_over_R", "thickness_over_chord")
    values = {name: np.asarray(getattr(blade, name)) for name in names}
    values[camber] = np.asarray(blade.camber_over_chord)
    if camber == "design_lift_coefficient":
        values[camber] = values[camber] * np.asarray(design_lift_coefficient(blade.camber_shape))
    return values


class GeometryComp(JaxComponent):
    """Meshes of blade 1 from distributions at the stations of a propeller.

    Inputs
    ------
    diameter : float
        Diameter from tip to tip, initially the propeller's, ``m``; the distributions are over its
        half, the tip radius R, and grow along.
    chord_over_R : (n_stations,) array
        Chord over tip radius, initially the propeller's, like all distributions.
    beta : (n_stations,) array
        Blade angle from the rotor plane, ``rad``: connect ``deg`` as you like.
    sweep_over_R, rake_over_R : (n_stations,) arrays
        Distance of the quarter chord from the radial line over the tip radius: aft, against the
        rotation, and toward thrust.
    thickness_over_chord : (n_stations,) array
        Maximum thickness over chord.
    camber_over_chord : (n_stations,) array
        Maximum camber over chord, if the option `camber` names it; the shape of the camber line is
        that of the propeller's airfoils.
    design_lift_coefficient : (n_stations,) array
        Camber as design lift coefficient by thin-airfoil theory, if the option `camber` names it.

    Outputs
    -------
    lattice_nodes : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the vortex lattice, leading edge and root first, ``m``.
    surface_nodes : (n_contour, n_surface_span, 3) array
        Points of the section contours for acoustics, ``m``.
    section_polars : (n_spanwise, 3, n_re, n_alpha) array
        Lift, logarithm of drag and moment coefficients of the sections in the middle of the strips,
        the values of a `PolarTable`; an output if there is the option `polars`.
    section_thickness_over_chord : (n_spanwise,) array
        Maximum thickness over chord there, from which shocks begin; an output with the polars.
    section_layers : (n_spanwise, 2, 4, n_re, n_alpha) array
        Boundary layers of these sections at the trailing edge, the values of an `EdgeLayerTable`;
        an output if there is the option `layers`.

    Options
    -------
    propeller : Propeller
        Propeller with the stations, airfoils and initial values.
    fidelity : Fidelity
        Numbers of panels.
    camber : {"camber_over_chord", "design_lift_coefficient"}
        Input that gives the camber; "camber_over_chord" is the default.
    polars : SectionPolars or None
        Polars of the propeller's sections, as `polars_for` finds them; None (default) for inviscid
        flow.
    layers : SectionLayers or None
        Boundary layers of the propeller's sections, as `layers_for` finds them; None (default)
        where nothing needs them.

    Raises
    ------
    om.AnalysisError
        If an input or a result is not finite, the diameter or a chord not positive, at a station or
        between, or a thickness not between 0 and 1 (splines can overshoot).
    """

    def initialize(self) -> None:
        self.options.declare("propeller", types=Propeller, desc="the described propeller")
        declare_model(self.options, ["fidelity"])
        declare_camber(self.options)
        declare_polars(self.options)
        declare_layers(self.options)

    def setup(self) -> None:
        propeller, fidelity = self.options["propeller"], self.options["fidelity"]
        stations, polars = propeller.r_over_R, self.options["polars"]
        initial = {
            "diameter": np.array([propeller.diameter]),
            **blade_distributions(propeller, self.options["camber"]),
        }
        units = {"diameter": "m", "beta": "rad"}
        for name, value in initial.items():
            self.add_input(name, val=value, units=units.get(name), tags=STATIC)
        self.function = _geometry
        self.static = fidelity
        self.constants = (
            Blade.from_propeller(propeller),
            mesh_radii(stations, fidelity.n_spanwise, fidelity.n_surface_span),
            polars,
            self.options["layers"],
        )
        # A solver around the propeller, Newton's say, starts from these without running this first.
        outputs = evaluate(self.function, self.static, self.constants, initial)
        units |= {"lattice_nodes": "m", "surface_nodes": "m"}
        for name, value in outputs.items():
            self.add_output(name, val=np.asarray(value), units=units.get(name))

    def check_inputs(self, inputs: Arrays) -> None:
        require_diameter(inputs)
        chord, thickness = inputs["chord_over_R"], inputs["thickness_over_chord"]
        for name, value, holds, rule in (
            ("chord_over_R", chord, chord > 0.0, "be positive"),
            ("thickness_over_chord", thickness, (thickness > 0.0) & (thickness < 1.0),
             "be above 0 and below 1"),
        ):  # fmt: skip
            if not holds.all():
                station = int(np.argmin(holds))
                r = self.options["propeller"].r_over_R[station]
                raise om.AnalysisError(
                    f"{name} must {rule}; station {station} (r/R {r:g}) has {value[station]:g}"
                )
        radii = self.constants[1]
        for span in (radii.lattice, radii.surface):
            between = np.asarray(span.smooth) @ chord
            if not (between > 0.0).all():
                place = int(np.argmin(between))
                raise om.AnalysisError(
                    "chord_over_R must be positive between stations, too; the spline through them"
                    f" has {between[place]:.3g} at r/R {float(span.r_over_R[place]):.3g}"
                )
        super().check_inputs(inputs)


def _geometry(inputs: Arrays, constants: Any, static: Fidelity) -> Arrays:
    blade, radii, polars, layers = constants
    changed = {**inputs, "radius": 0.5 * inputs["diameter"][0]}
    del changed["diameter"]
    if "design_lift_coefficient" in changed:
        changed["camber_over_chord"] = changed.pop(
            "design_lift_coefficient"
        ) / design_lift_coefficient(blade.camber_shape)
    blade = dataclasses.replace(blade, **changed)
    meshes = blade_meshes(blade, radii, static.n_chordwise, static.n_contour)
    outputs = {"lattice_nodes": meshes.lattice, "surface_nodes": meshes.surface}
    if polars is not None:
        outputs["section_polars"] = blade_tables(polars, blade, radii.strips).values
        outputs["section_thickness_over_chord"] = radii.strips.linear @ blade.thickness_over_chord
    if layers is not None:
        outputs["section_layers"] = blade_layers(layers, blade, radii.strips).values
    return outputs
