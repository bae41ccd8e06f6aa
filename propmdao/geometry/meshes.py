"""The two meshes of a blade: vortex lattice and surface."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes, strip_interpolation
from propmdao.geometry.surface import surface_interpolation, surface_nodes, surface_panels
from propmdao.propeller.description import Propeller
from propmdao.records.panels import Panels
from propmdao.records.pytrees import record


@record
class MeshRadii:
    """Interpolation from a blade's stations to all radii of its meshes.

    Attributes
    ----------
    lattice : SpanInterpolation
        Interpolation to the chordwise edges of the vortex lattice.
    strips : SpanInterpolation
        Interpolation to the middle of the lattice's strips, where the section polars belong.
    surface : SpanInterpolation
        Interpolation to the contours of the surface.
    """

    lattice: SpanInterpolation
    strips: SpanInterpolation
    surface: SpanInterpolation


def mesh_radii(
    stations: npt.NDArray[np.float64], n_spanwise: int, n_surface_span: int
) -> MeshRadii:
    """Build the interpolation to the radii of both meshes; call it outside ``jit``.

    Parameters
    ----------
    stations : (n_stations,) array
        r/R of the blade's stations.
    n_spanwise, n_surface_span : int
        Panels of the lattice and contours of the surface along the span.

    Returns
    -------
    MeshRadii
        Interpolation from the stations.
    """
    return _mesh_radii(np.asarray(stations, float).tobytes(), n_spanwise, n_surface_span)


@functools.lru_cache(maxsize=64)  # the stations of a design stay; splines take as long as its noise
def _mesh_radii(station_bytes: bytes, n_spanwise: int, n_surface_span: int) -> MeshRadii:
    stations = np.frombuffer(station_bytes)
    return MeshRadii(
        lattice=lattice_interpolation(stations, n_spanwise),
        strips=strip_interpolation(stations, n_spanwise),
        surface=surface_interpolation(stations, n_surface_span),
    )


class BladeMeshes(NamedTuple):
    """Nodes of both meshes of blade 1, at azimuth 0.

    Attributes
    ----------
    lattice : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice, leading edge and root first [m].
    surface : (n_contour, n_surface_span, 3) array
        Points of the section contours [m].
    """

    lattice: Array
    surface: Array

    @property
    def panels(self) -> Panels:
        """Panels of the closed surface."""
        return surface_panels(self.surface)


def blade_meshes(blade: Blade, radii: MeshRadii, n_chordwise: int, n_contour: int) -> BladeMeshes:
    """Lay out both meshes of a blade.

    Parameters
    ----------
    blade : Blade
        The blade.
    radii : MeshRadii
        Interpolation to the radii of the meshes.
    n_chordwise, n_contour : int
        Lattice panels over the chord, surface points around the section; static under ``jit``.

    Returns
    -------
    BladeMeshes
        Nodes of lattice and surface.
    """
    return BladeMeshes(
        lattice=lattice_nodes(blade, radii.lattice, n_chordwise),
        surface=surface_nodes(blade, radii.surface, n_contour),
    )


def propeller_surface(propeller: Propeller, n_contour: int, n_surface_span: int) -> Array:
    """Lay out the surface of a described propeller.

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
    span = surface_interpolation(propeller.r_over_R, n_surface_span)
    return surface_nodes(Blade.from_propeller(propeller), span, n_contour)
