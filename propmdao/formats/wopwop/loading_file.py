"""PSU-WOPWOP loading ("functional data") files, single precision, version 1.0."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from propmdao.formats.wopwop.binary import LOADING, Reader, Writer, read_opening, write_opening
from propmdao.formats.wopwop.zones import Zone, layout_of, read_header, read_zones, write_zones

DATA = {1: "pressure", 2: "loading", 3: "flow"}
N_COMPONENTS = {1: 1, 2: 3, 3: 5}
FRAMES = {1: "ground", 2: "mixed", 3: "patch"}


@dataclass(frozen=True)
class LoadingFile:
    """Contents of a loading file.

    Attributes
    ----------
    zones : tuple of Zone
        Data of the zones in `zone_numbers`.
    zone_numbers : tuple of int
        Zones of the geometry file that the data belong to, counted from 1; a negative number asks
        for no thickness noise of that zone.
    n_geometry_zones : int
        Number of zones of the geometry file.
    data : int
        Kind of the data: 1 surface gauge pressure, 2 loading vector, 3 flow.
    frame : int
        Frame of the loading vectors: 1 ground, 2 mixed, 3 patch.
    at_faces : bool
        True if the values belong to faces, False if to nodes.
    comment : str
        Text of at most 1024 characters.
    byte_order : str
        Byte order: "<" little-endian or ">" big-endian.
    padding : bytes
        The byte that fills up texts.
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
        File in single precision; constant, periodic or aperiodic.

    Returns
    -------
    LoadingFile
        All that the file holds, so that `write_loading` gives back the same bytes.

    Raises
    ------
    WopwopFileError
        If the file is not a loading file, is truncated or too long.
    """
    file = Reader(Path(path))
    (comment,), n_geometry_zones, layout = read_opening(file, LOADING)
    data = file.choose(DATA, "kind of the data")
    frame = file.choose(FRAMES, "frame of the loading vectors")
    file.choose({1: "single"}, "precision")
    file.ints(2)
    numbers = file.ints(file.count("number of zones with data"))
    for number in numbers:
        if not 1 <= abs(number) <= n_geometry_zones:
            raise file.error(f"zone numbers must be 1 ... {n_geometry_zones}; one is {number}")
    headers = [read_header(file, layout, has_faces=False) for _ in numbers]
    zones = read_zones(file, headers, N_COMPONENTS[data])
    return LoadingFile(
        zones,
        tuple(numbers),
        n_geometry_zones,
        data,
        frame,
        layout.at_faces,
        comment,
        file.byte_order,
        file.padding,
    )


def write_loading(path: str | Path, loading: LoadingFile) -> None:
    """Write a loading file.

    Parameters
    ----------
    path : str or Path
        File to write.
    loading : LoadingFile
        Contents of the file: all zones are constant, periodic or aperiodic.

    Raises
    ------
    ValueError
        If the zones do not go together or a text is too long.
    """
    layout = layout_of(loading.zones, loading.at_faces)
    out = Writer(loading.byte_order, loading.padding)
    write_opening(out, LOADING, (loading.comment,), loading.n_geometry_zones, layout)
    out.ints(loading.data, loading.frame, 1, 0, 0, len(loading.zones), *loading.zone_numbers)
    write_zones(out, loading.zones)
    out.save(Path(path))
