"""Thrust and noise over the time step, as section 4.4 of the thesis varies it: 3 to 20 deg.

The rotor is marched for four revolutions, of which the first is left out of the mean, with the
thesis' surface of 65 x 80 points and the default lattice, which `spatial_convergence.py` has within
1.1 % of the finest.

The thesis finds loading noise that rises beyond 10 deg; here it does not. In axial flight the
forces are steady in the frame of the blade, where they are kept and read between the steps by their
Fourier series, so no step is heard: levels with 5 and 10 deg are the same to 0.001 dB, and the
overall level is that of the tone at blade passage. A column shows what vectors do that are kept in
axes that do not turn and read by straight lines, as a program does that is given a file of them:
they have corners at every step and are heard at the steps' frequency, 0.1 dB more loading noise at
10 deg and 0.4 dB at 20. Whether that is all of the thesis' rise it does not say.

That is so from the wake of the steady solution. With `--start impulsive` the thrust falls through
the mean revolution, which ends lower than it begins; the jump is heard, with 2.5 dB of loading
noise at -45 deg and 3 deg, and less with long steps, which hold fewer harmonics.
"""

import argparse
import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import discretisation
import jax.numpy as jnp
import numpy as np
from jax import Array

import propmdao as pm
from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.acoustics.sources.periodic import rotor_tones
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.records.fidelity import Marching
from propmdao.records.loads import PeriodicLoads

TIMESTEPS_DEG = (3.0, 5.0, 8.0, 10.0, 15.0, 18.0, 20.0)
SCHEDULE = Marching(revolutions=4, average=3, timestep_deg=3.0, start="steady")
SHOWN = {"time step, deg": "g", "thrust, N": ".4f", "last turn, N": ".4f"}
FINE_DEG = 0.5  # azimuths between the steps
STRAIGHT_HARMONICS = 40  # 80 per revolution: twice the steps of 10 deg and more


def marched(schedule: Marching, mesh: pm.Fidelity) -> dict[str, Any]:
    """Mean thrust, that of the last revolution, and levels of a march."""
    analysis = discretisation.analysis_with(
        pm.Model(loads=pm.LoadModel(viscous=False, unsteady=schedule), fidelity=mesh)
    )
    loads = analysis.loads
    assert isinstance(loads, MarchedLoads)
    last = loads.thrust_history[-schedule.steps_per_turn :].mean()
    levels = discretisation.levels_of(analysis.tones)
    levels |= {
        f"{discretisation.STRAIGHT} {elevation:g}, dB": level
        for elevation, level in zip(
            discretisation.ELEVATION_DEG, straight_db(analysis, loads.point_loads), strict=True
        )
    }
    return {"thrust, N": float(loads.thrust), "last turn, N": float(last), **levels}


def straight_db(analysis: pm.Analysis, loads: PeriodicLoads) -> list[float]:
    """OASPL of loading noise with forces that are straight lines between the time steps.

    The lines are those of the components in axes that do not turn, as in files of vectors.
    """
    n = len(loads.force)
    finer = round(360.0 / n / FINE_DEG)
    number, share = np.divmod(np.arange(n * finer), finer)
    share = share[:, None, None] / finer
    step = 2.0 * np.pi / n
    # In the frame of the blade, which has turned on since one step and has not reached the next.
    before = turned(loads.force[number], -step * share)
    after = turned(loads.force[(number + 1) % n], step * (1.0 - share))
    straight = PeriodicLoads(loads.position, jnp.asarray((1.0 - share) * before + share * after))
    blades = equally_spaced(analysis.propeller.n_blades)
    rotor = Rotor(blades, float(analysis.state.rotation_speed), loads=straight)
    flight = 0.0, 0.0, discretisation.SPEED
    tones = rotor_tones(
        rotor, flight, discretisation.AIR, discretisation.MICROPHONES, STRAIGHT_HARMONICS
    )
    return [float(level) for level in oaspl_db(tones.total)]


def turned(force: Array, angle: np.ndarray) -> np.ndarray:
    """Vectors turned about the shaft by an angle [rad]."""
    x, y, z = np.moveaxis(np.asarray(force), -1, 0)
    cos, sin = np.cos(angle[..., 0]), np.sin(angle[..., 0])
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)


def compare(
    timesteps_deg: Sequence[float], schedule: Marching, mesh: pm.Fidelity
) -> list[dict[str, Any]]:
    """Results for every time step."""
    return [
        {"time step, deg": step} | marched(dataclasses.replace(schedule, timestep_deg=step), mesh)
        for step in timesteps_deg
    ]


def main() -> None:
    """Compute, print the table, write it with its figures."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="the two longest steps")
    parser.add_argument("--output", type=Path, default="results/temporal_convergence",
                        help="folder, default %(default)s")  # fmt: skip
    discretisation.add_start(parser, SCHEDULE)
    options = parser.parse_args()
    schedule = dataclasses.replace(SCHEDULE, start=options.start)
    rows = compare(TIMESTEPS_DEG[-2:] if options.quick else TIMESTEPS_DEG, schedule, pm.Fidelity())
    discretisation.report(rows, "time step, deg", SHOWN, options.output.absolute())
    discretisation.print_spread(rows)


if __name__ == "__main__":
    main()
