"""One run of a model as values: what it has left, and how a model comes to hold that."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import openmdao.api as om

from propmdao.components.drivers.evaluation.candidate import Array


@dataclasses.dataclass(frozen=True)
class ModelRun:
    """State in which a run has left a model, and why it ended early.

    Attributes
    ----------
    outputs : (n,) array
        All outputs of the model, as its outputs vector holds them.
    failure : str
        Message of the `om.AnalysisError` that ended the run, empty when there was none.
    error : Exception or None
        Any other exception that ended the run.
    built : bool
        False when the error was raised by building the model.
    """

    outputs: Array
    failure: str = ""
    error: Exception | None = None
    built: bool = True

    @property
    def ended_early(self) -> bool:
        """True when an exception ended the run."""
        return bool(self.failure) or self.error is not None


def put_outputs(model: om.Group, values: Array) -> None:
    """Make a model what it would be after a run that has left these outputs.

    Parameters
    ----------
    model : om.Group
        The whole model of a Problem.
    values : (n,) array
        All outputs, as its outputs vector holds them.
    """
    model.get_nonlinear_vectors()[1].set_val(values)
    with model._scaled_context_all():  # as during a run: inputs take scaled outputs
        for group in model.system_iter(include_self=True, typ=om.Group):
            group._transfer("nonlinear", "fwd")


def record_run(solve: Callable[[], object], outputs: Any) -> ModelRun:
    """Run a model, or a part of it, from what it holds.

    Parameters
    ----------
    solve : callable
        ``run_solve_nonlinear`` of the model or the part.
    outputs : Vector
        Outputs vector of the whole model.

    Returns
    -------
    ModelRun
        Outputs after the run, and the exception that has ended it, if any.
    """
    failure, other = "", None
    try:
        solve()
    except om.AnalysisError as error:
        failure = failure_message(error)
    except Exception as error:  # what becomes of it, the driver says
        other = error
    return ModelRun(outputs.asarray(copy=True), failure, other)


def failure_message(error: om.AnalysisError) -> str:
    """Return why an analysis failed, which is never empty."""
    return str(error) or "AnalysisError without a message"
