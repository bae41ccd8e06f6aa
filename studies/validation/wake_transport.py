"""The prescribed wake beside one that moves as it itself and the blades induce.

The sheets that the blades leave are let drift: their inner part as one, their outer part, which
becomes the tip vortex, as another, each with the mean of the velocity that all sheets and blades
induce on it, and they contract with the mean radial velocity of the outer part. Sheets, circulation
and the induced velocity of momentum theory are solved together by relaxation. That wake knows no
law; beside it stand the thrust and the power of the prescribed wake of
`aerodynamics.wakes.helical`, which is a curve through what comes out here, and of which it is the
evidence. Inviscid flow; two, three and four blades.
"""

import argparse
import dataclasses
from functools import partial
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from aerodynamic_validation import show, write_csv

import propmdao as pm
from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.lattice.rings import BOUND_CORE, blade_influence
from propmdao.aerodynamics.lattice.steady_wake import WakeInfluence, wake_influence
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.lattice_loads import (
    axial_onset,
    blade_influence_of,
    lattice_geometry,
    loads_with_wake,
)
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes import helical, momentum
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S

CASES = [(name, 2, J) for name in ("apcsf_11x4.7", "apce_10x7") for J in (0.0, 0.2, 0.4)]
CASES += [("apcsf_11x4.7", n_blades, J) for n_blades in (3, 4) for J in (0.0, 0.2)]
RPM, AIR = 4200.0, pm.Air()
TRANSPORT = wake_transport()
AGES = np.asarray(TRANSPORT.ages)
CORE = 0.03  # of the sheets where they act on themselves, in radii: 0.01 to 0.06 change CT by 0.1 %
RELAXATION, STEPS = 0.3, 24
LAST_TURN = 3.5  # beyond it the end of the wake is felt: the velocity of the turn before is kept
PASSAGES = (0.0, 0.85), (1.2, 4.0)  # of the next blade: before, and after
FORMATS = {"propeller": "", "blades": "d", "J": ".1f", "CT": ".4f", "P/ideal": ".3f",
           "r/r0": ".2f", "before": ".2f", "after": ".2f", "inner": ".2f", "CT, %": "+.1f",
           "CP, %": "+.1f"}  # fmt: skip

_loads = jax.jit(loads_with_wake)
_by_wake = jax.jit(wake_influence)


def case_of(propeller: pm.Propeller, speed: float) -> RotorCase:
    """A propeller in flight as the solvers take it, in inviscid flow."""
    span = lattice_interpolation(propeller.r_over_R, 24)
    nodes = lattice_nodes(Blade.from_propeller(propeller), span, 8)
    rotor = RotorGeometry(nodes, 0.5 * propeller.diameter, propeller.n_blades)
    return RotorCase(rotor, RotorState(RPM * RAD_PER_S, speed, AIR), wake=TRANSPORT)


def relaxed(propeller: pm.Propeller, speed: float, steps: int = STEPS) -> dict[str, float]:
    """Thrust and power of the wake that moves as it says, and how it moves, in w."""
    case = case_of(propeller, speed)
    rotor, state = case.rotor, case.state
    n_blades, radius, omega = rotor.n_blades, rotor.radius, state.rotation_speed
    lattice = lattice_geometry(rotor)
    blades = blade_influence_of(lattice, rotor)
    by_all_blades = jax.jit(partial(blade_influence, azimuths=rotor.azimuths))
    core, thick = (
        core_radius(middles(jnp.asarray(AGES)), state, initial * radius)
        for initial in (BOUND_CORE, CORE)
    )
    trailing, ages, time = lattice.rings.corner[-1], jnp.asarray(AGES), AGES / omega
    r0 = np.hypot(*np.asarray(trailing[:, :2]).T)
    outward = np.asarray(helical.outer_part(r0 / radius, TRANSPORT.law))
    inside = (1.0 - outward) * (r0 > 0.35 * radius) * np.gradient(r0) * r0  # area, without the hub

    induced = float(axial.solve(case).induced_velocity)
    rigid = (speed + induced) * time
    drift = np.stack([rigid, rigid, np.ones_like(time)])  # of outer, inner part, and contraction
    for _ in range(steps):
        downstream = outward[:, None] * drift[0] + (1.0 - outward)[:, None] * drift[1]
        sheets = helical.helices(trailing, ages, n_blades, downstream, drift[2])
        onset = axial_onset(lattice, state, induced)
        by_wake = WakeInfluence(_by_wake(lattice.points, sheets, core))
        loads = _loads(lattice, blades, by_wake, onset, AIR, None)
        thrust, torque = n_blades * float(loads.thrust), n_blades * float(loads.torque)
        induced = float(momentum.momentum_induced_velocity(thrust, state, radius))
        middle = np.asarray(0.5 * (sheets[:, 0, 1:] + sheets[:, 0, :-1]))
        points, circulation = middle.reshape(-1, 3), loads.circulation
        velocity = jnp.tensordot(circulation[-1], _by_wake(points, sheets, thick), axes=(0, 1))
        by_blades = by_all_blades(points, lattice.rings, core=BOUND_CORE * radius)
        velocity += jnp.tensordot(circulation, by_blades, axes=((0, 1), (1, 2)))
        x, y, z = np.asarray(velocity).reshape(3, *middle.shape[:2])
        radial = (x * middle[..., 0] + y * middle[..., 1]) / np.hypot(*middle[..., :2].T).T

        shed = np.abs(np.diff(np.pad(np.asarray(circulation[-1]), 1)))
        tip = shed * (np.arange(shed.size) > np.argmax(circulation[-1]))
        outer, inner = (
            _settled(np.average(-z, axis=0, weights=w)) for w in (shed * outward, inside)
        )
        inward = np.average(radial, axis=0, weights=tip) * (AGES[1:] < 4.0 * np.pi)
        change = [speed + outer, speed + inner, inward / np.average(r0, weights=tip)]
        towards = np.cumsum(np.pad(change * np.diff(time), ((0, 0), (1, 0))), axis=1)
        towards[2] += 1.0
        drift += RELAXATION * (towards - drift)
    numbers = coefficients(thrust, torque, state, propeller.diameter)
    passed = 0.5 * (AGES[1:] + AGES[:-1]) * n_blades / (2.0 * np.pi)
    bands = [(passed > low) & (passed <= high) for low, high in PASSAGES]
    return {
        "CT": float(numbers.CT),
        "CP": float(numbers.CP),
        "P/ideal": float(torque * omega / (thrust * (speed + induced))),
        "r/r0": float(drift[2, -1]),
        "before": float(outer[bands[0]].mean() / induced),
        "after": float(outer[bands[1]].mean() / induced),
        "inner": float(inner.mean() / induced),
    }


def _settled(velocity: np.ndarray) -> np.ndarray:
    """Velocity of the turn before the last ones in their stead."""
    age = AGES[1:] / (2.0 * np.pi)
    before = (age > LAST_TURN - 1.0) & (age <= LAST_TURN)
    return np.where(age > LAST_TURN, velocity[before].mean(), velocity)


def prescribed(propeller: pm.Propeller, speed: float) -> dict[str, float]:
    """Thrust and power of the prescribed wake."""
    case = case_of(propeller, speed)
    loads = axial.solve(case)
    numbers = coefficients(loads.thrust, loads.torque, case.state, propeller.diameter)
    return {"CT": float(numbers.CT), "CP": float(numbers.CP)}


def compare(cases: list[tuple[str, int, float]], steps: int = STEPS) -> list[dict[str, object]]:
    """A row of figures for every case."""
    rows = []
    for name, n_blades, J in cases:
        propeller = dataclasses.replace(pm.load_propeller(name), n_blades=n_blades)
        speed = J * RPM / 60.0 * propeller.diameter
        free, ours = relaxed(propeller, speed, steps), prescribed(propeller, speed)
        differences = {
            f"{key}, %": 100.0 * (value / free[key] - 1.0) for key, value in ours.items()
        }
        rows.append({"propeller": name, "blades": n_blades, "J": J} | free | differences)
    return rows


def main() -> None:
    """Relax, compare, print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="two cases")
    parser.add_argument("--output", type=Path, default="results/wake_transport",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)
    rows = compare(CASES[:2] if options.quick else CASES)
    write_csv(output / "wake_transport.csv", rows)
    show(rows, FORMATS)
    print(
        "CT, P/ideal, r/r0: of the relaxed wake, inviscid; r/r0 of the tip vortex far downstream."
    )
    print("Before, after, inner: drift relative to the free stream in induced velocities w, of the")
    print("outer part before and after the next blade has passed, and of the inner part.")
    print(f"CT, CP in %: difference of the prescribed wake. As CSV: {output}")


if __name__ == "__main__":
    main()
