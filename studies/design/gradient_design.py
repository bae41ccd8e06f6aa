"""Quieter propellers by derivatives: six variables, then a free-form blade. To copy and change.

- *Thesis' problem*: the six variables of `low_noise_design.py` by SLSQP instead of differential
  evolution.
- *Quiet tones* and *quiet total*: the 29 variables of `free_form_blade.py`. One minimises the
  tones and the other the A-weighted total with broadband noise, and each holds what the other
  minimises at the baseline's, with thrust, torque, thickness of the sections and slopes. Each blade
  is heard by other models of broadband noise, too: tripped, and by the fits of NASA RP-1218.
- ``--evolution N``: two levels, N designs of differential evolution and SLSQP from the best, on
  the thesis' problem: whether another valley than SLSQP's holds something better.

Printed are a table of the blades, what each kind of variable has brought, and the cost; the folder
has figures, the blades as propeller files and what the drivers recorded. An analysis that fails
ends SLSQP, so the bounds leave out what cannot be analysed.
"""

import argparse
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import free_form_blade as free_form
import low_noise_design as thesis
import numpy as np
import openmdao.api as om

import propmdao as pm
from propmdao.acoustics.levels.decibels import level_db, oaspl_db
from propmdao.acoustics.levels.weighting import level_dba
from propmdao.analysis.comparisons import (
    Cell,
    Row,
    Rows,
    markdown,
    print_comparison,
    side_by_side,
    write_comparison,
)
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.components.drivers.gradient_search import Search, run_slsqp
from propmdao.components.drivers.search_history import read_history
from propmdao.components.noise_objective_comp import soft_maximum_db
from propmdao.figures.designs import searches
from propmdao.figures.directivity import directivity
from propmdao.figures.rotor.blades import blade_comparison
from propmdao.figures.spectra import third_octaves
from propmdao.figures.style import save
from propmdao.records.models import Layers, Trip

COARSE = pm.Fidelity(n_chordwise=4, n_spanwise=12, n_contour=21, n_surface_span=20, n_harmonics=4)
TOLERANCE = 1e-4  # of a constraint in driver scaling
ROWS: tuple[Row, ...] = (
    ("rotation speed, rpm", "rpm", ".0f"),
    ("thrust, N", "thrust", ".4f"),
    ("torque, mN m", "torque", ".3f"),
    ("tones, soft maximum, dB", "tones", ".2f"),
    ("  thickness noise, dB", "thickness", ".2f"),
    ("  loading noise, dB", "loading", ".2f"),
    ("total, soft maximum, dBA", "total", ".2f"),
    ("  without laminar shedding", "unshed", ".2f"),
    ("  suction side, dBA", "suction_side", ".2f"),
    ("  separation, dBA", "separation", ".2f"),
    ("  total if heavily tripped", "tripped", ".2f"),
    ("  total by the fits of RP-1218", "fits", ".2f"),
    ("tones at -45 deg, dB", "tones_at", ".2f"),
    ("  thickness at -45 deg, dB", "thickness_at", ".2f"),
    ("  loading at -45 deg, dB", "loading_at", ".2f"),
    ("broadband at -45 deg, dB", "broadband_at", ".2f"),
    ("mean r/R of the thrust", "thrust_radius", ".3f"),
    ("blade area, cm2", "area", ".1f"),
    ("least Re beyond r/R 0.4", "reynolds", ".0f"),
)

# Distributions in the order in which they take the optimum's values, and what is shown then.
STEPS = {"": "none: the start", "beta": "+ blade angle", "chord_over_R": "+ chord",
         "camber_over_chord": "+ camber", "thickness_over_chord": "+ thickness",
         "sweep_over_R": "+ sweep: the optimum"}  # fmt: skip
BY_STEP = ("rpm", "torque", "tones", "thickness", "loading", "total", "tripped")
Design = dict[str, np.ndarray]  # control points by distribution


def evaluate(
    propeller: pm.Propeller, trip: Trip = "none", layers: Layers = "sections"
) -> pm.Analysis:
    """Analyse a propeller at the thrust, in the row of microphones and over the arc."""
    elevations = [*free_form.MICROPHONES, *thesis.DIRECTIVITY]
    return pm.analyze(
        propeller, thrust=thesis.THRUST, speed=thesis.SPEED, density=thesis.DENSITY,
        observers=pm.arc(thesis.DISTANCE, elevations), broadband=True,
        fidelity=thesis.FIDELITY, trip=trip, layers=layers,
    )  # fmt: skip


def total_dba(analysis: pm.Analysis) -> float:
    """Soft maximum of the A-weighted total over the row of microphones."""
    observers = analysis.to_dict()["observers"][: len(free_form.MICROPHONES)]
    levels = [observer["oaspl_total_dba"] for observer in observers]
    return soft_maximum_db(levels, free_form.EXPONENT)


def column(propeller: pm.Propeller, analysis: pm.Analysis) -> dict[str, Cell]:
    """Compute what the table shows of a blade."""
    n = len(free_form.MICROPHONES)
    microphone, p = n + thesis.MICROPHONE_INDEX, free_form.EXPONENT
    loads, air, noise = analysis.loads, analysis.state.air, analysis.broadband
    total, parts = analysis.tones.total, analysis.tones.parts
    assert noise is not None
    mechanisms = {
        "unshed": noise.total - noise.laminar_shedding,  # the tones are far below
        "suction_side": noise.suction_side,
        "separation": noise.separation,
    }
    r, thrust = np.asarray(loads.strips.r_over_R), np.asarray(loads.strip_thrust)
    reynolds = loads.sections.relative_speed * loads.strips.chord / air.kinematic_viscosity
    radius = 0.5 * propeller.diameter
    return {
        "rpm": analysis.rpm,
        "thrust": float(loads.thrust),
        "torque": 1e3 * float(loads.torque),
        "tones": soft_maximum_db(oaspl_db(total[:n]), p),
        "thickness": soft_maximum_db(oaspl_db(parts["thickness"][:n]), p),
        "loading": soft_maximum_db(oaspl_db(parts["loading"][:n]), p),
        "total": total_dba(analysis),
        **{
            name: soft_maximum_db(level_dba(BANDS_HZ, power[:n]), p)
            for name, power in mechanisms.items()
        },
        # Other models of the same noise: what is quiet in its own alone is no quiet blade.
        "tripped": total_dba(evaluate(propeller, trip="heavy")),
        "fits": total_dba(evaluate(propeller, layers="bpm")),
        "tones_at": float(oaspl_db(total[microphone])),
        "thickness_at": float(oaspl_db(parts["thickness"][microphone])),
        "loading_at": float(oaspl_db(parts["loading"][microphone])),
        "broadband_at": float(level_db(noise.total[microphone].sum())),
        "thrust_radius": float(r @ thrust / thrust.sum()),
        "area": 1e4 * radius**2 * float(np.trapezoid(propeller.c_over_R, propeller.r_over_R)),
        "reynolds": float(np.min(np.asarray(reynolds)[r > 0.4])),
    }


def contributions(prob: om.Problem, start: Design, best: Design) -> Rows:
    """Tabulate the effect of each kind of variable, set to its optimum's values in turn."""
    for name, value in start.items():
        prob.set_val(f"{name}_cp", value, units=free_form.units(name))
    steps = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, label in STEPS.items():
            if name:
                prob.set_val(f"{name}_cp", best[name], units=free_form.units(name))
            prob.run_model()
            blade = free_form.write_blade(prob, "step", Path(folder))
            steps[label] = column(blade, evaluate(blade))
    rows = [(label.strip(), key, form) for label, key, form in ROWS if key in BY_STEP]
    head, *others = zip(*side_by_side(rows, steps), strict=True)
    return [("taken from the optimum", *head[1:]), *others]


def cost(searches: dict[str, Search]) -> Rows:
    """Tabulate how each design was found, the head first."""
    rows: Rows = [("search", "designs", "objective at start", "at the end", "largest violation",
                   "time, s", "compiling, s")]  # fmt: skip
    for name, (history, seconds, compiling) in searches.items():
        objective, violation = history.objective, history.violation
        rows.append(
            (name, f"{objective.size}", f"{objective[0]:.3f}", f"{objective[-1]:.3f}",
             f"{violation[-1]:.1e}", f"{seconds:.0f}", f"{compiling:.0f}")
        )  # fmt: skip
    return rows


class Results(NamedTuple):
    """Blades by name with their analyses, and the searches by which they were found."""

    blades: dict[str, pm.Propeller]
    analyses: dict[str, pm.Analysis]
    searches: dict[str, Search]
    contributions: dict[str, Rows]

    def columns(self) -> dict[str, dict[str, Cell]]:
        """Columns of the table, by blade."""
        return {
            name: column(self.blades[name], analysis) for name, analysis in self.analyses.items()
        }


def control_points(prob: om.Problem) -> Design:
    """Control points of a free-form blade by distribution."""
    return {
        name: prob.get_val(f"{name}_cp", units=free_form.units(name)).copy()
        for name in free_form.BOUNDS
    }


def start_from(prob: om.Problem, design: Design) -> None:
    """Start a search where another has ended."""
    for name, (lower, upper) in free_form.BOUNDS.items():
        # Units that are changed and changed back leave a point on its bound a digit beyond it.
        rounding = 1e-12 * (upper - lower)
        inside = np.clip(design[name], lower + rounding, upper - rounding)
        prob.set_val(f"{name}_cp", inside, units=free_form.units(name))


def design(output: Path, evolution: int = 0) -> Results:
    """Search and write the blades; `evolution` designs of differential evolution, 0 for none."""
    blades = {"APC-SF": thesis.BASELINE}
    analyses = {"APC-SF": evaluate(thesis.BASELINE)}
    searches, brought = {}, {}
    before = column(blades["APC-SF"], analyses["APC-SF"])
    torque = float(analyses["APC-SF"].loads.torque)

    prob = thesis.build_problem(torque)
    searches["thesis' problem"] = run_slsqp(prob, output / "thesis.sql")
    if evolution:
        evolved = thesis.build_problem(torque)
        started = time.perf_counter()
        thesis.optimise(evolved, evolution, 1, output)
        history = read_history(evolved, output / "cases.sql")
        searches["evolution"] = Search(history, time.perf_counter() - started, 0.0)
        searches["and SLSQP"] = run_slsqp(evolved, output / "two_level.sql")
    six = {name: prob.get_val(f"{name}_cp") for name in thesis.BOUNDS}
    blades["six variables"] = thesis.naca_blade("six_variables", six, output)
    for objective, other in (("tones", "total"), ("total", "tones")):
        name, limits = f"quiet {objective}", (torque, float(before[other] or 0.0))
        # On coarse meshes most of the way costs little; on the fine ones the last steps.
        coarse = free_form.build_problem(objective, *limits, COARSE)
        start = control_points(coarse)
        searches[f"{name}, coarse"] = run_slsqp(coarse, output / f"{objective}_coarse.sql")
        prob = free_form.build_problem(objective, *limits)
        start_from(prob, control_points(coarse))
        searches[name] = run_slsqp(prob, output / f"{objective}.sql")
        blades[name] = free_form.write_blade(prob, f"quiet_{objective}", output)
        brought[name] = contributions(prob, start, control_points(prob))
    analyses |= {name: evaluate(blade) for name, blade in blades.items() if name not in analyses}
    return Results(blades, analyses, searches, brought)


def draw(results: Results, output: Path) -> None:
    """Write the figures."""
    n = len(free_form.MICROPHONES)
    runs = {name: (search.history.objective, search.history.violation)
            for name, search in results.searches.items() if name != "evolution"}  # fmt: skip
    elevations = np.array(thesis.DIRECTIVITY)
    tones, total, bands = {}, {}, {}
    for name, analysis in results.analyses.items():
        observers = analysis.to_dict()["observers"][n:]
        tones[name] = oaspl_db(analysis.tones.total[n:])
        total[name] = [levels["oaspl_total_dba"] for levels in observers]
        broadband = observers[thesis.MICROPHONE_INDEX]["broadband"]
        bands[name] = [band["spl_db"] for band in broadband]
    spectrum = third_octaves(BANDS_HZ, bands)
    spectrum.axes[0].set_xlim(left=500.0)  # nothing is drawn below
    for name, figure in (
        ("history", searches.history(runs, "objective, dB or dBA", TOLERANCE)),
        ("blades", blade_comparison(results.blades, [0.15, 0.5, 0.85])),
        ("tones", directivity(elevations, tones, label="tones")),
        ("total", directivity(elevations, total, label="A-weighted total")),
        ("broadband", spectrum),
    ):
        save(figure, output / f"{name}.png")


def main() -> None:
    """Search, print the tables, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="coarse meshes only")
    parser.add_argument("--evolution", type=int, default=0, metavar="N",
                        help="designs of differential evolution before SLSQP")  # fmt: skip
    parser.add_argument("--output", type=Path, default="results/gradient_design",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)
    if options.quick:
        thesis.FIDELITY = COARSE

    results = design(output, options.evolution)
    print_comparison(ROWS, results.columns())
    write_comparison(ROWS, results.columns(), output / "gradient_design.csv")
    print(markdown(cost(results.searches)))
    for name, table in results.contributions.items():
        print(f"{name}:")
        print(markdown(table))
    draw(results, output)
    print(f"Table, figures and the blades as propeller files: {output}")


if __name__ == "__main__":
    main()
