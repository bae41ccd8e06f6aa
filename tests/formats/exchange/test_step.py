"""Solid blades by the CAD kernel: closed, volume and box of our surface, hubs, curves."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest

from propmdao.formats.exchange import step
from propmdao.formats.exchange.step import export_step, rotor_solids, section_curves
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.meshes import propeller_surface
from propmdao.geometry.surface import surface_nodes, surface_panels
from propmdao.propeller.description import Propeller

BLADE = Propeller(
    name="blade",
    diameter=0.2,
    n_blades=2,
    r_over_R=np.array([0.2, 0.5, 0.8, 1.0]),
    c_over_R=np.array([0.16, 0.2, 0.15, 0.08]),
    beta_deg=np.array([30.0, 18.0, 11.0, 9.0]),
    airfoils=[(0.2, "naca4412"), (1.0, "naca2408")],
    sweep_over_R=np.array([0.0, -0.02, 0.0, 0.05]),
    rake_over_R=np.array([0.0, 0.0, 0.01, 0.03]),
)
RADIUS = 100.0  # mm

needs_kernel = pytest.mark.skipif(
    importlib.util.find_spec("OCP") is None, reason="the CAD kernel (extra cad) is not installed"
)


@pytest.fixture(scope="module", autouse=True)
def coarse() -> Any:
    """Fewer contours than a file has."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(step, "_N_SPAN", 16)
        yield


def volume(shape: Any) -> float:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.VolumePropertiesGK_s(shape, properties, 1e-5)
    return float(properties.Mass())


def box(shape: Any) -> np.ndarray:
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    bounds = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, bounds, False, False)
    corners = bounds.CornerMin(), bounds.CornerMax()
    return np.array([[c.X(), c.Y(), c.Z()] for c in corners])


def is_closed(shape: Any) -> bool:
    """A valid solid whose shells have no free edge."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    shells = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_SHELL)
    closed = []
    while shells.More():
        closed.append(BRep_Tool.IsClosed_s(shells.Current()))
        shells.Next()
    return bool(closed) and all(closed) and BRepCheck_Analyzer(shape).IsValid()


def read_back(path: Path) -> Any:
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    reader.TransferRoots()
    return reader.OneShape()


def count(shape: Any, kind: str) -> int:
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    found = TopExp_Explorer(shape, getattr(TopAbs_ShapeEnum, f"TopAbs_{kind}"))
    n = 0
    while found.More():
        n += 1
        found.Next()
    return n


@pytest.fixture(scope="module")
def solids(coarse: Any) -> list[Any]:
    """Both blades, without a hub."""
    return rotor_solids(BLADE, None)


@pytest.fixture(scope="module")
def volumes(solids: list[Any]) -> list[float]:
    """Those of both blades."""
    return [volume(blade) for blade in solids]


@needs_kernel
def test_blades_are_closed_and_as_large_as_our_surface(
    solids: list[Any], volumes: list[float]
) -> None:
    nodes = 1000.0 * np.asarray(propeller_surface(BLADE, 129, 60))
    panels = jax.jit(surface_panels)(nodes)
    ours = float(np.sum(np.asarray(panels.center) * panels.vector_area)) / 3.0
    first, second = solids
    assert is_closed(first) and is_closed(second)
    assert volumes[0] == pytest.approx(ours, rel=2e-3)
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-9)
    points = nodes.reshape(-1, 3)
    np.testing.assert_allclose(box(first), [points.min(axis=0), points.max(axis=0)], atol=0.02)
    # The second blade is the first, turned by half a turn.
    turned = points * [-1.0, -1.0, 1.0]
    np.testing.assert_allclose(box(second), [turned.min(axis=0), turned.max(axis=0)], atol=0.02)


@needs_kernel
def test_a_hub_makes_one_solid(volumes: list[float]) -> None:
    (whole,) = rotor_solids(BLADE, (24.0, 14.0))
    assert is_closed(whole)
    cylinder = np.pi * 12.0**2 * 14.0
    blades = sum(volumes)
    # Between hub and root there are the straight feet, 8 mm at their middle.
    span = span_interpolation(BLADE.r_over_R, BLADE.r_over_R[:1])
    root = RADIUS * 10.0 * np.asarray(surface_nodes(Blade.from_propeller(BLADE), span, 129))[:, 0]
    y, z = root[:, 1], root[:, 2]
    area = 0.5 * abs(float(y @ np.roll(z, 1) - z @ np.roll(y, 1)))
    inner = np.sqrt(12.0**2 - y**2).mean()
    expected = cylinder + blades + 2.0 * area * (0.2 * RADIUS - inner)
    assert volume(whole) == pytest.approx(expected, rel=0.01)
    np.testing.assert_allclose(box(whole)[:, 2], [-7.0, 7.0], atol=1e-6)


@needs_kernel
def test_a_file_is_read_back_with_its_curves_in_millimetres(
    solids: list[Any], tmp_path: Path
) -> None:
    assert export_step(tmp_path / "blade.step", BLADE, None) == 2
    back = read_back(tmp_path / "blade.step")
    assert count(back, "SOLID") == 2
    # A spline and a line for each station beside the edges of the faces.
    of_faces = sum(count(solid, "EDGE") for solid in solids)
    assert count(back, "EDGE") - of_faces == 2 * BLADE.r_over_R.size
    np.testing.assert_allclose(box(back)[:, 0], [-RADIUS, RADIUS], atol=1e-3)
    assert "MILLI" in (tmp_path / "blade.step").read_text()


@needs_kernel
def test_curves_lie_on_the_stations() -> None:
    curves = section_curves(BLADE)
    assert count(curves, "WIRE") == 4 and count(curves, "EDGE") == 8
    np.testing.assert_allclose(box(curves)[:, 0], [0.2 * RADIUS, RADIUS], atol=1e-3)


@needs_kernel
def test_the_kernel_prints_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    export_step(tmp_path / "blade.stp", BLADE, None)
    assert capfd.readouterr() == ("", "")


@needs_kernel
@pytest.mark.parametrize(
    ("hub", "message"),
    [
        ((8.0, 12.0), "hub: the diameter must be above 20.8 mm"),
        ((50.0, 12.0), "and at most 40 mm, where the blade begins; it is 50"),
        ((24.0, 1.0), "hub: the height must be above"),
    ],
)
def test_a_hub_that_does_not_hold_the_blade_is_refused(
    hub: tuple[float, float], message: str
) -> None:
    with pytest.raises(ValueError, match=message) as caught:
        rotor_solids(BLADE, hub)
    assert "\n" not in str(caught.value)


def test_without_the_kernel_there_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "OCP.collections", None)
    with pytest.raises(ValueError, match=r"^STEP files need the CAD kernel.*propmdao\[cad\]'$"):
        export_step(tmp_path / "blade.step", BLADE, None)
    assert not list(tmp_path.iterdir())


@needs_kernel
def test_a_mesh_of_the_solid_is_watertight(
    solids: list[Any], volumes: list[float], tmp_path: Path
) -> None:
    """The tessellation in another library's eyes."""
    trimesh = pytest.importorskip("trimesh")
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.StlAPI import StlAPI_Writer

    blade = solids[0]
    BRepMesh_IncrementalMesh(blade, 0.05, False, 0.3, False)
    StlAPI_Writer().Write(blade, str(tmp_path / "blade.stl"))
    mesh = trimesh.load_mesh(tmp_path / "blade.stl")
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(volumes[0], rel=0.01)
