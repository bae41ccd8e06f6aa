"""A wake that rolls up: a rotor in forward flight marched in time with a free wake.

The picture of the wake at the end, a GIF of it from the start on, and the load at twice per
revolution, which makes the tone at blade passage, beside that of the rigid wake. The rotor starts
with the wake of its steady solution.
"""

import argparse
import dataclasses
from pathlib import Path

import numpy as np

import propmdao as pm
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.figures.flow.wakes import wake_picture, write_wake_animation
from propmdao.figures.style import save
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes
from propmdao.records.fidelity import Marching, WakeMotion
from propmdao.records.states import OperatingPoint

PROPELLER = "apcmr_8x4.5"
POINT = OperatingPoint(rpm=6000.0, speed=10.0, incidence_deg=70.0)
MESH = pm.Fidelity(n_chordwise=4, n_spanwise=16)
SCHEDULE = Marching(revolutions=5, average=2, timestep_deg=10.0)
QUICK_MESH = pm.Fidelity(n_chordwise=2, n_spanwise=6, period_wake=pm.WakeGrid(2.0, 2.0, 1.5, 30.0))
FRAMES_PER_TURN = 12


def marched(
    propeller: pm.Propeller, mesh: pm.Fidelity, schedule: Marching, wake: WakeMotion
) -> MarchedLoads:
    """March the rotor, inviscid, in a wake of one kind; snapshots for the animation."""
    span = lattice_interpolation(propeller.r_over_R, mesh.n_spanwise)
    nodes = lattice_nodes(Blade.from_propeller(propeller), span, mesh.n_chordwise)
    assert POINT.rotation_speed is not None
    case = RotorCase(
        RotorGeometry(nodes, 0.5 * propeller.diameter, propeller.n_blades),
        POINT.at(POINT.rotation_speed),
        None,
        wake_transport(grid=mesh.period_wake),
    )
    frames = FRAMES_PER_TURN * schedule.revolutions if wake == "free" else 0
    return march(case, dataclasses.replace(schedule, wake_motion=wake), snapshots=frames)


def twice_per_turn(loads: MarchedLoads) -> float:
    """Amplitude of a blade's thrust at twice per revolution, over its mean."""
    spectrum = np.fft.rfft(np.asarray(loads.blade_force)[:, 2])
    return float(2.0 * np.abs(spectrum[2]) / np.abs(spectrum[0]))


def main() -> None:
    """March both wakes, print the loads, draw the free one."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("propeller", nargs="?", default=PROPELLER, help="default %(default)s")
    parser.add_argument("--quick", action="store_true", help="coarse, two revolutions")
    parser.add_argument("--output", type=Path, default="results/rolling_wake",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)
    propeller, mesh, schedule = pm.load_propeller(options.propeller), MESH, SCHEDULE
    if options.quick:
        mesh = QUICK_MESH
        schedule = dataclasses.replace(SCHEDULE, revolutions=2, average=1, timestep_deg=30.0)
    title = (
        f"{propeller.name}, {POINT.rpm:g} rpm, {POINT.speed:g} m/s at an incidence of"
        f" {POINT.incidence_deg:g}°, free wake"
    )
    for wake in ("prescribed", "free"):
        loads = marched(propeller, mesh, schedule, wake)
        change = 100.0 * float(loads.change[-1])
        print(f"{wake} wake: thrust {float(loads.thrust):.3f} N, of a blade's at twice per"
              f" revolution {100.0 * twice_per_turn(loads):.1f} %, change in the last revolution"
              f" {change:.2g} %")  # fmt: skip
    radius = 0.5 * propeller.diameter
    save(wake_picture(np.asarray(loads.wake), radius, title), output / "wake.png")
    write_wake_animation(
        output / "wake.gif", loads.snapshots, loads.snapshot_azimuth, radius, title
    )
    print(f"Picture and animation: {output}")


if __name__ == "__main__":
    main()
