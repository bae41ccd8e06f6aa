"""A propeller as one OpenMDAO group: blade and operating point in, rpm, power and noise out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import openmdao.api as om

from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.components.acoustics_comp import AcousticsComp
from propmdao.components.aerodynamics_comp import AerodynamicsComp, n_loads
from propmdao.components.bases.nodes_comp import declare_num_nodes
from propmdao.components.broadband_comp import BroadbandComp
from propmdao.components.geometry_comp import CAMBER_INPUTS, GeometryComp, blade_distributions
from propmdao.components.inputs.model_options import declare_model, model_of
from propmdao.components.inputs.rpm_bounds import declare_bounds
from propmdao.components.rotation_speed_comp import RotationSpeedComp
from propmdao.components.trimmed_aerodynamics_comp import TrimmedAerodynamicsComp
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.description import Propeller
from propmdao.records.listening import require_positions
from propmdao.records.models import Model

TRIM_METHODS = ("solve", "two_point")
SPLINE_METHODS = ("slinear", "akima", "cubic")


class PropellerGroup(om.Group):
    """Blade, rotation speed for a thrust, aerodynamics, tonal and broadband noise.

    Every variable is promoted under its name in the components, which describe shapes and units.
    With `num_nodes` what belongs to an operating point, thus everything but the blade and the
    observers, has a leading axis of that many. Exactly 0 N required, or 0 rpm, is a propeller that
    stands still: no loads, silence (-200 dB).

    Inputs
    ------
    speed : float
        Axial flight speed, 0 is hover, ``m/s``.
    density, sound_speed : float
        Of the air, ``kg/m**3``, ``m/s``.
    thrust_required : float
        Thrust of all blades, ``N``, with `trim` "thrust"; with "rpm" the input is `rpm`, ``rpm``.
    observer_position : (n_observers, 3) array
        From the rotor centre, flying along, ``m``.
    diameter : float
        Initially the propeller's, ``m``; distributions are over its half and grow along.
    chord_over_R, beta, sweep_over_R, rake_over_R, thickness_over_chord, camber_over_chord :
        Distributions at the propeller's stations, `beta` in ``rad``, initially the propeller's.
        One that is named in `design_distributions` is replaced by its control points,
        `chord_over_R_cp` and so on, (n_control_points,) arrays.

    Outputs
    -------
    rpm : float
        Rotation speed, ``rpm`` (with `trim` "thrust").
    thrust, torque, shaft_power, efficiency, J, CT, CQ, CP : float
        Of `AerodynamicsComp`, ``N``, ``N*m``, ``W``.
    spl_bpf_db, oaspl_db, oaspl_thickness_db, oaspl_loading_db, oaspl_dba : (n_observers,) arrays
        Levels of the tones, dB re 20 uPa, whether there is broadband noise or not.
    oaspl_broadband_db, oaspl_broadband_dba, oaspl_total_db, oaspl_total_dba : (n_observers,) arrays
        With `broadband`: levels of the broadband noise alone, and of tones and broadband together.
    lattice_nodes, surface_nodes, section_polars, circulation, load_position, load_force, \
section_speed, section_lift_coefficient, mean_square_pressure, frequency, \
broadband_mean_square_pressure, band_frequency
        As in `GeometryComp`, `AerodynamicsComp`, `AcousticsComp` and `BroadbandComp`.

    Options
    -------
    num_nodes : int or None
        Number of operating points, of a mission's phase or a multi-point design: their axis leads,
        also that of a single one. None (default): one point, with the shapes above.
    propeller : Propeller, str or Path
        The described propeller, a name of the catalogue or the path of a propeller file; its values
        are the initial ones.
    observers : (n_observers, 3) array or None
        Initial observer positions [m]; `propmdao.arc` makes them. None
        (default): thrust and power alone, neither loads nor noise are outputs, and the derivatives
        of missions are cheap.
    fidelity : Fidelity
        Numbers of panels and harmonics.
    trim : str
        ``"thrust"``: the rotation speed follows from `thrust_required`; ``"rpm"``: it is given.
    rpm_bounds : (float, float) or None
        Where the rotation speed is looked for [rpm]; None (default): where the tip of the present
        diameter turns at 0.01 to 0.9 of the standard speed of sound.
    trim_method : str
        ``"solve"``: the thrust is the required one (`TrimmedAerodynamicsComp`). ``"two_point"``:
        the rule of the thesis, which misses it by some per cent (`RotationSpeedComp`).
    design_distributions : dict
        Distribution name -> r/R of its control points, from the first station to the tip.
    spline_method : str
        What leads through the control points: ``"slinear"`` (straight lines), ``"akima"`` or
        ``"cubic"``.
    wake : WakeLaw
        How the prescribed wake moves.
    viscous : bool
        Hold the lattice to the polars of the sections (default); False for inviscid flow.
    stall_delay : bool
        Whether rotation delays the stall of the sections.
    polars : SectionPolars or None
        Of `polars_for`, for tables of one's own; by default the
        catalogue's.
    broadband : bool
        Add the broadband self-noise of the blades.
    trip : {"none", "light", "heavy"}
        How the boundary layers are tripped: of broadband noise, not of the loads.
    camber : str
        ``"camber_over_chord"``, or ``"design_lift_coefficient"`` to give camber as that.

    Raises
    ------
    ValueError
        For control points that do not fit the blade, for `broadband` without observers, and
        for `trip` without broadband noise.
    om.AnalysisError
        Where a component has no result, with the node where there are several.
    """

    def initialize(self) -> None:
        declare_num_nodes(self.options)
        declare = self.options.declare
        declare("propeller", types=(Propeller, str, Path), desc="Description, name or file.")
        declare("observers", None, types=np.ndarray, allow_none=True, desc="Positions [m].")
        declare_model(self.options)
        declare("trim", "thrust", values=("thrust", "rpm"), desc="What is given.")
        declare_bounds(self.options)
        declare("trim_method", "solve", values=TRIM_METHODS, desc="How the rpm is found.")
        declare("design_distributions", {}, types=dict, desc="Name -> r/R of control points.")
        declare("spline_method", "slinear", values=SPLINE_METHODS, desc="Through control points.")
        declare("polars", None, types=SectionPolars, allow_none=True, desc="Own ones.")
        declare("camber", "camber_over_chord", values=CAMBER_INPUTS, desc="How camber is given.")

    def setup(self) -> None:
        options = self.options
        model, observers = model_of(options), options["observers"]
        if observers is not None:
            require_positions(observers)
        elif model.noise.broadband is not None:
            raise ValueError("broadband noise is heard at observers; there are none")
        propeller = options["propeller"]
        if not isinstance(propeller, Propeller):
            propeller = load_propeller(propeller)
        polars = None
        if model.loads.viscous:
            polars = options["polars"] or polars_for(propeller)
        self._add_geometry(propeller, polars)
        self._add_loads(propeller, polars)
        if observers is not None:
            self._add_noise(propeller, model)

    def _add_geometry(self, propeller: Propeller, polars: SectionPolars | None) -> None:
        """Splines of the design distributions, and the meshes that they shape."""
        options = self.options
        initial = blade_distributions(propeller, options["camber"])
        self._add_splines(propeller.r_over_R, initial)
        self.add_subsystem(
            "geometry",
            GeometryComp(
                propeller=propeller,
                fidelity=options["fidelity"],
                camber=options["camber"],
                polars=polars,
            ),
            promotes_inputs=["diameter"],
            promotes_outputs=["*"],
        )
        self.set_input_defaults("diameter", val=propeller.diameter, units="m")
        for name in initial:
            self._promote_distribution("geometry", name)

    def _add_loads(self, propeller: Propeller, polars: SectionPolars | None) -> None:
        """Rotation speed, thrust and power, and the loads where there are observers."""
        options = self.options
        rotor = {
            "num_nodes": options["num_nodes"],
            "n_blades": int(propeller.n_blades),
            "polars": polars,
            **{name: options[name] for name in ("fidelity", "stall_delay", "wake")},
        }
        bounds = {"rpm_bounds": options["rpm_bounds"]}
        loads = options["observers"] is not None
        if options["trim"] == "rpm":
            aerodynamics = AerodynamicsComp(**rotor, loads=loads)
        elif options["trim_method"] == "solve":
            aerodynamics = TrimmedAerodynamicsComp(**rotor, **bounds, loads=loads)
        else:
            speed = RotationSpeedComp(**rotor, **bounds)
            self.add_subsystem("rotation_speed", speed, promotes=["*"])
            aerodynamics = AerodynamicsComp(**rotor, loads=loads)
        self.add_subsystem("aerodynamics", aerodynamics, promotes=["*"])

    def _add_noise(self, propeller: Propeller, model: Model) -> None:
        """Tones, and broadband noise where it is asked for."""
        shared = {name: self.options[name] for name in ("num_nodes", "observers", "fidelity")}
        tones = AcousticsComp(
            n_blades=int(propeller.n_blades), n_loads=n_loads(model.fidelity), **shared
        )
        self.add_subsystem("acoustics", tones, promotes=["*"])
        if model.noise.broadband is None:
            return
        self.add_subsystem(
            "broadband",
            BroadbandComp(propeller=propeller, trip=model.noise.broadband.trip, **shared),
            promotes_inputs=[
                "lattice_nodes",
                "section_speed",
                "section_lift_coefficient",
                "rpm",
                "speed",
                "density",
                "sound_speed",
                "observer_position",
                "oaspl_db",
                "oaspl_dba",
            ],
            promotes_outputs=["*"],
        )
        self._promote_distribution("broadband", "thickness_over_chord")

    def _promote_distribution(self, component: str, name: str) -> None:
        """Promote an input that is a distribution, where it is splined from the spline's output."""
        splined = name in self.options["design_distributions"]
        # SplineComp's output has a leading axis of one.
        self.promotes(component, inputs=[name], src_indices=om.slicer[0, :] if splined else None)

    def _add_splines(self, stations: np.ndarray, initial: Mapping[str, np.ndarray]) -> None:
        """Control points to stations, a spline for each design distribution."""
        for name, control_points in self.options["design_distributions"].items():
            points = _control_points(name, control_points, initial, stations)
            values = np.interp(points, stations, initial[name])
            units = "rad" if name == "beta" else None
            spline = om.SplineComp(
                method=self.options["spline_method"], x_cp_val=points, x_interp_val=stations
            )
            spline.add_spline("cp", name, y_cp_val=values, y_units=units)
            self.add_subsystem(f"{name}_spline", spline, promotes_outputs=[name])
            self.promotes(
                f"{name}_spline",
                inputs=[("cp", f"{name}_cp")],
                src_indices=np.arange(points.size),
                flat_src_indices=True,
                src_shape=(points.size,),
            )
            self.set_input_defaults(f"{name}_cp", val=values, units=units)


def _control_points(
    name: str, given: object, known: Mapping[str, object], stations: np.ndarray
) -> np.ndarray:
    if name not in known:
        raise ValueError(
            f"design_distributions: unknown distribution '{name}'; there are {', '.join(known)}"
        )
    points = np.asarray(given, dtype=float)
    if points.ndim != 1 or points.size < 2 or np.any(np.diff(points) <= 0.0):
        raise ValueError(
            f"design_distributions: control points of {name} must be at least two rising r/R; "
            f"they are {points.tolist()}"
        )
    if points[0] > stations[0] or points[-1] < stations[-1]:
        raise ValueError(
            f"design_distributions: control points of {name} must reach from "
            f"{stations[0]:g} to {stations[-1]:g} r/R; they reach from {points[0]:g} to "
            f"{points[-1]:g}"
        )
    return points
