"""A model at several designs at once, component by component."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any, NamedTuple

import openmdao.api as om

from propmdao.components.bases.function_at_points import copied
from propmdao.components.bases.jax_component import JaxComponent
from propmdao.components.drivers.evaluation.candidate import Array
from propmdao.components.drivers.evaluation.model_run import (
    ModelRun,
    failure_message,
    record_run,
)
from propmdao.runtime.side_by_side import free_memory


class _Transfer(NamedTuple):
    """Handing over of inputs from a group to one of its subsystems."""

    group: om.Group
    subsystem: str


class _Step(NamedTuple):
    """A subsystem that runs, and the transfers that lead to it from the model down."""

    transfers: tuple[_Transfer, ...]
    subsystem: Any


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
        Designs in a batch, shared out to all devices. Memory grows with it, and code is compiled
        for just this number.

    Attributes
    ----------
    memory : int
        Bytes that a batch takes on each device, by the compiled code.

    Raises
    ------
    ValueError
        When there is no `JaxComponent` outside of groups that iterate, or a device has not the
        memory for so many designs.
    """

    def __init__(self, model: om.Group, at_once: int) -> None:
        self._model, self._at_once = model, at_once
        self._steps = list(_steps(model, ()))
        components = [s.subsystem for s in self._steps if isinstance(s.subsystem, JaxComponent)]
        if not components:
            raise ValueError(
                f"designs_at_once is {at_once}, but the model has no component that evaluates"
                " several designs at once: none of JAX outside of groups that iterate"
            )
        self.memory = max(component.batch_memory(at_once) for component in components)
        if self.memory > (free := free_memory()):
            raise ValueError(
                f"designs_at_once {at_once} needs {self.memory / 2**30:.3g} GiB on a device, and"
                f" {free / 2**30:.3g} GiB are free: {free * at_once // self.memory} designs fit"
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
            Runs in the order of `starts`.
        """
        starts = iter(starts)
        while batch := [ModelRun(start) for start in islice(starts, self._at_once)]:
            for step in self._steps:
                if isinstance(step.subsystem, JaxComponent):
                    self._run_together(step.transfers, step.subsystem, batch)
                else:
                    self._run_in_turn(step, batch)
            yield from batch

    def _run_together(
        self, transfers: tuple[_Transfer, ...], component: JaxComponent, batch: list[ModelRun]
    ) -> None:
        """Take the runs on by a component that evaluates all designs at once."""
        places = _places_under_way(batch)
        designs = []
        for place in places:
            self._restore(batch[place], transfers)
            designs.append(copied(component._inputs))
        results = component.evaluate_designs(designs, self._at_once)
        for place, values in zip(places, results, strict=True):
            if isinstance(values, om.AnalysisError):
                failure = _failure_of_run(component, values)
                batch[place] = dataclasses.replace(batch[place], failure=failure)
                continue
            self._outputs.set_val(batch[place].outputs)
            for name, value in values.items():
                component._outputs.set_var(name, value)
            batch[place] = ModelRun(self._outputs.asarray(copy=True))

    def _run_in_turn(self, step: _Step, batch: list[ModelRun]) -> None:
        """Take the runs on by a subsystem that knows of one design only."""
        for place in _places_under_way(batch):
            self._restore(batch[place], step.transfers)
            batch[place] = record_run(step.subsystem.run_solve_nonlinear, self._outputs)

    def _restore(self, run: ModelRun, transfers: tuple[_Transfer, ...]) -> None:
        """Make the model what it is where a run has come to a subsystem."""
        self._outputs.set_val(run.outputs)
        with self._model._scaled_context_all():
            for transfer in transfers:
                transfer.group._transfer("nonlinear", "fwd", transfer.subsystem)

    @property
    def _outputs(self) -> Any:
        return self._model.get_nonlinear_vectors()[1]


def _failure_of_run(component: om.ExplicitComponent, error: om.AnalysisError) -> str:
    """Return what OpenMDAO makes of an error that a component raises when it runs."""
    try:
        with component._call_user_function("compute"):
            raise error
    except om.AnalysisError as raised:
        return failure_message(raised)


def _places_under_way(batch: list[ModelRun]) -> list[int]:
    """Places of the runs that no exception has ended."""
    return [place for place, run in enumerate(batch) if not run.ended_early]


def _steps(group: om.Group, transfers: tuple[_Transfer, ...]) -> Iterator[_Step]:
    """Subsystems in the order in which they run, with the transfers that lead to them."""
    for subsystem in group._relevance.filter(group._all_subsystem_iter()):
        path = (*transfers, _Transfer(group, subsystem.name))
        if isinstance(subsystem, om.Group) and _runs_once(subsystem):
            yield from _steps(subsystem, path)
        elif not isinstance(subsystem, om.IndepVarComp):
            yield _Step(path, subsystem)


def _runs_once(group: om.Group) -> bool:
    return isinstance(group.nonlinear_solver, om.NonlinearRunOnce)
