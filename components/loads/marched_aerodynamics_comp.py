"""Vortex lattice marched in time to the mean loads of its last revolutions."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
import openmdao.api as om

from propmdao.acoustics.kinematics.limits import require_subsonic_tip
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.limits import MarchError
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.solutions.result import failure
from propmdao.aerodynamics.wakes.edgewise import (
    edgewise_advance_ratio,
    grid_for,
    warn_if_fast,
)
from propmdao.aerodynamics.wakes.helical import WakeTransport, wake_transport
from propmdao.components.bases.array_function import Arrays, Derivatives
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.components.inputs.point_inputs import add_point_inputs
from propmdao.components.inputs.rotor_inputs import (
    RotorConstants,
    RotorKind,
    add_rotor_inputs,
    check_rotor_inputs,
    declare_rotor,
    rotor_at,
)
from propmdao.components.loads.rotor_outputs import add_loads, add_performance, loads_outputs
from propmdao.records.fidelity import Marching
from propmdao.records.units import RAD_PER_S

# Change of the largest input, over its size, to either side of the point where loads are
# differentiated: the far wake of a march is summed in single precision, which smaller steps show.
_STEP = 1.0e-3
# Sizes of inputs that may be zero; all others have their own.
_SIZES = {"speed": 1.0, "incidence": 10.0, "section_thickness_over_chord": 0.1}


class UnsettledMarchWarning(UserWarning):
    """The revolutions of a march in time are not alike."""


class MarchedAerodynamicsComp(NodesComp):
    """Vortex lattice marched in time, with a prescribed or a free wake; hover included.

    Results are means over the last revolutions of the march. They are for evaluating a blade;
    `AerodynamicsComp` solves for what repeats, faster and with exact derivatives.

    Derivatives are forward products alone, each from two marches to either side of the point (two
    to one side from hover): a model with this component is differentiated with
    ``setup(mode="fwd")``, at two marches for each design variable and node; backward there is an
    error. Finer differences of twice as many marches differ from them by some 1e-5 to 1e-4. A free
    wake in hover never repeats, and derivatives of its loads mean little.

    Inputs
    ------
    rpm : float
        Rotation speed, ``rpm``; at exactly 0 every output is 0.

    The other inputs are those of `AerodynamicsComp`.

    Outputs
    -------
    thrust, torque, shaft_power : float
        Means over the last revolutions, ``N``, ``N*m``, ``W``.

    The other outputs are those of `AerodynamicsComp`, those that change around the turn at the
    steps of a revolution.

    Options
    -------
    march : Marching
        Length of the march, time step, start and wake.

    The other options are those of `AerodynamicsComp` without `tilted` and `blade_element`.

    Raises
    ------
    om.AnalysisError
        If an input or a result is not finite, rotation or flight backwards, the incidence beyond
        its range, diameter or a property of the air not positive, the blade tip not slower than
        sound, or the march diverges; the message has the reason and, with `num_nodes`, the node.
    ValueError
        If the march needs too much memory.
    RuntimeError
        If derivatives are asked for backward.

    Warns
    -----
    UnsettledMarchWarning
        If the revolutions of the mean are not alike.
    FastEdgewiseWarning
        If the edgewise part of the flight is beyond 0.3 of the tip speed.
    """

    static: RotorKind
    constants: RotorConstants

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("loads", True, types=bool, desc="loads are outputs")
        self.options.declare("march", Marching(), types=Marching, desc="length, time step, wake")
        declare_rotor(self.options)

    def setup(self) -> None:
        fidelity, schedule = self.options["fidelity"], self.options["march"]
        self.static = RotorKind(self.options["n_blades"], schedule.steps_per_turn)
        self.constants = add_rotor_inputs(self, fidelity.period_wake)
        self.add_point_input("rpm", val=4000.0, units="rpm")
        add_point_inputs(self, ["incidence_deg"])
        add_performance(self, hub=True)
        if self.options["loads"]:
            add_loads(self, fidelity, self.static)

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["rpm"].any()

    def check_inputs(self, inputs: Arrays) -> None:
        super().check_inputs(inputs)
        check_rotor_inputs(inputs)
        try:
            require_subsonic_tip(0.5 * inputs["diameter"].item(), self._case(inputs).state)
        except ValueError as error:
            raise om.AnalysisError(str(error)) from error

    def found_at(self, inputs: Arrays) -> Mapping[str, Any]:
        return self._marched(inputs, self._wake_at(inputs))

    def in_one_call(self) -> bool:
        return False

    def check(self, inputs: Any, values: Any) -> None:
        self.require_numbers(inputs, values)
        loads = values["loads"]
        reason = failure(loads)
        if reason is not None and reason == loads.unsettled:
            warnings.warn(reason, UnsettledMarchWarning, stacklevel=2)
        elif reason is not None:
            raise om.AnalysisError(
                f"{reason}, at {inputs['rpm'][0]:g} rpm and {inputs['speed'][0]:g} m/s"
            )
        state, radius = self._case(inputs).state, 0.5 * inputs["diameter"].item()
        warn_if_fast(edgewise_advance_ratio(state, radius), stacklevel=2)

    def compile_derivatives(self, inputs: Arrays) -> None:
        """Begin nothing: derivatives are differences of marches."""

    def derivatives_at(self, inputs: Arrays) -> Derivatives:
        return _Differences(self, inputs)

    def _derivatives_to_keep(self, inputs: Arrays) -> Derivatives:
        return self.derivatives_at(inputs)  # gradients would be products backward

    def products(self, inputs: Arrays, seeds: Arrays) -> Mapping[str, Any]:
        """Derivatives along a direction, by differences of second order.

        Parameters
        ----------
        inputs, seeds : dict of arrays
            Point and direction by name.

        Returns
        -------
        dict of arrays
            Derivatives of the outputs by name.
        """
        sizes = {
            name: max(np.abs(value).max(), _SIZES.get(name, np.finfo(float).tiny))
            for name, value in inputs.items()
        }
        change = max(np.abs(seed).max() / sizes[name] for name, seed in seeds.items())
        step = _STEP / change
        wake = self._wake_at(inputs)  # as long at all points

        def at(place: float) -> Mapping[str, Any]:
            moved = {name: value + place * step * seeds[name] for name, value in inputs.items()}
            return self._marched(moved, wake)

        if (inputs["speed"] - step * np.abs(seeds["speed"]) < 0.0).any():
            side = 1.0 if (seeds["speed"] >= 0.0).all() else -1.0
            weights = {0.0: -1.5 * side, side: 2.0 * side, 2.0 * side: -0.5 * side}
        else:
            weights = {-1.0: -0.5, 1.0: 0.5}
        ends = {place: at(place) for place in weights}
        return {
            name: sum(w * np.asarray(ends[place][name]) for place, w in weights.items()) / step
            for name in self.output_shapes()
        }

    def _case(self, inputs: Arrays) -> RotorCase:
        omega = inputs["rpm"][0] * RAD_PER_S
        return rotor_at(inputs, self.constants, self.static, omega)

    def _wake_at(self, inputs: Arrays) -> WakeTransport:
        """Law of the wake, a longer one in slow flight."""
        ratio = edgewise_advance_ratio(self._case(inputs).state, 0.5 * inputs["diameter"].item())
        grid = grid_for(ratio, self.options["fidelity"].period_wake)
        return wake_transport(self.options["wake"], grid)

    def _marched(self, inputs: Arrays, wake: WakeTransport) -> Mapping[str, Any]:
        case = dataclasses.replace(self._case(inputs), wake=wake)
        try:
            loads = march(case, self.options["march"])
        except MarchError as error:
            raise om.AnalysisError(str(error)) from error
        return {**loads_outputs(loads, case.state, inputs), "loads": loads}


class _Differences(Derivatives):
    """Derivatives of a march: products forward alone."""

    def __init__(self, component: MarchedAerodynamicsComp, inputs: Arrays) -> None:
        self._component, self._inputs = component, inputs

    def forward(self, seeds: Arrays, outputs: Collection[str]) -> Mapping[str, Any]:
        return self._component.products(self._inputs, seeds)

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        raise RuntimeError(
            "a march in time has derivatives forward alone, of two marches for each design"
            ' variable: set the problem up with setup(mode="fwd"), or leave out unsteady'
        )
