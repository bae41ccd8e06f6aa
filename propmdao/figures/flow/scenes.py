"""What a rotor and its wake look like, with loads and circulation: surfaces for ParaView.

All is in the axes of docs/conventions.md, which do not turn: blades stand where they are at their
azimuth. The wake is the prescribed one of the solution, of the turns that `Fidelity` gives it, or
that of a march, with loads and circulation of the mean of its last revolutions.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.lattice.rings import vortex_rings
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.aerodynamics.solutions.point_sums import panel_sums
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.aerodynamics.wakes.helical import helical_wake, wake_transport
from propmdao.aerodynamics.wakes.history import history_weights
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.analysis.results import Analysis
from propmdao.formats.meshes.vtk import QuadMesh, write_pvd, write_vtu
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.output_files import replacing_in


@dataclasses.dataclass(frozen=True)
class Scene:
    """The rotor at a moment.

    Attributes
    ----------
    time : float
        Time since blade 1 stood at azimuth 0 [s].
    blades : QuadMesh
        Lattices of all blades: pressure_difference_Pa, from the lower to the upper side;
        force_N, without profile drag; circulation_m2_per_s of the rings; and of the section that a
        panel belongs to lift_coefficient, drag_coefficient, angle_of_attack_deg.
    wake : QuadMesh
        Sheets behind all blades: circulation_m2_per_s of their rings, age_deg, the azimuth by which
        the blade is ahead.
    """

    time: float
    blades: QuadMesh
    wake: QuadMesh


def scenes(analysis: Analysis) -> Iterator[Scene]:
    """Rotor and wake of an analysis, at one moment or several.

    In axial flight one, at an incidence all azimuths of blade 1, of a march in time its snapshots
    or, without any, its end.

    Parameters
    ----------
    analysis : Analysis
        Analysis of a rotor that turns.

    Yields
    ------
    Scene
        Blades and wake.

    Raises
    ------
    ValueError
        If the rotor stands still: it has no wake.
    """
    if analysis.rpm == 0.0:
        raise ValueError("a rotor that stands still has no wake to draw")
    propeller, fidelity = analysis.changed_propeller, analysis.model.fidelity
    span = lattice_interpolation(propeller.r_over_R, fidelity.n_spanwise)
    nodes = lattice_nodes(Blade.from_propeller(propeller), span, fidelity.n_chordwise)
    rotor = RotorGeometry(nodes, 0.5 * propeller.diameter, int(propeller.n_blades))
    ages, wakes = _marched_wakes(analysis.loads) or _prescribed_wakes(analysis, rotor)
    values, rings = _of_panels(np.asarray(nodes), analysis), _of_rings(analysis, ages)
    n = len(rings)
    numbers = np.arange(rotor.n_blades)
    age_deg = np.degrees(0.5 * (ages[1:] + ages[:-1]))
    for azimuth, sheets in wakes:
        k = round(azimuth / (2.0 * np.pi) * n) % n
        # Each blade has what blade 1 has where it stands.
        on_blades = {
            name: value[(k + numbers * n // rotor.n_blades) % n] for name, value in values.items()
        }
        at_blades = azimuth + 2.0 * np.pi * numbers / rotor.n_blades
        on_blades["force_N"] = _turned(on_blades["force_N"], at_blades)
        in_wake = {
            "circulation_m2_per_s": rings[k],
            "age_deg": np.broadcast_to(age_deg, rings[k].shape),
        }
        lattices = _turned(np.stack([nodes] * rotor.n_blades), at_blades)
        yield Scene(
            float(azimuth / (analysis.rpm * RAD_PER_S)),
            QuadMesh.of_sheets(lattices, on_blades),
            QuadMesh.of_sheets(sheets, in_wake),
        )


# Ages of the wake's nodes [rad]; azimuths of blade 1, and nodes (n_blades, n_filaments, n_nodes, 3)
# there, in the axes that do not turn.
_Wakes = tuple[np.ndarray, list[tuple[float, np.ndarray]]]


def _marched_wakes(loads: RotorLoads | TiltedLoads) -> _Wakes | None:
    """Wakes of a march at its snapshots, or at its end; None of other solutions."""
    if not isinstance(loads, MarchedLoads):
        return None
    wakes = list(zip(np.asarray(loads.snapshot_azimuth), np.asarray(loads.snapshots), strict=True))
    if not wakes:
        turns = loads.thrust_history.size / len(loads.circulation)
        wakes = [(2.0 * np.pi * turns, np.asarray(loads.wake))]
    return np.asarray(loads.wake_age), wakes


def _prescribed_wakes(analysis: Analysis, rotor: RotorGeometry) -> _Wakes:
    """Wakes of the steady solution, or at the azimuths of the periodic one."""
    loads, state, fidelity = analysis.loads, analysis.state, analysis.model.fidelity
    tilted = isinstance(loads, TiltedLoads)
    grid = fidelity.period_wake if tilted else fidelity.wake
    transport = wake_transport(analysis.model.loads.wake, grid)
    ages = np.asarray(transport.ages)
    edge, w = vortex_rings(rotor.nodes).corner[-1], loads.induced_velocity
    # Sheet by sheet: (n_blades, n_filaments, n_nodes, 3).
    helix = np.asarray(helical_wake(edge, transport, rotor, state, w)).swapaxes(0, 1)
    n = loads.circulation.shape[0] if tilted else 1
    azimuths = 2.0 * np.pi * np.arange(n) / n
    drift = np.asarray(sideways_drift(jnp.asarray(ages), jnp.asarray(azimuths), state))
    return ages, [
        (azimuth, _turned(helix + drift[k], np.full(rotor.n_blades, azimuth)))
        for k, azimuth in enumerate(azimuths)
    ]


def _of_panels(nodes: np.ndarray, analysis: Analysis) -> dict[str, np.ndarray]:
    """Values of the panels of blade 1 in its frame, (n_azimuths, nc, ns) or with an axis of 3."""
    loads = analysis.loads
    nc, ns = loads.circulation.shape[-2:]
    forces = -np.asarray(loads.point_loads.force).reshape(-1, *loads.point_loads.position.shape)
    force = np.asarray(jax.vmap(lambda one: panel_sums(one, nc, ns))(jnp.asarray(forces)))
    # Vector area toward the upper side, half the product of the diagonals.
    area = 0.5 * np.cross(nodes[1:, 1:] - nodes[:-1, :-1], nodes[:-1, 1:] - nodes[1:, :-1])
    sections = {
        "lift_coefficient": loads.sections.lift_coefficient,
        "drag_coefficient": loads.sections.drag_coefficient,
        "angle_of_attack_deg": np.degrees(loads.sections.angle_of_attack),
    }
    shape = force.shape[:3]
    return {
        "pressure_difference_Pa": (force * area).sum(axis=-1) / (area * area).sum(axis=-1),
        "force_N": force,
        "circulation_m2_per_s": np.asarray(loads.circulation).reshape(shape),
    } | {
        name: np.broadcast_to(np.asarray(value).reshape(-1, 1, ns), shape)
        for name, value in sections.items()
    }


def _of_rings(analysis: Analysis, ages: np.ndarray) -> np.ndarray:
    """Circulation of the wake's rings, (n_azimuths, n_blades, ns, n_nodes - 1) [m^2/s].

    The fraction of a panel by which a period's wake is older than its nodes is left out.
    """
    loads, n_blades = analysis.loads, int(analysis.changed_propeller.n_blades)
    circulation = np.asarray(loads.circulation)[..., -1, :]
    if not isinstance(loads, TiltedLoads):
        shape = (1, n_blades, circulation.size, ages.size - 1)
        return np.broadcast_to(circulation[:, None], shape)
    n, ns = circulation.shape
    weights, _ = history_weights(jnp.asarray(ages), jnp.zeros(ns), n, n_blades)
    later = np.stack([np.roll(circulation, -k, axis=0) for k in range(n)])
    rings = np.einsum("snc,kns->ksc", np.asarray(weights), later)
    return rings.reshape(n, ns, n_blades, -1).swapaxes(1, 2)


def _turned(vectors: npt.ArrayLike, azimuths: npt.NDArray[np.float64]) -> np.ndarray:
    """Vectors (n, ..., 3) from the frames of blades at n azimuths to the axes that do not turn."""
    x, y, z = np.moveaxis(np.asarray(vectors, float), -1, 0)
    angle = azimuths.reshape(-1, *(1,) * (x.ndim - 1))
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([x * cos - y * sin, x * sin + y * cos, z], axis=-1)


def write_scenes(folder: Path, analysis: Analysis) -> list[str]:
    """Write blades and wake of an analysis for ParaView.

    Parameters
    ----------
    folder : Path
        Folder of the files, made where there is none.
    analysis : Analysis
        Analysis of a rotor that turns.

    Returns
    -------
    list of str
        Files to open: blades.vtu and wake.vtu, or of several moments blades.pvd and wake.pvd, which
        play the files of all of them, blades_0000.0.vtu and so on by the azimuth in degrees.

    Raises
    ------
    ValueError
        If the rotor stands still, or its loads are those of blade elements.
    OutputError
        If the folder cannot be written.
    """
    if analysis.model.loads.blade_element:
        raise ValueError(
            "files for ParaView are of lattice and wake, which blade elements have not"
        )
    moments = list(scenes(analysis))
    turned_deg = [np.degrees(scene.time * analysis.rpm * RAD_PER_S) for scene in moments]
    with replacing_in(folder) as files:
        for part in ("blades", "wake"):
            meshes = [getattr(scene, part) for scene in moments]
            if len(meshes) == 1:
                write_vtu(files / f"{part}.vtu", meshes[0])
                continue
            names = [f"{part}_{degrees:06.1f}.vtu" for degrees in turned_deg]
            for name, mesh in zip(names, meshes, strict=True):
                write_vtu(files / name, mesh)
            times = (scene.time for scene in moments)
            write_pvd(files / f"{part}.pvd", zip(times, names, strict=True))
    ending = "vtu" if len(moments) == 1 else "pvd"
    return [str(folder / f"{part}.{ending}") for part in ("blades", "wake")]
