"""Analyses of several propellers beside each other: their table and their sounds."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.analysis.comparisons import (
    Cell,
    Row,
    operation_and_levels,
    print_comparison,
    write_comparison,
)
from propmdao.commands import report
from propmdao.commands.output.results_folder import file_name
from propmdao.runtime.terminal import printable

if TYPE_CHECKING:
    from propmdao.analysis.results import Analysis


@dataclasses.dataclass(frozen=True)
class ComparedAnalyses:
    """Analyses at the same operating point, heard by the same observers.

    Attributes
    ----------
    analyses : mapping of str to Analysis
        Analyses by the name of the propeller; changes are from the first.
    results : mapping of str to dict
        The same with the keys of ``propmdao analyze --json``.
    observer : int or None
        Index of the observer of table and spectra; None where nobody listens.
    """

    analyses: Mapping[str, Analysis]
    results: Mapping[str, dict[str, Any]]
    observer: int | None

    @classmethod
    def beside(
        cls, analyses: Mapping[str, Analysis], observer: int | None = None
    ) -> ComparedAnalyses:
        """Set analyses beside each other.

        Parameters
        ----------
        analyses : mapping of str to Analysis
            Analyses by the name of the propeller.
        observer : int, optional
            Index of the observer, by default that of the first propeller's loudest tones.

        Returns
        -------
        ComparedAnalyses
            With their results.
        """
        results = {name: analysis.to_dict() for name, analysis in analyses.items()}
        if observer is None:
            levels = [place["oaspl_db"] for place in next(iter(results.values()))["observers"]]
            observer = levels.index(max(levels)) if levels else None
        return cls(analyses, results, observer)

    def print_table(self) -> None:
        """Print operating points, levels, and what keeps them from being used."""
        rows, columns = self._table()
        shown = {printable(name): column for name, column in columns.items()}
        print_comparison(rows, shown, n_changes=len(shown) - 1)
        report.print_doubts(list(self.results.values()))

    def write_table(self, path: Path) -> list[str]:
        """Write the table unrounded.

        Parameters
        ----------
        path : Path
            CSV file.

        Returns
        -------
        list of str
            The file.

        Raises
        ------
        OutputError
            If it cannot be written.
        """
        rows, columns = self._table()
        write_comparison(rows, columns, path, n_changes=len(columns) - 1)
        return [str(path)]

    def write_sounds(self, folder: Path, seconds: float, suffix: str = "") -> list[str]:
        """Write what the observers hear, a file for each propeller, all of one full scale.

        Parameters
        ----------
        folder : Path
            Folder of the files.
        seconds : float
            Length of the sounds [s].
        suffix : str
            Ending of the files' names in front of .wav.

        Returns
        -------
        list of str
            The files.

        Raises
        ------
        OutputError
            If one cannot be written.
        """
        from propmdao.analysis.sounds import write_sounds

        paths = {
            folder / f"{file_name(name)}{suffix}.wav": analysis
            for name, analysis in self.analyses.items()
        }
        return [str(sound.path) for sound in write_sounds(paths, seconds)]

    def _table(self) -> tuple[list[Row], dict[str, dict[str, Cell]]]:
        """Rows, and numbers by propeller."""
        columns = {}
        for name, result in self.results.items():
            rows, columns[name] = operation_and_levels(result, self.observer or 0)
        return rows, columns
