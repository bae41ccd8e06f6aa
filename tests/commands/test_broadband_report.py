"""What the command line says of broadband noise: mechanisms, the loudest, what is not measured."""

import io

import pytest
from rich.console import Console

from propmdao.commands.broadband_report import print_mechanisms, trip_words

QUIET = dict.fromkeys(("pressure_side", "bluntness", "tip", "inflow_turbulence"), -200.0)
RANGES = {
    "reynolds": {"least": 4e3, "largest": 9e4, "measured": [5.5e4, 1.5e6], "outside": 0.42},
    "mach": {"least": 0.0, "largest": 0.2, "measured": [0.0, 0.21], "outside": 0.0},
}


def observer(suction, separation, laminar):
    levels = {"suction_side": suction, "separation": separation, "laminar_shedding": laminar}
    return {"elevation_deg": -45.0, "broadband_dba": {**QUIET, **levels}}


def said(*observers):
    console = Console(width=200, file=io.StringIO())
    analysis = {"rpm": 4200.0, "observers": observers, "broadband_range": RANGES}
    print_mechanisms(console, [analysis])
    return console.file.getvalue()


def test_every_mechanism_is_printed_and_the_loudest_named():
    text = said(observer(50.3, 45.2, 7.0))
    row = next(line for line in text.splitlines() if "50.3" in line)
    assert row.split() == ["4200.0", "-45", "-", "50.3", "45.2", "7.0", "-", "-", "-"]
    assert "The loudest is the boundary layer of the suction side." in text


def test_the_loudest_at_most_places_is_named():
    text = said(observer(50.0, 45.0, 7.0), observer(50.0, 45.0, 63.0), observer(40.0, 45.0, 63.0))
    assert "The loudest is vortices of laminar boundary layers at 2 of 3 places." in text


def test_what_is_not_measured_is_told():
    text = said(observer(50.0, 45.0, 7.0))
    assert "42 % of the span is outside of what NASA RP-1218 measured: Reynolds number" in text
    assert "Mach" not in text


def test_nothing_is_said_without_broadband_noise():
    assert said({"elevation_deg": 0.0}) == ""


@pytest.mark.parametrize(
    ("trip", "layers", "lower", "words"),
    [
        ("none", "sections", 1.0, "untripped"),
        ("none", "sections", 0.1, "tripped as in the polars"),
        ("none", "bpm", 0.1, "untripped"),
        ("heavy", "sections", 0.1, "heavily tripped"),
        (
            ["none", "light", "light"],
            "sections",
            1.0,
            "untripped (1) and lightly tripped (2) stations",
        ),
    ],
)
def test_trips_are_told(trip, layers, lower, words):
    loads = {"transition": {"trip_upper": 1.0, "trip_lower": lower}}
    model = {"noise": {"broadband": {"trip": trip, "layers": layers}}, "loads": loads}
    assert trip_words(model) == words
