"""Zones of PSU-WOPWOP files: headers first, then the data time by time and zone by zone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from propmdao.formats.wopwop.binary import (
    APERIODIC,
    CONSTANT,
    PERIODIC,
    STRUCTURED,
    TIMES,
    UNSTRUCTURED,
    Floats,
    Layout,
    Reader,
    Writer,
)


@dataclass(frozen=True)
class Zone:
    """One zone of a geometry or loading file.

    Attributes
    ----------
    name : str
        Name of at most 32 characters.
    values : (n_times, n_components, j_max, i_max) or (n_times, n_components, n) float32 array
        Values on a structured or unstructured grid. In a geometry: x, y, z [m] of the nodes and the
        three components of their normals. In a loading: pressure [Pa], the force ON THE BLADE per
        area [N/m^2] or per length of a line [N/m], or rho, rho u, rho v, rho w, p'. There is one
        time if they are constant.
    keys : (n_times,) float32 array or None
        Times [s], or periodic keys in any unit; None if constant.
    period : float or None
        Period of a periodic zone [s].
    normals_at_faces : (n_times, 3, j_max - 1, i_max - 1) or (n_times, 3, n_faces) array or None
        Face-centred normals of a geometry that has them; `values` then has the nodes alone.
    faces : tuple of tuple of int
        Nodes around each face of an unstructured geometry, counted from 1.
    """

    name: str
    values: Floats
    keys: Floats | None = None
    period: float | None = None
    normals_at_faces: Floats | None = None
    faces: tuple[tuple[int, ...], ...] = ()

    @property
    def structured(self) -> bool:
        """True if the nodes are a structured grid."""
        return self.values.ndim == 4


@dataclass(frozen=True)
class ZoneHeader:
    """Header of a zone: its name, size and times."""

    name: str
    shape: tuple[int, ...]
    faces: tuple[tuple[int, ...], ...]
    period: float | None
    n_times: int | None

    @property
    def shape_of_faces(self) -> tuple[int, ...]:
        """Shape of values at the faces, in the order of the nodes."""
        return (len(self.faces),) if self.faces else tuple(max(n - 1, 1) for n in self.shape)


def layout_of(zones: Sequence[Zone], at_faces: bool) -> Layout:
    """Layout that all zones of a file have.

    Parameters
    ----------
    zones : sequence of Zone
        Zones of one file.
    at_faces : bool
        True if normals or loads belong to faces.

    Returns
    -------
    Layout
        Layout that all of the zones have.

    Raises
    ------
    ValueError
        If there are no zones, or they differ in their grids, time dependence or number of times.
    """
    times = {(_time_dependence(zone), len(zone.values)) for zone in zones}
    if len(times) != 1:
        listed = ", ".join(f"{TIMES[time]} with {n} times" for time, n in sorted(times)) or "none"
        raise ValueError(f"zones of a file must have the same time dependence; got {listed}")
    if len({zone.structured for zone in zones}) > 1:
        raise ValueError("zones of a file must all be structured or all unstructured")
    grid = STRUCTURED if zones[0].structured else UNSTRUCTURED
    return Layout(grid, _time_dependence(zones[0]), at_faces)


def _time_dependence(zone: Zone) -> int:
    if zone.keys is None:
        return CONSTANT
    return APERIODIC if zone.period is None else PERIODIC


def read_header(file: Reader, layout: Layout, has_faces: bool) -> ZoneHeader:
    """Read the header of a zone.

    Parameters
    ----------
    file : Reader
        Reader at the beginning of the header.
    layout : Layout
        Layout of the file.
    has_faces : bool
        True if the faces of an unstructured zone are listed, as geometry files do.

    Returns
    -------
    ZoneHeader
        Header of the zone.

    Raises
    ------
    WopwopFileError
        If a face has fewer than three nodes or a node that does not exist, or a period is not
        positive.
    """
    name = file.text(32)
    period = float(file.floats(1)[0]) if layout.time == PERIODIC else None
    if period is not None and not 0 < period < np.inf:
        raise file.error(f"the period of zone {name!r} must be positive; it is {period:g} s")
    n_times = file.count("number of times of a zone") if layout.time != CONSTANT else None
    if layout.grid == STRUCTURED:
        i_max, j_max = file.count("iMax"), file.count("jMax")
        return ZoneHeader(name, (j_max, i_max), (), period, n_times)
    n = file.count("number of nodes" if has_faces else "number of data")
    faces = []
    for _ in range(file.count("number of faces") if has_faces else 0):
        n_nodes = file.count("number of nodes of a face")
        face = file.ints(n_nodes)
        if n_nodes < 3 or not 1 <= min(face) <= max(face) <= n:
            raise file.error(
                f"a face of zone {name!r} must have 3 or more of the nodes 1 ... {n}; it has {face}"
            )
        faces.append(tuple(face))
    return ZoneHeader(name, (n,), tuple(faces), period, n_times)


def read_zones(
    file: Reader, headers: Sequence[ZoneHeader], n_components: int, face_normals: bool = False
) -> tuple[Zone, ...]:
    """Read the data of all zones up to the end of the file.

    Parameters
    ----------
    file : Reader
        Reader behind the last header.
    headers : sequence of ZoneHeader
        Headers of all zones with data.
    n_components : int
        Number of values at each node.
    face_normals : bool
        True if the three components of a normal follow for each face.

    Returns
    -------
    tuple of Zone
        The zones in the order of the headers.

    Raises
    ------
    WopwopFileError
        If the file ends too early or goes on, holds NaN, or the zones differ in their number of
        times.
    """
    counts = {head.n_times for head in headers}
    if len(counts) > 1:
        raise file.error(f"all zones must have the same number of times; they have {counts}")
    n_times = counts.pop()
    keys: list[list[np.float32]] = [[] for _ in headers]
    values: list[list[Floats]] = [[] for _ in headers]
    normals: list[list[Floats]] = [[] for _ in headers]
    for _ in range(n_times or 1):
        for zone, head in enumerate(headers):
            if n_times is not None:
                keys[zone].append(file.floats(1)[0])
            values[zone].append(file.floats(n_components, *head.shape))
            if face_normals:
                normals[zone].append(file.floats(3, *head.shape_of_faces))
    file.end()
    for zone, head in enumerate(headers):
        blocks: list[Floats] = [*values[zone], *normals[zone], np.array(keys[zone])]
        if not all(np.isfinite(block).all() for block in blocks):
            raise file.error(f"zone {head.name!r} holds infinities or NaN")
    return tuple(
        Zone(
            head.name,
            np.stack(values[zone]),
            None if n_times is None else np.stack(keys[zone]),
            head.period,
            np.stack(normals[zone]) if face_normals else None,
            head.faces,
        )
        for zone, head in enumerate(headers)
    )


def write_zones(out: Writer, zones: Sequence[Zone]) -> None:
    """Append headers and data of zones.

    Parameters
    ----------
    out : Writer
        Writer at the place where the zones begin.
    zones : sequence of Zone
        Zones with one layout.
    """
    for zone in zones:
        out.text(zone.name, 32)
        if zone.period is not None:
            out.floats(zone.period)
        if zone.keys is not None:
            out.ints(len(zone.values))
        out.ints(*zone.values.shape[:1:-1])  # iMax, jMax
        if zone.faces:
            out.ints(len(zone.faces))
        for face in zone.faces:
            out.ints(len(face), *face)
    for step in range(len(zones[0].values)):
        for zone in zones:
            if zone.keys is not None:
                out.floats(float(zone.keys[step]))
            out.floats(zone.values[step])
            if zone.normals_at_faces is not None:
                out.floats(zone.normals_at_faces[step])
