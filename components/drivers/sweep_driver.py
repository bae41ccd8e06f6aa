"""Design of experiments, as an OpenMDAO driver that keeps a table."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.core.driver import RecordingDebugging

from propmdao.components.drivers.evaluation.candidate import Array
from propmdao.components.drivers.evaluation.model_run import ModelRun
from propmdao.components.drivers.evaluation.model_runner import (
    ModelRunner,
    declare_runner_options,
    model_runner,
)
from propmdao.components.drivers.progress import declare_progress, progress_bar
from propmdao.components.drivers.same_model import require_same_results
from propmdao.formats.result_table import ResultTable, Value, table_files
from propmdao.runtime.locks import locked
from propmdao.runtime.output_files import make_folder, require_writable

Sample = dict[str, dict[str, Any]]


class SweepDriver(om.AnalysisDriver):
    """Runs the model at every sample of OpenMDAO's generators, into a table that is gone on with.

    It keeps the samples, responses and recorder of ``om.AnalysisDriver`` and adds:

    - A CSV file with a row per sample: its values, the responses (``add_responses``, as well as
      objectives and constraints of the model), ``status`` and the ``reason`` of a failure. Elements
      of arrays are columns ``name[0]``, ``name[1]`` and so on, in the units of the sample and of
      the response.
    - Samples that the table has are not run again, so a sweep that was interrupted or killed goes
      on, and one with more samples adds these. One that it has is run to see that the model is
      still the same.
    - Every run starts from the output values that the model held when the driver started, so that
      no row depends on the one before it; and the samples may run on workers, or several at once.

    A sample whose analysis raises an error, or has a response that is nan, has failed.

    Parameters
    ----------
    samples : list, tuple or AnalysisGenerator
        Dictionaries ``{name: {"val": ..., "units": ...}}``, or a generator that makes them, as
        ``om.AnalysisDriver`` takes them.
    **kwargs : dict
        Values of the options.

    Attributes
    ----------
    failures : list of str
        Reason for each of the samples that has failed, in the last run.
    """

    def __init__(self, samples: Any = None, **kwargs: Any) -> None:
        super().__init__(samples, **kwargs)
        self._name = "SweepDriver"
        self.failures: list[str] = []
        self._initial: Array = np.empty(0)  # values of all outputs that every run starts from

    def _declare_options(self) -> None:
        super()._declare_options()
        declare_runner_options(self.options)
        declare_progress(self.options)
        self.options.declare(
            "table",
            "sweep.csv",
            types=(str, os.PathLike),
            desc="Table, .csv, or .parquet, which is written at the end beside the .csv of that "
            "name; a relative path lies in the Problem's outputs directory.",
        )

    def run(self) -> bool:
        """Run the samples that the table does not have.

        Returns
        -------
        bool
            True when every sample has failed.
        """
        self.result.reset()
        self.iter_count = 0
        csv_file, parquet_file = table_files(
            self._problem().get_outputs_dir() / self.options["table"]
        )
        samples = self._checked_samples()
        make_folder(csv_file.parent)
        with locked(csv_file):
            return self._complete(csv_file, parquet_file, samples)

    def _complete(self, csv_file: Path, parquet_file: Path | None, samples: list[Sample]) -> bool:
        """Run the samples that the table does not have; whether every sample has failed."""
        points = [_point(sample) for sample in samples]
        table = ResultTable(csv_file, list(points[0]), list(self._results()))
        if parquet_file is not None:
            require_writable(parquet_file)
        self._initial = self._outputs().asarray(copy=True)
        self._require_same_model(table, samples, points)
        missing = table.missing(points)
        with (
            model_runner(self) as runner,
            contextlib.closing(
                runner.run(self._start_at(samples[place]) for place in missing)
            ) as runs,
            progress_bar(self, len(missing), "sample") as progress,
        ):
            for place in missing:
                self._metadata = {"success": 0, "msg": "not finished"}  # of an interrupted case
                with RecordingDebugging(self._get_name(), self.iter_count, self):
                    reason = self._reason(next(runs))
                    self._metadata = {"success": int(not reason), "msg": reason}
                self.iter_count += 1
                table.add(points[place], {} if reason else self._results(), reason)
                progress.update()
        if parquet_file is not None:
            table.write_parquet(parquet_file)
        self.failures = table.failures(points)
        return len(self.failures) == len(points)

    def _checked_samples(self) -> list[Sample]:
        """All samples; those of a CSV file are texts, in one dictionary that changes."""
        model = self._problem().model
        inputs = model.list_inputs(is_indep_var=True, out_stream=None)
        states = model.list_outputs(explicit=False, out_stream=None)
        allowed = {meta["prom_name"] for _, meta in [*inputs, *states]}
        samples = []
        for sample in self._generator:
            for name in sample:
                if name not in allowed:
                    raise ValueError(
                        f"{self.msginfo}: sampled '{name}' is no independent variable of the model"
                    )
            samples.append(
                {
                    name: {**meta, "val": np.asarray(meta["val"], dtype=float)}
                    for name, meta in sample.items()
                }
            )
        if not samples:
            raise ValueError(f"{self.msginfo}: there are no samples; a generator gives them once")
        return samples

    def _require_same_model(
        self, table: ResultTable, samples: list[Sample], points: list[dict[str, Value]]
    ) -> None:
        """Run a sample that the table has: rows of another model are not gone on with."""
        for sample, point in zip(samples, points, strict=True):
            if point not in table or table.row(point)["status"] != "ok":
                continue
            next(ModelRunner(self).run([self._start_at(sample)]))
            known = {name: float(table.row(point)[name]) for name in self._results()}
            require_same_results(f"'{table.path}'", str(point), known, self._results())
            return

    def _outputs(self) -> Any:
        return self._problem().model.get_nonlinear_vectors()[1]

    def _results(self) -> dict[str, float]:
        """Responses by column as the model holds them."""
        values = {
            **self.get_objective_values(driver_scaling=False),
            **self.get_constraint_values(driver_scaling=False),
        }
        if not values:
            raise ValueError(f"{self.msginfo} needs a response; add_responses names them")
        return _columns(values)

    def _start_at(self, sample: Sample) -> Array:
        """Values of all outputs before a run at a sample; the model is left so."""
        model, outputs = self._problem().model, self._outputs()
        outputs.set_val(self._initial)
        for name, meta in sample.items():
            model.set_val(name, meta["val"], meta.get("units"), meta.get("indices"))
        values: Array = outputs.asarray(copy=True)
        return values

    def _reason(self, run: ModelRun) -> str:
        """Reason why the run that the model comes from has failed, empty when it has not."""
        if run.error is not None:  # as om.AnalysisDriver: a survey does not end at a sample
            return f"{type(run.error).__name__}: {run.error}"
        if run.failure:
            return run.failure
        nans = [name for name, value in self._results().items() if np.isnan(value)]
        return f"{', '.join(nans)} is nan" if nans else ""


def _point(sample: Sample) -> dict[str, Value]:
    return dict(_columns({name: meta["val"] for name, meta in sample.items()}))


def _columns(values: dict[str, Any]) -> dict[str, float]:
    """Numbers by column, arrays as one column per element."""
    columns: dict[str, float] = {}
    for name, value in values.items():
        flat = np.ravel(value).tolist()
        names = [name] if len(flat) == 1 else [f"{name}[{i}]" for i in range(len(flat))]
        columns.update(zip(names, flat, strict=True))
    return columns
