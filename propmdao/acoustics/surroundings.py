"""What is around a rotor and its observers: ground that reflects, air that absorbs.

Observers fly along with the rotor here, as they do for `tones` and `rotor_self_noise`; sound has
one way to them or, over ground, two: what is heard is computed at the ends of all ways
(`sound_paths`) and put together again.
"""

from __future__ import annotations

import dataclasses
from typing import Literal

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.acoustics.formulation1a import Tones
from propmdao.acoustics.propagation import (
    Air,
    absorb,
    absorb_tones,
    bands_with_reflection,
    mirrored,
    on_hard_ground,
    require_known_air,
    way_flying_along,
    with_reflection,
)

_ON_GROUND = 1e-9  # m: rounding of directions

Floats = NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Surroundings:
    """Ground and air around a rotor; by default there is no ground, and the air absorbs nothing.

    Attributes
    ----------
    ground : float, "flush" or None
        Height of the rotor centre above hard, plane ground [m]; "flush": all observers lie flush
        on hard ground, wherever it is, so that pressures are doubled; None: no ground. The flow
        around the rotor knows of no ground.
    level_flight : bool
        Whether the rotor's axis lies along the ground, azimuth 0 pointing down to it; by default it
        stands upright, in hover and climb.
    air : Air or None
        Air that absorbs sound, or None.

    Raises
    ------
    ValueError
        If the height is not positive or the air is outside what ISO 9613-1 states.
    """

    ground: float | Literal["flush"] | None = None
    level_flight: bool = False
    air: Air | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be."""
        if isinstance(self.ground, float | int) and not 0.0 < self.ground < np.inf:
            raise ValueError(f"height above ground must be positive [m]; it is {self.ground:g}")
        if self.air is not None:
            require_known_air(self.air)

    def __str__(self) -> str:
        """Say it in one line."""
        parts = []
        if isinstance(self.ground, str):
            parts.append("observers flush on hard ground")
        elif self.ground is not None:
            parts.append(f"hard ground {self.ground:g} m below the hub")
        if self.level_flight:
            parts.append("level flight")
        if self.air is not None:
            celsius, percent = self.air.temperature - 273.15, 100 * self.air.relative_humidity
            parts.append(
                f"absorbing air of {celsius:g} deg C, {percent:g} %, {self.air.pressure:g} Pa"
            )
        return ", ".join(parts) or "free field"

    @property
    def up(self) -> tuple[float, float, float]:
        """Unit vector away from the ground in the rotor's axes."""
        return (-1.0, 0.0, 0.0) if self.level_flight else (0.0, 0.0, 1.0)

    def from_ground_axes(self, positions: ArrayLike) -> Floats:
        """Positions in the rotor's axes.

        Parameters
        ----------
        positions : (..., 3) array
            From the rotor centre, the third coordinate up, in level flight the first one ahead [m].

        Returns
        -------
        (..., 3) array
            From the rotor centre, in its axes [m].
        """
        x, y, z = np.moveaxis(np.asarray(positions, float), -1, 0)
        return np.stack([-z, y, x] if self.level_flight else [x, y, z], axis=-1)


def sound_paths(positions: ArrayLike, surroundings: Surroundings) -> Floats:
    """Ends of the ways from the rotor to its observers: where they are and where mirrored.

    Parameters
    ----------
    positions : (n_observers, 3) array
        From the rotor centre, in its axes [m].
    surroundings : Surroundings
        With or without ground.

    Returns
    -------
    (n_ways, n_observers, 3) array
        Two ways where the ground is at a height, otherwise one [m].

    Raises
    ------
    ValueError
        If an observer is below the ground.
    """
    x = np.asarray(positions, float).reshape(-1, 3)
    ground = surroundings.ground
    if ground is None or isinstance(ground, str):
        return x[None]
    height = x @ np.asarray(surroundings.up) + ground
    for k in np.flatnonzero(height < -_ON_GROUND):
        raise ValueError(
            f"observer {k + 1} is {-height[k]:.4g} m below the ground, which is {ground:g} m below"
            " the rotor centre"
        )
    return np.stack([x, np.asarray(mirrored(x, ground, surroundings.up))])


def tones_by_paths(
    tones: Tones, paths: ArrayLike, mach: float, surroundings: Surroundings
) -> Tones:
    """Tones at observers: of all ways together, in phase.

    Parameters
    ----------
    tones : Tones
        At the ends of the ways, ``paths.reshape(-1, 3)``, in air without end.
    paths : (n_ways, n_observers, 3) array
        Of `sound_paths` [m].
    mach : float
        Of the flight along the axis.
    surroundings : Surroundings
        As they were for the paths.

    Returns
    -------
    Tones
        At the (n_observers,).
    """
    if surroundings.air is not None:
        distance, doppler = way_flying_along(jnp.asarray(paths).reshape(-1, 3), mach)
        tones = absorb_tones(tones, distance, surroundings.air, doppler)
    n_ways, n, _ = np.shape(paths)
    if n_ways == 1:
        return tones if surroundings.ground is None else on_hard_ground(tones)
    direct, reflected = (
        Tones(tones.frequency_hz, tones.thickness[k : k + n], tones.loading[k : k + n])
        for k in (0, n)
    )
    return with_reflection(direct, reflected)


def bands_by_paths(
    mean_square: ArrayLike,
    band_hz: ArrayLike,
    paths: ArrayLike,
    mach: float,
    sound_speed: float,
    surroundings: Surroundings,
) -> Array:
    """Broadband noise at observers, of all ways together.

    Parameters
    ----------
    mean_square : (n_ways * n_observers, n_bands) array
        In third octaves at the ends of the ways, in air without end [Pa^2].
    band_hz : (n_bands,) array
        Their mid-band frequencies [Hz].
    paths : (n_ways, n_observers, 3) array
        Of `sound_paths` [m].
    mach : float
        Of the flight along the axis.
    sound_speed : float
        [m/s].
    surroundings : Surroundings
        As they were for the paths.

    Returns
    -------
    (n_observers, n_bands) array
        Mean squares [Pa^2].

    Notes
    -----
    Two ways interfere as those from a point in the rotor's centre: see `bands_with_reflection`.
    """
    x, f = jnp.asarray(paths), jnp.asarray(band_hz, float)
    power = jnp.asarray(mean_square).reshape(*x.shape[:2], f.size)
    distance, doppler = way_flying_along(x, mach)
    if surroundings.air is not None:
        power = absorb(power, f * doppler[..., None], distance, surroundings.air)
    if len(power) == 1:
        return power[0] if surroundings.ground is None else 4 * power[0]
    delay = (distance[1] - distance[0]) / sound_speed
    return bands_with_reflection(power[0], power[1], f, delay)
