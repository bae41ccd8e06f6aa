"""What the edgewise advance ratio V sin(incidence) / (Omega R) decides: wake length, warning."""

from __future__ import annotations

import dataclasses
import warnings

from propmdao.records.pytrees import Scalar
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid

_SLOW, _LONGER = 0.05, 1.5  # below that ratio the wake stays near and has so many times the turns
_FAST = 0.3  # beyond it results are doubtful


class FastEdgewiseWarning(UserWarning):
    """A rotor flies edgewise so fast that its retreating side stalls."""


def edgewise_advance_ratio(state: RotorState, radius: Scalar) -> float:
    """Edgewise flight speed over the speed of the tip; call it outside ``jit``.

    Parameters
    ----------
    state : RotorState
        Rotation speed, flight speed and incidence of the rotor.
    radius : float
        Tip radius [m].

    Returns
    -------
    float
        V sin(incidence) / (Omega R), 0 for a rotor that does not turn.
    """
    tip_speed = float(state.rotation_speed) * float(radius)
    return float(state.edgewise_speed) / tip_speed if tip_speed else 0.0


def is_slow(ratio: float) -> bool:
    """Whether the wake stays near at an edgewise advance ratio, and has to be longer."""
    return ratio < _SLOW


def longer(grid: WakeGrid) -> WakeGrid:
    """Grid of the wake in slow flight, from that of faster flight."""
    return dataclasses.replace(grid, turns=_LONGER * grid.turns)


def grid_for(ratio: float, grid: WakeGrid) -> WakeGrid:
    """Grid of the wake at an edgewise advance ratio, from that of faster flight."""
    return longer(grid) if is_slow(ratio) else grid


def warn_if_fast(ratio: float, stacklevel: int) -> None:
    """Warn of an edgewise advance ratio at which the retreating side stalls.

    Parameters
    ----------
    ratio : float
        Edgewise advance ratio.
    stacklevel : int
        Level of the stack to which the warning points, as `warnings.warn` counts, from the caller.
    """
    if ratio > _FAST:
        warnings.warn(
            f"advance ratio V sin(incidence) / (Omega R) {ratio:.3g} is above {_FAST:g}: the"
            " retreating side stalls and meets the air from behind, and dynamic stall is not"
            " modelled",
            FastEdgewiseWarning,
            stacklevel=stacklevel + 1,
        )
