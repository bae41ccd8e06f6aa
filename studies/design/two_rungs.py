r"""Thousands of blades by blade elements, the best one finished by the lattice. To copy and change.

Chord and twist of the APC Slow Flyer 11x4.7 for the least tones at one microphone, at the thrust
and the flight speed of the thesis, without more torque than it takes as it is. On the lower rung
differential evolution sorts 20,000 blades, each with its rotation speed, loads and tones, in
compiled batches of a few hundred. The best of them is the start of SLSQP on the upper rung, the
lattice with all panels and harmonics and with exact derivatives.

Blade elements do not feel how the air curves over a wide chord (docs/theory/blade_elements.md):
the two rungs differ blade by blade. How far, and whether the lower one puts blades in the order in
which the upper one does, is what the table and the figure show, for blades of the whole range and
for those that evolution came to.

    python studies/design/two_rungs.py --output rungs
"""

import argparse
import contextlib
import dataclasses
import io
import time
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from openmdao.components.interp_util.interp import InterpND
from scipy.optimize import NonlinearConstraint, differential_evolution
from scipy.stats import qmc, spearmanr

import propmdao as pm
from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import blade_element
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.trim import rotation_bounds, solve_for_thrust
from propmdao.components import design_problem, designed_blade, run_slsqp
from propmdao.figures.designs.agreement import agreement
from propmdao.figures.style import save
from propmdao.geometry.blade import Blade
from propmdao.geometry.meshes import blade_meshes, mesh_radii
from propmdao.records.units import RAD_PER_S

PROPELLER = pm.load_propeller("apcsf_11x4.7")
THRUST = 1.2  # N
POINT = pm.OperatingPoint(thrust=THRUST, speed=8.0)
MICROPHONE = pm.arc(1.905, -45.0)
RANGES = {"chord": (0.7, 1.5), "twist": (-8.0, 8.0)}  # times the chord; deg
N_CONTROL = 5
FIDELITY = pm.Fidelity()  # of the lattice, and of both rungs where they are compared
# Of the lower rung: a coarse surface has the thickness noise to a tenth of a decibel, and tones
# beyond the third are far below the first.
SORTING = pm.Fidelity(n_chordwise=4, n_spanwise=16, n_contour=21, n_surface_span=20, n_harmonics=3)
AT_ONCE = 100  # blades in a compiled call
LEAST_CHORD = 0.35  # times the described one, between control points: that of `design_problem`
FAILED = 10.0  # torque over the limit of a blade that has no solution


class Rung(NamedTuple):
    """What a model says of blades at the thrust: (n,) arrays."""

    rpm: np.ndarray
    torque: np.ndarray
    level_db: np.ndarray


def bounds() -> np.ndarray:
    """Bounds of the control points (2 N_CONTROL, 2): of chord factors, then of twist in deg."""
    return np.repeat([RANGES["chord"], RANGES["twist"]], N_CONTROL, axis=0).astype(float)


def curves() -> np.ndarray:
    """Matrix from control points to the propeller's stations, (n_stations, N_CONTROL)."""
    r = PROPELLER.r_over_R
    spline = InterpND(method="cubic", points=np.linspace(r[0], 1.0, N_CONTROL), x_interp=r)
    return np.stack([spline.evaluate_spline(unit).ravel() for unit in np.eye(N_CONTROL)], axis=1)


def propeller_of(design: np.ndarray, name: str) -> pm.Propeller:
    """The described propeller with chord and twist of a design."""
    factor, twist = curves() @ design[:N_CONTROL], curves() @ design[N_CONTROL:]
    return dataclasses.replace(
        PROPELLER, name=name, c_over_R=factor * PROPELLER.c_over_R,
        beta_deg=PROPELLER.beta_deg + twist,
    )  # fmt: skip


class Sorting:
    """The lower rung: many designs in compiled calls of `AT_ONCE`."""

    def __init__(self) -> None:
        blade = Blade.from_propeller(PROPELLER)
        radii = mesh_radii(PROPELLER.r_over_R, SORTING.n_spanwise, SORTING.n_surface_span)
        # Sections keep their shape, so that the polars are those of the described blade.
        sections = viscous_sections(polars_for(PROPELLER), blade, radii.strips)
        spans = rotation_bounds(blade.radius, POINT.speed)
        self._evaluate = jax.jit(partial(_evaluated, (blade, radii, sections, spans, curves())))
        self._known: dict[bytes, tuple[float, ...]] = {}

    def __call__(self, designs: np.ndarray) -> Rung:
        """Evaluate designs (n, 2 N_CONTROL); nan stands where there is no solution."""
        designs = np.ascontiguousarray(designs)
        missing = {x.tobytes(): x for x in designs if x.tobytes() not in self._known}
        keys, new = list(missing), np.array(list(missing.values()))
        for first in range(0, len(new), AT_ONCE):
            batch = new[first : first + AT_ONCE]
            filled = np.concatenate([batch, np.repeat(batch[-1:], AT_ONCE - len(batch), axis=0)])
            values = np.stack(jax.device_get(self._evaluate(filled)), axis=1)
            rows = map(tuple, values[: len(batch)].tolist())
            self._known.update(zip(keys[first : first + AT_ONCE], rows, strict=True))
        return Rung(*np.array([self._known[x.tobytes()] for x in designs]).reshape(-1, 3).T)

    @property
    def n_blades(self) -> int:
        """Number of blades that have been evaluated."""
        return len(self._known)


def _evaluated(described: Any, designs: jax.Array) -> tuple[jax.Array, ...]:
    blade, radii, sections, spans, curve = described

    def evaluate(design: jax.Array) -> tuple[jax.Array, ...]:
        changed = dataclasses.replace(
            blade,
            chord_over_R=blade.chord_over_R * (curve @ design[:N_CONTROL]),
            beta=blade.beta + jnp.radians(curve @ design[N_CONTROL:]),
        )
        meshes = blade_meshes(changed, radii, SORTING.n_chordwise, SORTING.n_contour)
        rotor = RotorGeometry(meshes.lattice, blade.radius, int(PROPELLER.n_blades))
        case = RotorCase(rotor, POINT.at(0.0), sections)
        trimmed = solve_for_thrust(blade_element, case, THRUST, spans)
        state = POINT.at(trimmed.rotation_speed)
        loads: Any = trimmed.loads
        n_blades = int(PROPELLER.n_blades)
        sound = tones(
            meshes.panels, loads.point_loads, n_blades, state, MICROPHONE, SORTING.n_harmonics
        )
        good = trimmed.reached & loads.converged
        rpm = trimmed.rotation_speed / RAD_PER_S
        numbers = rpm, loads.torque, oaspl_db(sound.total)[0]
        return tuple(jnp.where(good, number, jnp.nan) for number in numbers)

    return jax.vmap(evaluate)(designs)


class Evolution(NamedTuple):
    """A search on the lower rung: the best design, blades on the way, and what it took."""

    best: np.ndarray
    first: np.ndarray  # designs of the first generation
    last: np.ndarray  # those of the last one
    n_blades: int
    seconds: float


def evolve(sorting: Sorting, population: int, generations: int, seed: int = 1) -> Evolution:
    """Search by differential evolution; the described blade is one of the first generation."""
    limits = bounds()
    described = np.repeat([1.0, 0.0], N_CONTROL)
    sample = qmc.LatinHypercube(len(limits), rng=seed).random(population)
    first = qmc.scale(sample, *limits.T)
    first[0] = described
    torque_limit = float(sorting(described[None]).torque[0])  # which compiles
    last, curve = [first], curves()

    def missed(designs: np.ndarray) -> np.ndarray:
        columns = designs.reshape(len(limits), -1)
        torque = np.nan_to_num(sorting(columns.T).torque / torque_limit, nan=FAILED)
        return np.stack([torque, (curve @ columns[:N_CONTROL]).min(axis=0)])

    def level(designs: np.ndarray) -> np.ndarray:
        return sorting(designs.reshape(len(limits), -1).T).level_db

    started = time.perf_counter()
    result = differential_evolution(
        level, limits, maxiter=generations, init=first, rng=seed, tol=0.0, atol=0.0, polish=False,
        constraints=NonlinearConstraint(missed, [-np.inf, LEAST_CHORD], [1.0, np.inf]),
        vectorized=True, updating="deferred",
        callback=lambda intermediate_result: last.append(intermediate_result.population),
    )  # fmt: skip
    seconds = time.perf_counter() - started
    return Evolution(result.x, first, last[-1], sorting.n_blades, seconds)


def finish(design: np.ndarray, folder: Path, iterations: int) -> tuple[pm.Propeller, int]:
    """Go on from a design by SLSQP on the lattice; the blade, and how many analyses it took."""
    prob = design_problem(
        PROPELLER, POINT, MICROPHONE, free=RANGES, minimise="tones",
        limits={"torque": "baseline"}, n_control=N_CONTROL, fidelity=FIDELITY,
    )  # fmt: skip
    prob.set_val("chord_over_R_cp", design[:N_CONTROL])
    prob.set_val("beta_cp", design[N_CONTROL:], units="deg")
    with contextlib.redirect_stdout(io.StringIO()):  # OpenMDAO prints that SLSQP was stopped
        search = run_slsqp(prob, folder / "slsqp.sql", iterations=iterations)
    return designed_blade(prob, "finished"), search.history.objective.size


def by_both(blades: list[pm.Propeller]) -> tuple[Rung, Rung]:
    """What blade elements and the lattice say of blades, on the same meshes."""
    rungs = []
    for chosen in (True, False):
        rows = []
        for blade in blades:
            analysis = pm.analyze(
                blade, POINT, observers=MICROPHONE, fidelity=FIDELITY, blade_element=chosen
            )
            level = float(oaspl_db(analysis.tones.total)[0])
            rows.append((analysis.rpm, float(analysis.loads.torque), level))
        rungs.append(Rung(*np.array(rows).T))
    return rungs[0], rungs[1]


def differences(name: str, elements: Rung, lattice: Rung) -> list[str]:
    """Rows of the table: how far the rungs differ over a group of blades."""
    rows = []
    for quantity, difference, unit in (
        ("rpm", 100.0 * (elements.rpm / lattice.rpm - 1.0), "%"),
        ("torque", 100.0 * (elements.torque / lattice.torque - 1.0), "%"),
        ("tones", elements.level_db - lattice.level_db, "dB"),
    ):
        field = "level_db" if quantity == "tones" else quantity
        order = spearmanr(getattr(elements, field), getattr(lattice, field)).statistic
        rows.append(
            f"{name:<18} {quantity:<7} {difference.mean():+8.2f} {difference.std():8.2f}"
            f" {difference.min():+8.2f} {difference.max():+8.2f} {unit:<3} {order:8.3f}"
        )
    return rows


def main() -> None:
    """Search, finish, compare; print the tables and write the figure."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--population", type=int, default=200, help="blades of a generation")
    parser.add_argument("--generations", type=int, default=99, help="default 99: 20,000 blades")
    parser.add_argument("--iterations", type=int, default=60, help="most of SLSQP, default 60")
    parser.add_argument("--compared", type=int, default=40, help="blades of each group, default 40")
    parser.add_argument("--output", type=Path, default=Path("two_rungs"), help="folder")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)

    evolution = evolve(Sorting(), options.population, options.generations)
    print(
        f"{evolution.n_blades} blades by blade elements in {evolution.seconds:.1f} s,"
        f" {1e3 * evolution.seconds / evolution.n_blades:.2f} ms each"
    )
    finished, analyses = finish(evolution.best, options.output, options.iterations)
    print(f"{analyses} analyses of the lattice to finish the best of them")

    named = {
        "as it is": PROPELLER,
        "best of elements": propeller_of(evolution.best, "best"),
        "finished": finished,
    }
    elements, lattice = by_both(list(named.values()))
    print(f"\n{'':<18} {'elements':>26}  {'lattice':>26}")
    print(f"{'blade':<18}" + 2 * f" {'rpm':>7} {'torque mN m':>11} {'dB':>6} ")
    for place, name in enumerate(named):
        cells = [
            f" {rung.rpm[place]:7.0f} {1e3 * rung.torque[place]:11.3f} {rung.level_db[place]:6.2f} "
            for rung in (elements, lattice)
        ]
        print(f"{name:<18}" + "".join(cells))

    rng = np.random.default_rng(2)
    compared = {}
    print(f"\n{'elements - lattice':<26} {'mean':>8} {'std':>8} {'least':>8} {'most':>8}     order")
    for name, designs in (("whole range", evolution.first), ("last generation", evolution.last)):
        solvable = designs[np.isfinite(Sorting()(designs).torque)]
        chosen = rng.permutation(len(solvable))[: options.compared]
        compared[name] = by_both([propeller_of(solvable[k], f"{name} {k}") for k in chosen])
        print("\n".join(differences(name, *compared[name])))
    quantities = {
        label: {name: (pair[1][field], pair[0][field]) for name, pair in compared.items()}
        for label, field in (("torque, N m", 1), ("tones, dB", 2))
    }
    save(agreement(quantities, ("lattice", "elements")), options.output / "agreement.png")


if __name__ == "__main__":
    main()
