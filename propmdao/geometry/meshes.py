"""The two meshes of a blade: vortex lattice and surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.geometry.blade import Blade, SpanInterpolation, span_interpolation
from propmdao.geometry.lattice import lattice_nodes, lattice_span
from propmdao.geometry.surface import surface_nodes, surface_span
from propmdao.records.pytrees import record

if TYPE_CHECKING:
    from propmdao.propeller.description import Propeller


@record
class MeshRadii:
    """Where along the span the meshes of a blade have their nodes.

    Attributes
    ----------
    lattice, surface : SpanInterpolation
        From the blade's stations to the radii of either mesh.
    """

    lattice: SpanInterpolation
    surface: SpanInterpolation


def mesh_radii(
    stations: npt.NDArray[np.float64], n_spanwise: int, n_surface_span: int
) -> MeshRadii:
    """Radii of both meshes.

    Parameters
    ----------
    stations : (n_stations,) array
        r/R of the blade's stations.
    n_spanwise, n_surface_span : int
        Panels of the lattice and of the surface along the span.

    Returns
    -------
    MeshRadii
        Interpolation from the stations.
    """
    root = float(stations[0])
    return MeshRadii(
        span_interpolation(stations, lattice_span(root, n_spanwise)),
        span_interpolation(stations, surface_span(root, n_surface_span)),
    )


def blade_meshes(
    blade: Blade, radii: MeshRadii, n_chordwise: int, n_contour: int
) -> tuple[Array, Array]:
    """Nodes of both meshes.

    Parameters
    ----------
    blade : Blade
        The blade.
    radii : MeshRadii
        Where the nodes are along the span.
    n_chordwise, n_contour : int
        Lattice panels over the chord, surface points around the section.

    Returns
    -------
    lattice : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice, leading edge and root first [m].
    surface : (n_contour, n_surface_span, 3) array
        Points of the section contours [m].
    """
    return (
        lattice_nodes(blade, radii.lattice, n_chordwise),
        surface_nodes(blade, radii.surface, n_contour),
    )


def propeller_surface(propeller: Propeller, n_contour: int, n_surface_span: int) -> Array:
    """Nodes of the surface of a described propeller.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    n_contour, n_surface_span : int
        Points around the section and along the span.

    Returns
    -------
    (n_contour, n_surface_span, 3) array
        Points of the section contours of blade 1 [m].
    """
    stations = propeller.r_over_R
    span = span_interpolation(stations, surface_span(stations[0], n_surface_span))
    return surface_nodes(Blade.from_propeller(propeller), span, n_contour)
