"""Files of VTK hold the mesh and its values."""

from __future__ import annotations

import base64
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from propmdao.formats.meshes.vtk import QuadMesh, write_pvd, write_vtu

TYPES = {"Float32": "<f4", "Int32": "<i4", "UInt8": "u1"}


def arrays_of(path: Path) -> dict[str, np.ndarray]:
    """Arrays of a file as VTK reads them: length in bytes, then the numbers."""
    root = ElementTree.parse(path).getroot()
    assert root.attrib["type"] == "UnstructuredGrid" and root.attrib["header_type"] == "UInt32"
    arrays = {}
    for element in root.iter("DataArray"):
        content = base64.b64decode(element.text or "", validate=True)
        assert int(np.frombuffer(content[:4], "<u4")[0]) == len(content) - 4
        values = np.frombuffer(content[4:], TYPES[element.attrib["type"]])
        n = int(element.get("NumberOfComponents", "1"))
        arrays[element.attrib["Name"]] = values.reshape(-1, n) if n > 1 else values
    piece = next(root.iter("Piece"))
    assert int(piece.attrib["NumberOfPoints"]) == len(arrays["points"])
    assert int(piece.attrib["NumberOfCells"]) == len(arrays["types"])
    return arrays


def sheets() -> QuadMesh:
    """Two sheets of 2 x 1 quads, at z 0 and 1."""
    x, y = np.meshgrid([0.0, 1.0, 2.0], [0.0, 3.0], indexing="ij")
    nodes = np.stack([np.stack([x, y, np.full_like(x, z)], axis=-1) for z in (0.0, 1.0)])
    load = np.arange(4.0).reshape(2, 2, 1)
    return QuadMesh.of_sheets(nodes, {"load": load, "force": load[..., None] * [1.0, 0.0, -1.0]})


def test_a_mesh_is_read_back(tmp_path: Path) -> None:
    write_vtu(tmp_path / "sheets.vtu", sheets())
    read = arrays_of(tmp_path / "sheets.vtu")
    np.testing.assert_array_equal(read["points"], sheets().points)
    quads = read["points"][read["connectivity"].reshape(-1, 4)]
    # Around each quad: opposite sides are equal and opposite.
    np.testing.assert_array_equal(quads[:, 1] - quads[:, 0], quads[:, 2] - quads[:, 3])
    np.testing.assert_array_equal(quads.mean(axis=1)[:, 0], [0.5, 1.5, 0.5, 1.5])
    np.testing.assert_array_equal(quads.mean(axis=1)[:, 2], [0.0, 0.0, 1.0, 1.0])
    assert read["offsets"].tolist() == [4, 8, 12, 16] and read["types"].tolist() == [9] * 4
    assert read["load"].tolist() == [0.0, 1.0, 2.0, 3.0]
    assert read["force"].tolist() == [[k, 0.0, -k] for k in range(4)]


def test_what_is_no_number_or_has_no_quad_is_refused(tmp_path: Path) -> None:
    mesh, path = sheets(), tmp_path / "sheets.vtu"
    with pytest.raises(ValueError, match="load must have a value for each of 4 quads; it has 3"):
        write_vtu(path, QuadMesh(mesh.points, mesh.quads, {"load": np.zeros(3)}))
    with pytest.raises(ValueError, match="load"):
        write_vtu(path, QuadMesh(mesh.points, mesh.quads, {"load": np.full(4, np.nan)}))
    assert not path.exists()


def test_a_series_names_its_files_in_time(tmp_path: Path) -> None:
    write_pvd(tmp_path / "wake.pvd", [(0.0, "wake_0.vtu"), (0.25, "wake_1.vtu")])
    root = ElementTree.parse(tmp_path / "wake.pvd").getroot()
    assert root.attrib["type"] == "Collection"
    assert [element.attrib for element in root.iter("DataSet")] == [
        {"timestep": "0.0", "file": "wake_0.vtu"},
        {"timestep": "0.25", "file": "wake_1.vtu"},
    ]
