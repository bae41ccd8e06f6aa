"""Results side by side: rounded to read, unrounded to keep."""

from __future__ import annotations

import csv

import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.comparisons import (
    ROWS,
    at_observer,
    markdown,
    print_comparison,
    side_by_side,
    write_comparison,
)

COLUMNS = {
    "first\nof all": {"a": 1.23456, "name": "e63"},
    "second": {"a": 1.0, "name": "NACA 6406", "b": 2.0},
    "third": {"b": 7.0},
}


@pytest.fixture
def table(tmp_path, capsys):
    file = tmp_path / "table.csv"
    rows = [("A, m", "a", ".2f"), ("name", "name", ""), ("B", "b", ".0f")]
    print_comparison(rows, COLUMNS)
    write_comparison(rows, COLUMNS, file)
    with file.open(newline="") as stream:
        return capsys.readouterr().out.splitlines(), list(csv.reader(stream))


def test_numbers_are_rounded_and_their_change_has_a_sign(table):
    printed, _ = table
    (line,) = (line for line in printed if line.startswith("A, m"))
    assert line.split() == ["A,", "m", "1.23", "1.00", "-0.23"]


def test_text_and_missing_values_have_no_change(table):
    printed, written = table
    (line,) = (line for line in printed if line.startswith("name"))
    assert line.split() == ["name", "e63", "NACA", "6406"]
    assert written[3] == ["B", "", "2.0", "", "7.0"]


def test_file_is_not_rounded_and_has_headings_of_one_line(table):
    _, written = table
    assert written[0] == ["", "first of all", "second", "change", "third"]
    assert [float(cell) for cell in written[1][1:4]] == [1.23456, 1.0, 1.0 - 1.23456]


def test_every_row_has_a_number_at_an_observer(apcsf_at_two_observers):
    values = at_observer(apcsf_at_two_observers, 1)
    levels = apcsf_at_two_observers.to_dict()["observers"][1]
    assert {key for _, key, _ in ROWS} <= values.keys()
    assert values["oaspl_db"] == levels["oaspl_db"]
    assert values["bpf_hz"] == pytest.approx(140.0)  # two blades at 4200 rpm


@pytest.fixture(scope="module")
def apcsf_at_two_observers():
    from propmdao.analysis.single_point import analyze
    from propmdao.formats.propellers import load_propeller
    from propmdao.records.fidelity import Fidelity

    return analyze(
        load_propeller("apcsf_11x4.7_uiuc"),
        rpm=4200.0,
        observers=arc(1.905, [0.0, -45.0]),
        fidelity=Fidelity(4, 8, 21, 16, 5),
    )


def test_markdown_has_a_row_for_each_and_cells_for_what_is_missing():
    lines = markdown(side_by_side([("A, m", "a", ".2f"), ("B", "b", ".0f")], COLUMNS)).splitlines()
    assert lines == [
        "|  | first of all | second | third |",
        "| --- | ---: | ---: | ---: |",
        "| A, m | 1.23 | 1.00 |  |",
        "| B |  | 2 | 7 |",
    ]
