"""The vortex lattice on the camber surface: its radii along the span, its corner points."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.geometry.blade import Blade, SpanInterpolation, span_interpolation
from propmdao.geometry.section import place_sections, section_shape
from propmdao.propeller.airfoils.airfoil import chord_interpolation


def lattice_span(root_r_over_R: float, n_spanwise: int) -> npt.NDArray[np.float64]:
    """Radii of the lattice's chordwise edges, cosine spaced toward root and tip.

    Parameters
    ----------
    root_r_over_R : float
        Radius at which the blade begins, r/R.
    n_spanwise : int
        Number of panels over the span.

    Returns
    -------
    (n_spanwise + 1,) array
        r/R from the root to 1.

    Raises
    ------
    ValueError
        If the root is not above 0 and below 1, or there is no panel.
    """
    if not 0.0 < root_r_over_R < 1.0:
        raise ValueError(f"root_r_over_R must be above 0 and below 1; got {root_r_over_R}")
    if n_spanwise < 1:
        raise ValueError(f"n_spanwise must be at least 1; got {n_spanwise}")
    angle = np.linspace(0.0, np.pi, n_spanwise + 1)
    spacing = 0.5 * (1.0 - np.cos(angle))
    return root_r_over_R + (1.0 - root_r_over_R) * spacing


def strip_middle(n_spanwise: int) -> npt.NDArray[np.float64]:
    """Position of the collocation and force points in each strip, as a fraction root to tip.

    The points lie at the middle of the cosine angle, not of the strip: there Glauert's integral is
    exact for the trailing vortices of cosine-spaced strips (Lan, J. Aircraft 11, 1974). Points in
    the middle of the strip need 48 strips where these need 12.

    Parameters
    ----------
    n_spanwise : int
        Number of strips, cosine spaced toward root and tip.

    Returns
    -------
    (n_spanwise,) array
        Fractions between 0 and 1.
    """
    angle = np.linspace(0.0, np.pi, 2 * n_spanwise + 1)
    x = 0.5 * (1.0 - np.cos(angle))
    edge, middle = x[::2], x[1::2]
    fractions: npt.NDArray[np.float64] = (middle - edge[:-1]) / np.diff(edge)
    return fractions


def strip_radii(root_r_over_R: float, n_spanwise: int) -> npt.NDArray[np.float64]:
    """Radii of the collocation points of an unswept blade, where the section polars belong.

    Parameters
    ----------
    root_r_over_R : float
        Radius at which the blade begins, r/R.
    n_spanwise : int
        Number of strips of the lattice.

    Returns
    -------
    (n_spanwise,) array
        r/R of the middle of each strip, as `strip_middle` defines it.
    """
    edge, f = lattice_span(root_r_over_R, n_spanwise), strip_middle(n_spanwise)
    middle: npt.NDArray[np.float64] = (1.0 - f) * edge[:-1] + f * edge[1:]
    return middle


def lattice_interpolation(stations: npt.NDArray[np.float64], n_spanwise: int) -> SpanInterpolation:
    """Build the interpolation from a blade's stations to the chordwise edges of its lattice.

    Parameters
    ----------
    stations : (n_stations,) array
        r/R of the blade's stations; the first is the root.
    n_spanwise : int
        Number of panels over the span.

    Returns
    -------
    SpanInterpolation
        Interpolation to the n_spanwise + 1 radii of `lattice_span`.
    """
    return span_interpolation(stations, lattice_span(stations[0], n_spanwise))


def strip_interpolation(stations: npt.NDArray[np.float64], n_spanwise: int) -> SpanInterpolation:
    """Build the interpolation from a blade's stations to the strips of its lattice.

    Parameters
    ----------
    stations : (n_stations,) array
        r/R of the blade's stations; the first is the root.
    n_spanwise : int
        Number of strips of the lattice.

    Returns
    -------
    SpanInterpolation
        Interpolation to the n_spanwise radii of `strip_radii`.
    """
    return span_interpolation(stations, strip_radii(stations[0], n_spanwise))


def lattice_chord_fraction(n_chordwise: int) -> npt.NDArray[np.float64]:
    """Chord fractions of the lattice's spanwise edges, cosine spaced toward both edges.

    Parameters
    ----------
    n_chordwise : int
        Number of panels over the chord.

    Returns
    -------
    (n_chordwise + 1,) array
        Fractions that rise from 0 at the leading edge to 1 at the trailing edge.
    """
    return 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, n_chordwise + 1)))


def lattice_nodes(blade: Blade, span: SpanInterpolation, n_chordwise: int) -> jax.Array:
    """Corner points of the vortex lattice on the camber surface.

    Parameters
    ----------
    blade : Blade
        The blade.
    span : SpanInterpolation
        Interpolation to the n_spanwise + 1 radii of `lattice_span`.
    n_chordwise : int
        Number of panels over the chord, static under ``jit``.

    Returns
    -------
    (n_chordwise + 1, n_spanwise + 1, 3) array
        Positions in the blade frame at azimuth 0 [m]; row 0 is the leading edge, column 0 the
        root.

    Notes
    -----
    With the vortex at 1/4 and the collocation point at 3/4 of each panel a flat section has exactly
    the lift of thin-airfoil theory, however its panels are spaced. Cosine spacing is for camber
    near the edges: 8 panels leave 0.06 deg of the zero-lift angle of an E63, equal panels 0.5 deg.
    """
    fraction = lattice_chord_fraction(n_chordwise)
    operator = jnp.asarray(chord_interpolation(np.arccos(1.0 - 2.0 * fraction)))
    camber, _ = section_shape(blade, span, operator)
    return place_sections(blade, span, jnp.asarray(fraction), camber)
