"""The table to which a sweep adds rows: what is in it stays, digit by digit."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import pytest

from propmdao.formats.result_table import ResultTable, table_files

POINT = {"name": "blade, new", "rpm": 0.1 + 0.2}


def table(path: Path) -> ResultTable:
    return ResultTable(path, ["name", "rpm"], ["thrust", "converged"])


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A table of three points, one of them failed."""
    file = tmp_path / "new" / "table.csv"
    rows = table(file)
    rows.add(POINT, {"thrust": 1.0 / 3.0, "converged": True})
    rows.add(POINT | {"rpm": 2.0}, {}, "out of reach,\n  at 2 rpm")
    rows.add(POINT | {"rpm": 3.0}, {"thrust": math.nan, "converged": False})
    return file


def test_numbers_are_read_back_with_every_digit(path: Path) -> None:
    with path.open(newline="") as file:
        first, failed, last = csv.DictReader(file)
    assert first["name"] == POINT["name"]
    assert (float(first["rpm"]), float(first["thrust"])) == (POINT["rpm"], 1.0 / 3.0)
    assert (first["converged"], first["status"], first["reason"]) == ("True", "ok", "")
    assert (failed["thrust"], failed["status"]) == ("", "failed")
    assert failed["reason"] == "out of reach, at 2 rpm"  # on one line
    assert math.isnan(float(last["thrust"]))


def test_rows_are_added_to_an_existing_table(path: Path) -> None:
    rows = table(path)
    assert len(rows) == 3
    assert POINT in rows and POINT | {"rpm": 4.0} not in rows
    assert rows.failures([POINT, POINT | {"rpm": 2.0}]) == ["out of reach, at 2 rpm"]
    rows.add(POINT | {"rpm": 4.0}, {"thrust": 1.0})
    assert len(table(path)) == len(path.read_text().splitlines()) - 1 == 4


@pytest.mark.parametrize("n_bytes", [1, 20])
def test_a_piece_of_a_row_that_a_killed_process_has_left_is_cut_off(
    path: Path, n_bytes: int
) -> None:
    whole = path.read_bytes()
    path.write_bytes(whole + b'"blade, new",4.0,1.0,True,ok,'[:n_bytes])
    assert len(table(path)) == 3
    assert path.read_bytes() == whole


def test_an_empty_file_is_a_new_table(tmp_path: Path) -> None:
    (tmp_path / "empty.csv").touch()
    assert len(table(tmp_path / "empty.csv")) == 0


@pytest.mark.parametrize(
    "content", [b"a,b\n1,2\n", b"hello", b"\x89PNG\r\n\x1a\n", b'"name,rpm\n', b"\n"]
)
def test_another_file_is_refused_and_left_alone(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "other.csv"
    file.write_bytes(content)
    with pytest.raises(ValueError, match=r"other.csv' holds something else .* name only here"):
        table(file)
    assert file.read_bytes() == content


def test_columns_that_differ_are_named(path: Path) -> None:
    with pytest.raises(ValueError, match="thrust only there, converged only there, torque only h"):
        ResultTable(path, ["name", "rpm"], ["torque"])
    with pytest.raises(ValueError, match="differ: their order"):
        ResultTable(path, ["rpm", "name"], ["thrust", "converged"])


def test_a_row_that_does_not_fit_is_named(path: Path) -> None:
    with path.open("a") as file:
        file.write("blade,5.0\n")
    with pytest.raises(ValueError, match="has 2 cells in row 5 and 6 columns"):
        table(path)


def test_missing_points_are_listed_once_each_in_their_order(path: Path) -> None:
    points = [POINT | {"rpm": rpm} for rpm in (5.0, 2.0, 4.0, 5.0, 3.0)]
    assert table(path).missing(points) == [0, 2]
    assert table(path).row(points[1])["reason"] == "out of reach, at 2 rpm"


def test_parquet_without_pyarrow_is_refused_before_the_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"need pyarrow: pip install 'propmdao\[parquet\]'"):
        table_files("sweep.parquet")


def test_parquet_has_the_same_values_with_their_types(path: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow, an extra, is not installed")
    table(path).write_parquet(tmp_path / "table.parquet")
    columns = parquet.read_table(tmp_path / "table.parquet").to_pydict()
    assert columns["name"] == ["blade, new"] * 3
    assert columns["rpm"] == [POINT["rpm"], 2.0, 3.0]
    assert columns["thrust"][:2] == [1.0 / 3.0, None] and math.isnan(columns["thrust"][2])
    assert columns["converged"] == [True, None, False]
    assert columns["status"] == ["ok", "failed", "ok"]
    assert columns["reason"] == ["", "out of reach, at 2 rpm", ""]
