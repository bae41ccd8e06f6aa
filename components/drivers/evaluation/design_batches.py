"""Runs of a model at several designs at once, component by component."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

import openmdao.api as om

from propmdao.components.bases.jax_component import JaxComponent, copied
from propmdao.components.drivers.evaluation.candidate import Array
from propmdao.components.drivers.evaluation.model_run import ModelRun, run_system, said

# Groups from the model down, each with the name of the subsystem that it hands inputs to.
_Path = tuple[tuple[om.Group, str], ...]


class DesignBatches:
    """A model whose `JaxComponent`s evaluate several designs in one compiled call.

    A batch of designs goes through the model as a single one does, subsystem by subsystem. What is
    no `JaxComponent`, and a group with a solver that iterates, runs at one design after the other.
    A design that fails takes no further part.

    Parameters
    ----------
    model : om.Group
        Model of a Problem after its final setup.
    at_once : int
        Designs in a batch. Memory grows with it, and code is compiled for just this number.

    Raises
    ------
    ValueError
        When there is no `JaxComponent` outside of groups that iterate.
    """

    def __init__(self, model: om.Group, at_once: int) -> None:
        self._model, self._at_once = model, at_once
        self._steps = list(_steps(model, ()))
        if not any(isinstance(subsystem, JaxComponent) for _, subsystem in self._steps):
            raise ValueError(
                f"designs_at_once is {at_once}, but the model has no component that evaluates"
                " several designs at once: none of JAX outside of groups that iterate"
            )

    def run(self, starts: Iterable[Array]) -> Iterator[ModelRun]:
        """Run the model from each of several outputs vectors.

        Parameters
        ----------
        starts : iterable of (n,) arrays
            Values of all outputs before each run.

        Yields
        ------
        ModelRun
            In the order of `starts`.
        """
        starts = iter(starts)
        while batch := [ModelRun(start) for start in islice(starts, self._at_once)]:
            for path, subsystem in self._steps:
                step = self._at_all if isinstance(subsystem, JaxComponent) else self._at_each
                step(path, subsystem, batch)
            yield from batch

    def _at_all(self, path: _Path, component: JaxComponent, batch: list[ModelRun]) -> None:
        """Take the runs on by a component that evaluates all designs at once."""
        going = list(_going(batch))
        designs = []
        for place in going:
            self._reach(path, batch[place])
            designs.append(copied(component._inputs))
        for place, values in zip(
            going, component.evaluate_designs(designs, self._at_once), strict=True
        ):
            if isinstance(values, om.AnalysisError):
                failure = _as_of_a_run(component, values)
                batch[place] = dataclasses.replace(batch[place], failure=failure)
                continue
            self._outputs.set_val(batch[place].outputs)
            for name, value in values.items():
                component._outputs.set_var(name, value)
            batch[place] = ModelRun(self._outputs.asarray(copy=True))

    def _at_each(self, path: _Path, subsystem: Any, batch: list[ModelRun]) -> None:
        """Take the runs on by a subsystem that knows of one design only."""
        for place in _going(batch):
            self._reach(path, batch[place])
            try:
                batch[place] = run_system(subsystem, self._outputs)
            except Exception as error:  # what becomes of it, the driver says
                batch[place] = dataclasses.replace(batch[place], error=error)

    def _reach(self, path: _Path, run: ModelRun) -> None:
        """Make the model what it is where a run has come to a subsystem."""
        self._outputs.set_val(run.outputs)
        with self._model._scaled_context_all():
            for group, name in path:
                group._transfer("nonlinear", "fwd", name)

    @property
    def _outputs(self) -> Any:
        return self._model.get_nonlinear_vectors()[1]


def _as_of_a_run(component: om.ExplicitComponent, error: om.AnalysisError) -> str:
    """Return what OpenMDAO makes of an error that a component raises when it runs."""
    try:
        with component._call_user_function("compute"):
            raise error
    except om.AnalysisError as told:
        return said(told)


def _going(batch: list[ModelRun]) -> Iterator[int]:
    """Places of the runs that have not failed."""
    for place, run in enumerate(batch):
        if not run.failure and run.error is None:
            yield place


def _steps(group: om.Group, path: _Path) -> Iterator[tuple[_Path, Any]]:
    """Subsystems in the order in which they run, with the transfers that lead to them."""
    for subsystem in group._relevance.filter(group._all_subsystem_iter()):
        there = (*path, (group, subsystem.name))
        if isinstance(subsystem, om.Group) and _runs_once(subsystem):
            yield from _steps(subsystem, there)
        elif not isinstance(subsystem, om.IndepVarComp):
            yield there, subsystem


def _runs_once(group: om.Group) -> bool:
    return isinstance(group.nonlinear_solver, om.NonlinearRunOnce)
