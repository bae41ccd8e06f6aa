"""What a march in time finds: loads of the mean of its last revolutions, and how it got there."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from jax import Array

from propmdao.aerodynamics.solutions.result import TiltedLoads
from propmdao.records.pytrees import record, static


@record
class MarchedLoads(TiltedLoads):
    """Loads of a march in time: the mean of the last revolutions, as loads that repeat every turn.

    Attributes
    ----------
    thrust_history, torque_history : (n_steps,) arrays
        Thrust and torque of all blades at each step [N], [N m].
    change : (n_revolutions - 1,) array
        Change of the thrust from each revolution to the next, root of the mean square over the
        turn, over that of the thrust.
    average : int
        Revolutions of the mean.
    settled : bool
        Whether the revolutions of the mean change by no more than the tolerance.
    wake : (n_blades, n_filaments, n_nodes, 3) array
        Nodes of the wake of all blades at the end, in the axes of the rotor that do not turn [m].
    wake_age : (n_nodes,) array
        Azimuths by which the blade is ahead of the nodes [rad].
    snapshots : (n_snapshots, n_blades, n_filaments, n_nodes, 3) array
        The same at moments equally spaced over the march.
    snapshot_azimuth : (n_snapshots,) array
        Azimuth of blade 1 at those moments, turns counted [rad].
    """

    thrust_history: Array
    torque_history: Array
    change: Array
    settled: Array
    wake: Array
    wake_age: Array
    snapshots: Array
    snapshot_azimuth: Array
    average: int = static()

    @property
    def thrust_by_revolution(self) -> np.ndarray:
        """Mean thrust of each revolution, (n_revolutions,) [N]."""
        return self._by_revolution(self.thrust_history)

    @property
    def torque_by_revolution(self) -> np.ndarray:
        """Mean torque of each revolution, (n_revolutions,) [N m]."""
        return self._by_revolution(self.torque_history)

    def _by_revolution(self, history: Array) -> np.ndarray:
        steps_per_turn = len(self.blade_force)
        of_turns: np.ndarray = np.asarray(history).reshape(-1, steps_per_turn).mean(axis=1)
        return of_turns

    @property
    def unsettled(self) -> str | None:
        """Why the revolutions are no mean that lasts, in one line; None where they are."""
        if self.settled:
            return None
        if not self.change.size:
            return "one revolution of a march does not show whether the loads repeat"
        largest = float(self.change[-max(self.average - 1, 1) :].max())
        return (
            f"thrust of the march changes by {100.0 * largest:.2g} % from one revolution to the"
            " next"
        )


@dataclasses.dataclass(frozen=True)
class MarchProgress:
    """Where a march is.

    Attributes
    ----------
    step, n_steps : int
        Steps done, and of the whole march.
    CT : float
        Thrust coefficient T / (rho n^2 D^4) at the step.
    seconds_left : float
        Time that the rest will take at the pace so far [s]; not a number before the second step.
    memory : int
        Memory that the march needs, about [bytes].
    """

    step: int
    n_steps: int
    CT: float
    seconds_left: float
    memory: int


#: Called after every step.
Progress = Callable[[MarchProgress], None]


def changes(thrust: np.ndarray, steps_per_turn: int) -> np.ndarray:
    """Change of the thrust from each whole revolution to the next.

    Parameters
    ----------
    thrust : (n_steps,) array
        Thrust at each step [N].
    steps_per_turn : int
        Steps of a revolution.

    Returns
    -------
    (n_revolutions - 1,) array
        Root of the mean square of the change over the turn, over that of the thrust.
    """
    turns = thrust.reshape(-1, steps_per_turn)
    size = np.sqrt((turns**2).mean(axis=1))
    apart = np.sqrt((np.diff(turns, axis=0) ** 2).mean(axis=1))
    ratios: np.ndarray = apart / np.maximum(size[1:], np.finfo(float).tiny)
    return ratios
