"""Mission of a light electric aeroplane in Aviary: climb, cruise and descent on the least energy.

Aviary finds the throttle at every point of its phases with a matrix that it factorises, for which
the lattice has none. An electric aeroplane weighs the same all along, so the propeller follows
from outside of that solve: an engine gives the thrust of the throttle, and a subsystem trims the
propeller to it, hands torque and rotation speed to the motor, and adds the battery's energy to the
states that Dymos integrates. The optimiser chooses how long each phase lasts. Aviary's masses and
drag are those of transports: mass and drag polar of this aeroplane are given. Aviary 1.0.1, SLSQP.
"""

import argparse
import dataclasses
from typing import Any

import aviary.api as av
import numpy as np
import openmdao.api as om
from aviary.api import Aircraft, Dynamic, Mission

import propmdao as pm
from propmdao.components import MotorComp, PropellerGroup
from propmdao.propeller.motors import Motor

MASS, WING_AREA = 600.0, 9.5  # kg, m2
DRAG_AT_ZERO_LIFT, INDUCED_DRAG = 0.025, 0.035  # CD = CD0 + k CL^2
LARGEST_THRUST = 2000.0  # N, at full throttle
RANGE, HEIGHT, ARRIVAL = 60.0, 900.0, 50.0  # km, m, m
SLOW, FAST = 0.11, 0.13  # Mach numbers at the ends of climb and descent, and in cruise
# The shape of a model aeroplane's propeller at the size of this one.
PROPELLER = dataclasses.replace(pm.load_propeller("apce_10x7"), name="light", diameter=1.7)
MOTOR = Motor("motor", speed_constant=7.0, resistance=0.1, no_load_current=3.0)
MICROPHONE = pm.arc(50.0, [-45.0])  # flies along
FIDELITY = pm.Fidelity(n_chordwise=4, n_spanwise=12)
TRANSPORT = "models/aircraft/advanced_single_aisle/advanced_single_aisle_FLOPS.csv"
PHASES = ("climb", "cruise", "descent")
POWER = "electrical_power"
ENERGY = "battery_energy"

_PROPULSION = Dynamic.Vehicle.Propulsion


class Throttle(av.EngineModel):
    """Engine of Aviary that gives a thrust in proportion to the throttle and burns nothing."""

    _default_name = "throttle_engine"
    compute_max_values = True

    def build_pre_mission(self, aviary_inputs: Any, subsystem_options: Any = None) -> om.Group:
        """Build a group without anything, which Aviary asks for."""
        return om.Group()

    def build_mission(
        self, num_nodes: int, aviary_inputs: Any, user_options: Any, subsystem_options: Any
    ) -> om.Group:
        """Build thrust, largest thrust and fuel flow at the points of a phase."""
        engine = om.ExecComp(
            [
                f"thrust = {LARGEST_THRUST} * throttle",
                f"largest = {LARGEST_THRUST} + 0 * throttle",
                "fuel = 0 * throttle",
            ],
            shape=(num_nodes,),
            has_diag_partials=True,
            thrust={"units": "N"},
            largest={"units": "N"},
            fuel={"units": "kg/s"},
        )
        group = om.Group()
        names = {"throttle": _PROPULSION.THROTTLE, "thrust": _PROPULSION.THRUST}
        names |= {"largest": _PROPULSION.THRUST_MAX}
        names |= {"fuel": _PROPULSION.FUEL_MASS_FLOW_RATE_NEGATIVE}
        group.add_subsystem("engine", engine, promotes=list(names.items()))
        return group


class _Beside(av.SubsystemBuilder):
    """Subsystem of Aviary outside of its solve, between inputs and outputs by their names."""

    of_flight: dict[str, str]
    gives: dict[str, str]

    def needs_mission_solver(self, aviary_inputs: Any, subsystem_options: Any) -> bool:
        """Tell that it may follow the solve."""
        return False

    def mission_inputs(self, **_: Any) -> list[tuple[str, str]]:
        """List what it takes of the flight."""
        return list(self.of_flight.items())

    def mission_outputs(self, **_: Any) -> list[tuple[str, str]]:
        """List what it gives."""
        return list(self.gives.items())


class DragPolar(_Beside):
    """Lift and drag by a parabola."""

    _default_name = "drag_polar"
    of_flight = {"mass": Dynamic.Vehicle.MASS, "pressure": Dynamic.Atmosphere.DYNAMIC_PRESSURE}
    gives = {
        "lift": Dynamic.Vehicle.LIFT,
        "drag": Dynamic.Vehicle.DRAG,
        "lift_coefficient": Dynamic.Vehicle.LIFT_COEFFICIENT,
        "drag_coefficient": Dynamic.Vehicle.DRAG_COEFFICIENT,
    }

    def build_mission(
        self, num_nodes: int, aviary_inputs: Any, user_options: Any, subsystem_options: Any
    ) -> om.ExecComp:
        """Build the forces at the points of a phase."""
        force = f"(pressure * {WING_AREA})"
        coefficient = f"(9.80665 * mass / {force})"
        drag = f"({DRAG_AT_ZERO_LIFT} + {INDUCED_DRAG} * {coefficient}**2)"
        return om.ExecComp(
            [
                "lift = 9.80665 * mass",
                f"drag = {force} * {drag}",
                f"lift_coefficient = {coefficient}",
                f"drag_coefficient = {drag}",
            ],
            shape=(num_nodes,),
            has_diag_partials=True,
            mass={"units": "kg"},
            pressure={"units": "Pa"},
            lift={"units": "N"},
            drag={"units": "N"},
        )


class ElectricPropulsion(_Beside):
    """Propeller, motor and battery behind the thrust of the flight.

    Parameters
    ----------
    fidelity : Fidelity
        Numbers of panels.
    """

    _default_name = "electric_propulsion"
    of_flight = {
        "thrust_required": _PROPULSION.THRUST_TOTAL,
        "speed": Dynamic.Mission.VELOCITY,
        "density": Dynamic.Atmosphere.DENSITY,
        "sound_speed": Dynamic.Atmosphere.SPEED_OF_SOUND,
    }
    gives = {name: name for name in ("rpm", "torque", "efficiency", "current", POWER, "oaspl_dba")}

    def __init__(self, fidelity: pm.Fidelity) -> None:
        super().__init__()
        self._fidelity = fidelity

    def build_mission(
        self, num_nodes: int, aviary_inputs: Any, user_options: Any, subsystem_options: Any
    ) -> om.Group:
        """Build propeller and motor at the points of a phase."""
        group = om.Group()
        propeller = PropellerGroup(
            propeller=PROPELLER,
            observers=MICROPHONE,
            num_nodes=num_nodes,
            fidelity=self._fidelity,
        )
        group.add_subsystem("propeller", propeller, promotes=["*"])
        group.add_subsystem("motor", MotorComp(motor=MOTOR, num_nodes=num_nodes), promotes=["*"])
        return group

    def get_states(self, **_: Any) -> dict[str, dict[str, Any]]:
        """Describe the energy that the battery has given."""
        state = {"rate_source": POWER, "units": "kW*h", "lower": 0.0, "ref": 10.0}
        return {ENERGY: state | {"fix_initial": True, "fix_final": False, "input_initial": 0.0}}

    def get_linked_variables(self, **_: Any) -> list[str]:
        """List what goes on from phase to phase."""
        return [ENERGY]

    def get_initial_guesses(self, **_: Any) -> dict[str, dict[str, Any]]:
        """Guess the energy."""
        return {ENERGY: {"val": 0.0, "units": "kW*h", "type": "state"}}

    def get_timeseries(self, **_: Any) -> list[str]:
        """List what is kept along the way."""
        return list(self.gives)


def mission(fidelity: pm.Fidelity = FIDELITY, segments: int = 2) -> av.AviaryProblem:
    """Set up the mission.

    Parameters
    ----------
    fidelity : Fidelity
        Numbers of panels.
    segments : int
        Segments of the collocation in each phase, four points each.

    Returns
    -------
    av.AviaryProblem
        Problem, ready for `run_aviary_problem`.
    """
    # What Aviary computes ahead of the mission needs a transport: of its example only the masses
    # below, the wing's area and the number of engines count in the mission, and they are replaced.
    inputs, _ = av.create_vehicle(TRANSPORT)
    for name in (Aircraft.Design.GROSS_MASS, Mission.GROSS_MASS, Mission.ZERO_FUEL_MASS):
        inputs.set_val(name, MASS, "kg")
    inputs.set_val(Aircraft.Wing.AREA, WING_AREA, "m**2")
    inputs.set_val(Aircraft.Engine.NUM_ENGINES, [1])
    inputs.set_val(Aircraft.Engine.NUM_WING_ENGINES, [0])
    inputs.set_val(Aircraft.Engine.NUM_FUSELAGE_ENGINES, [1])
    info: dict[str, dict[str, Any]] = {
        "pre_mission": {"include_takeoff": False, "optimize_mass": True},
        "climb": _phase(segments, (SLOW, FAST), (0.0, HEIGHT), (6.0, 20.0)),
        "cruise": _phase(segments, (FAST, FAST), (HEIGHT, HEIGHT), (5.0, 40.0)),
        "descent": _phase(segments, (FAST, SLOW), (HEIGHT, ARRIVAL), (8.0, 20.0)),
        "post_mission": {
            "include_landing": False,
            "constrain_range": True,
            "target_range": (RANGE, "km"),
        },
    }
    start = info[PHASES[0]]["user_options"]
    del start["time_initial_bounds"]
    start["time_initial"] = (0.0, "min")
    prob = av.AviaryProblem(verbosity=0, reports=False)
    prob.load_inputs(inputs, info)
    prob.load_external_subsystems([Throttle(), DragPolar(), ElectricPropulsion(fidelity)])
    prob.check_and_preprocess_inputs()
    prob.build_model()
    prob.add_driver("SLSQP", max_iter=50)
    prob.driver.options["tol"] = 1e-5
    prob.add_design_variables()
    prob.model.add_objective(f"traj.{PHASES[-1]}.timeseries.{ENERGY}", index=-1, ref=10.0)
    prob.setup()
    return prob


def _phase(
    segments: int,
    machs: tuple[float, float],
    heights: tuple[float, float],
    minutes: tuple[float, float],
) -> dict[str, dict[str, Any]]:
    """Phase between two Mach numbers and heights that lasts between some minutes."""
    options = {
        "num_segments": segments,
        "order": 3,
        "mach_initial": (machs[0], "unitless"),
        "mach_final": (machs[1], "unitless"),
        "mach_bounds": ((0.8 * SLOW, 1.2 * FAST), "unitless"),
        "mach_polynomial_order": 1,
        "mach_optimize": False,
        "altitude_initial": (heights[0], "m"),
        "altitude_final": (heights[1], "m"),
        "altitude_bounds": ((0.0, 2.0 * HEIGHT), "m"),
        "altitude_polynomial_order": 1,
        "altitude_optimize": False,
        "throttle_enforcement": "path_constraint",
        "time_duration_bounds": (minutes, "min"),
        "time_initial_bounds": ((0.0, 60.0), "min"),
        "mass_ref": (MASS, "kg"),
        "distance_ref": (RANGE, "km"),
    }
    return {
        "subsystem_options": {"aerodynamics": {"method": "external"}},
        "user_options": options,
        "initial_guesses": {"mass": ([MASS, MASS], "kg")},
    }


def phase_values(prob: av.AviaryProblem, phase: str) -> dict[str, Any]:
    """Collect what a phase has come to.

    Parameters
    ----------
    prob : av.AviaryProblem
        Mission that has run.
    phase : str
        Name of the phase.

    Returns
    -------
    dict
        At the points of the phase: time [min], distance [km], thrust [N], rotation speed [rpm],
        power [kW], energy since the start [kW h], level of the tones at the microphone [dBA].
    """
    units = {
        "time": "min", "distance": "km", _PROPULSION.THRUST_TOTAL: "N", "rpm": "rpm", POWER: "kW",
        ENERGY: "kW*h", "oaspl_dba": None,
    }  # fmt: skip
    keys = ("time", "distance", "thrust", "rpm", "power", "energy", "oaspl_dba")
    series = (
        prob.get_val(f"traj.{phase}.timeseries.{name}", units=unit).ravel()
        for name, unit in units.items()
    )
    return dict(zip(keys, series, strict=True))


def main() -> None:
    """Fly the mission and print its phases."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--segments", type=int, default=2, help="of a phase, default %(default)s")
    prob = mission(segments=parser.parse_args().segments)
    prob.run_aviary_problem(suppress_solver_print=True)
    print("phase        min     km  thrust N       rpm        kW  tones dBA")
    for phase in PHASES:
        v = phase_values(prob, phase)
        times = "".join(f"{np.ptp(v[name]):7.2f}" for name in ("time", "distance"))
        means = (v[name].mean() for name in ("thrust", "rpm", "power", "oaspl_dba"))
        print(f"{phase:8}{times}{''.join(f'{mean:10.2f}' for mean in means)}")
    verdict = "found" if prob.result.success else "NOT found"
    print(f"Least energy {verdict}: {phase_values(prob, PHASES[-1])['energy'][-1]:.3f} kW h.")


if __name__ == "__main__":
    main()
