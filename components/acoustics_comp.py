"""Blade surface and loads to tones and levels at observers."""

from __future__ import annotations

from propmdao.acoustics.levels.decibels import mean_square, oaspl_db, spl_db
from propmdao.acoustics.levels.weighting import oaspl_dba
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.acoustics.sources.periodic import tilted_tones
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import STATIC, NodesComp
from propmdao.components.inputs.model_options import declare_model
from propmdao.components.inputs.noise_inputs import (
    add_noise_inputs,
    check_rotor,
    declare_azimuths,
    declare_observers,
    noise_state,
)
from propmdao.geometry.surface import surface_panels
from propmdao.records.loads import PeriodicLoads, PointLoads
from propmdao.records.quantities import LEVELS


class AcousticsComp(NodesComp):
    """Tonal noise by Formulation 1A, at observers that fly along with the rotor.

    Usable alone, with blade loads from elsewhere: steady ones, or with `n_azimuths` those of a
    rotor in flight at an incidence, which repeat every turn. With `num_nodes` everything but the
    surface and the observers has a leading axis of that many operating points.

    Inputs
    ------
    surface_nodes : (n_contour, n_surface_span, 3) array
        Points of the section contours of blade 1, ``m``.
    load_position, load_force : (n_loads, 3) arrays
        Steady point forces of blade 1 ON THE FLUID, ``m``, ``N``; with `n_azimuths` `load_force`
        is (n_azimuths, n_loads, 3), at equally spaced azimuths of the blade from 0, components in
        its frame.
    rpm : float
        Rotation speed, ``rpm``.
    speed : float
        Flight speed, ``m/s``.
    incidence : float
        Angle between the shaft and the direction of flight, 0 is axial flight, 90 edgewise,
        ``deg``; an input with `n_azimuths`.
    density, sound_speed : float
        Density of the undisturbed air and its speed of sound, ``kg/m**3``, ``m/s``.
    observer_position : (n_observers, 3) array
        Positions from the rotor centre, +z toward thrust, flight in the plane of +z and +x, ``m``.

    Outputs
    -------
    spl_bpf_db : (n_observers,) array
        Level of the blade-passage tone, dB re 20 uPa (OpenMDAO knows no decibel).
    oaspl_db : (n_observers,) array
        Overall level of all tones, dB re 20 uPa.
    oaspl_thickness_db, oaspl_loading_db : (n_observers,) arrays
        Overall levels of the two sources alone.
    oaspl_dba : (n_observers,) array
        A-weighted overall level of the tones, dBA; broadband noise is `BroadbandComp`'s.
    mean_square_pressure : (n_observers, n_harmonics) array
        Mean square of each tone, ``Pa**2``; add these for rotors that turn independently.
    frequency : (n_harmonics,) array
        Frequencies of the tones, ``Hz``.

    Options
    -------
    num_nodes : int or None
        Number of operating points; None is a single one, with the shapes above.
    n_blades : int
        Number of equally spaced blades.
    n_loads : int
        Number of point forces.
    n_azimuths : int or None
        Azimuths of loads that change around the turn; None (default): steady loads, axial flight.
    observers : (n_observers, 3) array
        Initial `observer_position` [m]; `propmdao.arc` makes positions.
    fidelity : Fidelity
        Size of the surface mesh and number of harmonics.

    Raises
    ------
    om.AnalysisError
        If an input or a result is not finite, rotation or flight backwards, the incidence beyond
        its range, a property of the air not positive, the blade tip not slower than sound, or an
        observer not outside the rotor; with `num_nodes` the message has the node.
    ValueError
        If `observers` are no positions.
    """

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("n_blades", types=int, desc="number of equally spaced blades")
        self.options.declare("n_loads", types=int, desc="number of point forces of a blade")
        declare_azimuths(self.options)
        declare_observers(self.options)
        declare_model(self.options, ["fidelity"])

    def setup(self) -> None:
        fidelity, n_loads = self.options["fidelity"], self.options["n_loads"]
        n_azimuths = self.options["n_azimuths"]
        force = (n_loads, 3) if n_azimuths is None else (n_azimuths, n_loads, 3)
        n_observers = len(self.options["observers"])
        surface = (fidelity.n_contour, fidelity.n_surface_span, 3)
        self.add_input("surface_nodes", shape=surface, units="m", tags=STATIC)
        self.add_point_input("load_position", shape=(n_loads, 3), units="m")
        self.add_point_input("load_force", shape=force, units="N")
        add_noise_inputs(self)
        for quantity in LEVELS.values():
            self.add_point_output(quantity.variable, shape=(n_observers,))
        self.add_point_output(
            "mean_square_pressure", shape=(n_observers, fidelity.n_harmonics), units="Pa**2"
        )
        self.add_point_output("frequency", shape=(fidelity.n_harmonics,), units="Hz")
        self.function = _levels
        self.static = (self.options["n_blades"], fidelity.n_harmonics, n_azimuths is not None)
        self.axes = dict.fromkeys(self.output_shapes(), ("observer", "harmonic"))
        self.axes["frequency"] = ("harmonic",)

    def check_inputs(self, inputs: Arrays) -> None:
        super().check_inputs(inputs)
        check_rotor(inputs, "surface_nodes")


def _levels(inputs: Arrays, constants: None, static: tuple[int, int, bool]) -> Arrays:
    n_blades, n_harmonics, changing = static
    panels = surface_panels(inputs["surface_nodes"])
    loads = inputs["load_position"], inputs["load_force"]
    arguments = n_blades, noise_state(inputs), inputs["observer_position"], n_harmonics
    if changing:
        sound = tilted_tones(panels, PeriodicLoads(*loads), *arguments)
    else:
        sound = tones(panels, PointLoads(*loads), *arguments)
    return {
        "spl_bpf_db": spl_db(sound.total)[:, 0],
        "oaspl_db": oaspl_db(sound.total),
        **{f"oaspl_{name}_db": oaspl_db(part) for name, part in sound.parts.items()},
        "oaspl_dba": oaspl_dba(sound.frequency_hz, sound.total),
        "mean_square_pressure": mean_square(sound.total),
        "frequency": sound.frequency_hz,
    }
