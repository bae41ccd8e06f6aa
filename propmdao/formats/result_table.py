"""A table of points and their results, as a CSV file that grows row by row."""

from __future__ import annotations

import csv
import importlib.util
import io
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from propmdao.runtime.input_files import read_bytes
from propmdao.runtime.output_files import append, make_folder, replacing, require_writable

Value = float | int | str | bool
STATUS, REASON = "status", "reason"


class ResultTable:
    """A CSV file with a row for each point, to which results are added as they come.

    The file has a header and these columns: those of the point, those of its results, ``status``
    ("ok" or "failed") and ``reason`` (the reason of a failure, on one line). Rows are added to an
    existing file, after the piece of a row that a killed process may have left has been cut off.

    Parameters
    ----------
    path : path
        CSV file; the file and its folder are made if they do not exist.
    point_columns, result_columns : sequence of str
        Names of the columns that tell points apart, and of the columns for their results.

    Raises
    ------
    ValueError
        If the file cannot be written, has other columns, or rows that do not fit the columns.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        point_columns: Sequence[str],
        result_columns: Sequence[str],
    ) -> None:
        self.path = Path(path)
        self._point_columns = list(point_columns)
        self._columns = [*point_columns, *result_columns, STATUS, REASON]
        self._rows: dict[tuple[str, ...], list[str]] = {}
        make_folder(self.path.parent)
        require_writable(self.path)
        if self.path.exists() and self.path.stat().st_size > 0:
            self._read()
        else:
            append(self.path, _line(self._columns).encode())

    def __contains__(self, point: Mapping[str, Value]) -> bool:
        """True if the table has a row for the point."""
        return self._key(point) in self._rows

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self._rows)

    def missing(self, points: Sequence[Mapping[str, Value]]) -> list[int]:
        """Indices of the points that have no row yet, each point once."""
        first = {self._key(point): index for index, point in reversed([*enumerate(points)])}
        return sorted(index for key, index in first.items() if key not in self._rows)

    def row(self, point: Mapping[str, Value]) -> dict[str, str]:
        """Return the cells of a point's row by column."""
        return dict(zip(self._columns, self._rows[self._key(point)], strict=True))

    def add(
        self, point: Mapping[str, Value], results: Mapping[str, Value], reason: str = ""
    ) -> None:
        """Add the row of a point.

        Parameters
        ----------
        point : mapping
            Value of every point column.
        results : mapping
            Values of the result columns; one that is missing leaves its cell empty.
        reason : str
            Reason why the point has failed; empty for one that has not.

        Raises
        ------
        OutputError
            If the row cannot be written; those before it are kept.
        """
        row = {**point, **results}
        row |= {STATUS: "failed" if reason else "ok", REASON: " ".join(reason.split())}
        cells = [_text(row[name]) if name in row else "" for name in self._columns]
        append(self.path, _line(cells).encode())
        self._rows[self._key(point)] = cells

    def failures(self, points: Sequence[Mapping[str, Value]]) -> list[str]:
        """Reason of each of the points that has failed."""
        rows = [self._rows[self._key(point)] for point in points]
        return [reason for *_, status, reason in rows if status == "failed"]

    def write_parquet(self, path: str | os.PathLike[str]) -> None:
        """Write the table as a Parquet file too, numbers as 64-bit floats.

        Parameters
        ----------
        path : path
            File to write or replace.

        Raises
        ------
        OutputError
            If the file cannot be written.
        """
        # An extra, and without type information.
        pyarrow, parquet = map(importlib.import_module, ("pyarrow", "pyarrow.parquet"))
        columns = {}
        for name, *cells in zip(self._columns, *self._rows.values(), strict=True):
            columns[name] = cells if name in (STATUS, REASON) else _typed(cells)
        with replacing(path) as file:
            parquet.write_table(pyarrow.table(columns), file)

    def _key(self, point: Mapping[str, Value]) -> tuple[str, ...]:
        return tuple(_text(point[name]) for name in self._point_columns)

    def _read(self) -> None:
        content = read_bytes(self.path, ValueError)
        whole = content[: content.rfind(b"\n") + 1]
        try:
            header, *rows = csv.reader(io.StringIO(whole.decode()), strict=True)
        except (ValueError, csv.Error):
            header, rows = [], []
        if header != self._columns:
            raise ValueError(
                f"'{self.path}' holds something else than this sweep, its columns differ:"
                f" {_differences(header, self._columns)}; name another file, or delete it to start"
                " anew"
            )
        for number, row in enumerate(rows, start=2):
            if len(row) != len(self._columns):
                raise ValueError(
                    f"'{self.path}' has {len(row)} cells in row {number} and"
                    f" {len(self._columns)} columns; mend or delete that row to go on"
                )
            self._rows[tuple(row[: len(self._point_columns)])] = row
        if len(whole) < len(content):
            os.truncate(self.path, len(whole))


def table_files(path: str | os.PathLike[str]) -> tuple[Path, Path | None]:
    """CSV and Parquet file for the name that a user has given a table.

    Parameters
    ----------
    path : path
        Name with the ending .csv, or .parquet for a Parquet file beside a CSV file of that name.

    Returns
    -------
    csv_file : pathlib.Path
        File that grows row by row.
    parquet_file : pathlib.Path or None
        File that is to be written at the end, if the name asks for one.

    Raises
    ------
    ValueError
        If the ending is another one, or pyarrow (an extra) is not installed for .parquet.
    """
    path = Path(path)
    if path.suffix == ".csv":
        return path, None
    if path.suffix != ".parquet":
        raise ValueError(f"a table ends in .csv or .parquet; '{path}' does not")
    if importlib.util.find_spec("pyarrow") is None:  # before the work, not after
        raise ValueError("Parquet files need pyarrow: pip install 'propmdao[parquet]'")
    return path.with_suffix(".csv"), path


def _differences(present: list[str], wanted: list[str]) -> str:
    """Name the columns that only one of two headers has."""
    only = [f"{name} only there" for name in present if name not in wanted][:3]
    only += [f"{name} only here" for name in wanted if name not in present][:3]
    return ", ".join(only) or "their order"


def _text(value: Value) -> str:
    """Text of a value; a number is read back from it with every digit."""
    return value if isinstance(value, str) else repr(value)


def _typed(cells: list[str]) -> list[float | None] | list[bool | None] | list[str]:
    """Numbers, truth values or texts, whichever a whole column is; None for empty cells."""
    if set(cells) <= {"True", "False", ""}:
        return [cell == "True" if cell else None for cell in cells]
    try:
        return [float(cell) if cell else None for cell in cells]
    except ValueError:
        return cells


def _line(cells: Sequence[str]) -> str:
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow(cells)
    return line.getvalue()
