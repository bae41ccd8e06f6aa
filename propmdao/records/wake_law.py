"""Speed and nodes of the prescribed wake: numbers that a study may vary."""

from __future__ import annotations

import dataclasses

from propmdao.records.pytrees import Scalar, record
from propmdao.records.units import Range

# The longest and finest wake has 360,000 nodes on a filament.
_TURNS = Range(0.01, 100.0)
_STEP_DEG = Range(0.1, 360.0, "deg")
_GROWTH = Range(1.0, 100.0)


@record
class WakeLaw:
    """Speed of the wake's sheets relative to the free stream, in induced velocities at the disk.

    `propmdao.aerodynamics.wakes.helical` has the physics. The defaults are those at which sheets in
    hover move as they themselves and the blades induce (``studies/validation/wake_transport.py``).

    Attributes
    ----------
    before_passage : scalar
        Speed of the outer part until the next blade has passed over it, times the number of blades.
    after_passage : scalar
        Speed of the outer part after that passage: the mean of both sides of the stream's edge.
    inside : scalar
        Speed of the inner part, carried by the air inside the stream.
    passage_width : scalar
        Width of the change from `before_passage` to `after_passage`, in blade passages.
    inner_edge : scalar
        r/R inward of which the sheet belongs to the inner part altogether.
    """

    before_passage: Scalar = 0.7
    after_passage: Scalar = 1.0
    inside: Scalar = 2.0
    passage_width: Scalar = 0.2
    inner_edge: Scalar = 0.7


@dataclasses.dataclass(frozen=True)
class WakeGrid:
    """Nodes of the wake: azimuths behind the blade, in steps that grow.

    The default is six turns, in steps from 10 deg at the blade to 30 deg. Sixteen turns in steps of
    2 to 10 deg, with seven times the segments, change thrust and torque by at most 0.15 %, but in
    hover, where the wake leaves slowly, by 1.4 % and 0.9 % (docs/verification.md).

    Attributes
    ----------
    turns : float
        Length of the wake in revolutions.
    first_step_deg, last_step_deg : float
        Smallest step, at the blade, and largest step [deg].
    growth : float
        Ratio of one step to the one before.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    turns: float = 6.0
    first_step_deg: float = 10.0
    growth: float = 1.1
    last_step_deg: float = 30.0

    def __post_init__(self) -> None:
        """Refuse lengths and steps of which no wake is made."""
        _TURNS.require("turns of a wake", self.turns)
        for name in ("first_step_deg", "last_step_deg"):
            _STEP_DEG.require(f"{name} of a wake", getattr(self, name))
        _GROWTH.require("growth of a wake's steps", self.growth)
