"""Tables and figures of docs/thesis.md, the thesis beside ours; `update_tables.py` writes them.

Each runs the study that has the thesis' case and adds what the thesis reports. Figures are those of
the studies, which leave everything in ``results/``; copies of what the page shows are kept in
``docs/figures/thesis``.
"""

from __future__ import annotations

import functools
import shutil
import sys
import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import propmdao as pm
from propmdao.acoustics.levels.decibels import spl_db
from propmdao.analysis.comparisons import Rows, side_by_side
from propmdao.analysis.wind_tunnel import Points, computed, zero_thrust, zero_thrust_twist_deg
from propmdao.components.drivers.gradient_search import run_slsqp
from propmdao.figures.measured import performance
from propmdao.figures.rotor.blades import blade_comparison
from propmdao.figures.style import save
from propmdao.propeller.airfoils.airfoil import max_camber_for_design_lift

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "studies" / "validation"), str(ROOT / "studies" / "design")]
import acoustic_validation  # noqa: E402
import aerodynamic_validation  # noqa: E402
import discretisation  # noqa: E402
import low_noise_design  # noqa: E402
import spatial_convergence  # noqa: E402
import temporal_convergence  # noqa: E402

RESULTS = ROOT / "results"
FIGURES = ROOT / "docs" / "figures" / "thesis"
THESIS_BLADE = pm.load_propeller("apcsf_11x4.7_thesis")
SLOW_FLYER = pm.load_propeller("apcsf_11x4.7")
RUNS_RPM = (3004, 4003, 5003)  # figure 4.9
ADVANCE_RATIOS = (0.15, 0.30, 0.45, 0.60)
ANGLES_J, ANGLES_R = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6), (0.3, 0.5, 0.75, 0.9)
THESIS_J = 0.30  # of the noise in hover, table 4.6
LEVELS = [f"total {elevation:g}, dB" for elevation in discretisation.ELEVATION_DEG]
LEVELS += [f"{source} -45, dB" for source in ("thickness", "loading")]


def meshes() -> Rows:
    """Table 4.3, figures 4.5 and 4.6: the default and the ten meshes."""
    study = spatial_convergence
    shown = {name: form for name, form in study.SHOWN.items() if name != "run time, s"}
    return _refined("spatial_convergence", study.compare(study.MESHES), "mesh", shown)


def time_steps() -> Rows:
    """Table 4.4, figures 4.7 and 4.8: time steps of a march."""
    study = temporal_convergence
    rows = study.compare(study.TIMESTEPS_DEG, study.SCHEDULE, pm.Fidelity())
    straight = [f"{discretisation.STRAIGHT} -45, dB"]
    return _refined("temporal_convergence", rows, "time step, deg", study.SHOWN, straight)


def _refined(
    name: str,
    results: Sequence[Mapping[str, Any]],
    resolution: str,
    shown: Mapping[str, str],
    more: Sequence[str] = (),
) -> Rows:
    """Table of a study of resolution, its figures kept."""
    discretisation.report(results, resolution, shown, RESULTS / name)
    for figure in ("thrust", "oaspl"):
        _keep(RESULTS / name / f"{figure}.png", f"{name}_{figure}.png")
    formats = {**shown, **dict.fromkeys([*LEVELS, *more], ".2f")}
    return [
        tuple(formats),
        *(tuple(format(row[key], form) for key, form in formats.items()) for row in results),
    ]


def _keep(figure: Path, name: str) -> None:
    """Copy a figure of a study to where the page shows it."""
    FIGURES.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(figure, FIGURES / name)


def thrust_coefficient() -> Rows:
    """Figure 4.9: CT over advance ratio at three rotation speeds, its figure drawn."""
    tunnel = aerodynamic_validation.measurements("apcsf_11x4.7")
    twist = zero_thrust_twist_deg(SLOW_FLYER, zero_thrust(tunnel.dynamic))
    measured = tunnel.dynamic[np.isin(tunnel.dynamic.rpm, RUNS_RPM)]
    columns: dict[str, Points] = {
        "thesis' sections, inviscid": computed(THESIS_BLADE, measured, viscous=False),
        "maker's table, viscous": computed(SLOW_FLYER, measured),
        f"the same at its own zero thrust ({twist:+.1f} deg)": computed(
            SLOW_FLYER, measured, twist
        ),
    }
    FIGURES.mkdir(parents=True, exist_ok=True)
    save(performance.performance(measured, columns), FIGURES / "thrust_coefficient.png")
    rows: Rows = [("rpm", "J", "CT measured", *(f"CT {name}" for name in columns))]
    for rpm in RUNS_RPM:
        run = np.flatnonzero(measured.rpm == rpm)
        for ratio in ADVANCE_RATIOS:
            i = run[np.abs(measured.J[run] - ratio).argmin()]
            cells = (points.CT[i] for points in (measured, *columns.values()))
            rows.append((f"{rpm}", f"{measured.J[i]:.3f}", *(f"{ct:.4f}" for ct in cells)))
    return rows


def angles() -> Rows:
    """Figure 4.10: angle of attack and lift over advance ratio, as numbers."""
    head = [f"{name} at r/R {r:g}" for name in ("alpha, deg", "cl") for r in ANGLES_R]
    rows: Rows = [("J", *head)]
    for ratio in ANGLES_J:
        rpm = float(RUNS_RPM[1])
        speed = ratio * rpm / 60.0 * SLOW_FLYER.diameter
        loads = pm.analyze(SLOW_FLYER, rpm=rpm, speed=speed).loads
        r, states = np.asarray(loads.strips.r_over_R), loads.sections
        cells = [
            f"{np.interp(place, r, np.asarray(values)):{form}}"
            for values, form in (
                (np.degrees(states.angle_of_attack), "+.1f"), (states.lift_coefficient, "+.2f"),
            )
            for place in ANGLES_R
        ]  # fmt: skip
        rows.append((f"{ratio:g}", *cells))
    return rows


@functools.cache
def chamber() -> tuple[dict[int, acoustic_validation.Hover], dict[str, Any]]:
    """Hover at the three rotation speeds of the chamber, and the measurement; figures kept."""
    study = acoustic_validation
    test = tomllib.loads(study.MEASURED.read_text(encoding="utf-8"))
    arc = np.linspace(-90.0, 90.0, 73)
    hovers = {rpm: study.hover(rpm, test, arc) for rpm in test["blade_passage"]["rpm"]}
    folder = RESULTS / "acoustic_validation"
    folder.mkdir(parents=True, exist_ok=True)
    study.draw(hovers, study.band_comparisons(hovers, test), test, folder)
    for figure in sorted(folder.glob("figure_4_*.png")):
        _keep(figure, figure.name)
    return hovers, test


def directivity_errors() -> Rows:
    """Table 4.7, figures 4.12 to 4.15: errors of the tone at blade passage."""
    hovers, test = chamber()
    passage = test["blade_passage"]
    rows: Rows = [
        ("rpm", "elevation, deg", "measured, dB", "thesis, size of error, dB",
         "as the thesis computes, error, dB", "in hover, error, dB")
    ]  # fmt: skip
    sizes = []
    for k, (rpm, hovering) in enumerate(hovers.items()):
        alike = pm.analyze(
            THESIS_BLADE, rpm=rpm, speed=THESIS_J * rpm / 60.0 * THESIS_BLADE.diameter,
            viscous=False, observers=pm.arc(test["radius"], passage["elevation_deg"]),
        )  # fmt: skip
        for i, elevation in enumerate(passage["elevation_deg"]):
            measured = passage["spl_db"][k][i]
            thesis = test["thesis"]["absolute_error_db"][k][i]
            errors = [
                float(spl_db(analysis.tones.total[i, 0])) - measured
                for analysis in (alike, hovering.analysis)
            ]
            sizes.append([thesis, *np.abs(errors)])
            rows.append(
                (f"{rpm}", f"{elevation:+.1f}", f"{measured:.2f}", f"{thesis:.2f}",
                 *(f"{error:+.2f}" for error in errors))
            )  # fmt: skip
    for name, of in (("mean size", np.mean), ("largest", np.max)):
        rows.append((name, "", "", *(f"{size:.2f}" for size in of(sizes, axis=0))))
    return rows


@functools.cache
def designs() -> dict[str, tuple[pm.Propeller, dict[str, list[float]]]]:
    """The thesis' optimum and that of SLSQP: the blade and its six numbers."""
    study = low_noise_design
    folder = RESULTS / "thesis"
    folder.mkdir(parents=True, exist_ok=True)
    baseline = study.evaluate(study.BASELINE, thrust=study.THRUST)
    problem = study.build_problem(float(baseline.loads.torque))
    run_slsqp(problem, folder / "search.sql")
    ours = {name: list(problem.get_val(f"{name}_cp")) for name in study.BOUNDS}
    found = {"thesis": study.THESIS_DESIGN, "ours": ours}
    blades = {
        name: study.naca_blade(f"{name}_optimum", design, folder) for name, design in found.items()
    }
    figure = blade_comparison(
        {"APC-SF 11x4.7": study.BASELINE, "thesis' optimum": blades["thesis"],
         "our optimum": blades["ours"]},
        [*study.AT.values()],
    )  # fmt: skip
    FIGURES.mkdir(parents=True, exist_ok=True)
    save(figure, FIGURES / "optimum_blades.png")
    return {name: (blades[name], design) for name, design in found.items()}


def optimum() -> Rows:
    """Table 4.9: sections of both optima."""
    study = low_noise_design
    rows: Rows = [("", "thesis", "ours", "bounds")]
    for name, label in ((study.T_C, "thickness over chord"), (study.CL_I, "design lift")):
        for k, place in enumerate(study.AT):
            values = [f"{designs()[whose][1][name][k]:.4f}" for whose in ("thesis", "ours")]
            low, high = (study.BOUNDS[name][side][k] for side in ("lower", "upper"))
            rows.append((f"{label}, {place}", *values, f"{low:g} ... {high:g}"))
    for k, place in enumerate(study.AT):
        nacas = (
            f"NACA {100 * max_camber_for_design_lift(design[study.CL_I][k]):.0f}4"
            f"{100 * design[study.T_C][k]:02.0f}"
            for _, design in (designs()[whose] for whose in ("thesis", "ours"))
        )
        rows.append((f"section, {place}", *nacas, ""))
    return rows


def performance_of_designs() -> Rows:
    """Table 4.10: the thesis' propeller and its optimum, as reported and as computed here."""
    study = low_noise_design
    theirs, ours = (designs()[whose][0] for whose in ("thesis", "ours"))
    reported = [{key: pair[k] for key, pair in study.THESIS.items()} for k in (0, 1)]

    def at_reported(propeller: pm.Propeller, k: int) -> pm.Analysis:
        return pm.analyze(
            propeller, rpm=reported[k]["rpm"], speed=study.SPEED, density=study.DENSITY,
            viscous=False, observers=pm.arc(study.DISTANCE, study.MICROPHONE),
        )  # fmt: skip

    at_thrust = {
        "at 1.2 N: APC-SF": study.BASELINE,
        "its optimum": theirs,
        "our optimum": ours,
    }
    columns: dict[str, Mapping[str, Any]] = {
        "reported: APC-SF": reported[0],
        "reported: optimum": reported[1],
        "inviscid at its rpm: APC-SF": study.at_observer(at_reported(study.BASELINE, 0)),
        "inviscid at its rpm: optimum": study.at_observer(at_reported(theirs, 1)),
    }
    for name, propeller in at_thrust.items():
        analysis = study.evaluate(propeller, thrust=study.THRUST)
        columns[name] = study.at_observer(analysis, study.MICROPHONE_INDEX)
    return side_by_side(study.ROWS, columns)


#: Tables by the names that stand in docs/thesis.md.
TABLES: dict[str, Callable[[], Rows]] = {
    "thesis meshes": meshes,
    "thesis time steps": time_steps,
    "thesis thrust coefficient": thrust_coefficient,
    "thesis angles": angles,
    "thesis directivity": directivity_errors,
    "thesis optimum": optimum,
    "thesis performance": performance_of_designs,
}
