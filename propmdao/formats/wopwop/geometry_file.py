"""PSU-WOPWOP geometry ("patch") files, single precision, version 1.0."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from propmdao.formats.wopwop.binary import GEOMETRY, Reader, Writer, read_opening, write_opening
from propmdao.formats.wopwop.zones import Zone, layout_of, read_header, read_zones, write_zones


@dataclass(frozen=True)
class GeometryFile:
    """Contents of a geometry file.

    Attributes
    ----------
    zones : tuple of Zone
        Surfaces and lines, a line having one node in one of the two directions.
    units, comment : str
        Texts of at most 32 and 1024 characters.
    byte_order : str
        Byte order: "<" little-endian or ">" big-endian.
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
        File in single precision; constant, periodic or aperiodic.

    Returns
    -------
    GeometryFile
        All that the file holds, so that `write_geometry` gives back the same bytes.

    Raises
    ------
    WopwopFileError
        If the file is not a geometry file, is truncated or too long.
    """
    file = Reader(Path(path))
    (units, comment), n_zones, layout = read_opening(file, GEOMETRY)
    file.choose({1: "single"}, "precision")
    file.expect(0, "iblank flag")
    file.ints(1)
    headers = [read_header(file, layout, has_faces=True) for _ in range(n_zones)]
    zones = read_zones(file, headers, 3 if layout.at_faces else 6, layout.at_faces)
    return GeometryFile(zones, units, comment, file.byte_order, file.padding)


def write_geometry(path: str | Path, geometry: GeometryFile) -> None:
    """Write a geometry file.

    Parameters
    ----------
    path : str or Path
        File to write.
    geometry : GeometryFile
        Contents of the file: all zones are constant, periodic or aperiodic.

    Raises
    ------
    ValueError
        If the zones do not go together or a text is too long.
    """
    zones = geometry.zones
    layout = layout_of(zones, at_faces=any(zone.normals_at_faces is not None for zone in zones))
    out = Writer(geometry.byte_order, geometry.padding)
    write_opening(out, GEOMETRY, (geometry.units, geometry.comment), len(zones), layout)
    out.ints(1, 0, 0)  # single precision, no iblank values
    write_zones(out, zones)
    out.save(Path(path))
