"""Write the tables of docs/verification.md anew from the program as it is.

Run it from the repository: ``python docs/update_tables.py``. Each table stands between two comment
lines that name it; the text around them is written by hand.
"""

from __future__ import annotations

import dataclasses
import re
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.lattice_loads import lattice_geometry
from propmdao.aerodynamics.steady import WAKE_AGES, Flow, loads_at, solve_steady
from propmdao.aerodynamics.wake import wake_azimuths
from propmdao.analysis import analyze
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.lattice import lattice_nodes, lattice_span
from propmdao.propeller import Propeller, load_propeller

HERE = Path(__file__).parent
MEASURED = HERE.parent / "studies" / "measurements" / "uiuc_apcsf_11x4.7.toml"
RADIUS, DENSITY = 0.1397, 1.225
RAD_PER_S = np.pi / 30.0
DEG = np.pi / 180.0

Rows = list[tuple[str, ...]]


def slow_flyer(airfoil: str | None = None, twist_deg: float = 0.0) -> Propeller:
    """APC-SF 11x4.7, with one airfoil all over the span and a twist offset if asked for."""
    propeller = load_propeller("apcsf_11x4.7")
    if airfoil is not None:
        propeller = dataclasses.replace(propeller, airfoils=((0.15, airfoil),))
    return dataclasses.replace(propeller, beta_deg=propeller.beta_deg + twist_deg)


def lattice(propeller: Propeller, n_chordwise: int = 8, n_spanwise: int = 24):
    """Corner points of a propeller's lattice."""
    stations = propeller.r_over_R
    span = span_interpolation(stations, lattice_span(stations[0], n_spanwise))
    return lattice_nodes(Blade.from_propeller(propeller), span, n_chordwise)


def solve(nodes, rpm: float, speed: float, ages: np.ndarray = WAKE_AGES):
    """Steady solution of a two-bladed rotor."""
    return solve_steady(nodes, 2, RADIUS, rpm * RAD_PER_S, speed, DENSITY, ages)


def lattice_convergence() -> Rows:
    """Thrust and torque for other numbers of panels, against the default 8 x 24."""
    rows: Rows = [("panels", "hover T", "hover Q", "8 m/s T", "8 m/s Q")]
    base = {v: solve(lattice(slow_flyer()), 4200.0, v) for v in (0.0, 8.0)}
    for panels in ((4, 24), (6, 24), (12, 24), (16, 24), (8, 12), (8, 16), (8, 36), (8, 48)):
        nodes = lattice(slow_flyer(), *panels)
        cells = [change(solve(nodes, 4200.0, v), base[v]) for v in base]
        rows.append((f"{panels[0]} x {panels[1]}", *(c for pair in cells for c in pair)))
    return rows


def wake_convergence() -> Rows:
    """Thrust and torque for other wakes, against the finest."""
    nodes = lattice(slow_flyer())
    rows: Rows = [("turns", "steps, deg", "nodes", "hover T", "hover Q", "8 m/s T", "8 m/s Q")]
    finest = (16, 2, 1.03, 10)
    base = {v: solve(nodes, 4200.0, v, _ages(*finest)) for v in (0.0, 8.0)}
    for wake in ((4, 10, 1.1, 30), (6, 10, 1.1, 30), (8, 10, 1.1, 30), (12, 10, 1.1, 30),
                 (6, 15, 1.0, 15), (6, 10, 1.0, 10), (6, 5, 1.05, 15), finest):  # fmt: skip
        ages = _ages(*wake)
        cells = [change(solve(nodes, 4200.0, v, ages), base[v]) for v in base]
        steps = f"{wake[1]} to {wake[3]}"
        rows.append((str(wake[0]), steps, str(len(ages)), *(c for pair in cells for c in pair)))
    return rows


def _ages(turns: float, first: float, growth: float, last: float) -> np.ndarray:
    return wake_azimuths(turns, first * DEG, growth, last * DEG)


def change(solution, base) -> tuple[str, str]:
    """Differences in thrust and torque in per cent."""
    return tuple(
        f"{100.0 * float(getattr(solution, name) / getattr(base, name) - 1.0):+.2f} %"
        for name in ("thrust", "torque")
    )


def uiuc() -> Rows:
    """CT and CP of APC-SF 11x4.7 at 4003 rpm against the wind tunnel, and what moves CT."""
    run = next(r for r in tomllib.loads(MEASURED.read_text())["run"] if r["rpm"] == 4003)
    rows: Rows = [
        ("J", "CT UIUC", "CT", "error", "CP UIUC", "CP", "error",
         "CT, +1 deg", "CT, E63 to the tip", "CT, rigid wake"),
    ]  # fmt: skip
    blade, twisted, e63 = (
        lattice(slow_flyer(*change)) for change in ((), (None, 1.0), ("e63", 0.0))
    )
    for j, ct, cp in zip(run["J"], run["CT"], run["CP"], strict=True):
        speed = j * run["rpm"] / 60.0 * 2.0 * RADIUS
        own = _of(solve(blade, run["rpm"], speed), run["rpm"], speed)
        others = [
            float(_of(solve(nodes, run["rpm"], speed), run["rpm"], speed).CT)
            for nodes in (twisted, e63)
        ]
        cells = [f"{j:.3f}", f"{ct:.4f}", f"{float(own.CT):.4f}", _error(own.CT, ct)]
        cells += [f"{cp:.4f}", f"{float(own.CP):.4f}", _error(own.CP, cp)]
        rigid = rigid_wake_ct(blade, run["rpm"], speed)
        rows.append((*cells, *(f"{value:.4f}" for value in (*others, rigid))))
    return rows


def rigid_wake_ct(nodes, rpm: float, speed: float) -> float:
    """CT with the wake carried by the flight speed alone."""
    omega = rpm * RAD_PER_S
    flow = Flow(lattice_geometry(nodes, 2, RADIUS), RADIUS, omega, speed, DENSITY)
    loads = loads_at(flow, 2, 0.0)
    return float(coefficients(2.0 * loads.thrust, 0.0, omega, speed, DENSITY, 2.0 * RADIUS).CT)


def _of(solution, rpm: float, speed: float):
    return coefficients(
        solution.thrust, solution.torque, rpm * RAD_PER_S, speed, DENSITY, 2.0 * RADIUS
    )


def _error(value, measured: float) -> str:
    # Where the measured coefficient crosses zero a relative error says nothing.
    return f"{100.0 * (float(value) / measured - 1.0):+.0f} %" if measured > 0.02 else "-"


def design_point() -> Rows:
    """The thesis' design point: 8 m/s, 4200 rpm."""
    rows: Rows = [("sections and twist", "T, N", "CT", "CQ", "thickness tone, dB")]
    for label, change in {
        "E63 to Clark-Y (catalogue)": (),
        "NACA 4412": ("naca4412",),
        "NACA 4412, twist +1 deg": ("naca4412", 1.0),
        "E63 to the tip": ("e63",),
    }.items():
        result = analyze(
            slow_flyer(*change), rpm=4200.0, speed=8.0, observers=[(1.905, -45.0)]
        ).to_dict()
        thickness = result["observers"][0]["harmonics"][0]["spl_thickness_db"]
        rows.append(
            (label, f"{result['thrust']:.3f}", f"{result['CT']:.4f}", f"{result['CQ']:.5f}",
             f"{thickness:.2f}")
        )  # fmt: skip
    rows.append(("VSPAERO, NACA 4412", "1.49", "0.0410", "0.00360", ""))
    rows.append(("thesis, VSPAERO, E63 to Clark-Y", "", "0.040", "0.0034", "37.88"))
    return rows


TABLES: dict[str, Callable[[], Rows]] = {
    "lattice": lattice_convergence,
    "wake": wake_convergence,
    "uiuc": uiuc,
    "design point": design_point,
}


def markdown(rows: Rows) -> str:
    """A table, first column to the left, numbers to the right."""
    head, *body = rows
    rule = ("---", *("---:" for _ in head[1:]))
    return "\n".join("| " + " | ".join(row) + " |" for row in (head, rule, *body))


def main() -> None:
    """Replace every table of docs/verification.md."""
    page = HERE / "verification.md"
    text = page.read_text()
    for name, table in TABLES.items():
        begin, end = f"<!-- table: {name} -->", "<!-- end of table -->"
        pattern = re.compile(f"({re.escape(begin)}\n).*?({end})", re.DOTALL)
        text, n = pattern.subn(lambda m, t=table: m[1] + markdown(t()) + "\n" + m[2], text)
        if n != 1:
            raise SystemExit(f"{page.name} must have the table {name!r} once; it has it {n} times")
        print(f"{name}: written")
    page.write_text(text)


if __name__ == "__main__":
    main()
