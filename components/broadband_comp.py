"""Sections at work to broadband noise at observers."""

from __future__ import annotations

import dataclasses
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.acoustics.levels.decibels import energy_sum_db, level_db
from propmdao.acoustics.levels.weighting import level_dba
from propmdao.aerodynamics.lattice.rings import vortex_rings
from propmdao.aerodynamics.lattice.strips import blade_strips
from propmdao.aerodynamics.sections.edge_layers.tables import EdgeLayerTable, blade_layers
from propmdao.analysis.self_noise import (
    BANDS_HZ,
    self_noise,
    strip_flow,
    with_fitted_layers,
    with_layers,
)
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import STATIC, NodesComp
from propmdao.components.inputs.model_options import declare_model
from propmdao.components.inputs.noise_inputs import (
    add_noise_inputs,
    check_rotor,
    declare_azimuths,
    declare_layers,
    declare_observers,
    declare_turbulent_inflow,
    noise_state,
)
from propmdao.components.inputs.point_inputs import TURBULENCE_INPUTS, add_point_inputs
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.propeller.description import Propeller
from propmdao.records.air import Turbulence
from propmdao.records.models import SelfNoiseModel
from propmdao.records.quantities import BROADBAND_LEVELS
from propmdao.runtime.finite import Axis

_SILENCE_DB = -200.0


class BroadbandComp(NodesComp):
    """Broadband self-noise by Brooks, Pope and Marcolini, at observers that fly along.

    The sections work steadily, or with `n_azimuths` as in flight at an incidence, around the turn.
    `oaspl_db` and `oaspl_dba` without a qualifier mean the tones only, those of `AcousticsComp`;
    "broadband" means the noise alone, "total" tones and noise together. With `num_nodes`
    everything but the blade, the observers and `band_frequency` has a leading axis of that many
    operating points.

    Inputs
    ------
    lattice_nodes : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice of blade 1, ``m``: its strips are the sections that sound.
    section_speed : (n_spanwise,) array
        Speed of the air relative to the sections, ``m/s``.
    section_lift_coefficient : (n_spanwise,) array
        Lift coefficients of the sections, which tell the angle from zero lift. With `n_azimuths`
        both are (n_azimuths, n_spanwise), at equally spaced azimuths of the blade from 0.
    section_angle_of_attack : (n_spanwise,) array
        Angle of attack from the chord line, likewise, ``rad``; an input with the option `layers`.
    section_layers : (n_spanwise, 2, 4, n_re, n_alpha) array
        Boundary layers of the sections at the trailing edge, of `GeometryComp`; an input with the
        option `layers`.
    thickness_over_chord : (n_stations,) array
        Maximum thickness over chord at the propeller's stations. It and the propeller's section
        shapes give the trailing edge.
    rpm : float
        Rotation speed, ``rpm``.
    speed : float
        Flight speed, ``m/s``.
    incidence : float
        Angle between the shaft and the direction of flight, 0 is axial flight, 90 edgewise,
        ``deg``; an input with `n_azimuths`.
    density, sound_speed : float
        Density of the undisturbed air and its speed of sound, ``kg/m**3``, ``m/s``.
    turbulence_intensity, turbulence_length_scale : float
        Root mean square of each component of the velocity of turbulence that flows in, ``m/s``, and
        its longitudinal integral length scale, ``m``; inputs with `turbulent_inflow`. Both are 0 by
        default, and then nothing of it is heard.
    observer_position : (n_observers, 3) array
        Positions from the rotor centre, +z toward thrust, flight in the plane of +z and +x, ``m``.
    oaspl_db, oaspl_dba : (n_observers,) arrays
        Levels of the tones that the totals take in; silence where they are not connected.

    Outputs
    -------
    broadband_mean_square_pressure : (n_observers, n_bands) array
        Mean square of the noise in each third octave, ``Pa**2``; these add for any number of
        rotors.
    band_frequency : (n_bands,) array
        Mid-band frequencies, `propmdao.analysis.self_noise.BANDS_HZ`, ``Hz``.
    oaspl_broadband_db, oaspl_broadband_dba : (n_observers,) arrays
        Overall level of the noise alone, dB re 20 uPa, and A-weighted, dBA.
    oaspl_total_db, oaspl_total_dba : (n_observers,) arrays
        Overall level of tones and noise together, dB re 20 uPa, and A-weighted, dBA.

    Options
    -------
    num_nodes : int or None
        Number of operating points; None is a single one, with the shapes above.
    propeller : Propeller
        Propeller with the number of blades, stations, section shapes and initial thickness.
    observers : (n_observers, 3) array
        Initial `observer_position` [m]; `propmdao.arc` makes positions.
    n_azimuths : int or None
        Azimuths of sections that work differently around the turn; None (default): steady ones,
        axial flight.
    fidelity : Fidelity
        Numbers of panels.
    turbulent_inflow : bool
        Whether turbulence may flow in, which adds the noise of Amiet's model.
    trip : {"none", "light", "heavy"}, tuple of these, or None
        Tripping of the boundary layers that the fits have, everywhere or at the propeller's
        stations; None (default): as the propeller's description says.
    layers : SectionLayers or None
        Boundary layers of the propeller's sections, as `layers_for` finds them or, tripped,
        `propmdao.analysis.self_noise.section_layers`; None (default) for the fits of NASA RP-1218
        to a NACA 0012.

    Raises
    ------
    om.AnalysisError
        If an input or a result is not finite, rotation or flight backwards, the incidence beyond
        its range, a property of the air not positive, the blade tip not slower than sound, or an
        observer not outside the rotor; with `num_nodes` the message has the node.
    ValueError
        If `observers` are no positions, or `trip` is asked of `layers` that are what they are.
    """

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("propeller", types=Propeller, desc="the described propeller")
        declare_observers(self.options)
        declare_azimuths(self.options)
        declare_layers(self.options)
        declare_model(self.options, ["fidelity", "trip"])
        declare_turbulent_inflow(self.options)

    def setup(self) -> None:
        propeller, fidelity = self.options["propeller"], self.options["fidelity"]
        nc, ns = fidelity.n_chordwise, fidelity.n_spanwise
        n_observers, n_azimuths = len(self.options["observers"]), self.options["n_azimuths"]
        sections = (ns,) if n_azimuths is None else (n_azimuths, ns)
        blade = Blade.from_propeller(propeller)
        self.add_input("lattice_nodes", shape=(nc + 1, ns + 1, 3), units="m", tags=STATIC)
        self.add_point_input("section_speed", shape=sections, units="m/s")
        self.add_point_input("section_lift_coefficient", shape=sections)
        layers = self.options["layers"]
        if layers is not None:
            self.add_point_input("section_angle_of_attack", shape=sections, units="rad")
            initial = blade_layers(layers, blade, strip_interpolation(propeller.r_over_R, ns))
            self.add_input("section_layers", val=np.asarray(initial.values), tags=STATIC)
        self.add_input(
            "thickness_over_chord", val=np.asarray(blade.thickness_over_chord), tags=STATIC
        )
        add_noise_inputs(self)
        if self.options["turbulent_inflow"]:
            add_point_inputs(self, TURBULENCE_INPUTS)
        self.add_point_input("oaspl_db", _SILENCE_DB, shape=(n_observers,))
        self.add_point_input("oaspl_dba", _SILENCE_DB, shape=(n_observers,))
        self.add_point_output(
            "broadband_mean_square_pressure", shape=(n_observers, BANDS_HZ.size), units="Pa**2"
        )
        self.add_output("band_frequency", val=np.asarray(BANDS_HZ), units="Hz")
        for quantity in BROADBAND_LEVELS.values():
            self.add_point_output(quantity.variable, shape=(n_observers,))
        stations, trip = propeller.r_over_R, self.options["trip"]
        if layers is not None and trip is not None:
            raise ValueError(
                f"trip {trip!r} is about the fits of NASA RP-1218: layers have trips of their own"
            )
        noise = SelfNoiseModel(trip, layers="bpm" if layers is None else "sections")
        described = propeller.transition.completed()
        self.function = _broadband
        self.static = (
            int(propeller.n_blades),
            noise.completed(described, propeller.tip, propeller.trip),
        )
        self.constants = blade, strip_interpolation(stations, ns), layers
        axes: tuple[Axis, ...] = ("observer", [f"{frequency:g} Hz" for frequency in BANDS_HZ])
        self.axes = dict.fromkeys(self.output_shapes(), axes)

    def check_inputs(self, inputs: Arrays) -> None:
        super().check_inputs(inputs)
        check_rotor(inputs, "lattice_nodes")


def _broadband(inputs: Arrays, constants: Any, static: tuple[int, SelfNoiseModel]) -> Arrays:
    (n_blades, model), (blade, section_radii, layers) = static, constants
    blade = dataclasses.replace(blade, thickness_over_chord=inputs["thickness_over_chord"])
    nodes = inputs["lattice_nodes"]
    flow = strip_flow(
        # Only absolute sizes matter here, so the described blade's radius will do.
        blade_strips(nodes, vortex_rings(nodes), blade.radius),
        inputs["section_speed"],
        inputs["section_lift_coefficient"],
        blade,
        section_radii,
    )
    state, observers = noise_state(inputs), inputs["observer_position"]
    if layers is not None:
        table = EdgeLayerTable(layers.alpha, layers.log_re, inputs["section_layers"])
        angle = inputs["section_angle_of_attack"]
        flow = with_layers(flow, table, angle, state.air)
    else:
        flow = with_fitted_layers(flow, model, section_radii, state.air)
    turbulence = None
    if TURBULENCE_INPUTS[0] in inputs:
        turbulence = Turbulence(*(inputs[name][0] for name in TURBULENCE_INPUTS))
    noise = self_noise(flow, n_blades, state, observers, model, turbulence=turbulence)
    broadband_db = level_db(noise.total.sum(axis=1))
    broadband_dba = level_dba(BANDS_HZ, noise.total)
    return {
        "broadband_mean_square_pressure": noise.total,
        "oaspl_broadband_db": broadband_db,
        "oaspl_broadband_dba": broadband_dba,
        "oaspl_total_db": _together(inputs["oaspl_db"], broadband_db),
        "oaspl_total_dba": _together(inputs["oaspl_dba"], broadband_dba),
    }


def _together(one_db: Array, other_db: Array) -> Array:
    """Level of both (n_observers,)."""
    return energy_sum_db(jnp.stack([one_db, other_db]), axis=0)
