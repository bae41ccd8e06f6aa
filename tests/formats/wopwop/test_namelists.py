"""Namelists: as Fortran reads them, as VSPAERO writes them, and what is none."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.namelists.groups import read_namelists, write_namelists
from propmdao.formats.wopwop.namelists.syntax import formatted, parse


def only(text: str) -> dict:
    (group,) = parse(text)
    return group.values


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("5", 5),
        ("-2.5d-3", -2.5e-3),
        (".5E2", 50.0),
        ("1.", 1.0),
        (".TRUE.", True),
        ("f", False),
        ("'it''s ! no / comment'", "it's ! no / comment"),
        ('"a" ! a comment', "a"),
        ("1, 2,3,", [1, 2, 3]),
        ("1 2 3", [1, 2, 3]),
        ("3*0.5", [0.5, 0.5, 0.5]),
        ("1, , 3", [1, None, 3]),
        ("a.PSUWopWop.Loading.Rotor.1.dat", "a.PSUWopWop.Loading.Rotor.1.dat"),
        ("./data/geometry.dat", "./data/geometry.dat"),
        ("./data/\n", "./data/"),
        ("Rotor 1 of 2", "Rotor 1 of 2"),
        ("'\x1b[2J'", "?[2J"),
    ],
)  # fmt: skip
def test_values(written: str, value: object) -> None:
    assert only(f"&group a = {written}\n b = 7 /") == {"a": value, "b": 7}


def test_places_and_repeated_keys() -> None:
    assert only("&g vh(3) = 8.0 n = 1 N = 2 /") == {"vh": [None, None, 8.0], "n": 2}
    assert only("&g file(1) = 'a' /") == {"file": "a"}


def test_groups_are_found_between_other_text() -> None:
    groups = parse("a title = 1\n &One x=1/\nremarks, isn't it\n$two y = 2 $end\n&three /")
    assert [(g.name, g.values, g.line) for g in groups] == [
        ("one", {"x": 1}, 2),
        ("two", {"y": 2}, 4),
        ("three", {}, 5),
    ]


def test_a_group_may_end_where_the_next_begins(tmp_path: Path) -> None:
    file = tmp_path / "case.nam"
    file.write_text("&EnvironmentConstants\n rho = 1.2\n!\n&ObserverIn nt = 2 /\n")
    with pytest.warns(UserWarning, match="in line 1, it ends where the next begins, without a /"):
        groups = read_namelists(file)
    assert [group.values for group in groups] == [{"rho": 1.2}, {"nt": 2}]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("hello", "there is no &group in it"),
        ("&a\n x = 'y\n/", "line 2: a text without its end"),
        ("&a 5 /", "line 1: '5' stands before any key"),
        ("&a\n\nx = = 3 /", "line 3: '=' without a key"),
        ("\n&a b = 3", "line 2: &a has no / at its end"),
        ("&a b = 9999999999*1.0 /", "the number of equal values must be 1 ... 1000"),
        ("&a b(2000000) = 1.0 /", "the place of a value must be 1 ... 1000"),
    ],
)
def test_what_is_no_namelist_is_one_line(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "case.nam"
    file.write_text(text)
    with pytest.raises(WopwopFileError) as caught:
        read_namelists(file)
    assert str(caught.value).startswith(f"{file}: not a Fortran namelist file: ")
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    values = {"title": "it's", "nt": 3, "c": 340.0, "vh": [0.0, 1e-20, -3.0], "on": True}
    write_namelists(tmp_path / "x.nam", [("CB", values), ("CB", {})])
    with pytest.warns(UserWarning, match="is not known"):
        groups = read_namelists(tmp_path / "x.nam")
    assert [group.values for group in groups] == [values, {}]
    assert math.isnan(only(formatted("g", {"x": math.nan}))["x"])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("&EnvironmentConstants P_ref = 1e-6 /", "p_ref has no effect: levels are in dB re 20 uPa"),
        ("&CB colour = 3 /", "colour is not known and has no effect"),
    ],
)
def test_what_has_no_effect_is_named(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "x.nam").write_text(text)
    with pytest.warns(UserWarning) as caught:
        read_namelists(tmp_path / "x.nam")
    (warning,) = caught
    assert message in str(warning.message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("&ObserverIn nbHarmonics = 3 /", "nbharmonics asks for what is not done: all harmonics"),
        ("&EnvironmentIn sigmaFlag = T /", "sigmaflag asks for what is not done: no data on the"),
        ("&EnvironmentIn PNLFlag = T /", "pnlflag asks for what is not done: PNL without the"),
        ("&ContainerIn BWINoiseFlag = .true. /", "bwinoiseflag asks for what is not done: noise"),
    ],
)
def test_what_is_asked_for_and_not_done_is_refused(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "x.nam").write_text(text)
    with pytest.raises(WopwopFileError) as caught:
        read_namelists(tmp_path / "x.nam")
    assert message in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.filterwarnings("error")
def test_flags_that_are_off_or_choose_among_what_is_given_are_no_matter(tmp_path: Path) -> None:
    (tmp_path / "x.nam").write_text(
        "&EnvironmentIn SPLdBAFlag = .false. spectrumFlag = .true. sigmaFlag = F debugLevel = 5 "
        "OASPLFileName = OASPL.AllRotors. /\n&EnvironmentConstants P_ref = 20e-6 gamma = 1.4 /"
    )
    assert len(read_namelists(tmp_path / "x.nam")) == 2
