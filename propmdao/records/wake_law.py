"""Speed and nodes of the prescribed wake: numbers that a study may vary."""

from __future__ import annotations

import dataclasses

from propmdao.records.pytrees import Scalar, record


@record
class WakeLaw:
    """Speed of the wake's sheets relative to the free stream, in induced velocities at the disk.

    `propmdao.aerodynamics.wakes.helical` has the physics. The defaults are those at which sheets in
    hover move as they themselves and the blades induce (``studies/wake_transport.py``).

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
        If the wake has no length, or its steps no size.
    """

    turns: float = 6.0
    first_step_deg: float = 10.0
    growth: float = 1.1
    last_step_deg: float = 30.0

    def __post_init__(self) -> None:
        """Refuse lengths and steps that are not positive, and a growth below 1."""
        for name in ("turns", "first_step_deg", "last_step_deg"):
            value = getattr(self, name)
            if not 0.0 < value < float("inf"):
                raise ValueError(f"{name} of a wake must be positive; it is {value:g}")
        if not 1.0 <= self.growth < float("inf"):
            raise ValueError(f"growth of a wake's steps must be 1 or more; it is {self.growth:g}")
