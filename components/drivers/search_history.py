"""What a driver has tried, from the cases that it recorded."""

from __future__ import annotations

import dataclasses
import os

import numpy as np
import openmdao.api as om

from propmdao.components.drivers.evaluation.candidate import Array, constraint_violations


@dataclasses.dataclass(frozen=True)
class SearchHistory:
    """Designs that a driver has tried, in the order in which it did.

    Attributes
    ----------
    objective : (n_evaluations,) array
        In its declared units; nan where the analysis failed.
    violation : (n_evaluations,) array
        Largest violation of a constraint in driver scaling, 0 where all hold; infinite where the
        analysis failed.
    constraint : (n_evaluations,) list of str
        Which constraint that is, empty where all hold.
    """

    objective: Array
    violation: Array
    constraint: list[str]


def read_history(prob: om.Problem, file: str | os.PathLike[str]) -> SearchHistory:
    """Read what the driver of a problem has recorded.

    Parameters
    ----------
    prob : om.Problem
        After ``run_driver`` and ``cleanup``, with one objective. Its driver had a recorder.
    file : path
        The recorder's file.

    Returns
    -------
    SearchHistory
        A row for each run of the model. OpenMDAO's SLSQP starts with two runs of the same design.
    """
    (objective,) = prob.driver._objs.values()
    constraints = prob.driver._cons
    rows = []
    for case in om.CaseReader(os.fspath(file)).get_cases("driver"):
        if not case.success:
            rows.append((np.nan, np.inf, case.msg))
            continue
        by_name = {
            name: float(constraint_violations(
                case.get_val(meta["name"], units=meta["units"]).ravel(), meta, 0.0
            ).max())
            for name, meta in constraints.items()
        }  # fmt: skip
        worst = max(by_name, key=by_name.__getitem__)
        value = case.get_val(objective["name"], units=objective["units"])
        violation = by_name[worst]
        rows.append((float(value.ravel()[0]), violation, worst if violation > 0.0 else ""))
    values, violations, names = zip(*rows, strict=True)
    return SearchHistory(np.array(values), np.array(violations), list(names))
