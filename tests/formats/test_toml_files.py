"""Propeller files as other programs and hands leave them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from propmdao.formats.propellers import load_propeller
from propmdao.formats.toml_files import (
    propeller_from_text,
    read_toml,
    toml_text,
    write_toml,
)
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.identity import checksum
from propmdao.records.models import Transition

TEXT = """name = "x"
diameter = 0.25
n_blades = 2
r_over_R = [0.15, 1.0]
c_over_R = [0.1, 0.1]
beta_deg = [20.0, 10.0]
airfoils = [{ r_over_R = 0.15, airfoil = "naca4412" }]
"""


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_byte_order_mark_is_read_over(encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_text(TEXT, encoding=encoding)
    assert read_toml(path).diameter == 0.25


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("0.25", "[" * 3000 + "]" * 3000, ", line 2: lists and tables are nested too deeply"),
        ("0.25", "{a = " * 3000 + "1" + "}" * 3000, ", line 2: lists and tables are nested too"),
        ("[0.1, 0.1]", "[\n" * 3000 + "]" * 3000, ": lists and tables are nested too deeply"),
        ("0.25", "9" * 5000, ", line 2: a number has too many digits"),
        ("naca4412", "a\\u0000b.dat", r"a\0b.dat' cannot be read: embedded null byte in its path"),
    ],
)
def test_what_no_file_should_hold_is_one_line(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "p.toml"
    path.write_text(TEXT.replace(old, new, 1))
    with pytest.raises(PropellerError) as caught:
        read_toml(path)
    assert str(caught.value).startswith(str(path)) and message in str(caught.value)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400


def test_a_path_that_no_file_can_have_is_one_line() -> None:
    with pytest.raises(PropellerError, match=r"^a\\0b.toml: cannot be read: embedded null byte"):
        load_propeller("a\0b.toml")


def test_transition_is_described_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_text(TEXT + "n_crit = 7\ntrip_upper = 0.1\n")
    propeller = read_toml(path)
    assert propeller.transition == Transition(7.0, 0.1, None)
    write_toml(path, propeller)
    assert read_toml(path).transition == propeller.transition
    path.write_text(TEXT)
    assert read_toml(path).transition == Transition()
    assert checksum(read_toml(path)) == "01e72b9c"  # as before files could say it
    assert checksum(read_toml(path)) != checksum(propeller)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("n_crit = 0", "n_crit must be within 0.1 ... 30; it is 0"),
        ("n_crit = nan", "n_crit must be a finite number; it is nan"),
        ("trip_upper = -0.1", "trip_upper must be within 0 ... 1; it is -0.1"),
        ("trip_lower = 1.2", "trip_lower must be within 0 ... 1; it is 1.2"),
        ('trip_lower = "heavy"', "trip_lower must be a number; it is 'heavy'"),
    ],
)
def test_a_transition_that_there_is_not_is_refused(line: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_text(TEXT + line + "\n")
    with pytest.raises(PropellerError) as caught:
        read_toml(path)
    assert str(caught.value) == f"{path}: {message}"


def test_text_without_a_folder_names_coordinate_files_by_their_whole_path(tmp_path: Path) -> None:
    section = tmp_path / "mine.dat"
    around = [math.pi * k / 20.0 for k in range(41)]
    ellipse = "".join(f"{0.5 + 0.5 * math.cos(a)} {0.06 * math.sin(a)}\n" for a in around)
    section.write_text(f"mine\n{ellipse}")
    path = tmp_path / "p.toml"
    path.write_text(TEXT.replace("naca4412", "mine.dat"))
    text = toml_text(read_toml(path))
    assert f'airfoil = "{section}"' in text
    assert 'airfoil = "mine.dat"' in toml_text(read_toml(path), tmp_path)
    assert checksum(propeller_from_text(text, "text", None)) == checksum(read_toml(path))
