"""PSU-WOPWOP loading ("functional data") files, single precision, version 1.0."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from propmdao.formats.wopwop.binary import Reader, Writer
from propmdao.formats.wopwop.zones import (
    Zone,
    grid_of,
    read_header,
    read_layout,
    read_zones,
    time_dependence,
    write_zones,
)

DATA = {1: "pressure", 2: "loading", 3: "flow"}
N_COMPONENTS = {1: 1, 2: 3, 3: 5}
FRAMES = {1: "ground", 2: "mixed", 3: "patch"}


@dataclass(frozen=True)
class LoadingFile:
    """A loading file.

    Attributes
    ----------
    zones : tuple of Zone
        Data of the zones in `zone_numbers`.
    zone_numbers : tuple of int
        Which zones of the geometry file they belong to, counted from 1; negative if thickness
        noise is not wanted of that zone.
    n_geometry_zones : int
        Number of zones of the geometry file.
    data : int
        1 surface gauge pressure, 2 loading vector, 3 flow.
    frame : int
        Of the loading vector: 1 ground, 2 mixed, 3 patch.
    at_faces : bool
        Whether the values belong to faces, not nodes.
    comment : str
        At most 1024 characters.
    byte_order, padding
        As in `GeometryFile`.
    """

    zones: tuple[Zone, ...]
    zone_numbers: tuple[int, ...]
    n_geometry_zones: int
    data: int = 2
    frame: int = 3
    at_faces: bool = False
    comment: str = ""
    byte_order: str = "<"
    padding: bytes = b" "


def read_loading(path: str | Path) -> LoadingFile:
    """Read a loading file.

    Parameters
    ----------
    path : str or Path
        Single precision; constant, periodic or aperiodic.

    Returns
    -------
    LoadingFile
        All of it, so that `write_loading` gives back the same bytes.

    Raises
    ------
    WopwopFileError
        If the file is not such a file, is truncated or too long.
    """
    file = Reader(Path(path))
    file.version()
    comment = file.text(1024)
    file.expect(2, "file type (2 is a loading)")
    n_geometry_zones = file.count("number of zones of the geometry")
    grid, kind, at_faces = read_layout(file, "loading")
    data = file.choose(DATA, "kind of the data")
    frame = file.choose(FRAMES, "frame of the loading vectors")
    file.choose({1: "single"}, "precision")
    file.ints(2)
    numbers = file.ints(file.count("number of zones with data"))
    for number in numbers:
        if not 1 <= abs(number) <= n_geometry_zones:
            raise file.error(f"zone numbers must be 1 ... {n_geometry_zones}; one is {number}")
    headers = [read_header(file, kind, grid, False) for _ in numbers]
    zones = read_zones(file, headers, N_COMPONENTS[data])
    return LoadingFile(
        zones,
        tuple(numbers),
        n_geometry_zones,
        data,
        frame,
        at_faces,
        comment,
        file.byte_order,
        file.padding,
    )


def write_loading(path: str | Path, loading: LoadingFile) -> None:
    """Write a loading file.

    Parameters
    ----------
    path : str or Path
        Where to.
    loading : LoadingFile
        All zones constant, all periodic or all aperiodic.

    Raises
    ------
    ValueError
        If the zones do not go together or a text is too long.
    """
    kind = time_dependence(loading.zones)
    out = Writer(loading.byte_order, loading.padding)
    out.ints(1, 0)
    out.text(loading.comment, 1024)
    grid = grid_of(loading.zones)
    out.ints(2, loading.n_geometry_zones, grid, kind, 2 if loading.at_faces else 1)
    out.ints(loading.data, loading.frame, 1, 0, 0, len(loading.zones), *loading.zone_numbers)
    write_zones(out, loading.zones)
    out.save(Path(path))
