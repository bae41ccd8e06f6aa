"""Sensitivity of the differences to the wind tunnel to what is not known for sure.

APC-SF 11x4.7 and APC-E 10x7 are computed with one thing changed at a time: twist, sections, stall
delay, transition, drift of the wake. Then the question is turned round: which twist offset would
each measured CT need, and is the power right where the thrust is?

Nothing here is fitted, and nothing of it is in the catalogue.
"""

import argparse
import dataclasses
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from aerodynamic_validation import measurements, show, write_csv

import propmdao as pm
from propmdao.analysis.wind_tunnel import (
    Evaluate,
    Points,
    WindTunnel,
    calibrated_twist_deg,
    computed,
    errors,
    zero_thrust,
    zero_thrust_twist_deg,
)
from propmdao.figures.measured import performance
from propmdao.figures.style import save

CASES = ("apcsf_11x4.7", "apce_10x7")
N_CRIT = (3.0, 9.0)  # beside the default 5: dirty and clean air
FORMATS = {"changed": "", "static CT": "+.1f", "static CP": "+.1f", "CT to J 0.5": "+.1f",
           "CP to J 0.5": "+.1f", "trend": ".2f", "twist": "+.2f", "then CT": "+.1f",
           "then CP": "+.1f"}  # fmt: skip


def chosen(tunnel: WindTunnel) -> WindTunnel:
    """Every third static point and every sixth with flight speed: enough for mean errors."""
    return dataclasses.replace(tunnel, static=tunnel.static[::3], dynamic=tunnel.dynamic[::6])


def variants(propeller: pm.Propeller) -> Iterator[tuple[str, pm.Propeller, Evaluate]]:
    """The propeller with one thing changed, and how it is analysed."""
    change = partial(dataclasses.replace, propeller)
    beta = propeller.beta_deg
    yield "nothing", propeller, computed
    yield "twist +1 deg", change(beta_deg=beta + 1.0), computed
    yield "twist -1 deg", change(beta_deg=beta - 1.0), computed
    yield "photographed geometry", pm.load_propeller(f"{propeller.name}_uiuc"), computed
    yield "no sweep, no rake", change(sweep_over_R=0.0, rake_over_R=0.0), computed
    for label, airfoils in {
        "E63 to Clark-Y": ((0.15, "e63"), (1.0, "clarky")),
        "E63": ((0.15, "e63"),),
        "Clark-Y": ((0.15, "clarky"),),
    }.items():
        if airfoils != tuple(propeller.airfoils):
            yield f"sections {label}", change(airfoils=airfoils), computed
    if propeller.name == "apcsf_11x4.7":
        yield "sections of the thesis", pm.load_propeller("apcsf_11x4.7_thesis"), computed
    yield "no stall delay", propeller, partial(computed, stall_delay=False)
    yield "drag as computed", propeller, partial(computed, measured_drag=False)
    for n_crit in N_CRIT:
        yield f"n_crit {n_crit:g}", propeller, partial(computed, n_crit=n_crit)
    law = pm.WakeLaw()
    for factor in (0.75, 1.5):
        drift = {
            name: factor * getattr(law, name)
            for name in ("before_passage", "after_passage", "inside")
        }
        wake = dataclasses.replace(law, **drift)
        yield f"drift of the wake x {factor:g}", propeller, partial(computed, wake=wake)


def sensitivities(case: str, tunnel: WindTunnel) -> list[dict[str, Any]]:
    """Mean errors of every variant in per cent; then with its own twist of zero thrust."""
    rows, propeller = [], pm.load_propeller(case)
    zero = zero_thrust(measurements(case).dynamic)
    for label, blade, evaluate in variants(propeller):
        twist = zero_thrust_twist_deg(blade, zero, evaluate)
        published, turned = (
            _mean(tunnel, evaluate(blade, tunnel.static, offset),
                  evaluate(blade, tunnel.dynamic, offset))
            for offset in (0.0, twist)
        )  # fmt: skip
        then = {"then CT": turned["CT to J 0.5"], "then CP": turned["CP to J 0.5"]}
        rows.append({"changed": label, **published, "twist": twist, **then})
    return rows


def _mean(tunnel: WindTunnel, static: Points, dynamic: Points) -> dict[str, float]:
    difference = errors(tunnel, static, dynamic)
    named = {"static CT": difference.static_ct, "static CP": difference.static_cp,
             "CT to J 0.5": difference.low_ct, "CP to J 0.5": difference.low_cp}  # fmt: skip
    means = {name: 100.0 * float(np.nanmean(values)) for name, values in named.items()}
    return means | {"trend": difference.trend}


def twist_needed(propeller: pm.Propeller, measured: Points) -> tuple[np.ndarray, np.ndarray]:
    """Twist offset [deg] that gives each measured CT, and the error of CP with it [%]."""
    twist, cp = np.zeros((2, measured.rpm.size))
    for i in range(measured.rpm.size):
        point = measured[i : i + 1]
        twist[i] = calibrated_twist_deg(propeller, point)
        cp[i] = 100.0 * (computed(propeller, point, twist[i]).CP[0] / point.CP[0] - 1.0)
    return twist, cp


def fits_over_rpm(rpm: np.ndarray, twist: np.ndarray) -> str:
    """Say how well two laws describe the twist needed in hover."""
    lines = []
    for name, x in (("rpm^2", rpm**2), ("log rpm", np.log(rpm))):
        left = twist - np.polyval(np.polyfit(x, twist, 1), x)
        lines.append(f"linear in {name}: {np.sqrt(np.mean(left**2)):.2f} deg rms left over")
    return f"from {twist[0]:+.2f} to {twist[-1]:+.2f} deg; {', '.join(lines)}"


def main() -> None:
    """Vary, print the tables, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="a few points")
    parser.add_argument("--output", type=Path, default="results/aerodynamic_sensitivity",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)
    for case in CASES:
        tunnel = measurements(case, quick=True) if options.quick else chosen(measurements(case))
        rows = sensitivities(case, tunnel)
        write_csv(output / f"{case}.csv", [dict.fromkeys(FORMATS, "") | row for row in rows])
        print(f"\n{case}: mean errors in %; then with the twist of zero thrust [deg]")
        show(rows, FORMATS)

        propeller, climbing = pm.load_propeller(case), tunnel.dynamic[tunnel.dynamic.J <= 0.5]
        still, moving = (twist_needed(propeller, points) for points in (tunnel.static, climbing))
        print(
            f"Twist offset for the measured static CT: {fits_over_rpm(tunnel.static.rpm, still[0])}"
        )
        labels = "twist offset for the measured CT, deg", "error of CP with it, %"
        figure = performance.over_rpm_and_advance_ratio(
            tunnel.static, climbing, dict(zip(labels, zip(still, moving, strict=True), strict=True))
        )
        save(figure, output / f"{case}_twist_needed.png")
        rows_needed = zip(
            *(np.append(getattr(tunnel.static, name), getattr(climbing, name)) for name in
              ("rpm", "J")), *np.concatenate([still, moving], axis=1), strict=True
        )  # fmt: skip
        write_csv(
            output / f"{case}_twist_needed.csv",
            [dict(zip(("rpm", "J", "twist", "CP error"), row, strict=True)) for row in rows_needed],
        )
    print(f"\nAll rows and the figures: {output}")


if __name__ == "__main__":
    main()
