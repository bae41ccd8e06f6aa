"""Rotors of any number, each with its own speed, phase and sense of rotation, as sources of sound.

A rotor is one blade's sources and where its blades stand. `rotor_histories` marches through the
source times of all of them, whatever the motion; `periodic` and `flyover` are the fast ways where
every turn is like the one before.
"""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.kinematics.limits import require_air
from propmdao.acoustics.kinematics.motion import Motion, blade_motions, rotation
from propmdao.acoustics.kinematics.reception import (
    Observers,
    observer_clock,
    require_outside,
    source_times,
)
from propmdao.acoustics.signals import PressureHistory
from propmdao.acoustics.sources.advanced_time import source_history
from propmdao.acoustics.sources.kernels import TONAL_SOURCES
from propmdao.acoustics.sources.moving_sources import (
    AperiodicLoads,
    BladeLoads,
    PeriodicLoads,
    UnsteadySources,
    blade_loads,
)
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels

# Unsteady forces times source times kept at once: 0.2 GiB with their derivatives.
_AT_ONCE = 1 << 20


@dataclasses.dataclass(frozen=True)
class Rotor:
    """Equal blades that turn about +z of their mount.

    Attributes
    ----------
    azimuths : (n_blades,) array_like
        Azimuth of each blade at time 0 [rad]; any spacing.
    rotation_speed : float
        Rotation speed Omega [rad/s]; negative for a rotor that turns the other way, see `mirrored`.
    panels : Panels, optional
        Closed surface of a blade that lies along +x at azimuth 0; without it there is no thickness
        noise.
    loads : PointLoads, PeriodicLoads or AperiodicLoads, optional
        Forces of the blade on the fluid; without them there is no loading noise.
    mount : Motion
        Frames at rest in the aircraft, to the hub and into the direction of the shaft.
    name : str
        Name of the rotor in messages.
    """

    azimuths: ArrayLike
    rotation_speed: float
    panels: Panels | None = None
    loads: BladeLoads | None = None
    mount: Motion = ()
    name: str = "the rotor"

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions of the sources of a blade, (n, 3) [m]."""
        places = [] if self.panels is None else [self.panels.center]
        places += [] if self.loads is None else [self.loads.position]
        if not places:
            raise ValueError(f"{self.name} has neither panels nor loads: nothing to be heard")
        return np.concatenate([np.asarray(q, float) for q in places])

    @property
    def azimuths_held(self) -> dict[str, int]:
        """Kinds of sources that the rotor has, by their names in `TONAL_SOURCES`.

        The value of each is the number of azimuths at which it is tabulated over the turn: 0 for
        constant sources and for those given over time.
        """
        held = {} if self.panels is None else {"thickness": 0}
        if self.loads is not None:
            periodic = isinstance(self.loads, PeriodicLoads)
            held["loading"] = len(self.loads.force) if periodic else 0
        return held

    def source(
        self, name: str, blade: int, azimuth: float, times: ArrayLike
    ) -> Panels | PointLoads | UnsteadySources:
        """Sources of one kind of one blade at given source times.

        Parameters
        ----------
        name : str
            Kind of the sources, one of `azimuths_held`.
        blade : int
            Number of the blade, counted from 0.
        azimuth : float
            Azimuth of the blade at time 0 [rad].
        times : (n_times,) array_like
            Source times [s].

        Returns
        -------
        Panels, PointLoads or UnsteadySources
            Sources in the frame of the blade.

        Raises
        ------
        ValueError
            If a table over time does not cover the source times.
        """
        if name == "thickness" and self.panels is not None:
            return self.panels
        assert name == "loading" and self.loads is not None
        return blade_loads(self.loads, blade, azimuth, self.rotation_speed, times)


def equally_spaced(n_blades: int, first: float = 0.0) -> NDArray[np.float64]:
    """Azimuths of equally spaced blades.

    Parameters
    ----------
    n_blades : int
        Number of blades.
    first : float
        Azimuth of the first blade [rad].

    Returns
    -------
    (n_blades,) array
        Azimuths [rad].
    """
    return first + 2 * np.pi * np.arange(n_blades) / n_blades


def mirrored(rotor: Rotor) -> Rotor:
    """Mirror image of a rotor in the x-z plane of its mount: it turns the other way.

    Parameters
    ----------
    rotor : Rotor
        Any rotor.

    Returns
    -------
    Rotor
        Mirror image of the rotor, on the same mount.
    """
    flip = jnp.array([1.0, -1.0, 1.0])
    panels, loads = rotor.panels, rotor.loads
    if panels is not None:
        panels = Panels(flip * panels.center, flip * panels.vector_area)
    if loads is not None:
        force = flip * loads.force
        if isinstance(loads, PeriodicLoads):  # azimuth psi becomes -psi
            force = jnp.roll(force[::-1], 1, axis=0)
        loads = dataclasses.replace(loads, position=flip * loads.position, force=force)
    return dataclasses.replace(
        rotor,
        azimuths=-np.asarray(rotor.azimuths, float),
        rotation_speed=-rotor.rotation_speed,
        panels=panels,
        loads=loads,
    )


def rotor_histories(
    rotors: list[Rotor],
    observers: Observers,
    times: ArrayLike,
    air: Air,
    flight: Motion = (),
    step: float | None = None,
) -> PressureHistory:
    """Pressure that observers hear of rotors in any motion, by advanced-time marching.

    Parameters
    ----------
    rotors : list of Rotor
        Rotors of one aircraft.
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array_like
        Uniform observer times [s].
    air : Air
        The undisturbed air.
    flight : Motion
        Motion of the aircraft; at rest by default.
    step : float, optional
        Largest step between source times [s]; that of the observer times by default.

    Returns
    -------
    PressureHistory
        Pressure of all rotors together, the steady pressure field that they carry along included.

    Raises
    ------
    ValueError
        If sources reach the speed of sound, an observer comes into a rotor's region, tables over
        time do not cover the source times, times are not evenly spaced or density and speed of
        sound are not positive.

    Notes
    -----
    The record is made in segments, so that memory does not grow with its length; cost is
    proportional to panels x observers x times. `flyover_histories` is the faster way for loads
    that repeat every turn in uniform flight.
    """
    require_air(air)
    clock, _ = observer_clock(times)
    for rotor in rotors:
        turning = rotation((0, 0, 1), rate=rotor.rotation_speed)
        chain = (*flight, *rotor.mount, turning)
        require_outside(chain, rotor.points, observers, clock, rotor.name)
    history = silence(observers, clock)
    for part in segments(clock.size, max(map(_n_unsteady, rotors), default=0)):
        pieces = [_segment(rotor, observers, clock[part], air, flight, step) for rotor in rotors]
        for name, pressure in history.parts.items():
            pressure[:, part] = sum(piece.parts[name] for piece in pieces)
    return history


def silence(observers: Observers, times: NDArray[np.float64]) -> PressureHistory:
    """Record of all kinds of sources in which nothing is heard yet.

    Parameters
    ----------
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array
        Observer times [s].

    Returns
    -------
    PressureHistory
        Record of zeros, to which pressures are added.
    """
    shape = len(observers.position), times.size
    return PressureHistory(times, {name: np.zeros(shape) for name in TONAL_SOURCES})


def segments(n_times: int, n_unsteady: int) -> list[slice]:
    """Parts of a record that are marched one after another, all of the same length.

    Parameters
    ----------
    n_times : int
        Length of the record.
    n_unsteady : int
        Number of sources that change in time: each is tabulated at every source time.

    Returns
    -------
    list of slice
        Slices that cover the record; the last may overlap the one before it.
    """
    length = min(n_times, max(256, min(8192, _AT_ONCE // max(n_unsteady, 1))))
    starts = [*range(0, n_times - length, length), n_times - length]
    return [slice(start, start + length) for start in starts]


def _segment(
    rotor: Rotor,
    observers: Observers,
    times: NDArray[np.float64],
    air: Air,
    flight: Motion,
    step: float | None,
) -> PressureHistory:
    history = silence(observers, times)
    azimuths = np.atleast_1d(np.asarray(rotor.azimuths, float))
    motions = blade_motions(azimuths, rotor.rotation_speed, (*flight, *rotor.mount))
    # A coarse multiple: the Doppler shift changes the number of source times along the record.
    multiple = max(128, times.size // 4)
    for blade, (azimuth, motion) in enumerate(zip(azimuths, motions, strict=True)):
        tau = source_times(
            motion, rotor.points, observers, times, float(air.sound_speed), step, multiple
        )
        for name in rotor.azimuths_held:
            sources = rotor.source(name, blade, azimuth, tau)
            history.parts[name][:] += source_history(
                name, sources, motion, tau, observers, times, air
            )
    return history


def _n_unsteady(rotor: Rotor) -> int:
    if isinstance(rotor.loads, PeriodicLoads | AperiodicLoads):
        return len(rotor.loads.position)
    return 0
