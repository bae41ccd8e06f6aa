"""A model as a function of a design: what is set before a run, and what is read after it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from openmdao.core.driver import Driver

from propmdao.components.drivers.evaluation.candidate import Array, Candidate, constraint_violations

Mask = NDArray[np.bool_]


class DesignProblem:
    """Design variables, objective and constraints of a driver's model.

    A design is set before a run of the model; a `Candidate` is read after it.

    Parameters
    ----------
    driver : Driver
        Driver of a Problem after its final setup. Every run starts from the output values that
        its model holds now.
    equality_tolerance : float
        Deviation from ``equals`` that counts as none, in driver scaling.

    Attributes
    ----------
    lower, upper : (n_variables,) arrays
        Bounds in declared units.
    """

    def __init__(self, driver: Driver, equality_tolerance: float) -> None:
        self._driver = driver
        self._equality_tolerance = equality_tolerance
        metas = driver._designvars.values()
        self.lower, self.upper = (
            np.concatenate([np.broadcast_to(meta[side], meta["size"]) for meta in metas])
            for side in ("lower", "upper")
        )
        self._initial = self.outputs.asarray(copy=True)

    @property
    def outputs(self) -> Any:
        """The model's vector of all outputs."""
        return self._driver._problem().model.get_nonlinear_vectors()[1]

    def at_position(self, position: Array) -> Array:
        """Design at a position (n_variables,) in the unit cube between the bounds."""
        design = self.lower + position * (self.upper - self.lower)
        return np.clip(design, self.lower, self.upper)

    def current_position(self) -> Array:
        """Position of the model's design, clipped to the bounds."""
        values = self._driver.get_design_var_values(driver_scaling=False).values()
        span = self.upper - self.lower
        from_lower = np.clip(np.concatenate(list(values)), self.lower, self.upper) - self.lower
        return from_lower / np.where(span > 0.0, span, 1.0)

    def set_design(self, design: Array) -> None:
        """Make the model ready to run at a design.

        Every run starts alike: states of a diverged solver would spoil the runs after it.
        """
        self.outputs.set_val(self._initial)
        start = 0
        for name, meta in self._driver._designvars.items():
            stop = start + meta["size"]
            self._driver._set_design_var(name, design[start:stop], units=meta["units"])
            start = stop

    def start_at(self, design: Array) -> Array:
        """Values of all outputs before a run at a design; the model is left so."""
        self.set_design(design)
        values: Array = self.outputs.asarray(copy=True)
        return values

    def responses(self) -> dict[str, Array]:
        """Values of the outputs that the objective and the constraints are taken from."""
        return {name: np.array(self.outputs._abs_get_val(name)) for name in self._sources()}

    def outputs_from(self, design: Array, responses: dict[str, Any]) -> Array:
        """All outputs where only `responses` are known; others than the independent are nan."""
        start = self.start_at(design)
        model = self._driver._problem().model
        for name, meta in model._var_allprocs_abs2meta["output"].items():
            if "openmdao:indep_var" not in meta["tags"]:
                self.outputs.set_var(name, np.nan)
        for name, value in responses.items():
            self.outputs._abs_get_val(name)[:] = value
        values: Array = self.outputs.asarray(copy=True)
        self.outputs.set_val(start)
        return values

    def candidate(self, design: Array, failure: str) -> Candidate:
        """Candidate of the model that has just run.

        Parameters
        ----------
        design : (n_variables,) array
            Design of the run.
        failure : str
            Reason for which the run has failed, empty when it has not.

        Returns
        -------
        Candidate
            A failed one also where the objective or a constraint is not finite.
        """
        if failure:
            return self._failed(design, failure)
        objectives = self._driver.get_objective_values(driver_scaling=False)
        energies = self._driver.get_objective_values()
        constraints = self._driver.get_constraint_values(driver_scaling=False)
        for name, value in {**objectives, **constraints}.items():
            if not np.isfinite(value).all():
                return self._failed(design, f"{name} is not finite: {value}")
        violations = [
            constraint_violations(constraints[name], meta, self._equality_tolerance)
            for name, meta in self._driver._cons.items()
        ]
        deviations = [
            constraint_violations(constraints[name], meta, 0.0)
            for name, meta in self._driver._cons.items()
            if meta["equals"] is not None
        ]
        # The leading zero is the constraint that the analysis succeeds.
        violation = np.concatenate([[0.0], *violations])
        (objective,), (energy,) = (v for values in (objectives, energies) for v in values.values())
        deviation = float(np.concatenate(deviations).max()) if deviations else np.nan
        return Candidate(design, float(objective), float(energy), violation, deviation=deviation)

    def equalities(self) -> Mask:
        """True (n_constraints,) where a violation of a candidate is of an equality."""
        metas = self._driver._cons.values()
        sizes = [meta["size"] for meta in metas]
        are_equal = np.repeat([meta["equals"] is not None for meta in metas], sizes)
        return np.concatenate([[False], are_equal.astype(bool)])

    def _failed(self, design: Array, failure: str) -> Candidate:
        n_constraints = sum(meta["size"] for meta in self._driver._cons.values())
        return Candidate.failed(design, 1 + n_constraints, failure)

    def description(self) -> dict[str, Any]:
        """Variables, responses and the initial design as JSON values: what the problem is."""
        driver = self._driver
        return {
            "design variables": _described(driver._designvars, ("lower", "upper")),
            "objective": _described(driver._objs, ()),
            "constraints": _described(driver._cons, ("lower", "upper", "equals")),
            "initial position": self.current_position().tolist(),
        }

    def _sources(self) -> list[str]:
        metas = [*self._driver._objs.values(), *self._driver._cons.values()]
        return list(dict.fromkeys(meta["source"] for meta in metas))


def require_bounds(driver: Driver) -> None:
    """Refuse a driver whose design variables have no finite bounds.

    Parameters
    ----------
    driver : Driver
        Driver that has been set up.

    Raises
    ------
    ValueError
        When a bound is missing or infinite, or the lower one is above the upper one.
    """
    for name, meta in driver._designvars.items():
        lower, upper = meta["lower"], meta["upper"]
        # OpenMDAO keeps None for a bound that was not given; users also write 1e30.
        if any(bound is None or not np.all(np.abs(bound) < 1e30) for bound in (lower, upper)):
            need = "finite bounds"
        elif np.any(np.greater(lower, upper)):
            need = "lower <= upper"
        else:
            continue
        raise ValueError(
            f"{driver.msginfo} needs {need}; design variable '{name}' has "
            f"lower={lower}, upper={upper}"
        )


def _described(metas: dict[str, Any], bounds: tuple[str, ...]) -> dict[str, Any]:
    """Names, sizes, units, scaling and bounds of design variables or responses."""
    keys = ("size", "units", "total_scaler", "total_adder", *bounds)
    return {
        name: {key: meta[key] if key == "units" else _plain(meta[key]) for key in keys}
        for name, meta in metas.items()
    }


def _plain(value: Any) -> Any:
    return None if value is None else np.asarray(value, dtype=float).tolist()
