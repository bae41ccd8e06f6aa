"""Observers of a propeller, and the ground and air around it."""

from __future__ import annotations

import dataclasses
import math
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.records.units import Range

Floats = NDArray[np.float64]
#: Distance of an observer from the rotor centre.
DISTANCE = Range(0.001, 1e6, "m")
#: Height above the ground.
HEIGHT = Range(0.001, 1e6, "m")
#: Observers of one analysis.
MOST_OBSERVERS = 20_000
#: What places a group of observers, by the words of the command line.
GroupKind = Literal["arc", "point", "circle", "grid", "hemisphere"]


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
        Whether the rotor flies along the ground. In axial flight its axis lies along the ground,
        azimuth 0 pointing down to it; at an incidence the axis leans forward by 90 degrees less
        the incidence. By default the axis stands upright, as in hover and climb, and the height is
        that of the moment.
    absorption : bool
        Whether the air, which is that of the operating point, absorbs sound.

    Raises
    ------
    ValueError
        If the height is out of range.
    """

    ground: float | Literal["flush"] | None = None
    level_flight: bool = False
    absorption: bool = False

    def __post_init__(self) -> None:
        """Refuse a height that is out of range."""
        if self.ground is not None and self.ground != "flush":
            HEIGHT.require("height above ground", self.ground)

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

    def up(self, incidence_deg: float = 0.0) -> tuple[float, float, float]:
        """Unit vector away from the ground in the rotor's axes.

        Parameters
        ----------
        incidence_deg : float
            Angle between the shaft and the direction of flight [deg].

        Returns
        -------
        (3,) tuple
            In level flight perpendicular to the flight, in the plane of shaft and flight.
        """
        if not self.level_flight:
            return 0.0, 0.0, 1.0
        incidence = math.radians(incidence_deg)
        return -math.cos(incidence), 0.0, math.sin(incidence)

    def from_ground_axes(self, positions: ArrayLike, incidence_deg: float = 0.0) -> Floats:
        """Positions in the rotor's axes.

        Parameters
        ----------
        positions : (..., 3) array
            Positions from the rotor centre [m], the third coordinate pointing up and, in level
            flight, the first one ahead.
        incidence_deg : float
            Angle between the shaft and the direction of flight [deg].

        Returns
        -------
        (..., 3) array
            Positions from the rotor centre, in its axes [m].
        """
        left, up = np.array([0.0, 1.0, 0.0]), np.array(self.up(incidence_deg))
        return np.asarray(positions, float) @ np.stack([np.cross(left, up), left, up])


@dataclasses.dataclass(frozen=True)
class ObserverGroup:
    """Neighbours in a list of observers that were placed together.

    Attributes
    ----------
    name : str
        Name of the group, for titles and tables.
    kind : {"arc", "point", "circle", "grid", "hemisphere"}
        Arrangement in which the observers of the group were placed.
    n : int
        Number of observers in the group.

    Raises
    ------
    ValueError
        If the group has no observers or its kind is another word.
    """

    name: str
    kind: GroupKind
    n: int

    def __post_init__(self) -> None:
        """Refuse groups without observers or of an unknown kind."""
        if self.kind not in get_args(GroupKind):
            kinds = ", ".join(get_args(GroupKind))
            raise ValueError(f"kind of observers must be one of {kinds}; it is {self.kind!r}")
        if self.n < 1:
            raise ValueError(f"group of observers {self.name!r} needs at least 1; it has {self.n}")


@dataclasses.dataclass(frozen=True, eq=False)
class Listening:
    """Observers of a propeller, and the ground and air around it.

    Attributes
    ----------
    observers : (n_observers, 3) array
        Positions from the rotor centre in the rotor's axes [m]; the observers fly along.
    surroundings : Surroundings
        Ground and air on the way to the observers.
    groups : tuple of ObserverGroup
        Groups of consecutive observers, together all of them; an empty tuple means that all
        observers are one group.

    Raises
    ------
    ValueError
        If the observers are not (n, 3), or the groups together have another number of observers.
    """

    observers: Floats = dataclasses.field(default_factory=lambda: np.zeros((0, 3)))
    surroundings: Surroundings = Surroundings()
    groups: tuple[ObserverGroup, ...] = ()

    def __post_init__(self) -> None:
        """Refuse positions without three coordinates and groups of other observers."""
        # The attribute of a frozen dataclass can only be set this way.
        object.__setattr__(self, "observers", require_positions(self.observers))
        n_grouped = sum(group.n for group in self.groups)
        if self.groups and n_grouped != len(self.observers):
            raise ValueError(
                f"groups must hold all {len(self.observers)} observers; they hold {n_grouped}"
            )


def require_number_of_observers(n_observers: int) -> None:
    """Refuse more observers than memory is for, before they are placed.

    Parameters
    ----------
    n_observers : int
        Number of observers.

    Raises
    ------
    ValueError
        If there are more than `MOST_OBSERVERS`.
    """
    if n_observers > MOST_OBSERVERS:
        raise ValueError(f"{n_observers} observers are more than the {MOST_OBSERVERS} allowed")


def require_positions(observers: ArrayLike) -> Floats:
    """Refuse observers whose positions are not finite or not (n, 3).

    Parameters
    ----------
    observers : (n, 3) array_like
        Positions from the rotor centre [m].

    Returns
    -------
    (n, 3) array
        The positions.

    Raises
    ------
    ValueError
        If there are more than `MOST_OBSERVERS`, or the positions have another shape or are not
        finite or too far away; the message names the functions that make positions.
    """
    positions = np.asarray(observers, float)
    if positions.ndim != 2 or positions.shape[1] != 3:
        raise ValueError(
            "observers must be positions from the rotor centre, an (n, 3) array [m]; this has the"
            f" shape {positions.shape}: propmdao.arc(radius, elevation_deg) makes them, and point,"
            " circle, hemisphere, grid"
        )
    require_number_of_observers(len(positions))
    if not np.isfinite(positions).all():
        k = int(np.argmin(np.isfinite(positions).all(axis=1)))
        raise ValueError(f"observer {k + 1} must be at a finite position; it is {positions[k]}")
    far = np.abs(positions).max(axis=1, initial=0.0) > DISTANCE.highest
    if far.any():
        k = int(np.argmax(far))
        raise ValueError(
            f"coordinates of observer {k + 1} must be at most {DISTANCE.highest:g} {DISTANCE.unit};"
            f" they are {positions[k]}"
        )
    return positions
