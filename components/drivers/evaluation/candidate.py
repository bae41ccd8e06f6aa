"""Designs that a search has tried: how badly they violate, and which of two is better."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Candidate:
    """One evaluated design.

    Attributes
    ----------
    design : (n_variables,) array
        Design variables in their declared units.
    objective : float
        Objective in its declared units; nan when the analysis failed.
    energy : float
        Objective in driver scaling, minimised; infinite when the analysis failed.
    violation : (n_constraints,) array
        Violation of every constraint element in driver scaling, 0 where it holds; infinite when
        the analysis failed.
    failure : str
        Reason for which the analysis failed, empty when it did not.
    deviation : float
        Largest deviation from ``equals`` in driver scaling, tolerated or not; nan when the analysis
        failed or nothing has to equal.
    """

    design: Array
    objective: float
    energy: float
    violation: Array
    failure: str = ""
    deviation: float = np.nan

    @classmethod
    def failed(cls, design: Array, n_constraints: int, failure: str) -> Candidate:
        """Return a design whose analysis failed: it loses against every other.

        Its violation is infinite and not nan, which scipy takes for feasible.
        """
        return cls(design, np.nan, np.inf, np.full(n_constraints, np.inf), failure)

    def relaxed_violation(self, slack: Array) -> Array:
        """Violation where the bounds of every constraint element are wider by a slack."""
        if self.failure:  # an infinite one, which no slack makes feasible
            return self.violation
        return np.maximum(self.violation - slack, 0.0)

    @property
    def feasible(self) -> bool:
        """True when every constraint holds."""
        return not self.violation.any()

    @property
    def rank(self) -> tuple[bool, float]:
        """Key that sorts best first: feasible by objective, then infeasible by total violation."""
        return not self.feasible, self.energy if self.feasible else float(self.violation.sum())


def constraint_violations(value: Array, meta: dict[str, Any], equality_tolerance: float) -> Array:
    """Return how far each element of one constraint lies outside its bounds.

    Parameters
    ----------
    value : (n,) array
        Value of the constraint in its declared units.
    meta : dict
        OpenMDAO's metadata of the constraint: ``equals`` or ``lower`` and ``upper``,
        ``total_scaler``.
    equality_tolerance : float
        Deviation from ``equals`` that counts as none, in driver scaling.

    Returns
    -------
    (n,) array
        Violations in driver scaling, 0 where the element is within its bounds.
    """
    # Bounds are compared before scaling: a negative scaler would swap them.
    scale = 1.0 if meta["total_scaler"] is None else np.abs(meta["total_scaler"])
    if meta["equals"] is not None:
        return np.maximum(scale * np.abs(value - meta["equals"]) - equality_tolerance, 0.0)
    lower = -np.inf if meta["lower"] is None else meta["lower"]
    upper = np.inf if meta["upper"] is None else meta["upper"]
    return scale * np.maximum(np.maximum(lower - value, value - upper), 0.0)
