"""Blade surface and loads to tones and levels at observers."""

from __future__ import annotations

from typing import Any

import numpy as np

from propmdao.acoustics.levels.decibels import mean_square, oaspl_db, spl_db
from propmdao.acoustics.levels.weighting import oaspl_dba
from propmdao.acoustics.sources.formulation1a import SOURCES, tones
from propmdao.components.bases.jax_component import Arrays
from propmdao.components.bases.nodes_comp import STATIC, OperatingPointsComp
from propmdao.components.noise_inputs import add_noise_inputs, check_rotor, noise_at
from propmdao.geometry.surface import surface_panels
from propmdao.records.fidelity import Fidelity
from propmdao.records.loads import PointLoads


class AcousticsComp(OperatingPointsComp):
    """Tonal noise by Formulation 1A, at observers that fly along with the rotor.

    Usable alone, with blade loads from elsewhere. With `num_nodes` everything but the surface and
    the observers has a leading axis of that many operating points.

    Inputs
    ------
    surface_nodes : (n_contour, n_surface_span, 3) array
        Points of the section contours of blade 1, ``m``.
    load_position, load_force : (n_loads, 3) arrays
        Steady point forces of blade 1 ON THE FLUID, ``m``, ``N``.
    rpm : float
        Rotation speed, ``rpm``.
    speed : float
        Axial flight speed, ``m/s``.
    density, sound_speed : float
        Of the undisturbed air, ``kg/m**3``, ``m/s``.
    observer_position : (n_observers, 3) array
        From the rotor centre, +z toward thrust, ``m``.

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
        Of each tone, ``Pa**2``; add these for rotors that turn independently.
    frequency : (n_harmonics,) array
        Of the tones, ``Hz``.

    Options
    -------
    num_nodes : int or None
        Number of operating points; None is a single one, with the shapes above.
    n_blades : int
        Number of equally spaced blades.
    n_loads : int
        Number of point forces.
    observers : (n_observers, 3) array
        Initial `observer_position` [m]; `propmdao.acoustics.kinematics.observers.arc` makes one.
    fidelity : Fidelity
        Size of the surface mesh and number of harmonics.

    Raises
    ------
    om.AnalysisError
        When the blade tip is not slower than sound, or an observer not outside the rotor, with the
        node where there are several.
    """

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("n_blades", types=int, desc="Number of blades.")
        self.options.declare("n_loads", types=int, desc="Number of point forces.")
        self.options.declare("observers", types=np.ndarray, desc="Initial positions [m].")
        self.options.declare("fidelity", Fidelity(), types=Fidelity, desc="Mesh and harmonics.")

    def setup(self) -> None:
        fidelity, observers = self.options["fidelity"], self.options["observers"]
        n_observers, n_loads = len(observers), self.options["n_loads"]
        surface = (fidelity.n_contour, fidelity.n_surface_span, 3)
        self.add_input("surface_nodes", shape=surface, units="m", tags=STATIC)
        self.add_point_input("load_position", shape=(n_loads, 3), units="m")
        self.add_point_input(
            "load_force", shape=(n_loads, 3), units="N", desc="Force on the fluid."
        )
        add_noise_inputs(self, observers)
        for name, desc in (
            ("spl_bpf_db", "Level of the blade-passage tone."),
            ("oaspl_db", "Overall level of the tones."),
            *((f"oaspl_{name}_db", f"Overall level of {name} noise alone.") for name in SOURCES),
            ("oaspl_dba", "A-weighted overall level of the tones."),
        ):
            self.add_point_output(name, shape=(n_observers,), desc=desc)
        self.add_point_output(
            "mean_square_pressure", shape=(n_observers, fidelity.n_harmonics), units="Pa**2"
        )
        self.add_point_output("frequency", shape=(fidelity.n_harmonics,), units="Hz")
        self.function = _levels
        self.static = (self.options["n_blades"], fidelity.n_harmonics)

    def check(self, inputs: Any, values: Any) -> None:
        check_rotor(inputs, "surface_nodes")


def _levels(inputs: Arrays, constants: None, static: tuple[int, int]) -> Arrays:
    n_blades, n_harmonics = static
    pressure = tones(
        surface_panels(inputs["surface_nodes"]),
        PointLoads(inputs["load_position"], inputs["load_force"]),
        n_blades,
        *noise_at(inputs),
        n_harmonics,
    )
    return {
        "spl_bpf_db": spl_db(pressure.total)[:, 0],
        "oaspl_db": oaspl_db(pressure.total),
        **{f"oaspl_{name}_db": oaspl_db(part) for name, part in pressure.parts.items()},
        "oaspl_dba": oaspl_dba(pressure.frequency_hz, pressure.total),
        "mean_square_pressure": mean_square(pressure.total),
        "frequency": pressure.frequency_hz,
    }
