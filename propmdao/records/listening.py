"""Who listens to a propeller, and what is around it: observers, ground, air."""

from __future__ import annotations

import dataclasses
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
    absorption : bool
        Whether the air, which is that of the operating point, absorbs sound.

    Raises
    ------
    ValueError
        If the height is not positive.
    """

    ground: float | Literal["flush"] | None = None
    level_flight: bool = False
    absorption: bool = False

    def __post_init__(self) -> None:
        """Refuse a height that is not positive."""
        if isinstance(self.ground, float | int) and not 0.0 < self.ground < np.inf:
            raise ValueError(f"height above ground must be positive [m]; it is {self.ground:g}")

    def __str__(self) -> str:
        """Describe ground and air in one line."""
        parts = []
        if isinstance(self.ground, str):
            parts.append("observers flush on hard ground")
        elif self.ground is not None:
            parts.append(f"hard ground {self.ground:g} m below the hub")
        if self.level_flight:
            parts.append("level flight")
        if self.absorption:
            parts.append("absorbing air")
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
            Positions from the rotor centre, the third coordinate up, in level flight the first one
        ahead [m].

        Returns
        -------
        (..., 3) array
            Positions from the rotor centre, in its axes [m].
        """
        x, y, z = np.moveaxis(np.asarray(positions, float), -1, 0)
        return np.stack([-z, y, x] if self.level_flight else [x, y, z], axis=-1)
