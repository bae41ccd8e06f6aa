"""Polars over Mach number on a whole rotor: columns as found, one column by the rule."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.analysis.single_point import analyze
from propmdao.formats.c81 import read_c81
from propmdao.formats.propellers import load_propeller

ANGLES = [-180, -90, -20, -12, -8, -4, 0, 4, 8, 12, 20, 90, 180]
LIFT = [0, -0.1, -0.8, -0.9, -0.5, 0, 0.45, 0.9, 1.25, 1.2, 0.8, 0.1, 0]
DRAG = [0.02, 1.8, 0.3, 0.08, 0.03, 0.014, 0.012, 0.014, 0.02, 0.06, 0.3, 1.8, 0.02]


def c81(machs: list[float], drag_rise: float) -> str:
    """Lift and moment the same at all Mach numbers; drag times `drag_rise` at the last one."""
    lines = ["MY SECTION".ljust(30) + f"{len(machs):02d}{len(ANGLES):02d}" * 3]
    factor = np.linspace(1.0, drag_rise, len(machs))
    same = np.ones(len(machs))
    for values in (
        np.outer(LIFT, same),
        np.outer(DRAG, factor),
        np.full((len(ANGLES), len(machs)), -0.08),
    ):
        lines.append(" " * 7 + "".join(f"{mach:7.3f}" for mach in machs))
        lines += [
            f"{angle:7.1f}" + "".join(f"{value:7.4f}" for value in row)
            for angle, row in zip(ANGLES, values, strict=True)
        ]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("machs", "drag_rise", "thrust", "torque"),
    [
        ([0.0, 0.6], 1.0, 24.37, 0.3865),  # lift at Mach 0.6 is what the file says it is
        # Nothing is said: Prandtl and Glauert raise it, as tests of C81 files hold, too. Slow, for
        # a table of one column is a program of its own.
        pytest.param([0.0], 1.0, 25.18, 0.4045, marks=pytest.mark.slow),
        ([0.0, 0.6], 5.0, 24.15, 0.5112),  # drag grows between the columns
    ],
)
def test_a_rotor_at_tip_mach_half(
    tmp_path: Path, machs: list[float], drag_rise: float, thrust: float, torque: float
) -> None:
    """APC-SF 11x4.7, photographed, at 12000 rev/min, 5 m/s, all of its sections with one polar."""
    file = tmp_path / "my.c81"
    file.write_text(c81(machs, drag_rise))
    propeller, table = load_propeller("apcsf_11x4.7_uiuc"), read_c81(file)
    polars = polars_for(propeller, {"e63": table, "naca4412": table})
    loads = analyze(propeller, rpm=12000.0, speed=5.0, polars=polars).loads
    assert loads.thrust == pytest.approx(thrust, rel=1e-3)
    assert loads.torque == pytest.approx(torque, rel=1e-3)
