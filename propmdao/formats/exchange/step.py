"""Solid blades as STEP files, by the CAD kernel Open CASCADE (extra ``cad``).

Each blade is a loft of its section contours, closed by its trailing edge and by flat caps at root
and tip. A hub is a cylinder about the shaft, to which the root sections are carried straight and
fused. Beside the solids the file has the contours of blade 1 at its stations as curves in space,
for whoever builds the blade anew. Lengths are in millimetres, which STEP files say.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.geometry.blade import Blade, SpanInterpolation, span_interpolation
from propmdao.geometry.surface import surface_interpolation, surface_nodes
from propmdao.propeller.description import Propeller
from propmdao.runtime.output_files import OutputError, replacing
from propmdao.runtime.terminal import printable

FloatArray = npt.NDArray[np.float64]

#: Contours along the blade and points around each.
_N_SPAN, _N_CONTOUR = 40, 65
_MILLIMETRES = 1000.0
#: Least thickness of a trailing edge over the tip radius: a face needs two edges, and the kernel
#: does not fuse thinner ones with a hub.
_LEAST_EDGE, _LEAST_EDGE_OF_HUB = 2e-5, 2e-4
#: Points are met to this [mm].
_TOLERANCE = 1e-6


def export_step(path: str | Path, propeller: Propeller, hub: tuple[float, float] | None) -> int:
    """Write the blades, and a hub, as solids.

    Parameters
    ----------
    path : str or Path
        File to write.
    propeller : Propeller
        Propeller to write.
    hub : (float, float) or None
        Diameter and height of the hub [mm], about the shaft and as far above the rotor plane as
        below; None leaves the blades apart.

    Returns
    -------
    int
        Number of solids.

    Raises
    ------
    ValueError
        If the CAD kernel is not installed, or a root section does not end within the hub.
    OutputError
        If the file cannot be written.
    """
    solids = rotor_solids(propeller, hub)
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

    curves = section_curves(propeller)
    _say_warnings_alone()
    writer = STEPControl_Writer()
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    Interface_Static.SetCVal_s("write.step.product.name", printable(propeller.name))
    for shape in [*solids, curves]:
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
    with replacing(path) as file:
        if writer.Write(str(file)) != IFSelect_ReturnStatus.IFSelect_RetDone:
            raise OutputError(f"{path}: the CAD kernel could not write it")
    return len(solids)


def rotor_solids(propeller: Propeller, hub: tuple[float, float] | None) -> list[Any]:
    """Build the solids of a propeller.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    hub : (float, float) or None
        Diameter and height of the hub [mm]; None leaves the blades apart.

    Returns
    -------
    list of OCP.TopoDS.TopoDS_Shape
        The blades, or the one solid of blades and hub [mm].

    Raises
    ------
    ValueError
        If the CAD kernel is not installed, a root section does not end within the hub, or the
        kernel cannot fuse blades and hub.
    """
    _require_kernel()
    span = surface_interpolation(propeller.r_over_R, _N_SPAN)
    nodes = _nodes(propeller, span, _LEAST_EDGE if hub is None else _LEAST_EDGE_OF_HUB)
    if hub is not None:
        _require_hub(nodes[0], *hub)
    blade = _loft(nodes)
    angles = 2.0 * np.pi * np.arange(propeller.n_blades) / propeller.n_blades
    if hub is None:
        return [_turned(blade, angle) for angle in angles]
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
    from OCP.collections import List_TopoDS_Shape
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

    diameter, height = hub
    foot = _loft(np.stack([nodes[0] * [0.0, 1.0, 1.0], nodes[0]]), ruled=True)
    axis = gp_Ax2(gp_Pnt(0.0, 0.0, -0.5 * height), gp_Dir(0.0, 0.0, 1.0))
    first, others = List_TopoDS_Shape(), List_TopoDS_Shape()
    first.Append(BRepPrimAPI_MakeCylinder(axis, 0.5 * diameter, height).Shape())
    for angle in angles:
        for part in (foot, blade):
            others.Append(_turned(part, angle))
    fuse = BRepAlgoAPI_Fuse()
    fuse.SetArguments(first)
    fuse.SetTools(others)
    fuse.Build()
    solids = _solids_of(fuse.Shape())
    if len(solids) != 1 or not BRepCheck_Analyzer(solids[0]).IsValid():
        raise ValueError(
            f"hub: the CAD kernel could not fuse the blades of {propeller.name} with a hub of "
            f"{diameter:g} by {height:g} mm; write them without --hub, or try another one"
        )
    return solids


def section_curves(propeller: Propeller) -> Any:
    """Draw the contours of blade 1 at its stations as curves in space.

    Parameters
    ----------
    propeller : Propeller
        The propeller.

    Returns
    -------
    OCP.TopoDS.TopoDS_Compound
        Closed wires [mm], each a spline through the contour and the line of the trailing edge.

    Raises
    ------
    ValueError
        If the CAD kernel is not installed.
    """
    _require_kernel()
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Compound

    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    span = span_interpolation(propeller.r_over_R, propeller.r_over_R)
    for contour in _nodes(propeller, span, _LEAST_EDGE):
        builder.Add(compound, _wire(contour))
    return compound


def _require_kernel() -> None:
    """Refuse what needs the CAD kernel where it is not installed."""
    try:
        from OCP.collections import HArray1_gp_Pnt  # noqa: F401 - of version 8
    except ImportError:
        raise ValueError(
            "STEP files need the CAD kernel, version 8 or newer: pip install 'propmdao[cad]'"
        ) from None


def _say_warnings_alone() -> None:
    """Keep the kernel from printing its statistics."""
    from OCP.Message import Message, Message_Gravity

    for printer in Message.DefaultMessenger_s().Printers():
        printer.SetTraceLevel(Message_Gravity.Message_Warning)


def _nodes(propeller: Propeller, span: SpanInterpolation, least_edge: float) -> FloatArray:
    """Contours [mm], (n_span, n_contour, 3), with trailing edges of at least this over R."""
    nodes = np.asarray(surface_nodes(Blade.from_propeller(propeller), span, _N_CONTOUR))
    nodes = _MILLIMETRES * nodes.swapaxes(0, 1)
    angle = np.linspace(np.pi, -np.pi, _N_CONTOUR)
    share = np.sign(np.round(angle, 12)) * 0.25 * (1.0 - np.cos(angle))
    chord = 0.5 * (nodes[:, 0] + nodes[:, -1]) - nodes[:, _N_CONTOUR // 2]
    chord /= np.linalg.norm(chord, axis=1)[:, None]
    normal = np.stack([0.0 * chord[:, 0], chord[:, 2], -chord[:, 1]], axis=1)
    gap = np.linalg.norm(nodes[:, 0] - nodes[:, -1], axis=1)
    missing = np.maximum(0.5 * least_edge * _MILLIMETRES * propeller.diameter - gap, 0.0)
    opened: FloatArray = nodes + (missing[:, None] * share)[..., None] * normal[:, None]
    return opened


def _require_hub(root: FloatArray, diameter: float, height: float) -> None:
    """Refuse a hub that the root section, carried straight to the shaft, sticks out of."""
    least = 2.0 * np.abs(root[:, 1:]).max(axis=0)
    most = 2.0 * root[0, 0]
    if least[0] >= most:
        raise ValueError(
            f"no hub holds this blade: its root section is {least[0]:.4g} mm wide about the "
            f"shaft's plane, the blade begins at a diameter of {most:.4g} mm"
        )
    if not least[0] < diameter <= most:
        raise ValueError(
            f"hub: the diameter must be above {least[0]:.4g} mm, which the root section is wide, "
            f"and at most {most:.4g} mm, where the blade begins; it is {diameter:g}"
        )
    if not height > least[1]:
        raise ValueError(
            f"hub: the height must be above {least[1]:.4g} mm, for the root section to end within "
            f"it; it is {height:g}"
        )


def _wire(contour: FloatArray) -> Any:
    """Wire of a closed contour, (n_contour, 3)."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeWire
    from OCP.collections import HArray1_gp_Pnt
    from OCP.GeomAPI import GeomAPI_Interpolate
    from OCP.gp import gp_Pnt

    points = HArray1_gp_Pnt(1, len(contour))
    for number, point in enumerate(contour, start=1):
        points.SetValue(number, gp_Pnt(*map(float, point)))
    spline = GeomAPI_Interpolate(points, False, _TOLERANCE)
    spline.Perform()
    side = BRepBuilderAPI_MakeEdge(spline.Curve()).Edge()
    edge = BRepBuilderAPI_MakeEdge(points.Value(len(contour)), points.Value(1)).Edge()
    return BRepBuilderAPI_MakeWire(side, edge).Wire()


def _loft(contours: FloatArray, *, ruled: bool = False) -> Any:
    """Solid through contours, (n_span, n_contour, 3), straight between them if ruled."""
    from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections

    loft = BRepOffsetAPI_ThruSections(True, ruled, _TOLERANCE)
    loft.CheckCompatibility(False)  # all contours have the same points in the same order
    for contour in contours:
        loft.AddWire(_wire(contour))
    loft.Build()
    return loft.Shape()


def _turned(shape: Any, angle: float) -> Any:
    """A shape turned about the shaft."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp, gp_Trsf

    turn = gp_Trsf()
    turn.SetRotation(gp.OZ_s(), float(angle))
    return BRepBuilderAPI_Transform(shape, turn, True).Shape()


def _solids_of(shape: Any) -> list[Any]:
    """Solids that a shape is made of."""
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer

    solids, explorer = [], TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_SOLID)
    while explorer.More():
        solids.append(explorer.Current())
        explorer.Next()
    return solids
