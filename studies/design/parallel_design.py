r"""A design search on workers: processes, Dask or MPI, whichever is there. To copy and change.

Twist and chord of the APC Slow Flyer 11x4.7 for the least torque at 8 m/s and 1.2 N, without more
noise than it makes as it is, by differential evolution. A Problem cannot be sent to a worker, so
each builds its own by ``build_problem``; what the driver sends are numbers. The search, and the
design it ends in, are the same wherever its candidates run.

    python studies/design/parallel_design.py --workers 2
    python studies/design/parallel_design.py --workers 2 --on dask
    OPENMDAO_USE_MPI=0 mpiexec -n 3 python -m mpi4py.futures \
        studies/design/parallel_design.py --on mpi

The last starts one process that searches and two that work; every model is on one process, which
is what OPENMDAO_USE_MPI=0 tells OpenMDAO. Stop a search, or have it killed, and run it again with
the same ``--checkpoint``: it goes on from there.
"""

import argparse
import contextlib
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from functools import partial
from pathlib import Path

import openmdao.api as om

import propmdao as pm
from propmdao.components import DifferentialEvolutionDriver, PropellerGroup
from propmdao.runtime.locks import InUseError
from propmdao.runtime.worker_processes import start_workers, use_one_thread

PROPELLER = pm.load_propeller("apcsf_11x4.7_uiuc")
STATIONS = [0.15, 0.4, 0.7, 1.0]  # r/R of the control points
COARSE = pm.Fidelity(n_chordwise=4, n_spanwise=12, n_contour=21, n_surface_span=20, n_harmonics=4)


def build_problem(fidelity: pm.Fidelity, noise_limit: float = 200.0) -> om.Problem:
    """Blade to torque and noise. Without recorders: every worker would write them."""
    prob = om.Problem(reports=False)
    prob.model.add_subsystem(
        "propeller",
        PropellerGroup(
            propeller=PROPELLER,
            observers=pm.arc(1.905, -45.0),
            fidelity=fidelity,
            rpm_bounds=(3000.0, 7000.0),
            design_distributions={"beta": STATIONS, "chord_over_R": STATIONS},
            control="values",
        ),
        promotes=["*"],
    )
    prob.model.set_input_defaults("speed", 8.0, units="m/s")
    prob.model.set_input_defaults("thrust_required", 1.2, units="N")
    prob.model.add_design_var("beta_cp", lower=5.0, upper=30.0, units="deg")
    prob.model.add_design_var("chord_over_R_cp", lower=0.03, upper=0.40)
    prob.model.add_constraint("oaspl_db", upper=noise_limit)
    prob.model.add_objective("torque", ref=0.01)
    prob.setup()
    return prob


@contextlib.contextmanager
def executor(kind: str, n_workers: int) -> Iterator[Executor]:
    """Workers that compute on one thread each, so that they do not wait for one another."""
    if kind == "processes":
        # The same as the driver's option n_workers, here to be one of three.
        with start_workers(n_workers) as workers:
            yield workers
    elif kind == "dask":
        from distributed import Client, LocalCluster

        # A cluster of other machines: Client("tcp://its-scheduler:8786") instead of both.
        with (
            LocalCluster(n_workers=n_workers, threads_per_worker=1) as cluster,
            Client(cluster) as client,
        ):
            client.run(use_one_thread)
            yield client.get_executor()
    else:
        from mpi4py.futures import MPIPoolExecutor

        with MPIPoolExecutor(initializer=use_one_thread) as workers:
            yield workers


def main() -> None:
    """Search and print the design."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--on", choices=("processes", "dask", "mpi"), default="processes")
    parser.add_argument("--workers", type=int, default=2, help="processes; MPI's own: mpiexec -n")
    parser.add_argument("--generations", type=int, default=10, help="default 10")
    parser.add_argument("--population", type=int, default=24, help="designs in each, default 24")
    parser.add_argument("--fine", action="store_true", help="all panels and harmonics")
    parser.add_argument("--checkpoint", type=Path, help="file to go on from")
    options = parser.parse_args()

    fidelity = pm.Fidelity() if options.fine else COARSE
    baseline = build_problem(fidelity)
    baseline.run_model()
    factory = partial(build_problem, fidelity, float(baseline.get_val("oaspl_db")[0]))
    prob = factory()
    with executor(options.on, options.workers) as workers:
        prob.driver = DifferentialEvolutionDriver(
            executor=workers,
            problem_factory=factory,
            max_gen=options.generations,
            pop_size=options.population,
            seed=1,
            checkpoint=options.checkpoint and options.checkpoint.absolute(),
            best_file=None,
        )
        started = time.perf_counter()
        try:
            prob.run_driver()
        except InUseError as error:
            parser.exit(2, f"{parser.prog}: error: {error}\n")
        seconds = time.perf_counter() - started
    runs = prob.driver.history[-1].evaluations
    torque, before = (p.get_val("torque", units="N*m")[0] for p in (prob, baseline))
    print(f"{runs} designs in {seconds:.1f} s on {options.on}")
    print(f"torque {before:.6f} -> {torque:.6f} N m, beta {prob.get_val('beta_cp', units='deg')}")


if __name__ == "__main__":
    main()
