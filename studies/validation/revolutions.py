"""Thrust and noise over the number of revolutions, as section 4.5 of the thesis varies it: 3 to 10.

The march of `temporal_convergence.py` with a step of 3 deg; the first revolution is left out of the
mean. It starts impulsively: from the steady wake every revolution has the same thrust.

The thesis finds differences of the order of 1e-4. Here the start lasts longer: the mean of
revolutions 2 to 4 has 1.3 % too much thrust and that of 2 to 10 0.4 %; the sixth one alone is
the steady solution. What is left of the start is heard as well: at -45 deg the overall level of 3,
4, 6 and 10 revolutions is 2.7, 1.5, 0.6 and 0.15 dB above the steady one.
"""

import argparse
import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import discretisation
from temporal_convergence import marched

import propmdao as pm
from propmdao.records.fidelity import Marching

REVOLUTIONS = range(3, 11)
SCHEDULE = Marching(timestep_deg=3.0, start="impulsive")
SHOWN = {"revolutions": "d", "thrust, N": ".4f", "last turn, N": ".4f"}


def compare(
    revolutions: Sequence[int], schedule: Marching, mesh: pm.Fidelity
) -> list[dict[str, Any]]:
    """Results for every number of revolutions."""
    schedules = (dataclasses.replace(schedule, revolutions=n, average=n - 1) for n in revolutions)
    return [{"revolutions": run.revolutions} | marched(run, mesh) for run in schedules]


def main() -> None:
    """Compute, print the table, write it with its figures."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="3 and 4 of them, in steps of 20 deg")
    parser.add_argument("--output", type=Path, default="results/revolutions",
                        help="folder, default %(default)s")  # fmt: skip
    discretisation.add_start(parser, SCHEDULE)
    options = parser.parse_args()
    schedule = dataclasses.replace(SCHEDULE, start=options.start)
    if options.quick:
        schedule = dataclasses.replace(schedule, timestep_deg=20.0)
    rows = compare(REVOLUTIONS[:2] if options.quick else REVOLUTIONS, schedule, pm.Fidelity())
    discretisation.report(rows, "revolutions", SHOWN, options.output.absolute())
    discretisation.print_spread(rows)


if __name__ == "__main__":
    main()
