"""Mission of a small electric aeroplane in OpenConcept: climb, cruise, descent, energy, noise.

OpenConcept finds the throttle at every point of its phases by Newton's method. A battery that is
emptied weighs what it did, so the propeller follows: it is trimmed to the thrust at every point,
the motor has its torque and rotation speed, and the integral of its power is what the battery has
to hold. That keeps the lattice out of the mission's system of equations, whose matrix OpenConcept
factorises. OpenConcept 1.2.6 asks for NumPy below 2 and runs with 2: ``pip install --no-deps
openconcept``.
"""

import argparse
from typing import Any

import numpy as np
import openmdao.api as om
from openconcept.mission import BasicMission
from openconcept.utilities import Integrator

import propmdao as pm
from propmdao.components import MotorComp, PropellerGroup

MASS, WING_AREA = 1.0, 0.25  # kg, m2
DRAG_AT_ZERO_LIFT, INDUCED_DRAG = 0.035, 0.05  # CD = CD0 + k CL^2
LARGEST_THRUST = 8.0  # N, at full throttle
MOTOR, PROPELLER = "axi_2204_54", "apcsf_11x4.7"
SPEED, HEIGHT, RANGE = 11.0, 80.0, 3.0  # m/s, m, km
CLIMB_RATE, SINK_RATE = 1.5, 0.4  # m/s
MICROPHONE = pm.arc(20.0, [-45.0])  # flies along
FIDELITY = pm.Fidelity(n_chordwise=4, n_spanwise=12)
PHASES = ("climb", "cruise", "descent")


class Aeroplane(om.Group):
    """Thrust, drag and weight at the ``num_nodes`` points of a phase, as OpenConcept asks."""

    def initialize(self) -> None:
        """Declare what OpenConcept chooses."""
        self.options.declare("num_nodes", default=1)
        self.options.declare("flight_phase", default=None)

    def setup(self) -> None:
        """Add the forces."""
        at_points = {"shape": (self.options["num_nodes"],)}
        forces = om.ExecComp(
            [
                f"thrust = {LARGEST_THRUST} * throttle",
                f"drag = area * q * ({DRAG_AT_ZERO_LIFT} + {INDUCED_DRAG} * CL**2)",
                f"weight = {MASS} + 0 * q",
            ],
            has_diag_partials=True,
            thrust={"units": "N"} | at_points,
            drag={"units": "N"} | at_points,
            weight={"units": "kg"} | at_points,
            throttle=at_points,
            CL=at_points,
            q={"units": "Pa"} | at_points,
            area={"units": "m**2", "shape": (1,)},
        )
        of_flight = ["throttle", ("q", "fltcond|q"), ("CL", "fltcond|CL")]
        of_flight.append(("area", "ac|geom|wing|S_ref"))
        self.add_subsystem("forces", forces, promotes_inputs=of_flight, promotes_outputs=["*"])


class ElectricPropulsion(om.Group):
    """Propeller, motor and battery at the points of a phase, under OpenConcept's names."""

    def initialize(self) -> None:
        """Declare points and resolution."""
        self.options.declare("num_nodes", types=int)
        self.options.declare("fidelity", FIDELITY, types=pm.Fidelity)

    def setup(self) -> None:
        """Connect propeller, motor and battery."""
        n = self.options["num_nodes"]
        propeller = PropellerGroup(
            propeller=PROPELLER,
            observers=MICROPHONE,
            num_nodes=n,
            fidelity=self.options["fidelity"],
        )
        of_flight = {"thrust_required": "thrust", "speed": "fltcond|Utrue"}
        of_flight |= {"density": "fltcond|rho", "sound_speed": "fltcond|a"}
        self.add_subsystem(
            "propeller",
            propeller,
            promotes_inputs=list(of_flight.items()),
            promotes_outputs=["rpm", "torque", "oaspl_dba"],
        )
        self.add_subsystem("motor", MotorComp(motor=MOTOR, num_nodes=n), promotes=["*"])
        battery = Integrator(num_nodes=n, diff_units="s", time_setup="duration", method="simpson")
        battery.add_integrand("energy", rate_name="electrical_power", units="J")
        self.add_subsystem("battery", battery, promotes=["duration", "electrical_power", "energy"])


def mission(num_nodes: int = 5, fidelity: pm.Fidelity = FIDELITY) -> om.Problem:
    """Set up the mission.

    Parameters
    ----------
    num_nodes : int
        Points of each phase, odd.
    fidelity : Fidelity
        Numbers of panels.

    Returns
    -------
    om.Problem
        Problem, ready to run; what a phase flies is in ``mission.climb`` and so on, what that
        takes in ``climb``.
    """
    prob = om.Problem(reports=False)
    sizes = prob.model.add_subsystem("sizes", om.IndepVarComp(), promotes=["*"])
    sizes.add_output("ac|geom|wing|S_ref", WING_AREA, units="m**2")
    flight = BasicMission(aircraft_model=Aeroplane, num_nodes=num_nodes)
    flight.nonlinear_solver = om.NewtonSolver(
        solve_subsystems=True, maxiter=20, atol=1e-8, rtol=1e-8, err_on_non_converge=True, iprint=0
    )
    flight.linear_solver = om.DirectSolver()
    prob.model.add_subsystem("mission", flight, promotes_inputs=["ac|*"])
    for phase in PHASES:
        propulsion = ElectricPropulsion(num_nodes=num_nodes, fidelity=fidelity)
        prob.model.add_subsystem(phase, propulsion)
        for name in ("thrust", "duration", "fltcond|Utrue", "fltcond|rho", "fltcond|a"):
            prob.model.connect(f"mission.{phase}.{name}", f"{phase}.{name}")
    prob.setup()
    rates = {"climb": CLIMB_RATE, "cruise": 0.0, "descent": -SINK_RATE}
    for phase, rate in rates.items():
        prob.set_val(f"mission.{phase}.fltcond|vs", np.full(num_nodes, rate), units="m/s")
        prob.set_val(f"mission.{phase}.fltcond|Ueas", np.full(num_nodes, SPEED), units="m/s")
        prob.set_val(f"mission.{phase}.throttle", np.full(num_nodes, 0.2))
    prob.set_val("mission.takeoff|h", 0.0, units="m")
    prob.set_val("mission.cruise|h0", HEIGHT, units="m")
    prob.set_val("mission.mission_range", RANGE, units="km")
    return prob


def phase_values(prob: om.Problem, phase: str) -> dict[str, Any]:
    """Collect what a phase has come to.

    Parameters
    ----------
    prob : om.Problem
        Mission that has run.
    phase : str
        Name of the phase.

    Returns
    -------
    dict
        Duration [s], energy [W h], and at its points thrust [N], rotation speed [rpm], power [W],
        level of the tones at the microphone [dBA].
    """
    return {
        "duration": float(prob.get_val(f"mission.{phase}.duration", units="s")[0]),
        "energy": float(prob.get_val(f"{phase}.energy", units="W*h")[-1]),
        "thrust": prob.get_val(f"mission.{phase}.thrust", units="N"),
        "rpm": prob.get_val(f"{phase}.rpm", units="rpm"),
        "power": prob.get_val(f"{phase}.electrical_power", units="W"),
        "oaspl_dba": prob.get_val(f"{phase}.oaspl_dba")[:, 0],
    }


def main() -> None:
    """Fly the mission and print its phases."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--points", type=int, default=5, help="of a phase, default %(default)s")
    prob = mission(parser.parse_args().points)
    prob.run_model()
    print("phase      s    W h   thrust N       rpm        W  tones dBA")
    for phase in PHASES:
        v = phase_values(prob, phase)
        means = (v[name].mean() for name in ("thrust", "rpm", "power", "oaspl_dba"))
        numbers = "".join(f"{mean:10.2f}" for mean in means)
        print(f"{phase:8}{v['duration']:6.0f}{v['energy']:7.3f}{numbers}")
    total = sum(phase_values(prob, phase)["energy"] for phase in PHASES)
    print(f"The battery gives {total:.2f} W h.")


if __name__ == "__main__":
    main()
