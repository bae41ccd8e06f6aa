"""Effect of six variables on the noise of a blade: a design of experiments on the thesis' problem.

A Latin hypercube over thickness and design lift coefficient at hub, middle and tip, within the
bounds of `low_noise_design.py` and for its operating point: 8 m/s and 1.20 N. Every sample is a row
of a table (CSV, and Parquet if pyarrow is installed), to which an interrupted or killed run goes
on. Then

- responses over every variable, with the mean that a quadratic surrogate gives over the others,
- standardised regression coefficients: standard deviations of the response per standard deviation
  of the variable, in a linear fit,
- Sobol' indices of the surrogate: the share of the variance that a variable explains alone and
  with all its interactions (Saltelli et al. 2010, in ``scipy.stats.sobol_indices``).

The surrogate's Q2, the share of the variance that it predicts where a sample is left out, says how
far the indices can be trusted.
"""

import argparse
import csv
import dataclasses
import importlib.util
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from low_noise_design import AT, BOUNDS, CL_I, T_C, build_problem
from matplotlib.figure import Figure
from openmdao.drivers.sampling.pyDOE_generators import LatinHypercubeGenerator
from rich import box
from rich.console import Console
from rich.table import Table
from scipy.stats import sobol_indices, uniform

from propmdao.components import SweepDriver
from propmdao.figures.style import save

Array = npt.NDArray[np.float64]
VARIABLES = {  # column of the table: name
    f"{name}_cp[{i}]": f"{short} {place}"
    for name, short in ((T_C, "t/c"), (CL_I, "lift"))
    for i, place in enumerate(AT)
}
RESPONSES = {
    "oaspl_db": "OASPL, dB",
    "oaspl_thickness_db": "thickness noise, dB",
    "oaspl_loading_db": "loading noise, dB",
    "torque": "torque, N m",
    "rpm": "rotation speed, rpm",
}
SOBOL_POINTS = 2**13
ANY_LIMIT = 1.0  # N m; the torque is a response here, not a constraint


@dataclasses.dataclass(frozen=True)
class Surrogate:
    """Quadratic polynomial of variables that are scaled to [-1, 1].

    Attributes
    ----------
    coefficients : (n_terms,) array
        Coefficients of the columns that `terms` makes.
    q2 : float
        Share of the variance that is predicted when each sample in turn is left out.
    """

    coefficients: Array
    q2: float

    @classmethod
    def fit(cls, x: Array, y: Array) -> "Surrogate":
        """Fit by least squares to samples, x (n_samples, n_variables) and y (n_samples,)."""
        matrix = terms(x)
        if len(y) <= matrix.shape[1]:
            raise ValueError(
                f"the surrogate has {matrix.shape[1]} coefficients and {len(y)} samples are too"
                " few for it; more of them?"
            )
        coefficients = np.asarray(np.linalg.lstsq(matrix, y)[0], dtype=float)
        # Residuals with a sample left out follow from those with all (Allen 1974).
        leverage = np.sum(np.linalg.qr(matrix).Q ** 2, axis=1)
        left_out = (y - matrix @ coefficients) / (1.0 - leverage)
        return cls(coefficients, 1.0 - float(np.mean(left_out**2) / np.var(y)))

    def __call__(self, x: Array) -> Array:
        """Response (n_points,) at x (n_points, n_variables)."""
        return terms(x) @ self.coefficients


def terms(x: Array) -> Array:
    """One, the variables and their products at x (n_points, n_variables), as columns."""
    i, j = np.triu_indices(x.shape[1])
    return np.column_stack([np.ones(len(x)), x, x[:, i] * x[:, j]])


def run_sweep(table: Path, n_samples: int, seed: int, n_workers: int) -> None:
    """Run the samples that the table does not have."""
    factory = partial(build_problem, ANY_LIMIT)
    prob = factory()
    factors = {f"{name}_cp": {**bounds, "units": None} for name, bounds in BOUNDS.items()}
    prob.driver = SweepDriver(
        LatinHypercubeGenerator(factors, samples=n_samples, seed=seed),
        table=table.absolute(),
        n_workers=n_workers,
        problem_factory=factory,
    )
    # The objective and the constraint of the problem are responses already.
    prob.driver.add_responses([name for name in RESPONSES if name not in ("oaspl_db", "torque")])
    prob.setup()  # again, for the responses
    prob.run_driver()
    for reason in dict.fromkeys(prob.driver.failures):
        print(f"failed, {prob.driver.failures.count(reason)} times: {reason}")


def read_table(table: Path) -> tuple[Array, dict[str, Array]]:
    """Scaled variables (n_samples, 6) and the responses of the samples that have not failed."""
    with table.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["status"] == "ok"]
    lower, upper = (
        np.concatenate([bounds[side] for bounds in BOUNDS.values()]) for side in ("lower", "upper")
    )
    x = np.array([[float(row[name]) for name in VARIABLES] for row in rows]).reshape(-1, 6)
    y = {name: np.array([float(row[name]) for row in rows]) for name in RESPONSES}
    return 2.0 * (x - lower) / (upper - lower) - 1.0, y


def sensitivities(x: Array, y: Array, surrogate: Surrogate, seed: int) -> dict[str, Array]:
    """Measures of how much each variable matters, and R2 of the linear fit."""
    standard = (x - x.mean(axis=0)) / x.std(axis=0)
    target = (y - y.mean()) / y.std()
    slopes, *_ = np.linalg.lstsq(standard, target)
    indices = sobol_indices(
        func=lambda points: surrogate(points.T),
        n=SOBOL_POINTS,
        dists=[uniform(-1.0, 2.0)] * x.shape[1],
        rng=seed,
    )
    return {
        "regression": slopes,
        "alone": indices.first_order,
        "in all": indices.total_order,
        "R2": np.array(1.0 - np.var(target - standard @ slopes)),
    }


def plot_responses(x: Array, y: dict[str, Array], fits: dict[str, Surrogate]) -> Figure:
    """Draw noise and torque over every variable, with the surrogate's mean over the others."""
    responses = ("oaspl_db", "torque")
    figure = Figure(figsize=(12.0, 5.0), dpi=100, layout="constrained")
    axes = figure.subplots(len(responses), x.shape[1], sharex="col", sharey="row")
    lower, upper = (
        np.concatenate([b[side] for b in BOUNDS.values()]) for side in ("lower", "upper")
    )
    for column, name in enumerate(VARIABLES.values()):
        values = lower[column] + 0.5 * (x[:, column] + 1.0) * (upper[column] - lower[column])
        scaled = np.linspace(-1.0, 1.0, 21)
        for row, response in enumerate(responses):
            axes[row, column].plot(values, y[response], ".", color="0.6", markersize=3)
            means = []
            for level in scaled:
                points = x.copy()
                points[:, column] = level
                means.append(fits[response](points).mean())
            levels = lower[column] + 0.5 * (scaled + 1.0) * (upper[column] - lower[column])
            axes[row, column].plot(levels, means, color="#D55E00")
            axes[row, 0].set_ylabel(RESPONSES[response])
        axes[-1, column].set_xlabel(name)
    return figure


def plot_sensitivities(measures: dict[str, dict[str, Array]]) -> Figure:
    """Draw the Sobol' indices of every response, alone and in all."""
    figure = Figure(figsize=(12.0, 3.6), dpi=100, layout="constrained")
    axes = figure.subplots(1, len(measures), sharey=True)
    place = np.arange(len(VARIABLES))
    for ax, (response, indices) in zip(axes, measures.items(), strict=True):
        ax.barh(place, indices["in all"], color="#56B4E9", label="with interactions")
        ax.barh(place, indices["alone"], height=0.4, color="#0072B2", label="alone")
        ax.set_title(RESPONSES[response], fontsize=10)
        ax.set_yticks(place, list(VARIABLES.values()))
        ax.set_xlim(0.0, 1.0)
    axes[0].invert_yaxis()
    figure.supxlabel("share of the variance (Sobol' index)", fontsize=10)
    axes[0].legend(fontsize=8, loc="lower right")
    return figure


def print_table(measures: dict[str, dict[str, Array]], fits: dict[str, Surrogate], n: int) -> None:
    """Print regression coefficients and Sobol' indices, a row per variable."""
    table = Table(box=box.SIMPLE_HEAD, padding=0, title=f"{n} samples: regression | Sobol' in all")
    table.add_column("")
    for response in measures:
        table.add_column(RESPONSES[response], justify="right")
    for i, name in enumerate(VARIABLES.values()):
        cells = [f"{m['regression'][i]:+.2f} | {m['in all'][i]:.2f}" for m in measures.values()]
        table.add_row(name, *cells)
    quality = [f"{float(measures[r]['R2']):.2f} | {fits[r].q2:.3f}" for r in measures]
    table.add_row("R2 linear | Q2 quadratic", *quality)
    Console(width=120).print(table)


def main() -> None:
    """Sweep, print the sensitivities, write the figures."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--samples", type=int, default=200, help="of the hypercube, default 200")
    parser.add_argument("--seed", type=int, default=1, help="same seed, same samples; default 1")
    parser.add_argument("--workers", type=int, default=1, help="processes, default 1")
    parser.add_argument("--output", type=Path, default="results", help="folder, default results")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    ending = ".parquet" if importlib.util.find_spec("pyarrow") else ".csv"
    table = options.output / f"doe_sweep_{options.samples}_{options.seed}{ending}"

    run_sweep(table, options.samples, options.seed, options.workers)
    x, y = read_table(table.with_suffix(".csv"))
    fits = {name: Surrogate.fit(x, values) for name, values in y.items()}
    measures: dict[str, dict[str, Any]] = {
        name: sensitivities(x, y[name], fits[name], options.seed) for name in RESPONSES
    }
    print_table(measures, fits, len(x))
    save(plot_responses(x, y, fits), options.output / "doe_responses.png")
    save(plot_sensitivities(measures), options.output / "doe_sensitivities.png")


if __name__ == "__main__":
    main()
