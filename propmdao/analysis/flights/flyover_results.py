"""A flight past a microphone, and what is heard of it as levels."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.kinematics.tracks import Sight
from propmdao.acoustics.levels.decibels import level_db
from propmdao.acoustics.levels.epnl import effective_perceived_noise_level
from propmdao.acoustics.levels.perceived_noise import PERCEIVED_BANDS_HZ
from propmdao.acoustics.levels.time_levels import sound_exposure_level_db
from propmdao.acoustics.levels.weighting import level_dba
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.records.listening import HEIGHT
from propmdao.records.units import Range

#: Of the levels [s], as in certification.
STEP = 0.5
_SIDELINE = Range(-1e6, 1e6, "m")
_DURATION = Range(4 * STEP, 1200.0, "s")

Floats = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Flight:
    """Level flight of a propeller past a microphone over hard ground.

    Its axis is along the path or, at an incidence of the operating point, leans forward.

    Attributes
    ----------
    height : float
        Height of the propeller above the ground [m].
    sideline : float
        Distance of the microphone from the track, positive on the left [m].
    microphone_height : float
        Height of the microphone above the ground [m]; 0: flush with it, 1.2 m in certification of
        large aeroplanes.
    duration : float or None
        Time over which the propeller is heard [s]; by default until it is six times as far away as
        at its nearest, 20 s at least.
    absorption : bool
        Whether the air absorbs sound.

    Raises
    ------
    ValueError
        If the microphone is not between ground and propeller, or a value is out of range.
    """

    height: float
    sideline: float = 0.0
    microphone_height: float = 0.0
    duration: float | None = None
    absorption: bool = True

    def __post_init__(self) -> None:
        """Refuse flights that pass no microphone."""
        HEIGHT.require("height of flight", self.height)
        _SIDELINE.require("sideline distance", self.sideline)
        if not 0.0 <= self.microphone_height < self.height:
            raise ValueError(
                f"microphone must be between the ground and the flight at {self.height:g} m; it is"
                f" at {self.microphone_height:g} m"
            )
        if self.duration is not None:
            _DURATION.require("duration", self.duration)

    def heard_for(self, speed: float) -> float:
        """Time over which the propeller is heard.

        Parameters
        ----------
        speed : float
            Speed of the flight, positive [m/s].

        Returns
        -------
        float
            The duration, or what it is by default [s].

        Raises
        ------
        ValueError
            If the default is out of range, so that a duration has to be given.
        """
        if self.duration is not None:
            return self.duration
        by_default = max(20.0, 12.0 * self.miss_distance / speed)
        if by_default not in _DURATION:
            raise ValueError(
                f"a flyover at {speed:g} m/s past {self.miss_distance:g} m takes"
                f" {by_default:.4g} s, at most {_DURATION.highest:g} s are heard: give a duration"
            )
        return by_default

    @property
    def miss_distance(self) -> float:
        """Shortest distance between microphone and propeller [m]."""
        return float(np.hypot(self.height - self.microphone_height, self.sideline))


@dataclasses.dataclass(frozen=True)
class Flyover:
    """What the microphone hears.

    Attributes
    ----------
    time : (n_steps,) array
        Middle of steps of `STEP`; the propeller is overhead at 0 [s].
    mean_square : dict of str to (n_steps, n_bands) array
        Mean squares in the bands `propmdao.analysis.self_noise.BANDS_HZ`, of each source of tones,
        of "broadband" and of the "total" [Pa^2].
    sight : Sight
        From where it is heard, each array (1, n_steps).
    pressure : (n_times,) array or None
        Record at `SAMPLE_RATE`, tones and broadband noise, where asked for [Pa].
    """

    time: Floats
    mean_square: dict[str, Floats]
    sight: Sight
    pressure: Floats | None

    def level_dba(self, part: str = "total") -> Floats:
        """A-weighted level of each step, (n_steps,) [dBA].

        Parameters
        ----------
        part : str
            Key of `mean_square`.

        Returns
        -------
        (n_steps,) array
            Levels [dBA].
        """
        return np.asarray(level_dba(BANDS_HZ, self.mean_square[part]))

    def to_dict(self) -> dict[str, Any]:
        """Levels as plain numbers.

        Returns
        -------
        dict
            levels: of each part lamax_dba, the loudest step, and sel_dba; epnl and pnltm of all
            [EPNdB], [PNdB], None where there is none for the reason epnl_failure; history: time,
            distance, elevation_deg, doppler and levels of each step.
        """
        levels = {part: self.level_dba(part) for part in self.mean_square}
        perceived: dict[str, Any] = {"epnl": None, "pnltm": None, "epnl_failure": None}
        bands = np.asarray(level_db(self.mean_square["total"]))[:, : PERCEIVED_BANDS_HZ.size]
        try:
            effective = effective_perceived_noise_level(bands, STEP)
            perceived |= {"epnl": effective.epnl, "pnltm": effective.pnltm}
        except ValueError as reason:
            perceived["epnl_failure"] = str(reason)
        seen = {
            "time": self.time,
            "distance": np.asarray(self.sight.distance[0]),
            "elevation_deg": np.asarray(self.sight.elevation_deg[0]),
            "doppler": np.asarray(self.sight.doppler[0]),
            **{f"{part}_dba": level for part, level in levels.items()},
        }
        return {
            "levels": {
                part: {
                    "lamax_dba": float(level.max()),
                    "sel_dba": float(sound_exposure_level_db(level, STEP)),
                }
                for part, level in levels.items()
            },
            **perceived,
            "history": [
                dict(zip(seen, map(float, row), strict=True))
                for row in zip(*seen.values(), strict=True)
            ],
        }
