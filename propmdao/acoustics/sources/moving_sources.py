"""Sources in their own moving frame: at rest there, or changing in time."""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from propmdao.records.loads import PeriodicLoads, PointLoads
from propmdao.records.panels import Panels
from propmdao.records.pytrees import Scalar, record


@record
class UnsteadySources:
    """Panels or point forces that change in their own moving frame, at each source time.

    Attributes
    ----------
    position, position_rate, position_acceleration : (n_times or 1, n, 3) arrays
        Position of the sources in the frame and its two derivatives in time [m], [m/s], [m/s^2].
    vector, vector_rate : (n_times or 1, n, 3) arrays
        Outward vector area [m^2] or force ON THE FLUID [N], components in the frame, and its rate.
    """

    position: Array
    position_rate: Array
    position_acceleration: Array
    vector: Array
    vector_rate: Array


def unsteady_loads(position: ArrayLike, force: ArrayLike, force_rate: ArrayLike) -> UnsteadySources:
    """Forces that change in time at points that are at rest in the moving frame.

    Parameters
    ----------
    position : (n, 3) array_like
        Points at which the forces act, in the frame [m].
    force, force_rate : (n_times, n, 3) array_like
        Force ON THE FLUID [N], components in the frame, and its rate [N/s].

    Returns
    -------
    UnsteadySources
        Forces at the source times of the rows of `force`, for `source_history`.
    """
    x = jnp.asarray(position, float)[None]
    f, rate = jnp.asarray(force, float), jnp.asarray(force_rate, float)
    return UnsteadySources(x, jnp.zeros_like(x), jnp.zeros_like(x), f, rate)


def compact_sections(position: ArrayLike, volume: ArrayLike) -> Panels:
    """Panels that displace air at points: a blade of which only section areas are known.

    Parameters
    ----------
    position : (n, 3) array_like
        Positions of the elements, in the blade's frame [m].
    volume : (n,) array_like
        Section area times length of each element [m^3].

    Returns
    -------
    Panels
        Six sides of a cube around each point, a millionth of the blade in size and with areas that
        give it the volume. They hold for thickness noise of wavelengths above the chord.
    """
    x = np.asarray(position, float).reshape(-1, 3)
    size = 1e-6 * float(np.abs(x).max())
    sides = np.vstack([np.eye(3), -np.eye(3)])
    center = x[:, None] + 0.5 * size * sides
    area = np.asarray(volume, float).reshape(-1, 1, 1) / size * sides
    return Panels(jnp.asarray(center.reshape(-1, 3)), jnp.asarray(area.reshape(-1, 3)))


@record
class AperiodicLoads:
    """Forces of each blade of a rotor that change in time as they like.

    Attributes
    ----------
    position : (n, 3) array
        Points at which the forces act, in the blade's frame [m].
    times : (n_times,) array
        Source times, increasing [s].
    force : (n_blades, n_times, n, 3) array
        Force ON THE FLUID, components in the frame of its blade [N].
    """

    position: Array
    times: Array
    force: Array


BladeLoads = PointLoads | PeriodicLoads | AperiodicLoads


def blade_loads(
    loads: BladeLoads, blade: int, azimuth: float, rotation_speed: float, times: ArrayLike
) -> PointLoads | UnsteadySources:
    """Forces of one blade at given source times.

    Parameters
    ----------
    loads : PointLoads, PeriodicLoads or AperiodicLoads
        Forces that are constant, the same for every blade at its azimuth, or each blade's own.
    blade : int
        Number of the blade, counted from 0.
    azimuth : float
        Azimuth of the blade at time 0 [rad].
    rotation_speed : float
        Rotation speed Omega [rad/s].
    times : (n_times,) array_like
        Source times [s].

    Returns
    -------
    PointLoads or UnsteadySources
        Forces of the blade, constant or at the source times, for `source_history`.

    Raises
    ------
    ValueError
        If a table over time does not cover the source times.

    Notes
    -----
    Tables are interpolated, and differentiated, by cubic splines.
    """
    if isinstance(loads, PointLoads):
        return loads
    tau = np.asarray(times, float)
    if isinstance(loads, PeriodicLoads):
        return periodic_loads(loads, azimuth + rotation_speed * tau, rotation_speed)
    clock = np.asarray(loads.times, float)
    # Rows farther away change a cubic spline by less than 1e-13.
    first, last = np.searchsorted(clock, [tau.min(), tau.max()]) + np.array([-24, 24])
    near = slice(max(int(first), 0), int(last))
    value, rate, _ = sample(np.asarray(loads.force[blade, near]), clock[near], tau)
    return unsteady_loads(loads.position, value, rate)


def periodic_loads(
    loads: PeriodicLoads, azimuths: ArrayLike, rotation_speed: Scalar
) -> UnsteadySources:
    """Forces of a blade on its way around the turn, by a cubic spline.

    Parameters
    ----------
    loads : PeriodicLoads
        Forces at the azimuths of the table; JAX may trace them.
    azimuths : (n_times,) array_like
        Azimuths of the blade at the source times [rad].
    rotation_speed : float
        Rotation speed Omega [rad/s]; JAX may trace it.

    Returns
    -------
    UnsteadySources
        Forces at the source times.
    """
    n = loads.force.shape[0]
    table_azimuths = np.linspace(0, 2 * np.pi, n, endpoint=False)
    # The spline is linear in the forces that it goes through.
    weights = sample(np.eye(n), table_azimuths, azimuths, 2 * np.pi)[:2]
    force, slope = (jnp.tensordot(jnp.asarray(w), loads.force, axes=1) for w in weights)
    return unsteady_loads(loads.position, force, rotation_speed * slope)


def sample(
    values: ArrayLike, value_times: ArrayLike, times: ArrayLike, period: float | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Values and their first two derivatives from a table over time, by a cubic spline.

    Parameters
    ----------
    values : (n_values, ...) array_like
        Values of the table, one row for each time.
    value_times : (n_values,) array_like
        Times of the table's rows, increasing [s].
    times : (n_times,) array_like
        Times at which the values are wanted [s].
    period : float, optional
        Time after which the table repeats [s]; its last row may repeat the first or be left out.

    Returns
    -------
    values, rates, accelerations : (n_times, ...) arrays
        Interpolated values and their first two derivatives in time.

    Raises
    ------
    ValueError
        If the times do not increase, the table is longer than the period or shorter than `times`.
    """
    table, clock, wanted = (np.asarray(q, float) for q in (values, value_times, times))
    if clock.size < 2 or not np.all(np.diff(clock) > 0):
        raise ValueError(f"times of a table must increase; got {clock.size} of them, not all later")
    if period is not None:
        if clock[-1] - clock[0] > period * (1 + 1e-5):
            raise ValueError(
                f"table over {clock[-1] - clock[0]:g} s is longer than its period, {period:g} s"
            )
        closed = clock[-1] - clock[0] > period * (1 - 1e-5)
        table = np.concatenate([table[:-1] if closed else table, table[:1]])
        clock = np.append(clock[:-1] if closed else clock, clock[0] + period)
    elif wanted.size and not clock[0] <= wanted.min() <= wanted.max() <= clock[-1]:
        raise ValueError(
            f"table over {clock[0]:g} ... {clock[-1]:g} s is asked for "
            f"{wanted.min():g} ... {wanted.max():g} s"
        )
    spline = CubicSpline(clock, table, bc_type="not-a-knot" if period is None else "periodic")
    return spline(wanted), spline(wanted, 1), spline(wanted, 2)


class Sources(NamedTuple):
    """Sources by components, as the kernels want them.

    Attributes
    ----------
    position, vector : tuples of (3, n, n_times or 1) arrays
        Position, and vector area or force, in the frame: each the value and as many of its
        derivatives in time as are not zero.
    """

    position: tuple[Array, ...]
    vector: tuple[Array, ...]


def frame_sources(sources: Panels | PointLoads | UnsteadySources) -> Sources:
    """Split sources, at rest or unsteady, into components."""

    def time_last(*arrays: Array) -> tuple[Array, ...]:
        return tuple(jnp.asarray(a, float).transpose(2, 1, 0) for a in arrays)

    if isinstance(sources, UnsteadySources):
        moving = (sources.position, sources.position_rate, sources.position_acceleration)
        return Sources(time_last(*moving), time_last(sources.vector, sources.vector_rate))
    points, vectors = (
        (sources.center, sources.vector_area)
        if isinstance(sources, Panels)
        else (sources.position, sources.force)
    )
    return Sources(time_last(points[None]), time_last(vectors[None]))
