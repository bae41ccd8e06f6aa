"""What a thousand cores would give: dispatch of a search's designs measured, a cluster simulated.

A driver sends each design of a generation to an executor and reads the results in turn, so a part
of the work stays on one core: pickling what the outputs vector holds there and back, the executor's
own, and putting a result into the driver's model. That part is measured here, on processes and on
Dask where it is installed, as time of the processor of the process that sends; beside it what it
would be if design variables and responses alone travelled, and the time of a design. Then
generations are simulated on more and more cores: designs are sent one after the other, begin on the
first core that is free, take times drawn from those measured, and come back through the same
sender. Network and file system are not in it. To copy and change.

    python studies/design/cluster_efficiency.py --figure efficiency.png
"""

import argparse
import contextlib
import dataclasses
import heapq
import pickle
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from pathlib import Path

import numpy as np
import numpy.typing as npt
import openmdao.api as om
from parallel_design import COARSE, build_problem, executor

import propmdao as pm
from propmdao.analysis.comparisons import Rows, markdown
from propmdao.components.drivers.evaluation.model_run import ModelRun, put_outputs
from propmdao.runtime.worker_processes import results_in_order, use_one_thread

FloatArray = npt.NDArray[np.float64]

CORES = (1, 10, 30, 100, 300, 1000)
POPULATIONS = (100, 1000, 5000)
GENERATIONS = 3  # simulated, of which the mean counts
CALLS = 200  # that a dispatch is measured over
NO_MORE = 32  # numbers of a design whose variables and responses alone travel


@dataclasses.dataclass(frozen=True)
class Dispatch:
    """Cost of sending a design to an executor and taking its result.

    Attributes
    ----------
    name : str
        Name of the executor, and what travels where that is not the whole model.
    n_bytes : int
        Bytes of a design and of its result, pickled.
    seconds : float
        Time of the processor of the process that sends, for each design [s].
    """

    name: str
    n_bytes: int
    seconds: float


def echo(start: FloatArray) -> ModelRun:
    """Run of a model that takes no time."""
    return ModelRun(start)


def dispatch(kind: str, prob: om.Problem, n_calls: int = CALLS) -> list[Dispatch]:
    """Measure what it takes to send designs that take no time.

    Parameters
    ----------
    kind : str
        Executor, by its name in `parallel_design.executor`.
    prob : om.Problem
        Problem of the design, which has run.
    n_calls : int
        Number of designs.

    Returns
    -------
    list of Dispatch
        The cost as it is, and that if variables and responses alone travelled. Of Dask its
        scheduler is in it, which is a process of its own on a cluster.
    """
    whole = prob.model.get_nonlinear_vectors()[1].asarray(copy=True)
    costs = []
    with executor(kind, 1) as workers:
        for name, start in ((kind, whole), (f"{kind}, few numbers", whole[:NO_MORE])):
            n_bytes = len(pickle.dumps(start)) + len(pickle.dumps(echo(start)))
            _sent(workers, prob, start, 5)
            seconds = min(_sent(workers, prob, start, n_calls // 4) for _ in range(4))
            costs.append(Dispatch(name, n_bytes, seconds))
    return costs


def _sent(workers: Executor, prob: om.Problem, start: FloatArray, n_calls: int) -> float:
    """Time of the processor for each design."""
    n_outputs = prob.model.get_nonlinear_vectors()[1].asarray().size
    began = time.process_time()
    for run in results_in_order(workers, echo, [start] * n_calls):
        if run.outputs.size == n_outputs:
            put_outputs(prob.model, run.outputs)
    return (time.process_time() - began) / n_calls


def design_times(prob: om.Problem, n_designs: int = 24) -> FloatArray:
    """Measure how long designs take, on one core.

    Parameters
    ----------
    prob : om.Problem
        Problem of the design, which has run.
    n_designs : int
        Number of designs, drawn within the bounds of the search.

    Returns
    -------
    (n_designs,) array
        Times of the processor [s]; a design without a solution counts with the time it took.
    """
    use_one_thread()
    random = np.random.default_rng(1)
    variables = prob.model.get_design_vars()
    designs = [
        {name: random.uniform(v["lower"], v["upper"], v["size"]) for name, v in variables.items()}
        for _ in range(n_designs)
    ]
    times = np.full((2, n_designs), np.inf)
    for row in times:  # the first compiles what is not compiled yet
        for k, design in enumerate(designs):
            for name, values in design.items():
                prob.set_val(name, values, units=variables[name]["units"])
            began = time.process_time()
            with contextlib.suppress(om.AnalysisError):
                prob.run_model()
            row[k] = time.process_time() - began
    return times[1]


def generation(times: FloatArray, n_cores: int, dispatched: float) -> float:
    """Simulate a generation.

    Parameters
    ----------
    times : (n_designs,) array
        Times of the designs [s].
    n_cores : int
        Number of cores that work, beside the one that sends.
    dispatched : float
        Time of the sender for each design, half to send and half to take the result [s].

    Returns
    -------
    float
        Time of the generation [s].
    """
    free = [0.0] * min(n_cores, times.size)
    ends = []
    for k, duration in enumerate(times):
        begin = max(heapq.heappop(free), 0.5 * dispatched * (k + 1))
        ends.append(begin + duration)
        heapq.heappush(free, ends[-1])
    clock = 0.5 * dispatched * times.size
    for end in ends:
        clock = max(clock, end) + 0.5 * dispatched
    return clock


def efficiency(measured: FloatArray, population: int, n_cores: int, dispatched: float) -> float:
    """Work of a generation over the time of the cores that it has been given.

    Parameters
    ----------
    measured : array
        Times of designs, from which those of the generation are drawn [s].
    population, n_cores : int
        Designs of a generation and cores that work.
    dispatched : float
        Time of the sender for each design [s].

    Returns
    -------
    float
        Efficiency, the mean of some generations.
    """
    random = np.random.default_rng(1)
    shares = []
    for _ in range(GENERATIONS):
        times = random.choice(measured, population)
        shares.append(times.sum() / (n_cores * generation(times, n_cores, dispatched)))
    return float(np.mean(shares))


def table(measured: FloatArray, costs: list[Dispatch]) -> Rows:
    """Efficiency over cores, a row for each way of sending and population.

    Parameters
    ----------
    measured : array
        Times of designs [s].
    costs : list of Dispatch
        What dispatch costs.

    Returns
    -------
    list of tuples
        Rows for `propmdao.analysis.comparisons.markdown`.
    """
    heads = (f"{cores:,} core{'s' * (cores > 1)}" for cores in CORES)
    rows: Rows = [("sent to", "generation", *heads)]
    for cost in costs:
        for population in POPULATIONS:
            shares = (efficiency(measured, population, cores, cost.seconds) for cores in CORES)
            percent = (f"{100.0 * share:.0f} %" for share in shares)
            rows.append((cost.name, f"{population:,}", *percent))
    return rows


def draw(path: Path, measured: FloatArray, costs: list[Dispatch]) -> None:
    """Draw speed over cores, beside what no dispatch would give.

    Parameters
    ----------
    path : Path
        File to write.
    measured : array
        Times of designs [s].
    costs : list of Dispatch
        What dispatch costs.
    """
    from propmdao.figures.style import GRID, page, run_line, save

    figure = page(5.0)
    axes = figure.subplots(1, 2, sharey=True)
    cores = np.unique(np.geomspace(1, 1000, 25).astype(int))
    for panel, population in zip(axes, POPULATIONS[1:], strict=True):
        panel.loglog(cores, cores, color="0.6", linestyle=":", label="as many as cores")
        none = Dispatch("no dispatch", 0, 0.0)
        for number, cost in enumerate([none, *costs]):
            speed = [efficiency(measured, population, n, cost.seconds) * n for n in cores]
            label = cost.name if cost is none else f"{cost.name}, {1e3 * cost.seconds:.2g} ms"
            panel.loglog(cores, speed, **run_line(number), label=label)
        panel.set_title(f"{population:,} designs in a generation", fontsize="medium", loc="left")
        panel.set_xlabel("cores that work, beside the one that sends")
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_formatter("{x:,.0f}")
        panel.grid(**GRID)
    axes[0].set_ylabel("speed over one core")
    axes[0].legend(frameon=False)
    save(figure, path)


def executors() -> Iterator[str]:
    """Executors that are installed, but MPI, which wants a launcher."""
    yield "processes"
    with contextlib.suppress(ModuleNotFoundError):
        import distributed  # noqa: F401

        yield "dask"


def main() -> None:
    """Measure, simulate and print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--figure", type=Path, help="file of a figure to write")
    parser.add_argument("--coarse", action="store_true", help="few panels and harmonics")
    options = parser.parse_args()
    prob = build_problem(COARSE if options.coarse else pm.Fidelity())
    prob.run_model()
    costs = [cost for kind in executors() for cost in dispatch(kind, prob)]
    measured = design_times(prob)
    print(f"a design takes {1e3 * np.median(measured):.0f} ms of a core, "
          f"{1e3 * measured.min():.0f} to {1e3 * measured.max():.0f}")  # fmt: skip
    for cost in costs:
        most = np.median(measured) / cost.seconds
        print(f"{cost.name}: {cost.n_bytes / 1e6:.2f} MB and {1e3 * cost.seconds:.2f} ms of the "
              f"sender for a design, so at most {most:.0f} times one core")  # fmt: skip
    print(markdown(table(measured, costs)))
    if options.figure is not None:
        draw(options.figure, measured, costs)


if __name__ == "__main__":
    main()
