"""A propeller as one OpenMDAO group: blade and operating point in, rpm, power and noise out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import openmdao.api as om

from propmdao.aerodynamics.sections.edge_layers.tables import SectionLayers
from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions.period.flow import azimuths_for
from propmdao.analysis.self_noise import section_layers
from propmdao.components.acoustics_comp import AcousticsComp
from propmdao.components.bases.nodes_comp import declare_num_nodes
from propmdao.components.broadband_comp import BroadbandComp
from propmdao.components.geometry_comp import (
    GeometryComp,
    blade_distributions,
    declare_camber,
)
from propmdao.components.inputs.control_points import add_control_points, declare_control_points
from propmdao.components.inputs.model_options import (
    TRANSITION_OPTIONS,
    declare_model,
    model_of,
)
from propmdao.components.inputs.noise_inputs import declare_observers, declare_turbulent_inflow
from propmdao.components.inputs.rotor_inputs import RotorKind, declare_polars, declare_tilted
from propmdao.components.inputs.rpm_bounds import declare_bounds
from propmdao.components.loads.aerodynamics_comp import AerodynamicsComp
from propmdao.components.loads.marched_aerodynamics_comp import MarchedAerodynamicsComp
from propmdao.components.loads.rotation_speed_comp import RotationSpeedComp
from propmdao.components.loads.rotor_outputs import n_loads
from propmdao.components.loads.trimmed_aerodynamics_comp import TrimmedAerodynamicsComp
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.description import Propeller
from propmdao.records.models import Model

TRIMS = ("thrust", "rpm")
TRIM_METHODS = ("solve", "two_point")


class PropellerGroup(om.Group):
    """Blade, rotation speed for a thrust, aerodynamics, tonal and broadband noise.

    Every variable is promoted under its name in the components, which describe shapes and units.
    With `num_nodes` everything but the blade and the observers has a leading axis of that many
    operating points. Exactly 0 N required, or 0 rpm, is a propeller that stands still: no loads,
    silence (-200 dB). With `tilted` the shaft may stand at an angle to the flight: results are
    means over the turn, and the tones are those of loads that change around it.

    Inputs
    ------
    speed : float
        Flight speed, 0 is hover, ``m/s``.
    incidence : float
        Angle between the shaft and the direction of flight, 0 is axial flight, 90 edgewise,
        ``deg``, with `tilted` or `unsteady`.
    density : float
        Density of the air, ``kg/m**3``.
    sound_speed : float
        Speed of sound, ``m/s``; not in inviscid flow without observers.
    turbulence_intensity, turbulence_length_scale : float
        Turbulence that flows in: root mean square of each component of the velocity, ``m/s``, and
        longitudinal integral length scale, ``m``, with `turbulent_inflow`; 0 by default.
    thrust_required : float
        Thrust of all blades, ``N``, with `trim` "thrust".
    rpm : float
        Rotation speed, ``rpm``, with `trim` "rpm".
    observer_position : (n_observers, 3) array
        Positions from the rotor centre, +z toward thrust, flight in the plane of +z and +x,
        flying along, ``m``.
    diameter : float
        Diameter from tip to tip, initially the propeller's, ``m``; the distributions are over its
        half and grow along.
    chord_over_R, beta, sweep_over_R, rake_over_R, thickness_over_chord, camber_over_chord, \
design_lift_coefficient : (n_stations,) arrays
        Distributions at the propeller's stations, `beta` in ``rad``, initially the propeller's; of
        the last two the one that the option `camber` names. One that is named in
        `design_distributions` is replaced by its control points, `chord_over_R_cp` and so on,
        (n_control_points,) arrays: increments, factors of the chord, or values, as `control` says.

    Outputs
    -------
    rpm : float
        Rotation speed, ``rpm``, with `trim` "thrust".
    thrust, torque, shaft_power, efficiency, figure_of_merit, J, CT, CQ, CP : float
        Thrust, torque and power of all blades, ``N``, ``N*m``, ``W``, and the coefficients that
        `AerodynamicsComp` defines.
    hub_force, hub_moment : (3,) arrays
        Mean force and moment of all blades on the hub, about the rotor's centre, in axes that do
        not turn: +z is the shaft, flight is in the plane of +z and +x, ``N``, ``N*m``, with
        `tilted` or `unsteady`.
    spl_bpf_db, oaspl_db, oaspl_thickness_db, oaspl_loading_db, oaspl_dba : (n_observers,) arrays
        Levels of the tones, dB re 20 uPa, whether there is broadband noise or not.
    oaspl_broadband_db, oaspl_broadband_dba, oaspl_total_db, oaspl_total_dba : (n_observers,) arrays
        Levels of the broadband noise alone, and of tones and broadband noise together, with
        `broadband`.

    The other outputs are those of `GeometryComp`, `AerodynamicsComp`, `AcousticsComp` and
    `BroadbandComp`.

    Options
    -------
    num_nodes : int or None
        Number of operating points, of a mission's phase or a multi-point design: their axis leads,
        also that of a single one. None (default): one point, with the shapes above.
    propeller : Propeller, str or Path
        The described propeller, a name of the catalogue or the path of a propeller file; its values
        are the initial ones.
    observers : (n_observers, 3) array or None
        Initial `observer_position` [m]; `propmdao.arc` makes positions. None (default): thrust and
        power alone, neither loads nor noise are outputs, and the derivatives of missions are cheap.
    tilted : bool
        Flight at an incidence, some hundred times as long as the steady lattice of axial flight,
        which is the default. All nodes are solved so, hover as well; the trim "two_point" is of
        axial flight alone.
    unsteady : bool
        Loads marched in time (`MarchedAerodynamicsComp`), at a given rotation speed: `trim` must be
        "rpm". Derivatives are differences of marches and forward alone, so the problem is set up
        with ``mode="fwd"``; backward there is an error.
    revolutions, average, timestep_deg, start, wake_motion
        With `unsteady`, what `propmdao.records.fidelity.Marching` says: revolutions of the march
        (4) and of the mean (3), time step (3 deg), {"steady", "impulsive"} and
        {"prescribed", "free"}.
    fidelity : Fidelity
        Numbers of panels, wake nodes, azimuths and harmonics.
    trim : str
        ``"thrust"``: the rotation speed follows from `thrust_required`; ``"rpm"``: it is given.
    rpm_bounds : (float, float) or None
        Lowest and highest rotation speed with `trim` "thrust" [rpm]; None (default): those of
        `TrimmedAerodynamicsComp`, which follow the diameter and the flight speed.
    trim_method : str
        ``"solve"``: the thrust is the required one (`TrimmedAerodynamicsComp`). ``"two_point"``:
        the rule of the thesis, which misses it by some per cent (`RotationSpeedComp`).
    design_distributions : dict
        Distribution name -> r/R of its control points, from the first station to the tip.
    control : {"increments", "values"}
        What the curve through control points gives. "increments" (the default): what is added to
        the described distribution, or for `chord_over_R` factors of it; 0, and 1 for the chord,
        is the described blade. "values": the distribution itself, initially interpolated at the
        control points, which changes the blade between them; the largest change is warned of.
    spline_method : str
        Curve through the control points: ``"slinear"`` (straight lines, the default), ``"akima"``
        or ``"cubic"``.
    wake : WakeLaw
        Law by which the prescribed wake moves.
    viscous : bool
        Hold the lattice to the polars of the sections (default); False for inviscid flow.
    blade_element : bool
        Blade elements in annuli in place of the lattice, not by the trim "two_point": some sixty
        times as fast, and up to a fifth more thrust on wide blades. False by default.
    stall_delay : bool
        True (default): rotation delays the stall of the sections.
    n_crit, trip_upper, trip_lower : float or None
        Transition in the polars: critical amplification exponent, x/c of the trips of the upper and
        the lower side, 1 without; None (default): the propeller's, or 5 and no trips.
    polars : SectionPolars or None
        Polars that `polars_for` makes, for tables of one's own at a transition of their own; None
        (default) for the catalogue's.
    broadband : bool
        Add the broadband self-noise of the blades.
    trip : {"none", "light", "heavy"}, tuple of these, or None
        Tripping of the boundary layers in broadband noise alone, everywhere or at the propeller's
        stations; None (default): as the propeller's description says, or else as in the loads: the
        fits lightly tripped where both sides are.
    layers : {"sections", "bpm"}
        Boundary layers in broadband noise: of the blade's own sections (default), or the fits of
        NASA RP-1218 to a NACA 0012.
    turbulent_inflow : bool
        Whether turbulence may flow in, which `broadband` noise then hears.
    camber : {"camber_over_chord", "design_lift_coefficient"}
        Distribution that gives the camber; "camber_over_chord" is the default.

    Raises
    ------
    PropellerError
        If there is no propeller of that name, or its file is wrong.
    ValueError
        If `observers` are no positions, `rpm_bounds` are not positive and rising, control points do
        not fit the blade, or `broadband` is asked for without observers, `trip` or
        `turbulent_inflow` without `broadband`, a transition in inviscid flow or beside `polars`,
        `tilted` or `blade_element` with the trim "two_point", `blade_element` with `unsteady`,
        `unsteady` with a thrust, a march without `unsteady`, or one that cannot be.
    om.AnalysisError
        If a component has no result; with `num_nodes` the message has the node.
    """

    def initialize(self) -> None:
        declare_num_nodes(self.options)
        declare = self.options.declare
        declare(
            "propeller",
            types=(Propeller, str, Path),
            set_function=_described,
            desc="the described propeller, its name in the catalogue or its file",
        )
        declare_observers(self.options, optional=True)
        declare_tilted(self.options)
        declare_model(self.options)
        declare_polars(self.options)
        declare("trim", "thrust", values=TRIMS, desc="input that the rotation speed follows")
        declare_bounds(self.options)
        declare("trim_method", "solve", values=TRIM_METHODS, desc="rule for the rotation speed")
        declare_control_points(self.options)
        declare_camber(self.options)
        declare_turbulent_inflow(self.options)

    def setup(self) -> None:
        options = self.options
        propeller = options["propeller"]
        model = model_of(options).completed(propeller.transition, propeller.tip, propeller.trip)
        is_heard = options["observers"] is not None
        if model.noise.broadband is not None and not is_heard:
            raise ValueError("broadband noise is heard at observers; there are none")
        if options["turbulent_inflow"] and model.noise.broadband is None:
            raise ValueError("turbulent_inflow is heard as broadband noise: ask for broadband, too")
        for word, why in (("tilted", "is of axial flight"), ("blade_element", "is of the lattice")):
            if options[word] and self._follows_thrust("two_point"):
                raise ValueError(f'trim_method "two_point" {why}: {word} must be False')
        if model.loads.unsteady is not None and options["trim"] != "rpm":
            raise ValueError(
                'a march in time needs rpm, not thrust: trim must be "rpm" with unsteady; a group'
                " without unsteady finds the rpm"
            )
        polars = None
        if model.loads.viscous:
            polars = options["polars"]
            transition = [name for name in TRANSITION_OPTIONS if options[name] is not None]
            if polars is not None and transition:
                raise ValueError(
                    f"polars have been made at a transition of their own: {transition[0]} does not"
                    " go along"
                )
            polars = polars or polars_for(propeller, transition=model.loads.transition)
        layers = section_layers(propeller, model)
        self._add_geometry(propeller, polars, layers)
        self._add_loads(propeller, polars, model)
        if is_heard:
            self._add_noise(propeller, model, layers)

    def _follows_thrust(self, method: str) -> bool:
        """Whether the rotation speed follows from the thrust by a method."""
        return bool(self.options["trim"] == "thrust" and self.options["trim_method"] == method)

    def _add_geometry(
        self, propeller: Propeller, polars: SectionPolars | None, layers: SectionLayers | None
    ) -> None:
        """Splines of the design distributions, and the meshes that they shape."""
        options = self.options
        initial = blade_distributions(propeller, options["camber"])
        self._splined = add_control_points(self, propeller.r_over_R, initial)
        self.add_subsystem(
            "geometry",
            GeometryComp(
                propeller=propeller,
                fidelity=options["fidelity"],
                camber=options["camber"],
                polars=polars,
                layers=layers,
            ),
            promotes_inputs=["*"],
            promotes_outputs=["*"],
        )
        self.set_input_defaults("diameter", val=propeller.diameter, units="m")
        for name in self._splined:
            self._take_from_spline("geometry", name)

    def _add_loads(self, propeller: Propeller, polars: SectionPolars | None, model: Model) -> None:
        """Rotation speed, thrust and power, and the loads where there are observers."""
        options = self.options
        rotor = {
            "num_nodes": options["num_nodes"],
            "n_blades": int(propeller.n_blades),
            "polars": polars,
            **{name: options[name] for name in ("fidelity", "stall_delay", "wake")},
        }
        bounds = {"rpm_bounds": options["rpm_bounds"]}
        rotor_loads = {"loads": options["observers"] is not None}  # they are the sources of noise
        solved = {**rotor, **rotor_loads}
        solved |= {name: options[name] for name in ("tilted", "blade_element")}
        if self._follows_thrust("two_point"):
            speed = RotationSpeedComp(**rotor, **bounds)
            self.add_subsystem("rotation_speed", speed, promotes=["*"])
        aerodynamics: om.ExplicitComponent
        if (schedule := model.loads.unsteady) is not None:
            aerodynamics = MarchedAerodynamicsComp(**rotor, **rotor_loads, march=schedule)
        elif self._follows_thrust("solve"):
            aerodynamics = TrimmedAerodynamicsComp(**solved, **bounds)
        else:
            aerodynamics = AerodynamicsComp(**solved)
        self.add_subsystem("aerodynamics", aerodynamics, promotes=["*"])

    def _add_noise(self, propeller: Propeller, model: Model, layers: SectionLayers | None) -> None:
        """Tones, and broadband noise where it is asked for."""
        fidelity, n_blades = model.fidelity, int(propeller.n_blades)
        n_azimuths = None
        if (schedule := model.loads.unsteady) is not None:
            n_azimuths = schedule.steps_per_turn
        elif self.options["tilted"]:
            n_azimuths = azimuths_for(fidelity.n_azimuths, n_blades)
        shared = {
            **{name: self.options[name] for name in ("num_nodes", "observers", "fidelity")},
            "n_azimuths": n_azimuths,
        }
        count = n_loads(fidelity, RotorKind(n_blades, n_azimuths, model.loads.blade_element))
        tones = AcousticsComp(n_blades=n_blades, n_loads=count, **shared)
        self.add_subsystem("acoustics", tones, promotes=["*"])
        if model.noise.broadband is None:
            return
        self.add_subsystem(
            "broadband",
            BroadbandComp(
                propeller=propeller,
                trip=model.noise.broadband.trip if layers is None else None,
                layers=layers,
                turbulent_inflow=self.options["turbulent_inflow"],
                **shared,
            ),
            promotes_inputs=["*"],
            promotes_outputs=["*"],
        )
        if "thickness_over_chord" in self._splined:
            self._take_from_spline("broadband", "thickness_over_chord")

    def _take_from_spline(self, component: str, name: str) -> None:
        """Promote a distribution that is splined: SplineComp's output has a leading axis of one."""
        self.promotes(component, inputs=[name], src_indices=om.slicer[0, :])


def _described(_: Any, propeller: Propeller | str | Path) -> Propeller:
    return propeller if isinstance(propeller, Propeller) else load_propeller(propeller)
