"""Thrust and noise over the time step, as section 4.4 of the thesis varies it: 3 to 20 deg.

The rotor starts impulsively and is marched for four revolutions, of which the first is left out of
the mean, with the thesis' surface of 65 x 80 points and the default lattice, which
`spatial_convergence.py` has within a per cent of the finest.
"""

import argparse
import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import discretisation

import propmdao as pm
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.records.fidelity import Marching

TIMESTEPS_DEG = (3.0, 5.0, 8.0, 10.0, 15.0, 18.0, 20.0)
SCHEDULE = Marching(revolutions=4, average=3, timestep_deg=3.0, start="impulsive")
SHOWN = {"time step, deg": "g", "thrust, N": ".4f", "last turn, N": ".4f"}


def marched(schedule: Marching, mesh: pm.Fidelity) -> dict[str, Any]:
    """Mean thrust, that of the last revolution, and levels of a march."""
    analysis = discretisation.analysis_with(
        pm.Model(loads=pm.LoadModel(viscous=False, unsteady=schedule), fidelity=mesh)
    )
    loads = analysis.loads
    assert isinstance(loads, MarchedLoads)
    last = loads.thrust_history[-schedule.steps_per_turn :].mean()
    levels = discretisation.levels_of(analysis.tones)
    return {"thrust, N": float(loads.thrust), "last turn, N": float(last), **levels}


def compare(timesteps_deg: Sequence[float], mesh: pm.Fidelity) -> list[dict[str, Any]]:
    """Results for every time step."""
    return [
        {"time step, deg": step} | marched(dataclasses.replace(SCHEDULE, timestep_deg=step), mesh)
        for step in timesteps_deg
    ]


def main() -> None:
    """Compute, print the table, write it with its figures."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="the two longest steps")
    parser.add_argument("--output", type=Path, default="results/temporal_convergence",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    rows = compare(TIMESTEPS_DEG[-2:] if options.quick else TIMESTEPS_DEG, pm.Fidelity())
    discretisation.report(rows, "time step, deg", SHOWN, options.output.absolute())


if __name__ == "__main__":
    main()
