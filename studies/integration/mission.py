"""Climb of a small electric aeroplane that takes the least from its battery, with Dymos.

The propeller is trimmed to the thrust at every node of the phase: vortex lattice, polars and
derivatives inside the equations of motion. The optimiser chooses thrust and climb angle along the
way, the time it takes, and, if asked, the blade's twist.
"""

import argparse
from typing import Any

import dymos as dm
import numpy as np
import openmdao.api as om

import propmdao as pm
from propmdao.components import MotorComp, PropellerGroup
from propmdao.propeller.motors import Motor

MASS, WING_AREA, GRAVITY = 1.0, 0.25, 9.80665  # kg, m2, m/s2
DRAG_AT_ZERO_LIFT, INDUCED_DRAG = 0.035, 0.05  # CD = CD0 + k CL^2
# The resistance is that of motor and battery.
MOTOR = Motor("motor", speed_constant=1000.0, resistance=0.08, no_load_current=0.8)
LARGEST_CURRENT, AVIONICS = 12.0, 4.0  # A; W
HEIGHT = 60.0  # m, to climb
PROPELLER, RADII = pm.load_propeller("apcsf_11x4.7"), [0.15, 0.5, 1.0]  # of the twist's points
FIDELITY = pm.Fidelity(n_chordwise=4, n_spanwise=12)


class Flight(om.Group):
    """Equations of motion of the aeroplane with its propeller, at ``num_nodes`` points in time."""

    def initialize(self) -> None:
        """Declare what Dymos and the study choose."""
        self.options.declare("num_nodes", types=int)
        self.options.declare("fidelity", FIDELITY, types=pm.Fidelity)

    def setup(self) -> None:
        """Connect propeller, motor and flight mechanics."""
        n = self.options["num_nodes"]
        propeller = PropellerGroup(
            propeller=PROPELLER,
            num_nodes=n,
            fidelity=self.options["fidelity"],
            design_distributions={"beta": RADII},
            control="values",
        )
        self.add_subsystem("propeller", propeller, promotes=["*"])
        self.add_subsystem("motor", MotorComp(motor=MOTOR, num_nodes=n), promotes=["*"])
        pressure = f"(0.5 * density * speed**2 * {WING_AREA})"
        lift = f"({MASS * GRAVITY} * cos(climb_angle))"
        drag = f"({DRAG_AT_ZERO_LIFT} * {pressure} + {INDUCED_DRAG} * {lift}**2 / {pressure})"
        mechanics = om.ExecComp(
            [
                f"acceleration = (thrust - {drag}) / {MASS} - {GRAVITY} * sin(climb_angle)",
                "climb_rate = speed * sin(climb_angle)",
                f"battery_power = electrical_power + {AVIONICS}",
            ],
            shape=(n,),
            has_diag_partials=True,
            thrust={"units": "N"},
            density={"units": "kg/m**3"},
            speed={"units": "m/s"},
            climb_angle={"units": "rad"},
            electrical_power={"units": "W"},
            acceleration={"units": "m/s**2"},
            climb_rate={"units": "m/s"},
            battery_power={"units": "W"},
        )
        self.add_subsystem("mechanics", mechanics, promotes=["*"])
        self.set_input_defaults("density", np.full(n, 1.225), units="kg/m**3")
        self.set_input_defaults("speed", np.full(n, 10.0), units="m/s")


def mission(
    height: float = HEIGHT,
    segments: int = 4,
    twist: bool = False,
    fidelity: pm.Fidelity = FIDELITY,
) -> om.Problem:
    """Set up the climb at the least energy, with a first guess.

    Parameters
    ----------
    height : float
        Height to climb [m].
    segments : int
        Segments of the collocation, three points each.
    twist : bool
        True makes the blade angles at three radii design variables, too.
    fidelity : Fidelity
        Numbers of panels.

    Returns
    -------
    om.Problem
        Problem, ready to run; its trajectory is ``trajectory.climb``.
    """
    driver = om.ScipyOptimizeDriver(optimizer="SLSQP", maxiter=60, tol=1e-6)
    prob = om.Problem(driver=driver, reports=False)
    phase = dm.Phase(
        ode_class=Flight,
        ode_init_kwargs={"fidelity": fidelity},
        transcription=dm.Radau(num_segments=segments, order=3),
    )
    trajectory = prob.model.add_subsystem("trajectory", dm.Trajectory())
    trajectory.add_phase("climb", phase)
    phase.set_time_options(fix_initial=True, duration_bounds=(5.0, 120.0), duration_ref=20.0)
    phase.add_state("height", rate_source="climb_rate", units="m", fix_initial=True, ref=height)
    phase.add_state(
        "speed", rate_source="acceleration", units="m/s", fix_initial=True, lower=7.0, upper=14.0,
        ref=10.0,
    )  # fmt: skip
    phase.add_state("energy", rate_source="battery_power", units="kJ", fix_initial=True)
    phase.add_control("thrust_required", units="N", lower=0.2, upper=8.0, ref=2.0)
    phase.add_control("climb_angle", units="deg", lower=0.0, upper=30.0, ref=10.0)
    phase.add_boundary_constraint("height", loc="final", equals=height, ref=height)
    phase.add_boundary_constraint("speed", loc="final", lower=10.0, ref=10.0)
    phase.add_path_constraint("current", upper=LARGEST_CURRENT, ref=LARGEST_CURRENT)
    phase.add_timeseries_output(["rpm", "torque", "current", "battery_power", "efficiency"])
    phase.add_objective("energy", loc="final")
    if twist:
        phase.add_parameter(
            "beta_cp", units="deg", opt=True, static_targets=True, lower=[10, 8, 2],
            upper=[35, 25, 15], ref=10.0,
        )  # fmt: skip
    prob.setup()
    phase.set_time_val(initial=0.0, duration=0.4 * height)
    phase.set_state_val("height", [0.0, height])
    phase.set_state_val("speed", [10.0, 10.0])
    phase.set_state_val("energy", [0.0, 0.05 * height])
    phase.set_control_val("thrust_required", [3.2, 3.2])
    phase.set_control_val("climb_angle", [14.5, 14.5])
    if twist:
        angles = np.interp(RADII, PROPELLER.r_over_R, PROPELLER.beta_deg)
        phase.set_parameter_val("beta_cp", angles, units="deg")
    return prob


def main() -> None:
    """Optimise and print the climb."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--height", type=float, default=HEIGHT, help="m, default %(default)s")
    parser.add_argument("--twist", action="store_true", help="choose the blade angles, too")
    options = parser.parse_args()
    prob = mission(options.height, twist=options.twist)
    prob.run_driver()
    names = ("height", "speed", "thrust_required", "rpm", "current", "efficiency", "energy")
    show(prob, names)
    if options.twist:
        angles = prob.get_val("trajectory.climb.parameter_vals:beta_cp", units="deg")
        print(f"blade angles at r/R {RADII}: {np.round(angles.ravel(), 2)} deg")


def show(prob: om.Problem, names: tuple[str, ...], phase: str = "trajectory.climb") -> None:
    """Print a table of the trajectory."""

    def series(name: str) -> Any:
        return prob.get_val(f"{phase}.timeseries.{name}")[:, 0]

    print(" ".join(f"{name:>15}" for name in ("time", *names)))
    for row in zip(series("time"), *(series(name) for name in names), strict=True):
        print(" ".join(f"{value:15.4g}" for value in row))


if __name__ == "__main__":
    main()
