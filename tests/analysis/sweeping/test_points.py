"""Points of a sweep: grids, samples, files."""

from __future__ import annotations

from pathlib import Path

import pytest

from propmdao.analysis.sweeping.points import grid, latin_hypercube, read_points


def test_a_grid_is_every_combination() -> None:
    assert grid({"rpm": [3.0, 4.0], "speed": [0.0, 1.0]}) == [
        {"rpm": rpm, "speed": speed} for rpm in (3.0, 4.0) for speed in (0.0, 1.0)
    ]
    assert grid({}) == [{}]


def test_a_latin_hypercube_has_one_point_in_every_slice_of_every_range() -> None:
    points = latin_hypercube({"rpm": (3000.0, 6000.0), "speed": (-1.0, 1.0)}, 20, seed=3)
    for name, low, high in (("rpm", 3000.0, 6000.0), ("speed", -1.0, 1.0)):
        slices = [int(20 * (point[name] - low) / (high - low)) for point in points]
        assert sorted(slices) == list(range(20))
    assert points == latin_hypercube({"rpm": (3000.0, 6000.0), "speed": (-1.0, 1.0)}, 20, seed=3)
    assert points != latin_hypercube({"rpm": (3000.0, 6000.0), "speed": (-1.0, 1.0)}, 20, seed=4)


def test_points_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text("\ufeffrpm,speed\n3000,1.5\n4e3,0\n", encoding="utf-8")  # as Excel writes it
    assert read_points(file) == [{"rpm": 3000.0, "speed": 1.5}, {"rpm": 4000.0, "speed": 0.0}]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("rpm,sped\n3000,1\n", "has a column 'sped', which is no variable"),
        ("rpm,speed,rpm\n3000,1,4000\n", "line 1: the column 'rpm' is there more than once"),
        ("rpm,speed\n3000,fast\n", "row 2 of .* is not all numbers"),
        ("rpm,speed\n3000,1\n3000\n", "row 3 of .* is not all numbers"),
        ("", "has a column ''"),
    ],
)
def test_a_file_of_points_that_is_none(tmp_path: Path, content: str, said: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(content)
    with pytest.raises(ValueError, match=said):
        read_points(file)
    with pytest.raises(ValueError, match="points cannot be read from"):
        read_points(tmp_path / "none.csv")
