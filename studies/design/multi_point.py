"""A blade for two operating points: quieter in hover and cruise together, at no more torque.

Both points are nodes of one model: the blade is shared, thrust is required in each, and the torque
of each is bounded by that of the first blade. What is minimised is the weighted mean of the
mean-square pressures, tones and broadband noise, A-weighted.
"""

import argparse

import numpy as np
import openmdao.api as om

import propmdao as pm
from propmdao.components import PropellerGroup

SPEED = np.array([0.0, 8.0])  # m/s: hover, cruise
THRUST = np.array([2.5, 1.2])  # N
SHARE = np.array([0.3, 0.7])  # shares of the time
OBSERVERS = pm.arc(1.905, [-45.0, -15.0])
FIDELITY = pm.Fidelity(n_chordwise=4, n_spanwise=12, n_contour=33, n_surface_span=24, n_harmonics=4)
RADII = [0.15, 0.5, 1.0]


def multi_point(
    propeller: pm.Propeller, fidelity: pm.Fidelity = FIDELITY, max_iterations: int = 20
) -> om.Problem:
    """Set up the design problem and run it at the propeller's own blade, whose torque is the limit.

    Parameters
    ----------
    propeller : Propeller
        Propeller from which the search starts.
    fidelity : Fidelity
        Numbers of panels and harmonics.
    max_iterations : int
        Most iterations of the optimiser.

    Returns
    -------
    om.Problem
        Problem, ready for its driver; `level` is the objective [dBA].
    """
    n, n_observers = SPEED.size, len(OBSERVERS)
    driver = om.ScipyOptimizeDriver(optimizer="SLSQP", maxiter=max_iterations, tol=1e-4, disp=False)
    prob = om.Problem(driver=driver, reports=False)
    group = PropellerGroup(
        propeller=propeller,
        num_nodes=n,
        observers=OBSERVERS,
        fidelity=fidelity,
        design_distributions={"beta": RADII, "chord_over_R": RADII},
        control="values",
        broadband=True,
    )
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    mean = om.ExecComp(
        "level = 10 * log10(sum(share * 10**(oaspl_total_dba / 10)))",
        share=np.repeat(SHARE[:, None] / n_observers, n_observers, axis=1),
        oaspl_total_dba={"shape": (n, n_observers)},
    )
    prob.model.add_subsystem("mean", mean, promotes=["oaspl_total_dba", "level"])
    prob.model.set_input_defaults("speed", SPEED, units="m/s")
    prob.model.set_input_defaults("thrust_required", THRUST, units="N")
    prob.model.add_design_var("beta_cp", lower=3.0, upper=35.0, ref=10.0, units="deg")
    prob.model.add_design_var("chord_over_R_cp", lower=0.03, upper=0.3, ref=0.1)
    prob.model.add_objective("level", ref=10.0)
    prob.setup()
    prob.run_model()
    limit = prob.get_val("torque").copy()
    prob.model.add_constraint("torque", upper=limit, ref=limit)
    prob.setup()
    prob.run_model()
    return prob


def show(prob: om.Problem, title: str) -> None:
    """Print the blade and its results at each point."""
    print(title)
    print(f"  chord/R {np.round(prob.get_val('chord_over_R_cp'), 4)}, "
          f"blade angle {np.round(prob.get_val('beta_cp', units='deg'), 2)} deg "
          f"at r/R {RADII}; mean level {prob.get_val('level')[0]:.2f} dBA")  # fmt: skip
    for node, speed in enumerate(SPEED):
        levels = ", ".join(f"{level:.2f}" for level in prob.get_val("oaspl_total_dba")[node])
        print(f"  {speed:g} m/s, {prob.get_val('thrust')[node]:.3f} N: "
              f"{prob.get_val('rpm')[node]:.0f} rpm, {prob.get_val('torque')[node]:.5f} N m, "
              f"{levels} dBA")  # fmt: skip


def main() -> None:
    """Optimise and print both blades."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("propeller", nargs="?", default="apcsf_11x4.7_uiuc", help="%(default)s")
    prob = multi_point(pm.load_propeller(parser.parse_args().propeller))
    show(prob, "start")
    result = prob.run_driver()
    show(prob, f"after {prob.driver.result.model_evals} evaluations, {result.exit_status}")


if __name__ == "__main__":
    main()
