"""Computed thrust and power of propellers against the wind tunnel, over the whole catalogue.

Every propeller of the catalogue that is in the measurements of the UIUC Propeller Data Site, in two
sets that are never mixed: the blade "as published", and the same blade with ONE twist offset, that
with which its thrust is zero at the advance ratios where it was measured to be. The offset sees
neither static thrust nor power. `aerodynamic_sensitivity.py` shows what the differences depend on,
`hover_noise.py` what is heard of it.
"""

import argparse
import contextlib
import csv
import dataclasses
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from rich.console import Console
from rich.table import Table
from tqdm import tqdm

import propmdao as pm
from propmdao.analysis.wind_tunnel import (
    Errors,
    MeasurementError,
    Points,
    WindTunnel,
    computed,
    errors,
    read_wind_tunnel,
    zero_thrust,
    zero_thrust_ratio,
    zero_thrust_twist_deg,
)
from propmdao.figures.measured import performance
from propmdao.figures.style import save
from propmdao.geometry.blade import Blade
from propmdao.propeller.catalog import catalog_names
from propmdao.runtime.output_files import replacing
from propmdao.runtime.worker_processes import results_in_order, start_workers

MEASUREMENTS = Path(__file__).parent / "measurements"
PUBLISHED, TURNED = "as published", "own zero thrust"  # sets
ERRORS = ("static CT", "static CP", "CT to J 0.5", "CP to J 0.5", "CT above", "CP above")
THICK = 0.07  # thickness over chord at r/R 0.75 from which a blade has thick sections
# Groups of propellers, whose members are told by their names; others are those left over.
FAMILIES = {
    "APC slow flyer": ("apcsf_",),
    "APC thin electric": ("apce_",),
    "GWS": ("gws",),
    "printed by UIUC": ("da40", "nr640"),
    "others": ("",),
}
# Mean errors in per cent that are aimed at, with their sign over the propellers of a family;
# "size" is the mean absolute error. With flight speed they are of the static coefficient.
TARGETS = (
    ("APC slow flyer", PUBLISHED,
     {"static CT": 6.0, "static CP": 8.0, "CT to J 0.5": 7.0, "CP to J 0.5": 7.0}),
    ("APC thin electric", PUBLISHED,
     {"static CT": 4.0, "static CP": 6.0, "CT to J 0.5": 4.0, "CP to J 0.5": 5.0}),
    ("thick sections", TURNED,
     {"static CP": 4.0, "CP to J 0.5": 4.0, "static CT, size": 5.0, "CT to J 0.5, size": 5.0}),
)  # fmt: skip
# Columns of the table on the screen, by set, beside those of both.
OF_SET = dict.fromkeys(ERRORS[:4], "+.1f") | {"trend": ".2f"}


@dataclasses.dataclass(frozen=True)
class Column:
    """A propeller of one set, beside its measurements.

    Attributes
    ----------
    name : str
        `PUBLISHED` or `TURNED`.
    twist_deg : float
        Offset to the blade angle [deg].
    static, dynamic : Points
        Computed points without and with flight speed.
    errors : Errors
        Differences from the measurements.
    """

    name: str
    twist_deg: float
    static: Points
    dynamic: Points
    errors: Errors


@dataclasses.dataclass(frozen=True)
class Comparison:
    """A propeller of the catalogue against its measurements.

    Attributes
    ----------
    propeller : str
        Name in the catalogue.
    thickness : float
        Thickness over chord at r/R 0.75.
    tunnel : WindTunnel
        The measured points that were computed.
    zero_thrust : (float, float)
        Advance ratio of zero thrust, measured and computed as published.
    columns : (Column, Column)
        As published, and with the one twist offset.
    """

    propeller: str
    thickness: float
    tunnel: WindTunnel
    zero_thrust: tuple[float, float]
    columns: tuple[Column, Column]

    @property
    def family(self) -> str:
        """Group of propellers that it belongs to."""
        return next(name for name, starts in FAMILIES.items() if self.propeller.startswith(starts))

    @property
    def best_known(self) -> bool:
        """Whether there is no better description of the same propeller in the catalogue."""
        return self.propeller == self.tunnel.propellers[0]


def cases() -> dict[str, Path]:
    """Propellers of the catalogue that were measured, and the files of their measurements."""
    known = set(catalog_names())
    return {
        name: file
        for file in sorted(MEASUREMENTS.glob("uiuc_*.toml"))
        for name in read_wind_tunnel(file).propellers
        if name in known
    }


def measurements(case: str, quick: bool = False) -> WindTunnel:
    """Read the measurements of a case, or, to be quick, a few of them."""
    tunnel = read_wind_tunnel(cases()[case])
    return chosen(tunnel, 7, 25) if quick else tunnel


def chosen(tunnel: WindTunnel, static: int, dynamic: int) -> WindTunnel:
    """Take every so many static points and points with flight speed."""
    return dataclasses.replace(
        tunnel, static=tunnel.static[::static], dynamic=tunnel.dynamic[::dynamic]
    )


def compare(case: str, tunnel: WindTunnel, zero: Points) -> Comparison:
    """Compute a propeller of both sets at points of the wind tunnel; ``zero`` of zero thrust."""
    propeller = pm.load_propeller(case)
    twist = zero_thrust_twist_deg(propeller, zero)
    columns = []
    for name, offset in ((PUBLISHED, 0.0), (TURNED, twist)):
        still, moving = (
            computed(propeller, points, offset) for points in (tunnel.static, tunnel.dynamic)
        )
        columns.append(Column(name, offset, still, moving, errors(tunnel, still, moving)))
    measured_j = float(zero.J.mean())
    thickness = np.asarray(Blade.from_propeller(propeller).thickness_over_chord)
    return Comparison(
        propeller=case,
        thickness=float(np.interp(0.75, propeller.r_over_R, thickness)),
        tunnel=tunnel,
        zero_thrust=(measured_j, zero_thrust_ratio(propeller, zero) * measured_j),
        columns=(columns[0], columns[1]),
    )


def compared(case: tuple[str, bool]) -> Comparison | str:
    """Compare one case by its name, quickly or not; or say why there is nothing to compare."""
    name, quick = case
    whole = read_wind_tunnel(cases()[name])
    # Neighbouring points say the same; zero thrust lies between two of all of them.
    tunnel = chosen(whole, 7, 25) if quick else chosen(whole, 2, 3)
    try:
        return compare(name, tunnel, zero_thrust(whole.dynamic))
    except MeasurementError as error:
        return f"{name} is left out: {error}"


def mean_errors(difference: Errors) -> dict[str, float]:
    """Mean errors in per cent and, as "size", mean absolute ones, of points that converged."""
    arrays = (difference.static_ct, difference.static_cp, difference.low_ct, difference.low_cp,
              difference.high_ct, difference.high_cp)  # fmt: skip
    means = {}
    for name, values in zip(ERRORS, arrays, strict=True):
        if (converged := values[np.isfinite(values)]).size:  # none where nothing was measured
            means[name] = 100.0 * float(converged.mean())
            means[f"{name}, size"] = 100.0 * float(np.abs(converged).mean())
    return means


def summary(propellers: Iterable[Comparison]) -> list[dict[str, str | float]]:
    """Tabulate the errors, a row for each propeller; columns of a set begin with its name."""
    rows = []
    for comparison in propellers:
        row: dict[str, str | float] = {
            "propeller": comparison.propeller,
            "J0 measured": comparison.zero_thrust[0],
            "J0 computed": comparison.zero_thrust[1],
            "twist": comparison.columns[1].twist_deg,
        }
        for column in comparison.columns:
            values = mean_errors(column.errors) | {"trend": column.errors.trend}
            row |= {f"{column.name}: {name}": value for name, value in values.items()}
            parts = (column.static, column.dynamic)
            lost = sum(int(np.isnan(points.CT).sum()) for points in parts)
            row[f"{column.name}: not converged"] = lost
        rows.append(row)
    return rows


def verdicts(propellers: Sequence[Comparison]) -> list[dict[str, str | float]]:
    """Compare the means of the families with what is aimed at; best known descriptions alone."""
    rows: list[dict[str, str | float]] = []
    for family, name, targets in TARGETS:
        members = [
            comparison
            for comparison in propellers
            if comparison.best_known
            and (comparison.thickness >= THICK if family == "thick sections"
                 else comparison.family == family)
        ]  # fmt: skip
        for quantity, target in targets.items():
            values = [
                mean_errors(column.errors)[quantity]
                for comparison in members
                for column in comparison.columns
                if column.name == name
            ]
            if values:
                mean = float(np.mean(values))
                rows.append({"family": family, "n": len(values), "set": name,
                             "error": quantity, "target": target, "mean": mean,
                             "verdict": "met" if abs(mean) <= target else "missed"})  # fmt: skip
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
        heading = name.rpartition(": ")[2].replace(" ", "\n", 1)  # to fit 80 characters
        table.add_column(heading, justify=justify, no_wrap=True)
    for row in rows:
        table.add_row(
            *(format(row[name], form) if name in row else "" for name, form in formats.items())
        )
    Console(highlight=False).print(table)


def points(propellers: Iterable[Comparison]) -> list[dict[str, object]]:
    """Every measured point with what was computed there in both sets."""
    rows: list[dict[str, object]] = []
    for comparison in propellers:
        for part in ("static", "dynamic"):
            origins = {"measured": getattr(comparison.tunnel, part)}
            origins |= {column.name: getattr(column, part) for column in comparison.columns}
            measured = origins["measured"]
            for i, (rpm, j) in enumerate(zip(measured.rpm, measured.J, strict=True)):
                row: dict[str, object] = {"propeller": comparison.propeller, "rpm": rpm, "J": j}
                for origin, values in origins.items():
                    for quantity in ("CT", "CP"):
                        row[f"{quantity} {origin}"] = getattr(values, quantity)[i]
                rows.append(row)
    return rows


def catalogue(quick: bool = False, n_workers: int = 1) -> list[Comparison]:
    """Compare every propeller, on several processes if that is asked for; say which are missing."""
    tasks = [(name, quick) for name in cases()]
    with contextlib.ExitStack() as stack:
        results: Iterable[Comparison | str] = map(compared, tasks)
        if n_workers > 1:
            executor = stack.enter_context(start_workers(n_workers))
            results = results_in_order(executor, compared, tasks)
        results = list(tqdm(results, total=len(tasks), unit="propeller"))
    for result in results:
        if isinstance(result, str):
            print(result)
    return [result for result in results if isinstance(result, Comparison)]


def main() -> None:
    """Compare, print the tables, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="a few points of every propeller")
    parser.add_argument("--workers", type=int, default=2, help="processes, default %(default)s")
    parser.add_argument("--output", type=Path, default="results/aerodynamic_validation",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)

    began = time.perf_counter()
    propellers = catalogue(options.quick, options.workers)
    table = summary(propellers)
    every: dict[str, object] = {name: "" for row in table for name in row}
    write_csv(output / "summary.csv", [every | row for row in table])
    write_csv(output / "points.csv", points(propellers))
    for name, both in ((PUBLISHED, {"J0 measured": ".3f", "J0 computed": ".3f"}),
                       (TURNED, {"twist": "+.2f"})):  # fmt: skip
        print(f"\n{name}: mean errors in %; static: of each point, with flight speed: of the")
        print(
            "static coefficient. J0: of zero thrust. Trend: of static CT over rpm, over measured."
        )
        show(table, {"propeller": "", **both,
                     **{f"{name}: {error}": form for error, form in OF_SET.items()}})  # fmt: skip
    print("\nMeans over families of n propellers, one description for each")
    show(verdicts(propellers), {"family": "", "n": "d", "set": "", "error": "",
                           "target": ".1f", "mean": "+.1f", "verdict": ""})  # fmt: skip
    write_figures(output, propellers)
    seconds = time.perf_counter() - began
    print(f"\nMean absolute errors, those beyond J 0.5, every point, the figures: {output}")
    print(f"{len(propellers)} propellers in {seconds:.0f} s")


def write_figures(output: Path, propellers: Sequence[Comparison]) -> None:
    """Draw all propellers together, and each over its advance ratio."""
    off = {
        comparison.propeller: {column.name: column.errors for column in comparison.columns}
        for comparison in propellers
    }
    save(performance.errors_by_propeller(off), output / "catalogue.png")
    for comparison in propellers:
        titles = [
            f"{comparison.propeller}, {c.name} ({c.twist_deg:+.2f} deg)" for c in comparison.columns
        ]
        moving = {t: c.dynamic for t, c in zip(titles, comparison.columns, strict=True)}
        figure = performance.performance(comparison.tunnel.dynamic, moving)
        save(figure, output / f"{comparison.propeller}.png")


if __name__ == "__main__":
    main()
