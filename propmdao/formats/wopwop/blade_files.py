"""A blade in PSU-WOPWOP's files: its skin as grids, its forces as a line."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.sources.moving_sources import AperiodicLoads, BladeLoads, PeriodicLoads
from propmdao.formats.wopwop.cells import means, vector_areas
from propmdao.formats.wopwop.geometry_file import GeometryFile
from propmdao.formats.wopwop.loading_file import LoadingFile
from propmdao.formats.wopwop.zones import Zone

Array = NDArray[np.float64]


def blade_geometry(nodes: ArrayLike | None, loads: BladeLoads | None) -> GeometryFile:
    """Geometry of a blade: its skin, and the line that its forces act on.

    Parameters
    ----------
    nodes : (n_contour, n_span, 3) array_like or None
        Points of the surface, as `surface_nodes` makes them [m].
    loads : PointLoads, PeriodicLoads, AperiodicLoads or None
        Forces of the blade.

    Returns
    -------
    GeometryFile
        File with these zones: skin, trailing edge if it has a thickness, root and tip cap, and last
        the line.

    Raises
    ------
    ValueError
        If there is neither a surface nor loads.
    """
    zones = [] if nodes is None else _skin(np.asarray(nodes, float))
    if loads is not None:
        position, _ = _line(loads)
        normal = np.broadcast_to([0.0, 0.0, 1.0], position.shape)
        zones.append(_zone("loads", position[:, None], normal[:, None]))
    if not zones:
        raise ValueError("a blade for PSU-WOPWOP must have a surface or loads; it has neither")
    return GeometryFile(tuple(zones), comment="propmdao")


def blade_loading(
    loads: BladeLoads, n_zones: int, rotation_speed: float, blade: int = 0
) -> LoadingFile:
    """Loading of a blade, as force ON THE BLADE per length of the line of its forces.

    Parameters
    ----------
    loads : PointLoads, PeriodicLoads or AperiodicLoads
        Forces ON THE FLUID.
    n_zones : int
        Number of zones of the geometry; the line is the last of them.
    rotation_speed : float
        Rotation speed [rad/s], which gives the period; keys are the angle turned through.
    blade : int
        Number of the blade, counted from 0; it matters to `AperiodicLoads` alone.

    Returns
    -------
    LoadingFile
        Loads in the frame of the blade.
    """
    position, point = _line(loads)
    force = np.asarray(loads.force, float)
    keys = period = None
    if isinstance(loads, PeriodicLoads):
        if rotation_speed < 0:  # from the angle turned through to the azimuth
            force = np.roll(force[::-1], 1, axis=0)
        force = np.concatenate([force, force[:1]])
        keys = np.linspace(0, 2 * np.pi, len(force), dtype=np.float32)
        period = float(np.float32(2 * np.pi / abs(rotation_speed)))
    elif isinstance(loads, AperiodicLoads):
        force, keys = force[blade], np.asarray(loads.times, np.float32)
    else:
        force = force[None]
    total = np.zeros((len(position), len(force), 3))
    np.add.at(total, point, np.swapaxes(force, 0, 1))
    # The line is integrated by the trapezoidal rule, so that each node gets back its force.
    between = 0.5 * np.linalg.norm(np.diff(position, axis=0), axis=-1)
    length = np.pad(between, (0, 1)) + np.pad(between, (1, 0))
    density = -total / length[:, None, None]
    values = density.transpose(1, 2, 0)[..., None].astype(np.float32)
    zone = Zone("loads", values, keys, period)
    return LoadingFile((zone,), (-n_zones,), n_zones, comment="propmdao")


def _line(loads: BladeLoads) -> tuple[Array, NDArray[np.int64]]:
    """Points that forces act on from root to tip, each once, and the index of the point of each."""
    # Single precision, as they are written: lengths have to be of what is read.
    position = np.asarray(loads.position, np.float32).astype(float)
    points, indices = np.unique(position, axis=0, return_inverse=True)
    order = np.lexsort((points[:, 1], np.linalg.norm(points[:, :2], axis=1)))
    rank = np.empty_like(order)
    rank[order] = np.arange(order.size)
    if order.size < 2:
        raise ValueError("loads for PSU-WOPWOP must act at 2 or more points: they are a line there")
    return points[order], rank[indices.reshape(-1)]


def _skin(nodes: Array) -> list[Zone]:
    """Zones of the surface of a blade, closed by its trailing edge and two caps."""
    half = (len(nodes) - 1) // 2
    upper, lower = nodes[: half + 1], nodes[half:][::-1]
    grids = {"skin": nodes}
    if np.abs(nodes[0] - nodes[-1]).max() > 0:
        grids["trailing edge"] = nodes[[-1, 0]]
    grids["root"] = np.stack([upper[:, 0], lower[:, 0]])
    grids["tip"] = np.stack([lower[:, -1], upper[:, -1]])
    areas = {name: vector_areas(grid) for name, grid in grids.items()}
    # All grids turn the same way round; the sign of the volume says which side is outside.
    volume = sum(
        np.sum(means(grid) * area)
        for grid, area in zip(grids.values(), areas.values(), strict=True)
    )
    sign = np.sign(volume)
    return [_zone(name, grid, sign * _normals(areas[name])) for name, grid in grids.items()]


def _zone(name: str, grid: Array, normal: Array) -> Zone:
    values = np.concatenate([np.moveaxis(grid, -1, 0), np.moveaxis(normal, -1, 0)])
    return Zone(name, values[None].astype(np.float32))


def _normals(area: Array) -> Array:
    """Unit normals at the nodes, from the areas of the cells around each."""
    padded = np.pad(area, ((1, 1), (1, 1), (0, 0)))
    around = padded[:-1, :-1] + padded[:-1, 1:] + padded[1:, 1:] + padded[1:, :-1]
    length = np.linalg.norm(around, axis=-1, keepdims=True)
    # Where the ends of a cap come to a point there is no area: any direction.
    return np.where(length > 0, around / np.where(length > 0, length, 1.0), [0.0, 0.0, 1.0])
