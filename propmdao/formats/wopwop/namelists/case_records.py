"""What a case of PSU-WOPWOP asks for: sources and their motion, observers, and levels."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.motion import Motion
from propmdao.formats.wopwop.namelists.broadband_groups import BpmNoise, PeggNoise
from propmdao.records.air import Air


@dataclass(frozen=True)
class Container:
    """A container with its own files, at the end of its chain of frames.

    Attributes
    ----------
    title : str
        Title of the container itself.
    motion : Motion
        Changes of base from the ground to the container.
    geometry : Path
        Geometry file.
    loading : Path or None
        Loading file; a container without one has thickness noise only.
    key_offset : float
        Offset of the periodic keys of the files, ``periodicKeyOffset``.
    step : float or None
        Step of the source times [s], the container's own or that of the container around it.
    """

    title: str
    motion: Motion
    geometry: Path
    loading: Path | None
    key_offset: float
    step: float | None


@dataclass(frozen=True)
class BroadbandContainer:
    """A rotor's container with broadband noise.

    Attributes
    ----------
    title : str
        Title of the container, with its namelist file.
    motion : Motion
        Changes of base from the ground to the container.
    turning : float or None
        Rotation speed of the innermost base that turns with the rotor [rad/s]; None without one.
    shaft : (3,) array or None
        Direction of that rotation's axis in the frame that it is in, `shaft_motion`.
    shaft_motion : Motion
        Changes of base from the ground to that frame.
    noise : BpmNoise or PeggNoise
        What is heard of it.
    blades : tuple of Container
        Containers with files within it.
    """

    title: str
    motion: Motion
    turning: float | None
    shaft: NDArray[np.float64] | None
    shaft_motion: Motion
    noise: BpmNoise | PeggNoise
    blades: tuple[Container, ...]


@dataclass(frozen=True)
class ObserverGrid:
    """Observers that listen together.

    Attributes
    ----------
    title : str
        Title of the observers.
    position : (n, 3) array
        Positions on the ground at time 0, the first index of the grid fastest [m].
    velocity : (3,) array
        Velocity on the ground [m/s].
    times : (n_times,) array
        Observer times [s].
    band_hz : tuple of float
        High-pass and low-pass frequency [Hz], 0 and infinity if not filtered.
    shape : tuple of int
        Numbers of observers along the first and the second index of the grid.
    segment, step : float
        Length of the segments of the record of which spectra are taken, and from the beginning of
        one to that of the next [s].
    window : {"boxcar", "hann"}
        Window of the spectra.
    third_octaves, absorption : bool
        Whether levels of third octaves are asked for, and whether the air absorbs sound.
    """

    title: str
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    times: NDArray[np.float64]
    band_hz: tuple[float, float]
    shape: tuple[int, int]
    segment: float
    step: float
    window: str
    third_octaves: bool
    absorption: bool

    @property
    def segment_starts(self) -> NDArray[np.float64]:
        """Times at which the segments begin [s], of those that lie in the record as a whole."""
        left = float(self.times[-1] - self.times[0]) - self.segment
        n = int(np.floor(left / self.step * (1.0 + 1e-9) + 1e-9)) + 1
        return np.asarray(self.times[0] + self.step * np.arange(n))


@dataclass(frozen=True)
class Wanted:
    """Results that a case asks for.

    Attributes
    ----------
    spectrum, weighted_spectrum : bool
        Spectra, in dB and A-weighted.
    oaspl, weighted_oaspl : bool
        Overall levels of the segments, in dB and A-weighted.
    exposure : bool
        Sound exposure level, SEL.
    perceived, effective : bool
        Perceived noise level with its correction for tones, PNLT, and the effective one, EPNL.
    text : bool
        Whether files are text.
    """

    spectrum: bool
    weighted_spectrum: bool
    oaspl: bool
    weighted_oaspl: bool
    exposure: bool
    perceived: bool
    effective: bool
    text: bool


@dataclass(frozen=True)
class Case:
    """A case of PSU-WOPWOP: its air, sources and observers.

    Attributes
    ----------
    name : str
        Name of the case's namelist file.
    air : Air
        The air; temperature and pressure are those of its density and speed of sound.
    thickness, loading : bool
        True for the kinds of noise that are wanted.
    wanted : Wanted
        Results that are asked for.
    containers : tuple of Container
        Containers that have files.
    broadband : tuple of BroadbandContainer
        Containers that have broadband noise, where it is asked for.
    observers : tuple of ObserverGrid
        All observers.
    """

    name: str
    air: Air
    thickness: bool
    loading: bool
    wanted: Wanted
    containers: tuple[Container, ...]
    broadband: tuple[BroadbandContainer, ...]
    observers: tuple[ObserverGrid, ...]
