"""The designs that a driver has tried, from the cases that it recorded."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import openmdao.api as om

from propmdao.components.drivers.evaluation.candidate import Array, constraint_violations


@dataclasses.dataclass(frozen=True)
class SearchHistory:
    """Designs that a driver has tried, in the order in which it did.

    Attributes
    ----------
    objective : (n_evaluations,) array
        Objective in its declared units; nan where the analysis failed.
    violation : (n_evaluations,) array
        Largest violation of a constraint in driver scaling, 0 where all hold; infinite where the
        analysis failed.
    constraint : (n_evaluations,) list of str
        Name of the constraint that is violated most, empty where all hold; the reason where the
        analysis failed.
    """

    objective: Array
    violation: Array
    constraint: list[str]


class SearchRecorder(om.SqliteRecorder):
    """OpenMDAO's recorder that does not wait for the disk.

    OpenMDAO has each case written four times before the next design is run: a millisecond or two on
    a fast disk, far longer on a slow one. Here the system writes when it has time, whatever
    becomes of this process; only where the whole machine goes down cases may be missing.

    Parameters
    ----------
    file : path
        File of the cases.
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        # A relative path OpenMDAO takes from its own output folder.
        super().__init__(os.path.abspath(file), record_viewer_data=False)

    def startup(self, recording_requester: Any, comm: Any = None) -> None:
        """Prepare for a new run."""
        super().startup(recording_requester, comm)
        if self.connection:  # none where another process of MPI records
            self.connection.execute("PRAGMA synchronous = OFF")


class Trial(NamedTuple):
    """One design of a `SearchHistory`.

    Attributes
    ----------
    objective : float
        Objective in its declared units; nan where the analysis failed.
    violation : float
        Largest violation of a constraint in driver scaling; infinite where the analysis failed.
    constraint : str
        Name of that constraint, or the reason of the failure.
    """

    objective: float
    violation: float
    constraint: str


def trial_of(objective: float, values: Mapping[str, Array], metas: Mapping[str, Any]) -> Trial:
    """Judge a design that has been analysed.

    Parameters
    ----------
    objective : float
        Objective in its declared units.
    values : mapping of str to array
        Constraints by name, in their declared units.
    metas : mapping of str to dict
        OpenMDAO's metadata of the constraints.

    Returns
    -------
    Trial
        The design.
    """
    by_name = {
        name: float(constraint_violations(values[name].ravel(), meta, 0.0).max())
        for name, meta in metas.items()
    }
    worst = max(by_name, key=by_name.__getitem__, default="")
    violation = by_name.get(worst, 0.0)
    return Trial(objective, violation, worst if violation > 0.0 else "")


def read_history(prob: om.Problem, file: str | os.PathLike[str]) -> SearchHistory:
    """Read the cases that the driver of a problem has recorded.

    Parameters
    ----------
    prob : om.Problem
        Problem after ``run_driver`` and ``cleanup``, with one objective. Its driver had a recorder.
    file : path
        File of the recorder.

    Returns
    -------
    SearchHistory
        History with an entry for each run of the model. OpenMDAO's SLSQP starts with two runs of
        the same design.
    """
    (objective,) = prob.driver._objs.values()
    constraints = prob.driver._cons
    trials = []
    for case in om.CaseReader(os.fspath(file)).get_cases("driver"):
        if not case.success:
            trials.append(Trial(np.nan, np.inf, case.msg))
            continue
        values = {
            name: case.get_val(meta["name"], units=meta["units"])
            for name, meta in constraints.items()
        }
        value = case.get_val(objective["name"], units=objective["units"])
        trials.append(trial_of(float(value.ravel()[0]), values, constraints))
    return SearchHistory(
        objective=np.array([trial.objective for trial in trials]),
        violation=np.array([trial.violation for trial in trials]),
        constraint=[trial.constraint for trial in trials],
    )
