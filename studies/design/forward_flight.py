"""A blade for a drone's hover and forward flight together: quieter, at no more power.

The drone leans forward by 20 degrees, so the rotor meets the air at an incidence of 70 degrees, and
its loads change around the turn. Hover and flight are nodes of one model: the blade is shared,
thrust is required in each, and the power of each is bounded by that of the first blade. What is
minimised is the mean of the mean-square pressures, tones and broadband noise, A-weighted, ahead of
the rotor and below it. Figures show both blades, the thrust of one blade around the turn, and the
levels over the arc ahead.
"""

import argparse
from pathlib import Path

import numpy as np
import openmdao.api as om

import propmdao as pm
from propmdao.analysis.comparisons import Row, print_comparison, write_comparison
from propmdao.components import NoiseObjectiveComp, PropellerGroup, designed_blade
from propmdao.components.drivers.gradient_search import Search, run_slsqp
from propmdao.figures.contents.palette import line_colors, line_styles
from propmdao.figures.directivity import directivity
from propmdao.figures.rotor.blades import blade_comparison
from propmdao.figures.style import GRID, page, save
from propmdao.records.wake_law import WakeGrid

POINTS = ("hover", "flight")
SPEED, INCIDENCE = np.array([0.0, 10.0]), 70.0  # m/s, deg; in hover any incidence is the same
THRUST = np.array([2.5, 2.6])  # N
DISTANCE, MICROPHONES = 1.905, [-60.0, -30.0]  # m, deg: ahead and below
DIRECTIVITY = np.arange(-90.0, 91.0, 15.0)
RADII = [0.15, 0.45, 0.75, 1.0]
FIDELITY = pm.Fidelity(
    n_chordwise=4, n_spanwise=12, n_contour=33, n_surface_span=24, n_harmonics=4, n_azimuths=24
)
QUICK = pm.Fidelity(
    n_chordwise=2,
    n_spanwise=6,
    n_contour=9,
    n_surface_span=8,
    n_harmonics=2,
    n_azimuths=12,
    period_wake=WakeGrid(2.0, 1.0, 1.4, 20.0),
)
ROWS: tuple[Row, ...] = (
    ("rotation speed, rpm", "rpm", ".0f"),
    ("thrust, N", "thrust", ".3f"),
    ("shaft power, W", "power", ".2f"),
    ("total at -60 deg, dBA", "below", ".1f"),
    ("total at -30 deg, dBA", "ahead", ".1f"),
    ("tones at -60 deg, dB", "tones_below", ".1f"),
    ("tones at -30 deg, dB", "tones_ahead", ".1f"),
    ("force along the disk, N", "along", ".3f"),
    ("rolling moment, mN m", "roll", ".1f"),
)


def forward_flight(propeller: pm.Propeller, fidelity: pm.Fidelity = FIDELITY) -> om.Problem:
    """Set up the design problem; the power of the propeller's own blade is the limit.

    Parameters
    ----------
    propeller : Propeller
        Propeller from which the search starts.
    fidelity : Fidelity
        Numbers of panels, azimuths and harmonics.

    Returns
    -------
    om.Problem
        Problem that has run, ready for a search; `level` is the objective [dBA].
    """
    n = SPEED.size
    prob = om.Problem(reports=False)
    group = PropellerGroup(
        propeller=propeller,
        num_nodes=n,
        tilted=True,
        observers=pm.arc(DISTANCE, MICROPHONES),
        fidelity=fidelity,
        design_distributions={"beta": RADII, "chord_over_R": RADII},
        broadband=True,
    )
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    prob.model.add_subsystem(
        "mean",
        NoiseObjectiveComp(shape=(n, len(MICROPHONES)), exponent=1.0),
        promotes_inputs=[("level_db", "oaspl_total_dba")],
        promotes_outputs=[("soft_maximum_db", "level")],
    )
    prob.model.set_input_defaults("speed", SPEED, units="m/s")
    prob.model.set_input_defaults("incidence", np.full(n, INCIDENCE), units="deg")
    prob.model.set_input_defaults("thrust_required", THRUST, units="N")
    prob.model.add_design_var("beta_cp", lower=-6.0, upper=6.0, ref=4.0, units="deg")
    prob.model.add_design_var("chord_over_R_cp", lower=0.6, upper=1.6, ref=0.5)
    prob.model.add_objective("level", ref=5.0)
    prob.setup()
    prob.run_model()
    limit = prob.get_val("shaft_power").copy()
    prob.model.add_constraint("shaft_power", upper=limit, ref=limit)
    prob.setup()
    prob.run_model()
    return prob


def evaluate(propeller: pm.Propeller, fidelity: pm.Fidelity = FIDELITY) -> list[pm.Analysis]:
    """Analyse a propeller at both points, at the microphones and over the arc ahead."""
    observers = pm.arc(DISTANCE, [*MICROPHONES, *DIRECTIVITY])
    return [
        pm.analyze(
            propeller, thrust=thrust, speed=speed, incidence_deg=INCIDENCE, observers=observers,
            broadband=True, fidelity=fidelity,
        )
        for speed, thrust in zip(SPEED, THRUST, strict=True)
    ]  # fmt: skip


def column(analysis: pm.Analysis) -> dict[str, float]:
    """Compute what the table shows of a point."""
    result = analysis.to_dict()
    below, ahead = result["observers"][:2]
    return {
        "rpm": result["rpm"],
        "thrust": result["thrust"],
        "power": result["shaft_power"],
        "below": below["oaspl_total_dba"],
        "ahead": ahead["oaspl_total_dba"],
        "tones_below": below["oaspl_db"],
        "tones_ahead": ahead["oaspl_db"],
        "along": result["hub_force"][0],
        "roll": 1e3 * result["hub_moment"][0],
    }


def tabulate(analyses: dict[str, list[pm.Analysis]], output: Path) -> None:
    """Print and write a table for each point."""
    for k, point in enumerate(POINTS):
        print(point)
        columns = {name: column(points[k]) for name, points in analyses.items()}
        print_comparison(ROWS, columns)
        write_comparison(ROWS, columns, output / f"{point}.csv")


def draw(
    blades: dict[str, pm.Propeller], analyses: dict[str, list[pm.Analysis]], output: Path
) -> None:
    """Write the figures."""
    levels = {}
    figure = page(3.0)
    axes = figure.subplots()
    colors, styles = line_colors(blades), line_styles(blades)
    for name, points in analyses.items():
        for point, analysis in zip(POINTS, points, strict=True):
            observers = analysis.to_dict()["observers"][len(MICROPHONES) :]
            total = [observer["oaspl_total_dba"] for observer in observers]
            levels[f"{name}, {point}"] = np.array(total)
        around = points[-1].to_dict()["azimuths"]
        axes.plot(
            [place["azimuth_deg"] for place in around],
            [place["blade_force"][2] for place in around],
            color=colors[name],
            linestyle=styles[name],
            label=name,
        )
    axes.set(
        xlabel="azimuth of the blade in forward flight, deg; it retreats at 90",
        xticks=range(0, 361, 90),
        ylabel="thrust of a blade, N",
    )
    axes.grid(**GRID)
    axes.legend()
    save(figure, output / "around.png")
    save(blade_comparison(blades, [0.45, 0.75]), output / "blades.png")
    ahead = directivity(DIRECTIVITY, levels, label="total ahead, dBA re 20 µPa")
    save(ahead, output / "levels.png")


def design(
    propeller: pm.Propeller, output: Path, fidelity: pm.Fidelity = FIDELITY
) -> tuple[om.Problem, Search]:
    """Search from a propeller's blade, and leave the optimum in the problem."""
    prob = forward_flight(propeller, fidelity)
    return prob, run_slsqp(prob, output / "cases.sql", tolerance=1e-3, iterations=30)


def main() -> None:
    """Search, print the table, draw both blades."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("propeller", nargs="?", default="apcsf_11x4.7", help="%(default)s")
    parser.add_argument("--quick", action="store_true", help="coarse meshes, few azimuths")
    parser.add_argument("--output", type=Path, default="results/forward_flight",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)
    fidelity = QUICK if options.quick else FIDELITY

    start = pm.load_propeller(options.propeller)
    prob, search = design(start, output, fidelity)
    blades = {"start": start, "optimum": designed_blade(prob, f"{start.name}_forward")}
    analyses = {name: evaluate(blade, fidelity) for name, blade in blades.items()}
    tabulate(analyses, output)
    history = search.history
    print(f"mean level {history.objective[0]:.2f} to {history.objective[-1]:.2f} dBA in "
          f"{history.objective.size} designs, {search.seconds:.0f} s and {search.compiling:.0f} s "
          f"to compile; largest violation {history.violation[-1]:.1e}")  # fmt: skip
    draw(blades, analyses, output)
    print(f"Tables and figures: {output}")


if __name__ == "__main__":
    main()
