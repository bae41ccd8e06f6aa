"""Are the objectives smooth? Scans along random lines through the design space of a blade.

An optimiser that follows derivatives stops at a jump or a kink, and one that does not exploits it.
Lines join random designs within the bounds of `free_form_blade.py`, far wilder than any blade, at
the trimmed rotation speed. Along each

- the second differences are compared with their neighbours, and where they stand out most the line
  is looked at again 2 and 8 times finer. They shrink with the step to the power 2 where the slope
  is continuous, 1 at a kink and 0 at a jump: below 1.5 is reported as a kink;
- the derivative that the model gives is compared with central differences in the middle.

What the interpolation of the polars leaves, jumps of the curvature, is allowed: powers stay 2.
"""

import argparse
import csv
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import free_form_blade as free_form
import low_noise_design as thesis
import numpy as np
import openmdao.api as om
from numpy.typing import NDArray
from scipy.ndimage import median_filter

import propmdao as pm
from propmdao.analysis.comparisons import Rows, markdown
from propmdao.figures.designs import searches
from propmdao.figures.style import save
from propmdao.runtime.output_files import replacing

Array = NDArray[np.float64]
QUICK = pm.Fidelity(n_chordwise=4, n_spanwise=12, n_contour=21, n_surface_span=20, n_harmonics=4)
MICROPHONE = free_form.MICROPHONES.index(thesis.MICROPHONE)
RESPONSES = {  # output: element, label
    "spl_bpf_db": (MICROPHONE, "BPF tone, dB"),
    "oaspl_db": (MICROPHONE, "tones, dB"),
    "oaspl_total_dba": (MICROPHONE, "total, dBA"),
    free_form.OBJECTIVES["tones"]: (0, "soft maximum, dB"),
    free_form.OBJECTIVES["total"]: (0, "soft maximum, dBA"),
    "torque": (0, "torque, N m"),
    "rpm": (0, "rotation speed, rpm"),
}
SUSPECTS = 1  # places of each response that are looked at again
KINK = 1.5  # power between that of a kink and that of a smooth function
STEP = 2e-4  # of the central differences, in lengths of the line


class Suspect(NamedTuple):
    """A place where a response is least smooth: position on the line, power of the step."""

    response: str
    line: int
    position: float
    power: float


class Line:
    """The model along a line between two designs, position 0 to 1."""

    def __init__(self, prob: om.Problem, start: Array, end: Array) -> None:
        self._prob, self._start, self._along = prob, start, end - start

    def __call__(self, position: float) -> Array:
        """Responses (n_responses,), nan where the analysis fails."""
        parts = np.split(self._start + position * self._along, len(free_form.BOUNDS))
        for name, value in zip(free_form.BOUNDS, parts, strict=True):
            self._prob.set_val(f"{name}_cp", value, units=free_form.units(name))
        try:
            self._prob.run_model()
        except om.AnalysisError:
            return np.full(len(RESPONSES), np.nan)
        return np.array([self._prob.get_val(name).ravel()[k] for name, (k, _) in RESPONSES.items()])

    def slope(self, position: float) -> Array:
        """Derivatives (n_responses,) by the position, from the model's totals."""
        self(position)
        wrt = [f"{name}_cp" for name in free_form.BOUNDS]
        totals = self._prob.compute_totals(list(RESPONSES), wrt, driver_scaling=False)
        # Totals are by what is free, and by radians.
        parts = np.split(self._along, len(wrt))
        along = np.concatenate([
            part[free_form.free_indices(name)] * (np.pi / 180.0 if free_form.units(name) else 1.0)
            for name, part in zip(free_form.BOUNDS, parts, strict=True)
        ])  # fmt: skip
        return np.array([
            np.concatenate([totals[response, name][k] for name in wrt]) @ along
            for response, (k, _) in RESPONSES.items()
        ])  # fmt: skip


def random_line(prob: om.Problem, seed: int) -> Line:
    """Line between two random designs within the bounds."""
    lower, upper = (np.concatenate(side) for side in zip(*free_form.BOUNDS.values(), strict=True))
    start, end = lower + (upper - lower) * np.random.default_rng(seed).random((2, lower.size))
    return Line(prob, start, end)


def suspects(values: Array) -> list[int]:
    """Indices at which the second differences (n,) stand out most from their neighbours'."""
    second = np.abs(np.diff(values, 2))
    usual = median_filter(second, 15) + 1e-3 * np.max(second)
    return [int(k) + 1 for k in np.argsort(-second / usual)[:SUSPECTS]]


def power(function: Callable[[float], Array], position: float, step: float) -> Array:
    """Power of the step with which second differences shrink within a step around a position."""
    values = np.array([function(position + step * k / 16.0) for k in range(-16, 17)])

    def largest(k: int) -> Array:
        """Second difference over k sixteenths, wherever they begin: a kink lies between them."""
        size: Array = np.abs(values[2 * k :] - 2.0 * values[k:-k] + values[: -2 * k]).max(axis=0)
        return size

    return np.log(largest(8) / largest(2)) / np.log(4.0)


def scan(lines: list[Line], n: int) -> tuple[Array, list[Suspect]]:
    """Values (n_lines, n, n_responses) and the places where they are least smooth."""
    positions = np.linspace(0.0, 1.0, n)
    scans, least_smooth = [], []
    for number, line in enumerate(lines):
        values = np.array([line(position) for position in positions])
        scans.append(values)
        responses_at: dict[int, list[int]] = {}
        for k, column in enumerate(values.T):
            for index in suspects(column):
                responses_at.setdefault(index, []).append(k)
        for index, responses in responses_at.items():
            powers = power(line, positions[index], positions[1])
            least_smooth += [
                Suspect([*RESPONSES][k], number, positions[index], float(powers[k]))
                for k in responses
            ]
    return np.array(scans), least_smooth


def derivative_errors(lines: list[Line]) -> Array:
    """Largest error of the totals against differences, over the largest slope: (n_responses,)."""
    middle = 0.5
    exact = np.array([line.slope(middle) for line in lines])
    central = np.array(
        [(line(middle + STEP) - line(middle - STEP)) / (2.0 * STEP) for line in lines]
    )
    return np.abs(exact - central).max(axis=0) / np.abs(exact).max(axis=0)


def survey(n_lines: int = 3, n: int = 201) -> tuple[Array, list[Suspect], Array]:
    """Scan random lines: values, places that are least smooth, errors of the derivatives."""
    prob = free_form.build_problem("total", np.inf, np.inf)
    lines = [random_line(prob, seed) for seed in range(n_lines)]
    return *scan(lines, n), derivative_errors(lines)


def rows(values: Array, least_smooth: list[Suspect], errors: Array) -> Rows:
    """Tabulate the responses, the head first."""
    table: Rows = [("response", "range", "largest second difference", "least power",
                    "derivative against differences", "kinks")]  # fmt: skip
    for k, (name, (_, label)) in enumerate(RESPONSES.items()):
        response = values[..., k]
        powers = [suspect.power for suspect in least_smooth if suspect.response == name]
        second = np.nanmax(np.abs(np.diff(response, 2, axis=1)))
        table.append(
            (label, f"{np.nanmax(response) - np.nanmin(response):.3g}", f"{second:.1e}",
             f"{min(powers):.2f}", f"{errors[k]:.0e}", f"{sum(p < KINK for p in powers)}")
        )  # fmt: skip
    failed = f"{np.isnan(values).any(axis=2).sum()} of {values[..., 0].size}"
    return [*table, ("analyses that failed", failed, "", "", "", "")]


def main() -> None:
    """Scan, print the table, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="coarse meshes")
    parser.add_argument("--lines", type=int, default=3, help="random lines, default %(default)s")
    parser.add_argument("--points", type=int, default=201, help="on each, default %(default)s")
    parser.add_argument("--output", type=Path, default="results/smooth_objectives",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)
    if options.quick:
        thesis.FIDELITY = QUICK

    values, least_smooth, errors = survey(options.lines, options.points)
    print(markdown(rows(values, least_smooth, errors)))
    for suspect in sorted(least_smooth, key=lambda suspect: suspect.power)[:5]:
        print(f"{suspect.response}: line {suspect.line} at {suspect.position:.4f}, "
              f"power {suspect.power:.2f}")  # fmt: skip
    with (
        replacing(output / "smooth_objectives.csv") as beside,
        beside.open("w", newline="", encoding="utf-8") as stream,
    ):
        writer = csv.writer(stream)
        writer.writerow(["line", "position", *RESPONSES])
        for number, line_values in enumerate(values):
            positions = np.linspace(0.0, 1.0, options.points)
            for position, row in zip(positions, line_values, strict=True):
                writer.writerow([number, position, *row])
    figure = searches.line_scans(
        np.linspace(0.0, 1.0, options.points),
        {name: values[..., k] for k, name in enumerate(RESPONSES)},
        {name: label for name, (_, label) in RESPONSES.items()},
    )
    first = figure.axes[0]
    first.legend(first.lines, [f"line {number}" for number in range(options.lines)])
    save(figure, output / "scans.png")
    print(f"Table and figure: {output}")


if __name__ == "__main__":
    main()
