"""A drone's way through level air at the least energy, with Dymos: how far to lean, and when.

One rotor of the drone carries its share of the weight. Thrust and incidence along the way are the
controls: the incidence is 90 degrees less what the shaft leans forward, and the rotor's force in
its disk counts in the equations of motion as its thrust does. The periodic lattice, trimmed to the
thrust at every node of the phase, and its derivatives are inside of them.
"""

import argparse

import dymos as dm
import numpy as np
import openmdao.api as om
from mission import show

import propmdao as pm
from propmdao.components import PropellerGroup
from propmdao.records.wake_law import WakeGrid

WEIGHT, GRAVITY = 2.5, 9.80665  # N for each rotor; m/s2
DRAG_AREA = 0.006  # m2 of the body for each rotor, drag over dynamic pressure
START, DISTANCE, TIME = 4.0, 60.0, 8.0  # m/s, m, s
PROPELLER = "apcsf_11x4.7"
FIDELITY = pm.Fidelity(
    n_chordwise=2, n_spanwise=8, n_azimuths=16, period_wake=WakeGrid(3.0, 1.0, 1.4, 20.0)
)


class Flight(om.Group):
    """Equations of motion of the drone, for one of its rotors, at ``num_nodes`` points in time."""

    def initialize(self) -> None:
        """Declare what Dymos and the study choose."""
        self.options.declare("num_nodes", types=int)
        self.options.declare("fidelity", FIDELITY, types=pm.Fidelity)

    def setup(self) -> None:
        """Connect rotor and flight mechanics."""
        n = self.options["num_nodes"]
        rotor = PropellerGroup(
            propeller=PROPELLER, num_nodes=n, tilted=True, fidelity=self.options["fidelity"]
        )
        self.add_subsystem("rotor", rotor, promotes=["*"])
        # Force of the hub along the flight, and across it, upward.
        along = "(hub_force[:, 2] * cos(incidence) + hub_force[:, 0] * sin(incidence))"
        across = "hub_force[:, 2] * sin(incidence) - hub_force[:, 0] * cos(incidence)"
        drag = f"0.5 * density * speed**2 * {DRAG_AREA}"
        mechanics = om.ExecComp(
            [f"acceleration = ({along} - {drag}) * {GRAVITY / WEIGHT}", f"lift = {across}"],
            hub_force={"shape": (n, 3), "units": "N"},
            incidence={"shape": (n,), "units": "rad"},
            density={"shape": (n,), "units": "kg/m**3"},
            speed={"shape": (n,), "units": "m/s"},
            acceleration={"shape": (n,), "units": "m/s**2"},
            lift={"shape": (n,), "units": "N"},
        )
        self.add_subsystem("mechanics", mechanics, promotes=["*"])
        self.set_input_defaults("density", np.full(n, 1.225), units="kg/m**3")
        self.set_input_defaults("speed", np.full(n, START), units="m/s")
        self.set_input_defaults("incidence", np.full(n, 80.0), units="deg")


def level_flight(segments: int = 3, fidelity: pm.Fidelity = FIDELITY) -> om.Problem:
    """Set up the flight at the least energy, with a first guess.

    Parameters
    ----------
    segments : int
        Segments of the collocation, three points each.
    fidelity : Fidelity
        Numbers of panels and azimuths.

    Returns
    -------
    om.Problem
        Problem, ready to run; its trajectory is ``trajectory.flight``.
    """
    driver = om.ScipyOptimizeDriver(optimizer="SLSQP", maxiter=40, tol=1e-5)
    prob = om.Problem(driver=driver, reports=False)
    phase = dm.Phase(
        ode_class=Flight,
        ode_init_kwargs={"fidelity": fidelity},
        transcription=dm.Radau(num_segments=segments, order=3),
    )
    trajectory = prob.model.add_subsystem("trajectory", dm.Trajectory())
    trajectory.add_phase("flight", phase)
    phase.set_time_options(fix_initial=True, fix_duration=True)
    phase.add_state(
        "speed", rate_source="acceleration", units="m/s", fix_initial=True, lower=START - 1.0,
        upper=14.0, ref=10.0,
    )  # fmt: skip
    phase.add_state("distance", rate_source="speed", units="m", fix_initial=True, ref=DISTANCE)
    phase.add_state("energy", rate_source="shaft_power", units="J", fix_initial=True, ref=200.0)
    phase.add_control("thrust_required", units="N", lower=1.5, upper=4.0, ref=2.5)
    phase.add_control("incidence", units="deg", lower=50.0, upper=110.0, ref=90.0)
    # An equality at every point would leave nothing free. The least energy lifts no more than that.
    phase.add_path_constraint("lift", lower=WEIGHT, upper=1.01 * WEIGHT, ref=WEIGHT)
    phase.add_boundary_constraint("distance", loc="final", equals=DISTANCE, ref=DISTANCE)
    phase.add_boundary_constraint("speed", loc="final", equals=START, ref=10.0)
    phase.add_timeseries_output(["rpm", "torque", "shaft_power", "lift"])
    phase.add_objective("energy", loc="final", ref=100.0)
    prob.setup()
    phase.set_time_val(initial=0.0, duration=TIME)
    phase.set_state_val("distance", [0.0, DISTANCE])
    fastest = 2.0 * DISTANCE / TIME - START
    phase.set_state_val("speed", [START, fastest, START], [0.0, 0.5 * TIME, TIME])
    phase.set_state_val("energy", [0.0, 25.0 * TIME])
    phase.set_control_val("thrust_required", [1.02 * WEIGHT, 1.02 * WEIGHT])
    phase.set_control_val("incidence", [82.0, 82.0])
    return prob


def main() -> None:
    """Optimise and print the flight."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--segments", type=int, default=3, help="default %(default)s")
    prob = level_flight(parser.parse_args().segments)
    prob.run_driver()
    names = ("distance", "speed", "incidence", "thrust_required", "rpm", "shaft_power")
    show(prob, names, "trajectory.flight")
    print(f"energy {prob.get_val('trajectory.flight.timeseries.energy')[-1, 0]:.1f} J")


if __name__ == "__main__":
    main()
