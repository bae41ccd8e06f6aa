"""Write the tables of docs/verification.md and docs/thesis.md anew from the program as it is.

Run it from the repository: ``python docs/update_tables.py``, or with the names of some tables, or
with what several begin with: ``gradient``. Each table stands between two comment lines that name
it; the text around them is written by hand. All of them take more than half an hour, most of it for
searches and smoothness (`gradient_tables.py`) and the thesis' meshes (`thesis_tables.py`).
"""

from __future__ import annotations

import argparse
import dataclasses
import functools
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import propmdao as pm
from propmdao.aerodynamics.solutions.result import RotorLoads
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.analysis.comparisons import Rows, markdown
from propmdao.analysis.wind_tunnel import Points, computed, zero_thrust, zero_thrust_twist_deg
from propmdao.propeller.catalog import catalog_names

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "studies" / "validation"))
import aerodynamic_sensitivity  # noqa: E402
import aerodynamic_validation  # noqa: E402
import gradient_tables  # noqa: E402
import hover_noise as hover_noise_study  # noqa: E402
import thesis_tables  # noqa: E402
import wake_transport as wake_study  # noqa: E402

SLOW_FLYER = pm.load_propeller("apcsf_11x4.7")


def solve(speed: float, **fidelity: Any) -> RotorLoads:
    """Loads of the slow flyer at 4200 rpm, with some fields of `Fidelity` that are not default."""
    return pm.analyze(SLOW_FLYER, rpm=4200.0, speed=speed, fidelity=pm.Fidelity(**fidelity)).loads


@functools.cache
def catalogue() -> list[aerodynamic_validation.Comparison]:
    """Every propeller of the catalogue that was measured, against its measurements."""
    return aerodynamic_validation.catalogue(n_workers=2)


def targets() -> Rows:
    """What is aimed at, and what is measured."""
    rows: Rows = [("propellers", "set", "error", "target", "measured", "")]
    for row in aerodynamic_validation.verdicts(catalogue()):
        rows.append(
            (f"{row['family']} ({row['n']})", str(row["set"]), str(row["error"]),
             f"{row['target']:g} %", f"{row['mean']:+.1f} %", str(row["verdict"]))
        )  # fmt: skip
    levels = hover_noise_study.hover_tones()
    for name, computed_db in (
        (aerodynamic_validation.PUBLISHED, levels.spl_db),
        (aerodynamic_validation.TURNED, levels.turned_db),
    ):
        error = np.abs(computed_db - levels.measured_db)
        for label, value, target in (("mean", error.mean(), 1.5), ("largest", error.max(), 3.0)):
            rows.append(
                ("APC-SF 11x4.7 in hover", name, f"tone at blade passage, {label}",
                 f"{target:g} dB", f"{value:.1f} dB", _verdict(value <= target))
            )  # fmt: skip
    return rows


def _verdict(met: bool) -> str:
    return "met" if met else "missed"


def lattice_convergence() -> Rows:
    """Thrust and torque for other numbers of panels, against the default 8 x 24."""
    rows: Rows = [("panels", "hover T", "hover Q", "8 m/s T", "8 m/s Q")]
    base = {v: solve(v) for v in (0.0, 8.0)}
    for nc, ns in ((4, 24), (6, 24), (12, 24), (16, 24), (8, 12), (8, 16), (8, 36), (8, 48)):
        cells = [change(solve(v, n_chordwise=nc, n_spanwise=ns), base[v]) for v in base]
        rows.append((f"{nc} x {ns}", *(cell for pair in cells for cell in pair)))
    return rows


def wake_convergence() -> Rows:
    """Thrust and torque for other wakes, against the finest."""
    rows: Rows = [("turns", "steps, deg", "nodes", "hover T", "hover Q", "8 m/s T", "8 m/s Q")]
    finest = pm.WakeGrid(16, 2, 1.03, 10)
    base = {v: solve(v, wake=finest) for v in (0.0, 8.0)}
    for wake in (
        *(pm.WakeGrid(turns, 10, 1.1, 30) for turns in (4, 6, 8, 12)),
        *(pm.WakeGrid(6, *steps) for steps in ((15, 1.0, 15), (10, 1.0, 10), (5, 1.05, 15))),
        finest,
    ):
        cells = [change(solve(v, wake=wake), base[v]) for v in base]
        rows.append(
            (f"{wake.turns}", f"{wake.first_step_deg} to {wake.last_step_deg}",
             f"{len(wake_azimuths(wake))}", *(cell for pair in cells for cell in pair))
        )  # fmt: skip
    return rows


def change(solution: RotorLoads, base: RotorLoads) -> tuple[str, ...]:
    """Differences in thrust and torque in per cent."""
    return tuple(
        f"{100.0 * float(getattr(solution, name) / getattr(base, name) - 1.0):+.2f} %"
        for name in ("thrust", "torque")
    )


def wake_transport() -> Rows:
    """The wake that moves as it itself and the blades induce, and the prescribed one beside it."""
    return _formatted(wake_study.compare(wake_study.CASES), wake_study.FORMATS)


def ideal_disk() -> Rows:
    """Power over that of the ideal actuator disk at the same thrust."""
    rows: Rows = [("J", "CT inviscid", "power / ideal", "CT viscous", "power / ideal")]
    for j in (0.0, 0.1, 0.2, 0.3, 0.4):
        cells = []
        for viscous in (False, True):
            speed = j * 4003 / 60.0 * SLOW_FLYER.diameter
            result = pm.analyze(SLOW_FLYER, rpm=4003.0, speed=speed, viscous=viscous).to_dict()
            disk = 0.5 * result["rho"] * np.pi * SLOW_FLYER.diameter**2
            w = -0.5 * speed + np.sqrt(0.25 * speed**2 + result["thrust"] / disk)
            ideal = result["thrust"] * (speed + w)
            cells += [f"{result['CT']:.4f}", f"{result['shaft_power'] / ideal:.3f}"]
        rows.append((f"{j:.1f}", *cells))
    return rows


def summary() -> Rows:
    """Mean errors of every propeller, in both sets."""
    study = aerodynamic_validation
    formats = {"propeller": "", "J0 measured": ".3f", "J0 computed": ".3f", "twist": "+.2f"}
    for name in (study.PUBLISHED, study.TURNED):
        formats |= {f"{name}: {error}": form for error, form in study.OF_SET.items()}
    return _formatted(study.summary(catalogue()), formats)


def _formatted(table: list[dict], formats: dict[str, str]) -> Rows:
    """Rows of a study with its formats, head first."""
    return [
        tuple(formats),
        *(
            tuple("" if key not in row else format(row[key], form) for key, form in formats.items())
            for row in table
        ),
    ]


def run_4003() -> Rows:
    """APC-SF 11x4.7 at 4003 rpm, point by point."""
    tunnel = aerodynamic_validation.measurements("apcsf_11x4.7")
    run = tunnel.dynamic[tunnel.dynamic.rpm == 4003]
    twist = zero_thrust_twist_deg(SLOW_FLYER, zero_thrust(tunnel.dynamic))
    published, turned = (computed(SLOW_FLYER, run, offset) for offset in (0.0, twist))
    inviscid = computed(SLOW_FLYER, run, viscous=False)
    thesis = computed(pm.load_propeller("apcsf_11x4.7_thesis"), run)
    columns: dict[str, Points] = {
        "UIUC": run, "published": published, "own zero thrust": turned, "inviscid": inviscid,
        "thesis' sections": thesis,
    }  # fmt: skip
    names = ("CT", "CP")
    rows: Rows = [("J", *(f"{name} {origin}" for name in names for origin in columns))]
    for i, j in enumerate(run.J):
        cells = (f"{getattr(p, name)[i]:.4f}" for name in names for p in columns.values())
        rows.append((f"{j:.3f}", *cells))
    return rows


def sensitivity(case: str) -> Rows:
    """Errors of a propeller with one thing changed at a time."""
    study = aerodynamic_sensitivity
    tunnel = study.chosen(aerodynamic_validation.measurements(case))
    return _formatted(study.sensitivities(case, tunnel), study.FORMATS)


def twist_needed() -> Rows:
    """Twist offset for the measured CT in hover, and the error of CP with it."""
    rows: Rows = [("propeller", "rpm", "J", "twist for the measured CT, deg", "error of CP, %")]
    study = aerodynamic_sensitivity
    for case in study.CASES:
        tunnel = study.chosen(aerodynamic_validation.measurements(case))
        for part in (tunnel.static, tunnel.dynamic[tunnel.dynamic.J <= 0.5]):
            for rpm, j, twist, cp in zip(
                part.rpm, part.J, *study.twist_needed(pm.load_propeller(case), part), strict=True
            ):
                rows.append((case, f"{rpm:.0f}", f"{j:.3f}", f"{twist:+.2f}", f"{cp:+.1f}"))
    return rows


def hover_noise() -> Rows:
    """Blade passage levels in hover."""
    return hover_noise_study.rows(hover_noise_study.hover_tones())


def design_point() -> Rows:
    """The thesis' design point: 8 m/s, 4200 rpm."""

    def with_sections(airfoil: str) -> pm.Propeller:
        photographed = pm.load_propeller("apcsf_11x4.7_uiuc")  # as the thesis has it
        return dataclasses.replace(
            photographed, airfoils=((0.15, airfoil),), thickness_over_chord=None
        )

    rows: Rows = [("sections", "flow", "T, N", "CT", "CQ", "thickness tone, dB")]
    for label, propeller in {
        "catalogue": SLOW_FLYER,
        "thesis, E63 to Clark-Y": pm.load_propeller("apcsf_11x4.7_thesis"),
        "NACA 4412": with_sections("naca4412"),
    }.items():
        for flow, viscous in (("viscous", True), ("inviscid", False)):
            result = pm.analyze(
                propeller, rpm=4200.0, speed=8.0, viscous=viscous, observers=pm.arc(1.905, -45.0)
            ).to_dict()
            thickness = result["observers"][0]["harmonics"][0]["spl_thickness_db"]
            rows.append(
                (label, flow, f"{result['thrust']:.3f}", f"{result['CT']:.4f}",
                 f"{result['CQ']:.5f}", f"{thickness:.2f}")
            )  # fmt: skip
    rows.append(("NACA 4412", "VSPAERO", "1.49", "0.0410", "0.00360", ""))
    rows.append(("thesis, E63 to Clark-Y", "its VSPAERO", "", "0.040", "0.0034", "37.88"))
    return rows


def blade_elements() -> Rows:
    """Blade elements over the lattice, propeller by propeller at 5000 rpm."""
    rows: Rows = [("propeller", "c / R at 0.75", *(f"{name}, J {j:g}" for j in (0.0, 0.3)
                   for name in ("T", "Q")))]  # fmt: skip
    for name in catalog_names():
        if name.endswith(("_uiuc", "_thesis")):
            continue
        propeller = pm.load_propeller(name)
        chord = np.interp(0.75, propeller.r_over_R, propeller.c_over_R)
        cells: list[str] = []
        for j in (0.0, 0.3):
            speed = j * 5000.0 / 60.0 * propeller.diameter
            elements, lattice = (
                pm.analyze(propeller, rpm=5000.0, speed=speed, blade_element=chosen).loads
                for chosen in (True, False)
            )
            cells += change(elements, lattice)
        rows.append((name, f"{chord:.3f}", *cells))
    return rows


TABLES: dict[str, Callable[[], Rows]] = {
    "targets": targets,
    "lattice": lattice_convergence,
    "wake": wake_convergence,
    "wake transport": wake_transport,
    "ideal disk": ideal_disk,
    "blade elements": blade_elements,
    "wind tunnel": summary,
    "run at 4003 rpm": run_4003,
    "sensitivity apcsf_11x4.7": functools.partial(sensitivity, "apcsf_11x4.7"),
    "sensitivity apce_10x7": functools.partial(sensitivity, "apce_10x7"),
    "twist needed": twist_needed,
    "hover noise": hover_noise,
    "design point": design_point,
    **gradient_tables.TABLES,
    **thesis_tables.TABLES,
}


def main() -> None:
    """Replace the tables on their pages."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "tables",
        nargs="*",
        help=f"some of: {', '.join(TABLES)}; or what several begin with; default all",
    )
    names = []
    for start in parser.parse_args().tables or [""]:
        begun = [start] if start in TABLES else [name for name in TABLES if name.startswith(start)]
        if not begun:
            parser.error(f"no table {start!r}; there are: {', '.join(TABLES)}")
        names += begun
    for name in names:
        page = HERE / ("thesis.md" if name in thesis_tables.TABLES else "verification.md")
        begin, end = f"<!-- table: {name} -->", "<!-- end of table -->"
        pattern = re.compile(f"({re.escape(begin)}\n).*?({end})", re.DOTALL)
        text = markdown(TABLES[name]())
        new_page, n = pattern.subn(
            lambda m, t=text: f"{m[1]}{t}{m[2]}", page.read_text(encoding="utf-8")
        )
        if n != 1:
            raise SystemExit(f"{page.name} must have the table {name!r} once; it has it {n} times")
        page.write_text(new_page, encoding="utf-8")
        print(f"{name}: written", flush=True)


if __name__ == "__main__":
    main()
