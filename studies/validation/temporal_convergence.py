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

from propmdao.acoustics.sources.periodic import rotor_tones
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.geometry.blade import Blade
from propmdao.geometry.meshes import blade_meshes, mesh_radii
from propmdao.records.fidelity import Fidelity, Marching
from propmdao.records.states import OperatingPoint

TIMESTEPS_DEG = (3.0, 5.0, 8.0, 10.0, 15.0, 18.0, 20.0)
SCHEDULE = Marching(revolutions=4, average=3, timestep_deg=3.0, start="impulsive")
SHOWN = {"time step, deg": "g", "thrust, N": ".4f", "last turn, N": ".4f"}


def marched(schedule: Marching, mesh: Fidelity) -> dict[str, Any]:
    """Mean thrust, that of the last revolution, and levels of a march."""
    propeller, air = discretisation.PROPELLER, discretisation.AIR
    radii = mesh_radii(propeller.r_over_R, mesh.n_spanwise, mesh.n_surface_span)
    meshes = blade_meshes(Blade.from_propeller(propeller), radii, mesh.n_chordwise, mesh.n_contour)
    point = OperatingPoint(rpm=discretisation.RPM, speed=discretisation.SPEED, air=air)
    assert point.rotation_speed is not None
    state = point.at(point.rotation_speed)
    geometry = RotorGeometry(meshes.lattice, 0.5 * propeller.diameter, propeller.n_blades)
    case = RotorCase(geometry, state, None, wake_transport(grid=mesh.period_wake))
    loads = march(case, schedule)
    rotor = Rotor(
        equally_spaced(propeller.n_blades), point.rotation_speed, meshes.panels, loads.point_loads
    )
    flight = 0.0, 0.0, discretisation.SPEED
    tones = rotor_tones(rotor, flight, air, discretisation.MICROPHONES, mesh.n_harmonics)
    last = loads.thrust_history[-schedule.steps_per_turn :].mean()
    levels = discretisation.levels_of(tones)
    return {"thrust, N": float(loads.thrust), "last turn, N": float(last), **levels}


def compare(timesteps_deg: Sequence[float], mesh: Fidelity) -> list[dict[str, Any]]:
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
    rows = compare(TIMESTEPS_DEG[-2:] if options.quick else TIMESTEPS_DEG, Fidelity())
    discretisation.report(rows, "time step, deg", SHOWN, options.output.absolute())


if __name__ == "__main__":
    main()
