"""One run of a model as values: what it has left, and how a model comes to hold that."""

from __future__ import annotations

import dataclasses
from typing import Any

import openmdao.api as om

from propmdao.components.drivers.evaluation.candidate import Array


@dataclasses.dataclass(frozen=True)
class ModelRun:
    """What a run of a model has left.

    Attributes
    ----------
    outputs : (n,) array
        All outputs of the model, as its outputs vector holds them.
    failure : str
        Message of the `om.AnalysisError` that ended the run, empty when there was none.
    error : Exception or None
        What else was raised.
    built : bool
        False when it was raised by building the model.
    """

    outputs: Array
    failure: str = ""
    error: Exception | None = None
    built: bool = True


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


def run_system(system: Any, outputs: Any) -> ModelRun:
    """Run a system of a model, or the whole model, from what the model holds.

    Parameters
    ----------
    system : System
        What runs.
    outputs : Vector
        Outputs vector of the whole model.

    Returns
    -------
    ModelRun
        What it has left.
    """
    failure = ""
    try:
        system.run_solve_nonlinear()
    except om.AnalysisError as error:
        failure = said(error)
    return ModelRun(outputs.asarray(copy=True), failure)


def said(error: om.AnalysisError) -> str:
    """Return why an analysis failed, which is never empty."""
    return str(error) or "AnalysisError without a message"
