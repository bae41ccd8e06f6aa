"""The blade's outer surface: closed section contours over span, capped at root and tip."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.geometry.blade import Blade, SpanInterpolation, span_interpolation
from propmdao.geometry.lattice import lattice_span
from propmdao.geometry.section import place_sections, section_shape
from propmdao.propeller.airfoils.airfoil import chord_interpolation
from propmdao.records.panels import Panels


def surface_span(root_r_over_R: float, n_span: int) -> npt.NDArray[np.float64]:
    """Radii of the section contours, cosine spaced toward root and tip.

    Parameters
    ----------
    root_r_over_R : float
        Radius at which the blade begins, r/R.
    n_span : int
        Number of contours (OpenVSP's Tess_U), at least 2.

    Returns
    -------
    (n_span,) array
        r/R from the root to 1.

    Raises
    ------
    ValueError
        If the root is not above 0 and below 1, or there are fewer than two contours.
    """
    if n_span < 2:
        raise ValueError(f"n_span must be at least 2; got {n_span}")
    return lattice_span(root_r_over_R, n_span - 1)


def surface_interpolation(stations: npt.NDArray[np.float64], n_span: int) -> SpanInterpolation:
    """Build the interpolation from a blade's stations to the contours of its surface.

    Parameters
    ----------
    stations : (n_stations,) array
        r/R of the blade's stations; the first is the root.
    n_span : int
        Number of contours, at least 2.

    Returns
    -------
    SpanInterpolation
        Interpolation to the n_span radii of `surface_span`.
    """
    return span_interpolation(stations, surface_span(stations[0], n_span))


def surface_nodes(blade: Blade, span: SpanInterpolation, n_contour: int = 65) -> jax.Array:
    """Points of the section contours.

    Parameters
    ----------
    blade : Blade
        The blade.
    span : SpanInterpolation
        Interpolation to the n_span radii of `surface_span`.
    n_contour : int
        Points around each section (OpenVSP's Tess_W), odd so that the leading edge is one of
        them; static under ``jit``.

    Returns
    -------
    (n_contour, n_span, 3) array
        Positions in the blade frame at azimuth 0 [m], from the trailing edge over the upper
        (suction) side to the leading edge and back along the lower side, cosine spaced.

    Raises
    ------
    ValueError
        If `n_contour` is even or less than 5.
    """
    if n_contour < 5 or n_contour % 2 == 0:
        raise ValueError(f"n_contour must be odd and at least 5; got {n_contour}")
    angle = np.linspace(np.pi, -np.pi, n_contour)
    camber, thickness = section_shape(blade, span, jnp.asarray(chord_interpolation(np.abs(angle))))
    side = jnp.asarray(0.5 * np.sign(np.round(angle, 12)))[:, None]
    fraction = jnp.asarray(0.5 * (1.0 - np.cos(angle)))
    return place_sections(blade, span, fraction, camber + side * thickness)


def surface_quads(nodes: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array, jax.Array]:
    """Close the contours into a watertight surface of quadrilaterals.

    Parameters
    ----------
    nodes : (n_contour, n_span, 3) array
        Points of the section contours, as `surface_nodes` makes them [m].

    Returns
    -------
    a, b, c, d : (n, 3) arrays
        Corners [m], counter-clockwise seen from outside: n_contour * (n_span - 1) of the skin, the
        one across the trailing edge included (without area where that is sharp), then
        (n_contour - 1) / 2 across the root and as many across the tip.
    """
    around = jnp.concatenate([nodes, nodes[:1]])
    half = (nodes.shape[0] - 1) // 2
    upper, lower = nodes[: half + 1], nodes[half:][::-1]
    skin = around[:-1, :-1], around[:-1, 1:], around[1:, 1:], around[1:, :-1]
    root = upper[:-1, 0], upper[1:, 0], lower[1:, 0], lower[:-1, 0]
    tip = upper[:-1, -1], lower[:-1, -1], lower[1:, -1], upper[1:, -1]
    a, b, c, d = (
        jnp.concatenate([corner.reshape(-1, 3), at_root, at_tip])
        for corner, at_root, at_tip in zip(skin, root, tip, strict=True)
    )
    return a, b, c, d


def surface_panels(nodes: jax.Array) -> Panels:
    """Compute the panels of the watertight surface.

    Parameters
    ----------
    nodes : (n_contour, n_span, 3) array
        Points of the section contours, as `surface_nodes` makes them [m].

    Returns
    -------
    Panels
        Centres and area vectors, in the order of `surface_quads`.
    """
    a, b, c, d = surface_quads(nodes)
    return Panels(center=0.25 * (a + b + c + d), vector_area=0.5 * jnp.cross(c - a, d - b))
