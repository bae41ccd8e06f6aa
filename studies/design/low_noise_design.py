"""A quieter propeller at the same thrust: a study to copy and change.

The blade keeps chord and twist of the APC Slow Flyer 11x4.7. Its sections become NACA 4-digit ones
with maximum camber at 0.4 c, whose thickness and design lift coefficient are free at hub, r/R 0.5
and tip and linear in between. The rotation speed follows from the thrust, the overall level of the
tones at one microphone is minimised, and the torque may not exceed the baseline's.

It is the problem of tables 4.8 to 4.10 in "Study of the noise and aerodynamics of a propeller used
in drones by applying a low-fidelity method" (bachelor thesis, Universidade Federal de Uberlandia,
2022), but for the bounds of the rotation speed: 4000 to 5000 rpm nearly exclude the baseline.
Differential evolution is the thesis' choice and needs no derivatives; with them, which this model
has, SLSQP arrives at the same blade in some ten evaluations: `gradient_design.py`.
"""

import argparse
import dataclasses
from pathlib import Path

import numpy as np
import openmdao.api as om

import propmdao as pm
from propmdao.analysis.comparisons import (
    ROWS,
    Cell,
    at_observer,
    print_comparison,
    write_comparison,
)
from propmdao.components import DifferentialEvolutionDriver, PropellerGroup
from propmdao.components.geometry_comp import blade_distributions
from propmdao.figures.contents.pressures import blade_passage
from propmdao.figures.contents.sound import Sound, source_levels
from propmdao.figures.designs.convergence import convergence
from propmdao.figures.directivity import directivity
from propmdao.figures.pressure import pressure
from propmdao.figures.rotor.blades import blade_comparison
from propmdao.figures.spectra import harmonic_spectrum
from propmdao.figures.style import save
from propmdao.formats.naca_blade import with_naca_sections
from propmdao.propeller.airfoils.airfoil import max_camber_for_design_lift

BASELINE = pm.load_propeller("apcsf_11x4.7_thesis")
START = dataclasses.replace(BASELINE, airfoils=[(1.0, "naca4409")])
SPEED, DENSITY, THRUST = 8.0, 1.225, 1.20  # m/s, kg/m3, N
RPM_BOUNDS = (3500.0, 5500.0)
DISTANCE, MICROPHONE = 1.905, -45.0  # m from the hub, deg from the rotor plane, negative: wake side
DIRECTIVITY = sorted({*range(-90, 91, 3), MICROPHONE})  # deg
MICROPHONE_INDEX = DIRECTIVITY.index(MICROPHONE)
AT = {"hub": 0.15, "middle": 0.5, "tip": 1.0}  # r/R of the design variables
T_C, CL_I = "thickness_over_chord", "design_lift_coefficient"
BOUNDS = {
    T_C: {"lower": [0.05, 0.03, 0.03], "upper": [0.13, 0.10, 0.10]},
    CL_I: {"lower": [0.50, 0.30, 0.30], "upper": [0.80, 0.95, 0.80]},
}
FIDELITY = pm.Fidelity()  # panels and harmonics
POPULATION = 24  # designs in a generation

# Values that the thesis reports, tables 4.9 and 4.10.
THESIS_DESIGN = {T_C: [0.0581, 0.0309, 0.0346], CL_I: [0.7792, 0.3899, 0.5313]}
THESIS = {
    "rpm": (4200.0, 4636.0),
    "thrust": (1.20, 1.24),
    "CT": (0.040, 0.035),
    "CQ": (0.0034, 0.0026),
    "oaspl_thickness_db": (37.88, 33.18),
    "oaspl_loading_db": (52.87, 41.33),
    "oaspl_db": (53.04, 38.93),
    "spl_bpf_db": (44.92, 37.09),
    "bpf_hz": (140.0, 155.0),
}
NOTES = """\
Comparable with what the thesis reports: BPF and thickness levels, CT, CQ. Its other
levels stand 8 dB above its own BPF tone, content of a 10 deg time step; its CT of 0.040
at 4200 rpm is 1.46 N, not 1.20 N. The APC-SF at 4200 rpm here: {thrust:.2f} N, CT {CT:.4f},
CQ {CQ:.5f}, thickness {oaspl_thickness_db:.2f} dB, BPF {spl_bpf_db:.2f} dB.
Viscous loads, which the thesis does not have. Tones only, no broadband noise."""


def build_problem(torque_limit: float) -> om.Problem:
    """Blade to noise, with design variables, constraint and objective."""
    propeller = PropellerGroup(
        propeller=START,
        observers=pm.arc(DISTANCE, MICROPHONE),
        fidelity=FIDELITY,
        rpm_bounds=RPM_BOUNDS,
        camber=CL_I,
        design_distributions={name: list(AT.values()) for name in BOUNDS},
        control="values",  # the thesis' six numbers are the blade
    )
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("propeller", propeller, promotes=["*"])
    prob.model.set_input_defaults("speed", SPEED, units="m/s")
    prob.model.set_input_defaults("density", DENSITY, units="kg/m**3")
    prob.model.set_input_defaults("thrust_required", THRUST, units="N")
    for name, bounds in BOUNDS.items():
        prob.model.add_design_var(f"{name}_cp", **bounds)
    prob.model.add_constraint("torque", upper=torque_limit, ref=torque_limit)
    prob.model.add_objective("oaspl_db")
    prob.setup()
    return prob


def optimise(prob: om.Problem, evaluations: int, seed: int, output: Path) -> None:
    """Leave the best design that meets the constraint in the problem."""
    best = output / "best_design.json"
    best.unlink(missing_ok=True)  # of an earlier run
    prob.driver = DifferentialEvolutionDriver(
        pop_size=POPULATION,
        max_gen=max(evaluations // POPULATION - 1, 0),  # after the initial one
        tol=1e-5,
        seed=seed,
        best_file=best,
    )
    prob.driver.add_recorder(om.SqliteRecorder(output / "cases.sql", record_viewer_data=False))
    try:
        prob.run_driver()
    except KeyboardInterrupt:
        raise SystemExit(f"Interrupted. The best design so far, if any, is in {best}") from None
    finally:
        prob.cleanup()
    if prob.driver.fail:
        raise SystemExit("No design meets the constraint: more evaluations or other bounds?")


def evaluate(
    propeller: pm.Propeller, thrust: float | None = None, rpm: float | None = None
) -> pm.Analysis:
    """Analyse a propeller at a thrust or an rpm, on the arc of the microphone."""
    return pm.analyze(propeller, thrust=thrust, rpm=rpm, speed=SPEED, density=DENSITY,
                      observers=pm.arc(DISTANCE, DIRECTIVITY), fidelity=FIDELITY)  # fmt: skip


def naca_blade(name: str, design: dict[str, list[float]], folder: Path) -> pm.Propeller:
    """Make the blade of a design and write it as a file that `propmdao analyze` reads."""
    return with_naca_sections(
        BASELINE, name, [*AT.values()],
        [max_camber_for_design_lift(lift) for lift in design[CL_I]], design[T_C], folder,
        source=f"chord and blade angle of {BASELINE.name}, sections of a design study",
    )  # fmt: skip


def column(propeller: pm.Propeller, analysis: pm.Analysis) -> dict[str, Cell]:
    """Results at the microphone, and the design variables as this blade has them."""
    values: dict[str, Cell] = {**at_observer(analysis, MICROPHONE_INDEX)}
    blade, airfoils = blade_distributions(propeller, CL_I), dict(propeller.airfoils)
    for place, r in AT.items():
        t, lift = (float(np.interp(r, propeller.r_over_R, blade[name])) for name in (T_C, CL_I))
        naca = f"NACA {100 * max_camber_for_design_lift(lift):.0f}4{100 * t:02.0f}"  # whole digits
        section = airfoils.get(r, "blend")
        values[f"section {place}"] = naca if section.endswith(".dat") else section
        values |= {f"{T_C} {place}": t, f"{CL_I} {place}": lift}
    return values


def designs_tried(output: Path, torque_limit: float) -> tuple[list[float], list[bool]]:
    """Read the objective of every design, nan where the analysis failed, and its feasibility."""
    cases = om.CaseReader(output / "cases.sql").get_cases("driver")[:-1]  # the last: best again
    objective = [case["oaspl_db"][0] if case.success else np.nan for case in cases]
    return objective, [case.success and case["torque"][0] <= torque_limit for case in cases]


def main() -> None:
    """Optimise, print the table, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--evaluations", type=int, default=1200, help="designs, default 1200")
    parser.add_argument("--seed", type=int, default=1, help="same seed, same search; default 1")
    parser.add_argument("--output", type=Path, default="results", help="folder, default results")
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)

    baseline = evaluate(BASELINE, thrust=THRUST)
    torque_limit = float(baseline.loads.torque)
    prob = build_problem(torque_limit)
    optimise(prob, options.evaluations, options.seed, output)
    best = naca_blade("optimum", {name: prob.get_val(f"{name}_cp") for name in BOUNDS}, output)
    optimum = evaluate(best, thrust=THRUST)

    thesis_blade = naca_blade("thesis_optimum", THESIS_DESIGN, output)
    columns: dict[str, dict[str, Cell]] = {
        "APC-SF\n11x4.7": column(BASELINE, baseline),
        "optimum": column(best, optimum),
        "thesis'\noptimum": column(thesis_blade, evaluate(thesis_blade, thrust=THRUST)),
        "reported:\nAPC-SF": {key: values[0] for key, values in THESIS.items()},
        "reported:\noptimum": {key: values[1] for key, values in THESIS.items()},
    }
    rows = [(f"t/c {place}", f"{T_C} {place}", ".4f") for place in AT]
    rows += [(f"design lift {place}", f"{CL_I} {place}", ".4f") for place in AT]
    rows += [(f"section {place}", f"section {place}", "") for place in AT]
    rows += ROWS
    print_comparison(rows, columns)
    write_comparison(rows, columns, output / "low_noise_design.csv")
    same_rpm = evaluate(BASELINE, rpm=THESIS["rpm"][0])
    print(NOTES.format(**at_observer(same_rpm, MICROPHONE_INDEX)))

    level = "OASPL at the microphone, dB re 20 µPa"
    start = {"APC-SF 11x4.7": at_observer(baseline, MICROPHONE_INDEX)["oaspl_db"]}
    compared = {"APC-SF 11x4.7": Sound.of_tones(baseline.tones),
                "optimum": Sound.of_tones(optimum.tones)}  # fmt: skip
    passages = {name: blade_passage(sound.tones, MICROPHONE_INDEX)
                for name, sound in compared.items()}  # fmt: skip
    levels = {name: source_levels(sound) for name, sound in compared.items()}
    for name, figure in (
        ("convergence", convergence(*designs_tried(output, torque_limit), level, start)),
        ("blades", blade_comparison({"APC-SF 11x4.7": BASELINE, "optimum": best}, [*AT.values()])),
        ("spectrum", harmonic_spectrum(compared, MICROPHONE_INDEX)),
        ("pressure", pressure(passages)),
        ("directivity", directivity(DIRECTIVITY, levels, microphone_deg=MICROPHONE)),
    ):
        save(figure, output / f"{name}.png")
    print(f"\nTable, figures, the blades as propeller files and every design tried: {output}")


if __name__ == "__main__":
    main()
