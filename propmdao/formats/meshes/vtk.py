"""Surfaces with values on their cells, for ParaView: VTK's XML files.

A .vtu file is one moment, a .pvd file names those of several (VTK User's Guide, "XML File Formats";
the .pvd of ParaView). Arrays stand in the file as base64 of 32-bit numbers, so that it is small and
needs no library to write.
"""

from __future__ import annotations

import base64
import dataclasses
from collections.abc import Iterable, Mapping
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from propmdao.runtime.finite import require_finite
from propmdao.runtime.output_files import replacing

_QUAD = 9  # VTK's number of a cell with four corners
_TYPES = {"f": ("Float32", "<f4"), "i": ("Int32", "<i4"), "u": ("UInt8", "u1")}


@dataclasses.dataclass(frozen=True)
class QuadMesh:
    """Quadrilaterals in space, with values.

    Attributes
    ----------
    points : (n_points, 3) array
        Corners [m].
    quads : (n_quads, 4) array of int
        Corners of each quadrilateral, around it.
    values : mapping of str to (n_quads,) or (n_quads, 3) array
        Values of the quadrilaterals by name.
    """

    points: npt.NDArray[np.float64]
    quads: npt.NDArray[np.int64]
    values: Mapping[str, npt.NDArray[np.float64]]

    @classmethod
    def of_sheets(
        cls, nodes: npt.ArrayLike, values: Mapping[str, npt.NDArray[np.float64]]
    ) -> QuadMesh:
        """Make the mesh of sheets that are grids each.

        Parameters
        ----------
        nodes : (n_sheets, n_i, n_j, 3) array
            Nodes of the sheets [m].
        values : mapping of str to (n_sheets, n_i - 1, n_j - 1, ...) array
            Values of the quadrilaterals between the nodes; a last axis of 3 is a vector.

        Returns
        -------
        QuadMesh
            All sheets in one mesh.
        """
        nodes = np.asarray(nodes, float)
        number = np.arange(nodes[..., 0].size).reshape(nodes.shape[:3])
        corners = (
            number[:, :-1, :-1], number[:, :-1, 1:], number[:, 1:, 1:], number[:, 1:, :-1]
        )  # fmt: skip
        quads = np.stack(corners, axis=-1)
        of_quads = {
            name: np.asarray(value, float).reshape(-1, *np.shape(value)[3:])
            for name, value in values.items()
        }
        return cls(nodes.reshape(-1, 3), quads.reshape(-1, 4), of_quads)


def write_vtu(path: str | Path, mesh: QuadMesh) -> None:
    """Write a mesh as a file of VTK.

    Parameters
    ----------
    path : str or Path
        File to write, which should end in .vtu.
    mesh : QuadMesh
        The mesh.

    Raises
    ------
    NotFiniteError
        If a coordinate or a value is no number.
    ValueError
        If there are more or fewer values than quadrilaterals.
    OutputError
        If the file cannot be written.
    """
    require_finite("points", mesh.points)
    n = len(mesh.quads)
    for name, of_quads in mesh.values.items():
        if len(of_quads) != n:
            raise ValueError(
                f"{name} must have a value for each of {n} quads; it has {len(of_quads)}"
            )
        require_finite(name, of_quads)
    root = _file("UnstructuredGrid")
    root.set("header_type", "UInt32")  # of the number of bytes in front of each array
    grid = ElementTree.SubElement(root, "UnstructuredGrid")
    size = {"NumberOfPoints": str(len(mesh.points)), "NumberOfCells": str(n)}
    piece = ElementTree.SubElement(grid, "Piece", size)
    of_cells = ElementTree.SubElement(piece, "CellData")
    for name, of_quads in mesh.values.items():
        _add_array(of_cells, name, of_quads)
    _add_array(ElementTree.SubElement(piece, "Points"), "points", mesh.points)
    cells = ElementTree.SubElement(piece, "Cells")
    _add_array(cells, "connectivity", mesh.quads.astype("i4").ravel())
    _add_array(cells, "offsets", 4 * np.arange(1, n + 1, dtype="i4"))
    _add_array(cells, "types", np.full(n, _QUAD, "u1"))
    _write(path, root)


def write_pvd(path: str | Path, moments: Iterable[tuple[float, str]]) -> None:
    """Write the list of a series of files, which ParaView plays.

    Parameters
    ----------
    path : str or Path
        File to write, which should end in .pvd.
    moments : iterable of (float, str)
        Time [s], and file as seen from the folder of the list.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    root = _file("Collection")
    collection = ElementTree.SubElement(root, "Collection")
    for time, file in moments:
        ElementTree.SubElement(collection, "DataSet", timestep=repr(float(time)), file=file)
    _write(path, root)


def _file(kind: str) -> ElementTree.Element:
    """Outermost element of a file."""
    return ElementTree.Element("VTKFile", type=kind, version="1.0", byte_order="LittleEndian")


def _add_array(parent: ElementTree.Element, name: str, values: npt.NDArray[np.generic]) -> None:
    """Add an array: the number of its bytes and then they, as base64."""
    kind, code = _TYPES[values.dtype.kind]
    content = values.astype(code).tobytes()
    text = base64.b64encode(np.array(len(content), "<u4").tobytes() + content)
    element = ElementTree.SubElement(parent, "DataArray", type=kind, Name=name, format="binary")
    if values.ndim > 1:
        element.set("NumberOfComponents", str(values.shape[1]))
    element.text = text.decode()


def _write(path: str | Path, root: ElementTree.Element) -> None:
    """Write a file that is whole at any time."""
    with replacing(path) as file:
        ElementTree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)
