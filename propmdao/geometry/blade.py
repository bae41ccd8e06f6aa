"""The blade as arrays: distributions over span, and how they are read between stations."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from propmdao.geometry.spline_swings import warn_of_swings
from propmdao.propeller.airfoils.airfoil import DESIGN_LIFT_WEIGHTS, naca4_camber_line
from propmdao.propeller.description import Propeller
from propmdao.records.pytrees import record


@record
class Blade:
    """One blade at the stations of its propeller; blade 1 lies along +x.

    A modified blade is ``dataclasses.replace(blade, beta=blade.beta + 0.02)``.

    Attributes
    ----------
    radius : scalar array
        Tip radius [m].
    chord_over_R, beta, sweep_over_R, rake_over_R : (n_stations,) arrays
        Chord, blade angle [rad], sweep of the quarter chord (positive aft, against rotation) and
        rake (positive toward thrust); all but the blade angle over the tip radius.
    thickness_over_chord, camber_over_chord : (n_stations,) arrays
        Maximum thickness and maximum camber over chord.
    camber_shape, thickness_shape : (n_stations, n_chord) arrays
        Camber line and full thickness scaled to a maximum of 1, on
        `propeller.airfoils.airfoil.CHORD_FRACTION`. Both are laid off perpendicular to the chord.
    edge_over_R, edge_angle : (n_stations,) arrays or None
        Thickness of the trailing edge over the tip radius and angle between the surfaces there
        [rad], where they are described; None: those of the sections.
    """

    radius: jax.Array
    chord_over_R: jax.Array
    beta: jax.Array
    sweep_over_R: jax.Array
    rake_over_R: jax.Array
    thickness_over_chord: jax.Array
    camber_over_chord: jax.Array
    camber_shape: jax.Array
    thickness_shape: jax.Array
    edge_over_R: jax.Array | None = None
    edge_angle: jax.Array | None = None

    @classmethod
    def from_propeller(cls, propeller: Propeller) -> Blade:
        """Turn a described propeller into arrays.

        Parameters
        ----------
        propeller : Propeller
            The description; its airfoils are blended linearly to its stations.

        Returns
        -------
        Blade
            The blade. A station without camber gets the NACA mean line with its maximum at
            0.4 c as its shape, so that camber can be added to it.

        Warns
        -----
        ChordWarning
            Where the chord between two stations is far from the chords at them.
        """
        warn_of_swings(propeller.r_over_R, propeller.c_over_R, 0.5 * float(propeller.diameter))
        camber, thickness = propeller.sections()
        peak = np.argmax(np.abs(camber), axis=1)
        max_camber = np.take_along_axis(camber, peak[:, None], axis=1)[:, 0]
        flat = max_camber == 0.0
        shape = np.where(
            flat[:, None],
            _unit_mean_line(),
            camber / np.where(flat, 1.0, max_camber)[:, None],
        )
        max_thickness = thickness.max(axis=1)
        thickness_over_chord, camber_over_chord = (
            there if described is None else described
            for there, described in (
                (max_thickness, propeller.thickness_over_chord),
                (max_camber, propeller.camber_over_chord),
            )
        )
        angle = propeller.trailing_edge_angle_deg
        arrays = {
            "radius": np.float64(0.5 * propeller.diameter),
            "chord_over_R": propeller.c_over_R,
            "beta": np.radians(propeller.beta_deg),
            "sweep_over_R": propeller.sweep_over_R,
            "rake_over_R": propeller.rake_over_R,
            "thickness_over_chord": thickness_over_chord,
            "camber_over_chord": camber_over_chord,
            "camber_shape": shape,
            "thickness_shape": thickness / max_thickness[:, None],
            "edge_over_R": propeller.trailing_edge_over_R,
            "edge_angle": None if angle is None else np.radians(angle),
        }
        return cls(**jax.device_put(arrays))  # jnp.asarray compiles for each shape


def _unit_mean_line() -> npt.NDArray[np.float64]:
    """NACA mean line, maximum at 0.4 c, scaled to 1 at its largest grid point."""
    line = naca4_camber_line(1.0, 0.4)
    unit: npt.NDArray[np.float64] = line / line.max()
    return unit


@record
class SpanInterpolation:
    """Linear operators that carry station values to other radii.

    Attributes
    ----------
    r_over_R : (n,) array
        Radii to which the values are carried, over the tip radius.
    smooth : (n, n_stations) array
        Not-a-knot cubic spline, for chord, beta, sweep and rake.
    linear : (n, n_stations) array
        Piecewise linear interpolation, for thickness, camber and section shapes.
    """

    r_over_R: jax.Array
    smooth: jax.Array
    linear: jax.Array


def span_interpolation(
    station_r_over_R: npt.ArrayLike, r_over_R: npt.ArrayLike
) -> SpanInterpolation:
    """Build the operators from stations to radii; call it outside ``jit``.

    Parameters
    ----------
    station_r_over_R : (n_stations,) array
        Radii of the blade's stations over the tip radius, rising, at least two.
    r_over_R : (n,) array
        Radii wanted over the tip radius, within the stations.

    Returns
    -------
    SpanInterpolation
        The operators.

    Raises
    ------
    ValueError
        If a radius lies outside the stations: a spline says nothing there.
    """
    stations = np.asarray(station_r_over_R, dtype=float)
    radii = np.asarray(r_over_R, dtype=float)
    outside = (radii < stations[0] - 1e-12) | (radii > stations[-1] + 1e-12)
    if outside.any():
        raise ValueError(
            f"r_over_R must be within the blade's stations {stations[0]:g}..{stations[-1]:g}; "
            f"got {radii[outside][0]:g}"
        )
    unit = np.eye(stations.size)
    smooth = CubicSpline(stations, unit)(radii)
    linear = np.stack([np.interp(radii, stations, e) for e in unit], axis=1)
    return SpanInterpolation(*jax.device_put((radii, smooth, linear)))


def design_lift_coefficient(camber_shape: npt.ArrayLike | jax.Array) -> jax.Array:
    """Compute the design lift coefficient of mean lines of unit camber, by thin-airfoil theory.

    Parameters
    ----------
    camber_shape : (..., n_chord) array
        Camber lines scaled to a maximum of 1, on `propeller.airfoils.airfoil.CHORD_FRACTION`.

    Returns
    -------
    (...) array
        pi A1, the lift coefficient at the ideal angle of attack per unit of camber: 12.80 for
        the NACA mean line with its maximum at 0.4 c. Camber over chord is the design lift
        coefficient divided by this.
    """
    return jnp.asarray(camber_shape) @ jnp.asarray(DESIGN_LIFT_WEIGHTS)
