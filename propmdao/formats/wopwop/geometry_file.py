"""PSU-WOPWOP geometry ("patch") files, single precision, version 1.0."""

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


@dataclass(frozen=True)
class GeometryFile:
    """A geometry file.

    Attributes
    ----------
    zones : tuple of Zone
        Surfaces and lines, a line having one node in one of the two directions.
    units, comment : str
        Texts of at most 32 and 1024 characters.
    byte_order : str
        "<" little-endian or ">" big-endian.
    padding : bytes
        The byte that fills up texts.
    """

    zones: tuple[Zone, ...]
    units: str = "Pa"
    comment: str = ""
    byte_order: str = "<"
    padding: bytes = b" "


def read_geometry(path: str | Path) -> GeometryFile:
    """Read a geometry file.

    Parameters
    ----------
    path : str or Path
        Single precision; constant, periodic or aperiodic.

    Returns
    -------
    GeometryFile
        All of it, so that `write_geometry` gives back the same bytes.

    Raises
    ------
    WopwopFileError
        If the file is not such a file, is truncated or too long.
    """
    file = Reader(Path(path))
    file.version()
    units, comment = file.text(32), file.text(1024)
    file.expect(1, "file type (1 is a geometry)")
    n_zones = file.count("number of zones")
    grid, kind, at_faces = read_layout(file, "geometry")
    file.choose({1: "single"}, "precision")
    file.expect(0, "iblank flag")
    file.ints(1)
    headers = [read_header(file, kind, grid, True) for _ in range(n_zones)]
    zones = read_zones(file, headers, 3 if at_faces else 6, at_faces)
    return GeometryFile(zones, units, comment, file.byte_order, file.padding)


def write_geometry(path: str | Path, geometry: GeometryFile) -> None:
    """Write a geometry file.

    Parameters
    ----------
    path : str or Path
        Where to.
    geometry : GeometryFile
        All zones constant, all periodic or all aperiodic.

    Raises
    ------
    ValueError
        If the zones do not go together or a text is too long.
    """
    kind, zones = time_dependence(geometry.zones), geometry.zones
    at_faces = zones[0].normals_at_faces is not None
    out = Writer(geometry.byte_order, geometry.padding)
    out.ints(1, 0)
    out.text(geometry.units, 32)
    out.text(geometry.comment, 1024)
    out.ints(1, len(zones), grid_of(zones), kind, 2 if at_faces else 1, 1, 0, 0)
    write_zones(out, zones)
    out.save(Path(path))
