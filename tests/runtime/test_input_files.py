"""Files that users name: what is read, and one line for what cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest

from propmdao.runtime.input_files import read_bytes, read_text, table_rows


class OwnError(ValueError):
    """Stands for the error of a format."""


@pytest.mark.parametrize("read", [read_text, read_bytes])
def test_a_missing_file_is_the_format_s_own_error_in_one_line(read, tmp_path: Path) -> None:
    path = tmp_path / "none.txt"
    with pytest.raises(OwnError) as caught:
        read(path, OwnError)
    assert str(caught.value) == f"{path}: cannot be read: No such file or directory"
    with pytest.raises(OwnError, match=r"^no points in 'none': No such file or directory$"):
        read(path, OwnError, complaint="no points in 'none'")


def test_bytes_that_are_no_text_are_refused_or_replaced(tmp_path: Path) -> None:
    path = tmp_path / "latin.txt"
    path.write_bytes(b"\xe9tude\r\n1 2\n")
    with pytest.raises(OwnError, match=r"latin.txt: cannot be read: it is not text in UTF-8$"):
        read_text(path, OwnError)
    assert read_text(path, OwnError, undecodable="replace") == "\ufffdtude\n1 2\n"
    assert read_text(path, OwnError, encoding="latin-1") == "étude\n1 2\n"


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_says_the_encoding(encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "marked.txt"
    path.write_text("étude\n1 2\n", encoding=encoding)
    assert read_text(path, OwnError) == "étude\n1 2\n"
    assert read_text(path, OwnError, encoding="latin-1") == "étude\n1 2\n"


@pytest.mark.parametrize("read", [read_text, read_bytes])
def test_a_path_that_no_file_can_have_is_one_line(read) -> None:
    with pytest.raises(OwnError, match=r"^a\\0b: cannot be read: embedded null byte in its path$"):
        read("a\0b", OwnError)


@pytest.mark.parametrize("title", ["a title\n", "x, y\n", ""])
def test_rows_are_read_under_a_title_or_none(title: str) -> None:
    rows = table_rows(title + "1 2\n\n3,4\n", 2, "two numbers x y", OwnError, "points")
    assert rows == [[1.0, 2.0], [3.0, 4.0]]


@pytest.mark.parametrize("line", ["3", "3 4 5", "3 four"])
def test_a_line_that_is_no_row_is_named(line: str) -> None:
    with pytest.raises(OwnError) as caught:
        table_rows(f"x y\n1 2\n {line}\n", 2, "two numbers x y", OwnError, "points")
    assert str(caught.value) == f"points, line 3: two numbers x y expected, not '{line}'"
