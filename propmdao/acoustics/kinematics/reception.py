"""The two clocks of advanced-time marching: when sources emit and when observers hear it."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from propmdao.acoustics.kinematics.motion import Motion, place, poses
from propmdao.records.pytrees import record


@record
class Observers:
    """Observers in uniform motion; fixed ones have no velocity.

    Attributes
    ----------
    position : (n_observers, 3) array
        Positions on the ground at time 0 [m].
    velocity : (3,) array
        Velocity of all observers [m/s].
    """

    position: Array
    velocity: Array


def observer_clock(times: ArrayLike) -> tuple[NDArray[np.float64], float]:
    """Observer times and their step.

    Parameters
    ----------
    times : (n_times,) array_like
        Evenly spaced observer times [s].

    Returns
    -------
    times : (n_times,) array
        Observer times [s].
    step : float
        Step between the times [s].

    Raises
    ------
    ValueError
        If there are fewer than two times, or they do not increase or are not evenly spaced.
    """
    clock = np.asarray(times, float)
    if clock.ndim != 1 or clock.size < 2 or not clock[1] > clock[0]:
        raise ValueError(f"observer times must be 2 or more that increase; got {clock.size}")
    step = float(clock[-1] - clock[0]) / (clock.size - 1)
    if np.ptp(np.diff(clock)) > 1e-6 * step + 8 * np.spacing(np.abs(clock).max()):
        raise ValueError(f"observer times must be evenly spaced; the steps differ from {step:g} s")
    return clock, step


def require_slower_than_sound(observers: Observers, sound_speed: float) -> float:
    """Refuse observers at the speed of sound or faster: sound would never catch up with them.

    Parameters
    ----------
    observers : Observers
        Observers at rest or in uniform motion.
    sound_speed : float
        Speed of sound [m/s].

    Returns
    -------
    float
        Mach number of the observers.

    Raises
    ------
    ValueError
        If the Mach number is not below 1.
    """
    mach = float(np.linalg.norm(np.asarray(observers.velocity, float))) / sound_speed
    if not mach < 1:
        raise ValueError(f"observers must be slower than sound; their Mach number is {mach:.3f}")
    return mach


def source_times(
    motion: Motion,
    points: ArrayLike,
    observers: Observers,
    times: ArrayLike,
    sound_speed: float,
    step: float | None = None,
    multiple: int = 32,
) -> NDArray[np.float64]:
    """Source times from which all of `points` are heard over all of the observers' times.

    Parameters
    ----------
    motion : Motion
        Motion of the points' frame.
    points : (n, 3) array_like
        Positions of the points in their frame [m].
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array_like
        Observer times [s].
    sound_speed : float
        Speed of sound [m/s].
    step : float, optional
        Largest step between source times [s]; that of the observer times by default.
    multiple : int
        Divisor of the number of source times. A shorter step rounds this number up to a multiple,
        so that the blades of a rotor run the same compiled code.

    Returns
    -------
    (n_source_times,) array
        Evenly spaced source times [s].

    Raises
    ------
    ValueError
        If points or observers move at the speed of sound or faster, or the step is not positive.
    """
    clock = np.asarray(times, np.float64)
    x = np.asarray(points, np.float64).reshape(-1, 3)
    step = float(clock[1] - clock[0]) if step is None else step
    if not step > 0:
        raise ValueError(f"step of the source times must be positive [s]; got {step:g}")
    # A step of the record's length would be interpolated from what is heard long before and after.
    step = min(step, float(clock[-1] - clock[0]))
    center = 0.5 * (x.min(axis=0) + x.max(axis=0))
    start, velocity = np.asarray(observers.position, float), np.asarray(observers.velocity, float)
    observer_mach = require_slower_than_sound(observers, sound_speed)
    # What is emitted at one time is heard at t - |x + v t - y| / c = tau. The left side grows at
    # least by 1 - M_observer per second, so that a point that is r away from the centre is heard
    # within r / (c (1 - M_observer)) of it, whatever the motion.
    radius = float(np.linalg.norm(x - center, axis=1).max())
    margin = radius / (sound_speed * (1 - observer_mach))

    def distance(tau: float, t: float) -> NDArray[np.float64]:
        pose = poses(motion, np.array([tau]))
        y = pose.origin[0] + pose.rotation[0] @ center
        apart: NDArray[np.float64] = start + velocity * t - y
        return np.asarray(np.sqrt(np.sum(apart**2, axis=1)))

    def emitted(t: float, which: str) -> float:
        pick = np.max if which == "first" else np.min

        def late(tau: float) -> float:
            return float(tau + pick(distance(tau, t)) / sound_speed - t)

        reach = float(np.max(distance(t, t))) / sound_speed + step
        for _ in range(60):
            if late(t - reach) < 0:
                return float(brentq(late, t - reach, t, xtol=1e-3 * step))
            reach *= 2
        raise ValueError(f"sources must be slower than sound ({sound_speed:g} m/s); they are not")

    # The interpolation takes one step on either side; one more for the root's tolerance.
    first = emitted(float(clock[0]) - margin, "first") - 2.5 * step
    last = emitted(float(clock[-1]) + margin, "last") + 2.5 * step
    n = multiple * int(np.ceil(((last - first) / step + 1) / multiple))
    tau = np.linspace(first, last, n)
    _, speed, _ = place(poses(motion, tau[:: -(-n // 64)]), x)
    mach = float(np.linalg.norm(speed, axis=-1).max()) / sound_speed
    if not mach < 1:
        raise ValueError(
            f"sources must be slower than sound ({sound_speed:g} m/s); "
            f"their Mach number is {mach:.3f}"
        )
    return tau


def require_outside(
    motion: Motion, points: ArrayLike, observers: Observers, times: ArrayLike, name: str
) -> None:
    """Refuse observers that come into the region which the sources sweep.

    The region is the sphere around the hub that holds all of the points; the hub is the point on
    the axis of the fastest turning frame that is nearest to them. Where nothing turns, the region
    is the box around the points, along the axes of their frame.

    Parameters
    ----------
    motion : Motion
        Motion of the points' frame.
    points : (n, 3) array_like
        Positions of the points in their frame [m].
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array_like
        Observer times [s], of which at most 1000, evenly spaced, are looked at.
    name : str
        Name of the sources in messages.

    Raises
    ------
    ValueError
        If an observer comes into the region; the message has its distance from the centre.
    """
    clock = np.asarray(times, float)
    clock = np.linspace(clock[0], clock[-1], min(clock.size, 1000))
    x = np.asarray(points, float).reshape(-1, 3)
    rates = [abs(float(frame.rate)) for frame in motion]
    turning = int(np.argmax(rates)) + 1 if any(rates) else len(motion)
    # The frames within the turning one keep their places in it.
    inner = poses(motion[turning:], np.zeros(1))
    x = inner.origin[0] + x @ inner.rotation[0].T
    center = 0.5 * (x.min(axis=0) + x.max(axis=0))
    if any(rates):
        axis = motion[turning - 1].axis
        center = axis * (axis @ center)
    radius = float(np.linalg.norm(x - center, axis=1).max())
    half = np.abs(x - center).max(axis=0)
    pose = poses(motion[:turning], clock)
    hub = place(pose, center[None])[0][:, 0]
    velocity = np.asarray(observers.velocity, float)
    for number, start in enumerate(np.asarray(observers.position, float), start=1):
        apart = start + velocity * clock[:, None] - hub
        distance = np.linalg.norm(apart, axis=1)
        if any(rates):
            inside, extent = distance <= radius, f"the region's radius is {radius:.3g} m"
        else:
            along_axes = np.abs(np.einsum("ti,tij->tj", apart, pose.rotation))
            inside = np.all(along_axes <= half, axis=1)
            extent = "the region is {:.3g} x {:.3g} x {:.3g} m".format(*(2 * half))
        if inside.any():
            raise ValueError(
                f"observers must be outside of the sources' region; observer {number} comes to "
                f"{distance[inside].min():.3g} m from the centre of {name}; {extent}"
            )


def sum_on_clock(
    arrival: Array, pressure: Array, start: Array, step: Array, n: int, each: int
) -> Array:
    """Interpolate what arrives from every source to the observer's clock, and sum over sources.

    Parameters
    ----------
    arrival : (n_sources, n_source_times) array
        Reception times, increasing along the last axis [s].
    pressure : (n_sources, n_source_times) array
        Pressure that is heard at the reception times [Pa].
    start, step : float
        First observer time and their step [s].
    n : int
        Number of observer times (static).
    each : int
        Largest number of observer times between two neighbours in `arrival` (static).

    Returns
    -------
    (n,) array
        Pressure at the observer times by cubic (four-point) interpolation [Pa].

    Notes
    -----
    Every source interval puts its values onto the clock (40 ns per source and time): that needs
    neighbours only, where looking for the interval of an observer time is a search and eight
    gathers in memory (230 ns).
    """
    t0, t1, t2, t3 = (arrival[:, k : k - 3 or None] for k in range(4))
    p0, p1, p2, p3 = (pressure[:, k : k - 3 or None] for k in range(4))
    # Newton's divided differences
    d01, d12, d23 = (p1 - p0) / (t1 - t0), (p2 - p1) / (t2 - t1), (p3 - p2) / (t3 - t2)
    d012, d123 = (d12 - d01) / (t2 - t0), (d23 - d12) / (t3 - t1)
    d0123 = (d123 - d012) / (t3 - t0)
    first = jnp.ceil((t1 - start) / step)

    def add(k: int, record: Array) -> Array:
        tick = first + k
        t = start + tick * step
        p = p0 + (t - t0) * (d01 + (t - t1) * (d012 + (t - t2) * d0123))
        inside = (tick >= 0) & (tick < n) & (t < t2)
        slot = jnp.where(inside, tick, n).astype(int)
        return record.at[slot].add(jnp.where(inside, p, 0.0), mode="promise_in_bounds")

    # the last one takes what is outside the record
    return jax.lax.fori_loop(0, each, add, jnp.zeros(n + 1))[:n]
