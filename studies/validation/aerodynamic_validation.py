"""Computed thrust, power and efficiency of propellers against the wind tunnel.

Three propellers of the UIUC Propeller Data Site, at every run measured and standing still, in two
columns that are never mixed: the published geometry as it is, and the same with ONE twist offset,
fitted to static thrust alone. The slow flyer 11x4.7 has both section stacks that are on record, the
maker's (the catalogue's) and the thesis'. `aerodynamic_sensitivity.py` shows what the differences
depend on, `hover_noise.py` what is heard of it.
"""

import argparse
import csv
import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from rich.console import Console
from rich.table import Table

import propmdao as pm
from propmdao.analysis.wind_tunnel import (
    Errors,
    Points,
    WindTunnel,
    calibrated_twist_deg,
    computed,
    errors,
    read_wind_tunnel,
)
from propmdao.figures import comparisons
from propmdao.figures.style import save
from propmdao.runtime.output_files import replacing

MEASUREMENTS = Path(__file__).parent / "measurements"
# Propellers of the catalogue, and the files of their measurements.
CASES = {
    "apcsf_11x4.7": "uiuc_apcsf_11x4.7",
    "apcsf_11x4.7_thesis": "uiuc_apcsf_11x4.7",
    "apcsf_10x4.7": "uiuc_apcsf_10x4.7",
    "apce_10x7": "uiuc_apce_10x7",
}
PUBLISHED, CALIBRATED = "published", "calibrated"  # geometry
# Mean absolute errors in per cent that are aimed at; static ones of each point, with flight speed
# of the static coefficient. The Reynolds trend is a ratio of slopes.
TARGETS = {
    PUBLISHED: {"static CT": 8.0, "static CP": 12.0, "CT to J 0.5": 8.0, "trend": 0.5},
    CALIBRATED: {"CT to J 0.5": 2.5, "CP to J 0.5": 8.0, "trend": 0.5},
}
ERRORS = ("static CT", "static CP", "CT to J 0.5", "CP to J 0.5", "CT above", "CP above")
FORMATS = {"propeller": "", "geometry": "", "twist": "+.2f", **dict.fromkeys(ERRORS, ".1f"),
           "trend": ".2f"}  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Column:
    """A propeller as published or calibrated, beside its measurements.

    Attributes
    ----------
    propeller, name : str
        Propeller's name in the catalogue, and `PUBLISHED` or `CALIBRATED`.
    twist_deg : float
        Offset to the blade angle [deg].
    static, dynamic : Points
        Computed points without and with flight speed.
    errors : Errors
        Differences from the measurements.
    """

    propeller: str
    name: str
    twist_deg: float
    static: Points
    dynamic: Points
    errors: Errors


def measurements(case: str, quick: bool = False) -> WindTunnel:
    """Read the measurements of a case, or, to be quick, a few of them."""
    tunnel = read_wind_tunnel(MEASUREMENTS / f"{CASES[case]}.toml")
    if not quick:
        return tunnel
    return dataclasses.replace(tunnel, static=tunnel.static[::7], dynamic=tunnel.dynamic[::25])


def compare(case: str, tunnel: WindTunnel) -> list[Column]:
    """Compute the published and the calibrated geometry at the points of the wind tunnel."""
    propeller = pm.load_propeller(case)
    columns = []
    for name in (PUBLISHED, CALIBRATED):
        twist = calibrated_twist_deg(propeller, tunnel.static) if name == CALIBRATED else 0.0
        still, moving = (
            computed(propeller, points, twist) for points in (tunnel.static, tunnel.dynamic)
        )
        columns.append(Column(case, name, twist, still, moving, errors(tunnel, still, moving)))
    return columns


def mean_errors(difference: Errors) -> dict[str, float]:
    """Mean absolute errors and mean errors in per cent; points not converged are left out."""
    arrays = (difference.static_ct, difference.static_cp, difference.low_ct, difference.low_cp,
              difference.high_ct, difference.high_cp)  # fmt: skip
    named = dict(zip(ERRORS, arrays, strict=True))
    sizes = {name: 100.0 * float(np.nanmean(np.abs(values))) for name, values in named.items()}
    means = {f"{name}, mean": 100.0 * float(np.nanmean(values)) for name, values in named.items()}
    return sizes | means


def summary(columns: Iterable[Column]) -> list[dict[str, str | float]]:
    """Tabulate the errors, and at the end the targets."""
    rows: list[dict[str, str | float]] = [
        {
            "propeller": column.propeller,
            "geometry": column.name,
            "twist": column.twist_deg,
            **mean_errors(column.errors),
            "trend": column.errors.trend,
            "not converged": sum(
                np.isnan(points.CT).sum() for points in (column.static, column.dynamic)
            ),
        }
        for column in columns
    ]
    for name, target in TARGETS.items():
        rows.append({"propeller": "target", "geometry": name, **target, "not converged": 0})
    return rows


def write_csv(file: Path, rows: Sequence[Mapping[str, object]]) -> None:
    """Write a table; the first row has all columns."""
    with replacing(file) as beside, beside.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def show(rows: Sequence[Mapping[str, object]], formats: Mapping[str, str]) -> None:
    """Print the columns that have a format."""
    table = Table(box=None, padding=(0, 1, 0, 0))
    for name in formats:
        justify: Literal["left", "right"] = "right" if formats[name] else "left"
        heading = name.replace(" ", "\n", 1)  # to fit a terminal of 80 characters
        table.add_column(heading, justify=justify, no_wrap=True)
    for row in rows:
        table.add_row(
            *(format(row[name], form) if name in row else "" for name, form in formats.items())
        )
    Console(highlight=False).print(table)


def write_points(file: Path, tunnel: WindTunnel, columns: Sequence[Column]) -> None:
    """Write every measured point with what was computed there."""
    rows: list[dict[str, object]] = []
    for part in ("static", "dynamic"):
        points = {"measured": getattr(tunnel, part)}
        points |= {column.name: getattr(column, part) for column in columns}
        for i, (rpm, j) in enumerate(
            zip(points["measured"].rpm, points["measured"].J, strict=True)
        ):
            rows.append({"rpm": rpm, "J": j})
            for origin, values in points.items():
                for quantity in ("CT", "CP", "eta"):
                    rows[-1][f"{quantity} {origin}"] = getattr(values, quantity)[i]
    write_csv(file, rows)


def main() -> None:
    """Compare, print the table, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="a few points of every propeller")
    parser.add_argument("--output", type=Path, default="results/aerodynamic_validation",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)

    all_columns: list[Column] = []
    for case in CASES:
        tunnel = measurements(case, options.quick)
        columns = compare(case, tunnel)
        all_columns += columns
        write_points(output / f"{case}.csv", tunnel, columns)
        names = [f"{case}, {column.name} ({column.twist_deg:+.2f} deg)" for column in columns]
        moving = {name: column.dynamic for name, column in zip(names, columns, strict=True)}
        save(comparisons.performance(tunnel.dynamic, moving), output / f"{case}.png")
        still = {name: column.static for name, column in zip(names, columns, strict=True)}
        figure = comparisons.static_performance(tunnel.static, still)
        save(figure, output / f"{case}_static.png")
    table = summary(all_columns)
    write_csv(output / "summary.csv", table)
    # 80 characters have no room for the points beyond J 0.5.
    show(table, {name: form for name, form in FORMATS.items() if "above" not in name})
    print("Mean absolute errors in %; static: of each point, with flight speed: of the static")
    print("coefficient. Twist in deg. Trend: slope of static CT over rpm, computed over measured.")
    print(f"Errors beyond J 0.5 and with their sign, every point, the figures: {output}")


if __name__ == "__main__":
    main()
