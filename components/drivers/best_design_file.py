"""The best design so far as a JSON file that is whole at any time."""

from __future__ import annotations

import json
import pathlib
from typing import Any

from openmdao.core.driver import Driver

from propmdao.runtime.output_files import replacing


def write_best_design(path: pathlib.Path, driver: Driver, evaluations: int) -> None:
    """Write the design, objective and constraints that the driver's model holds now.

    The file is replaced in one step, so that an interrupted run leaves the last whole one.

    Parameters
    ----------
    path : pathlib.Path
        File to write or replace; its folder must exist.
    driver : Driver
        Driver of a model that has just run.
    evaluations : int
        Designs evaluated up to this one, written with it.
    """
    model = driver._problem().model
    sources = model._var_allprocs_abs2meta["output"]

    def with_units(metas: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
        return {
            name: {
                "value": values[name].tolist(),
                "units": meta["units"] or sources[meta["source"]]["units"],
            }
            for name, meta in metas.items()
        }

    content = {
        "evaluations": evaluations,
        "objective": with_units(driver._objs, driver.get_objective_values(driver_scaling=False)),
        "design_variables": with_units(
            driver._designvars, driver.get_design_var_values(driver_scaling=False)
        ),
        "constraints": with_units(driver._cons, driver.get_constraint_values(driver_scaling=False)),
    }
    with replacing(path) as file:
        file.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
