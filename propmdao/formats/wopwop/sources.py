"""Sources of Formulation 1A at given source times, made from the zones of files."""

from __future__ import annotations

from collections.abc import Iterator

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.motion import Motion, poses
from propmdao.acoustics.sources.moving_sources import UnsteadySources, sample
from propmdao.formats.wopwop.cells import means, vector_areas
from propmdao.formats.wopwop.loading_file import LoadingFile
from propmdao.formats.wopwop.zones import Zone

Array = NDArray[np.float64]
_Rates = tuple[Array, Array, Array]


def is_line(zone: Zone) -> bool:
    """Whether a geometry zone is a line of nodes, not a surface."""
    return zone.structured and 1 in zone.values.shape[2:]


def source_points(zone: Zone) -> Array:
    """Nodes of a zone at all of its times, (n, 3) [m]."""
    return np.moveaxis(zone.values[:, :3], 1, -1).reshape(-1, 3).astype(float)


def thickness_sources(zone: Zone, tau: Array, key_offset: float = 0.0) -> UnsteadySources:
    """Panels of a surface zone.

    Parameters
    ----------
    zone : Zone
        Surface zone of a geometry file.
    tau : (n_times,) array
        Source times [s].
    key_offset : float
        Offset added to the keys of periodic zones at all times (``periodicKeyOffset``).

    Returns
    -------
    UnsteadySources
        Panels by centres and outward vector areas of the cells of the grid; one time if constant.

    Raises
    ------
    ValueError
        If an aperiodic zone does not cover the source times.
    """
    center, area = _panels(zone)
    position = _in_time(center, zone, tau, key_offset)
    return _unsteady(position, _in_time(area, zone, tau, key_offset)[:2])


def loading_sources(
    geometry: Zone,
    loading: Zone,
    file: LoadingFile,
    tau: Array,
    motion: Motion,
    key_offset: float = 0.0,
) -> UnsteadySources:
    """Point forces on the fluid of a zone.

    Parameters
    ----------
    geometry, loading : Zone
        Zone of the geometry file, and the data of the loading file for it.
    file : LoadingFile
        Loading file that the data are from, with their kind, place and frame.
    tau, key_offset
        Source times [s], and the offset added to the keys of periodic zones
        (``periodicKeyOffset``).
    motion : Motion
        Motion of the zone, for data that are given in the ground's frame.

    Returns
    -------
    UnsteadySources
        Forces at the nodes of a line (its lengths by the trapezoidal rule) or at the cells of a
        surface.

    Raises
    ------
    ValueError
        If the data are of a kind that is not computed, do not fit the geometry or do not cover
        the source times.
    """
    if file.data == 3:
        raise ValueError(
            "flow data (permeable surface) are not computed, only pressure and loading"
        )
    at_start = poses(motion, np.zeros(1)).rotation[0]
    if file.data == 2 and file.frame == 2 and not np.allclose(at_start, np.eye(3), atol=1e-6):
        # As VSPAERO has it: the ground's components at time 0, turning with the patch.
        raise ValueError(
            "loading vectors in the mixed frame (2) are computed where the patch has the ground's"
            " axes at time 0 only; here it is turned: use 1 or 3"
        )
    line = is_line(geometry)
    if file.data == 1 and line:
        raise ValueError("surface pressure is given for a line; a line takes loading vectors")
    center, extent = _line(geometry) if line else _panels(geometry)
    if file.data == 2 and not line:
        extent = np.linalg.norm(extent, axis=-1, keepdims=True)
    # Files hold the force ON THE BLADE, pressure pushes the fluid along the outward normal.
    sign = 1.0 if file.data == 1 else -1.0
    density = sign * _density(geometry, loading, file.at_faces, line)
    size, size_rate, _ = _in_time(extent, geometry, tau, key_offset)
    value, value_rate, _ = _in_time(density, loading, tau, key_offset)
    force, rate = value * size, value_rate * size + value * size_rate
    if file.data == 2 and file.frame == 1:
        pose = poses(motion, tau)
        turn, turn_rate = pose.rotation, pose.rotation_rate

        def local(matrix: Array, vector: Array) -> Array:
            return np.einsum(
                "tji,tnj->tni", matrix, np.broadcast_to(vector, (tau.size, *force.shape[1:]))
            )

        force, rate = local(turn, force), local(turn_rate, force) + local(turn, rate)
    return _unsteady(_in_time(center, geometry, tau, key_offset), (force, rate))


def _unsteady(position: _Rates, vector: tuple[Array, ...]) -> UnsteadySources:
    return UnsteadySources(*(jnp.asarray(q) for q in (*position, *vector)))


def _panels(zone: Zone) -> tuple[Array, Array]:
    """Return centres and outward vector areas of the cells, each (n_times, n, 3)."""
    nodes = np.moveaxis(zone.values[:, :3].astype(float), 1, -1)
    if zone.structured:
        center, area = means(nodes), vector_areas(nodes)
    else:
        center = _mean_of_faces(zone, nodes)
        area = np.zeros_like(center)
        for which, corners in _faces_by_size(zone):
            around = nodes[:, corners] - center[:, which, None]
            area[:, which] = 0.5 * np.cross(around, np.roll(around, -1, axis=2)).sum(axis=2)
    if zone.normals_at_faces is None:
        normal = _at_cells(zone, np.moveaxis(zone.values[:, 3:].astype(float), 1, -1))
    else:
        normal = np.moveaxis(zone.normals_at_faces.astype(float), 1, -1)
    # The file's normals say which side is outside; areas come from the nodes.
    outward = np.where(np.sum(area * normal, axis=-1, keepdims=True) < 0, -1.0, 1.0)
    n_times = len(nodes)
    return center.reshape(n_times, -1, 3), (outward * area).reshape(n_times, -1, 3)


def _line(zone: Zone) -> tuple[Array, Array]:
    """Return nodes (n_times, n, 3) and the lengths that belong to them (n_times, n, 1)."""
    nodes = np.moveaxis(zone.values[:, :3].astype(float), 1, -1).reshape(len(zone.values), -1, 3)
    between = 0.5 * np.linalg.norm(np.diff(nodes, axis=1), axis=-1, keepdims=True)
    return nodes, np.pad(between, ((0, 0), (0, 1), (0, 0))) + np.pad(
        between, ((0, 0), (1, 0), (0, 0))
    )


def _density(geometry: Zone, loading: Zone, at_faces: bool, line: bool) -> Array:
    """Return the data per area or length at the places of the sources, (n_times, n, 1 or 3)."""
    density = np.moveaxis(loading.values.astype(float), 1, -1)
    wanted = geometry.values.shape[2:]
    if at_faces and not line:
        wanted = (len(geometry.faces),) if geometry.faces else tuple(n - 1 for n in wanted)
    if density.shape[1:-1] != wanted:
        sizes = (" x ".join(map(str, size[::-1])) for size in (wanted, density.shape[1:-1]))
        raise ValueError(
            f"data of zone {loading.name!r} must be {next(sizes)} to fit its geometry; "
            f"they are {next(sizes)}"
        )
    if not line and not at_faces:
        density = _at_cells(geometry, density)
    return np.asarray(density.reshape(len(density), -1, density.shape[-1]))


def _at_cells(zone: Zone, at_nodes: Array) -> Array:
    return means(at_nodes) if zone.structured else _mean_of_faces(zone, at_nodes)


def _faces_by_size(zone: Zone) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Numbers of the faces with 3, 4, ... corners, and these: (n, n_corners) nodes from 0."""
    sizes = np.array([len(face) for face in zone.faces])
    for size in np.unique(sizes):
        which = np.flatnonzero(sizes == size)
        yield which, np.array([zone.faces[i] for i in which]) - 1


def _mean_of_faces(zone: Zone, at_nodes: Array) -> Array:
    mean = np.empty((len(at_nodes), len(zone.faces), at_nodes.shape[-1]))
    for which, corners in _faces_by_size(zone):
        mean[:, which] = at_nodes[:, corners].mean(axis=2)
    return mean


def _in_time(table: Array, zone: Zone, tau: Array, key_offset: float) -> _Rates:
    """Return a table of a zone at the source times with two derivatives; one time if constant."""
    if zone.keys is None:
        return table, np.zeros_like(table), np.zeros_like(table)
    keys = zone.keys.astype(float)
    if zone.period is None:
        return sample(table, keys, tau)
    unit = _key_unit(table, keys, zone.period, zone.name)
    return sample(table, unit * keys, tau + unit * key_offset, zone.period)


def key_offset_in_time(zone: Zone, key_offset: float) -> float:
    """Offset of a zone's periodic keys as a time.

    Parameters
    ----------
    zone : Zone
        Zone of a file.
    key_offset : float
        Offset in the unit of the keys.

    Returns
    -------
    float
        Offset [s], 0 if the zone is not periodic.
    """
    if zone.keys is None or zone.period is None:
        return 0.0
    values = zone.values.astype(float)
    return key_offset * _key_unit(values, zone.keys.astype(float), zone.period, zone.name)


def _key_unit(table: Array, keys: Array, period: float, name: str) -> float:
    """Time that a periodic key is [s]."""
    # Keys are in any unit; one period is where the first values come back. Files repeat them at
    # their end or leave them out.
    n, span = len(keys), keys[-1] - keys[0]
    if n < 2 or not span > 0:
        raise ValueError(f"keys of the periodic zone {name!r} must be 2 or more that increase")
    scale = np.ptp(table) or 1.0
    repeats = np.abs(table[-1] - table[0]).max() < 1e-6 * scale
    return float(period / (span if repeats else span * n / (n - 1)))
