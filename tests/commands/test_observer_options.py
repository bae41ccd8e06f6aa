"""Observers, ground and air of a command line."""

from __future__ import annotations

import argparse

import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import directions, hemisphere
from propmdao.commands.observer_options import (
    add_observers,
    add_surroundings,
    air_of,
    listening_of,
)
from propmdao.commands.options import take_negative_ranges
from propmdao.records.listening import ObserverGroup, Surroundings


def parse(arguments: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser(exit_on_error=False)
    take_negative_ranges(parser)
    add_observers(parser)
    add_surroundings(parser)
    return parser.parse_args(arguments.split())


@pytest.mark.parametrize(
    ("arguments", "observers"),
    [
        ("", []),
        ("--arc 2 -45 0", [(2.0, -45.0, 0.0), (2.0, 0.0, 0.0)]),
        ("--arc 2 -90:0:45", [(2.0, -90.0, 0.0), (2.0, -45.0, 0.0), (2.0, 0.0, 0.0)]),
        ("--point 2 -10 90 --arc 1 0", [(1.0, 0.0, 0.0), (2.0, -10.0, 90.0)]),
        ("--point 1:2:1 0 30", [(1.0, 0.0, 30.0), (2.0, 0.0, 30.0)]),
        ("--circle 2 -30 3", [(2.0, -30.0, 0.0), (2.0, -30.0, 120.0), (2.0, -30.0, -120.0)]),
        ("--grid 0:1:1 1 0", [(1.0, 0.0, 90.0), (np.sqrt(2.0), 0.0, 45.0)]),
    ],
)
def test_observers_are_named_by_distance_elevation_and_azimuth(
    arguments: str, observers: list[tuple[float, float, float]]
) -> None:
    placed = listening_of(parse(arguments)).observers
    assert placed.shape == (len(observers), 3)
    found = np.stack(directions(placed).rounded(), axis=-1)
    np.testing.assert_allclose(found, np.reshape(observers, (-1, 3)))


def test_each_option_places_a_group_of_its_own() -> None:
    """Figures and tables find the arc, and the hemisphere, by its group."""
    arguments = "--hemisphere 5 30 --arc 2 -45 0 45 --point 1:2:1 0 0 --arc 3 0 --grid 0:4:1 0 -9"
    listening = listening_of(parse(arguments + " --circle 2 0 6"))
    assert listening.groups == (
        ObserverGroup("arc", "arc", 3),
        ObserverGroup("arc 2", "arc", 1),
        ObserverGroup("point", "point", 2),
        ObserverGroup("circle", "circle", 6),
        ObserverGroup("grid", "grid", 5),
        ObserverGroup("hemisphere", "hemisphere", 1 + 3 * 12),
    )
    assert len(listening.observers) == 3 + 1 + 2 + 6 + 5 + 1 + 3 * 12
    assert listening_of(parse("")).groups == ()


def test_a_hemisphere_is_below_the_rotor_or_below_the_aircraft() -> None:
    upright = listening_of(parse("--hemisphere 5 30 --grid 0 0 1")).observers
    np.testing.assert_allclose(upright[1:], hemisphere(5.0, 30.0), atol=1e-8)
    level = listening_of(parse("--hemisphere 5 30 --level")).observers
    ahead, left, up = level[:, 2], level[:, 1], -level[:, 0]
    np.testing.assert_allclose(
        np.stack([ahead, left, up], axis=-1), hemisphere(5.0, 30.0), atol=1e-8
    )


def test_in_level_flight_a_grid_has_its_third_coordinate_up() -> None:
    """Ten metres below the hub, five ahead: on the side of azimuth 0."""
    placed = directions(listening_of(parse("--grid 5 0 -10 --level")).observers)
    assert placed.radius == pytest.approx(np.sqrt(125.0))
    assert placed.elevation_deg == pytest.approx(np.degrees(np.arctan2(5.0, 10.0)))
    assert placed.azimuth_deg == 0.0


def test_at_an_incidence_level_flight_is_along_the_ground() -> None:
    """Leaning forward by 20 deg: straight ahead is 20 deg above the rotor plane."""
    placed = directions(listening_of(parse("--grid 5 0 0 --level"), 70.0).observers)
    assert placed.elevation_deg == pytest.approx(20.0)
    assert placed.azimuth_deg == pytest.approx(0.0)
    upright = directions(listening_of(parse("--grid 5 0 0"), 70.0).observers)
    assert upright.elevation_deg == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("arguments", "surroundings"),
    [
        ("", Surroundings()),
        ("--ground 2.5", Surroundings(2.5)),
        ("--ground flush --level", Surroundings("flush", True)),
        ("--absorption", Surroundings(absorption=True)),
        ("--absorption -5 40 --ground 1", Surroundings(1.0, absorption=True)),
    ],
)
def test_ground_and_air(arguments: str, surroundings: Surroundings) -> None:
    assert listening_of(parse(arguments)).surroundings == surroundings


@pytest.mark.parametrize(
    ("arguments", "air"),
    [
        ("", {}),
        ("--absorption", {}),
        ("--absorption -5 40", {"temperature": 268.15, "relative_humidity": 0.4}),
        (
            "--absorption 20 50 9e4",
            {"temperature": 293.15, "relative_humidity": 0.5, "pressure": 9e4},
        ),
    ],
)
def test_air_that_absorbs(arguments: str, air: dict[str, float]) -> None:
    assert air_of(parse(arguments)) == air


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--arc 2", "--arc 2 needs one radius and then at least one elevation"),
        ("--arc 1:2:1 0", "--arc 1 needs one radius"),
        (
            "--circle 2 0 1.5",
            "--circle needs a whole number N of observers, 1 ... 20000; it is 1.5",
        ),
        ("--circle 2 0 0", "it is 0"),
        ("--hemisphere 2 7", "step of a hemisphere must divide 90 deg; got 7"),
        ("--hemisphere 2 0.01", "step of a hemisphere must be within 1 ... 90 deg; it is 0.01"),
        ("--grid 0:999:1 0:99:1 -2", "100000 observers are more than the 20000"),
        ("--grid 0:99:1 0:99:1 -2 --grid 0:99:1 0:99:1 -3 --arc 2 0", "20001 observers are more"),
    ],
)
def test_observers_that_are_none(arguments: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        listening_of(parse(arguments))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--ground 0", "height above ground must be within 0.001 ... 1000000 m; it is 0"),
        ("--absorption 1 2 3 4", "at most; it has 4 values"),
        ("--absorption 51", "temperature must be within -20 ... 50 degrees Celsius; it is 51"),
        ("--absorption 15 101", "relative humidity must be within 0 ... 100 %; it is 101"),
        ("--absorption 15 70 1013.25e3", "pressure must be within 1000 ... 200000 Pa"),
    ],
)
def test_surroundings_that_are_none(arguments: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        options = parse(arguments)
        listening_of(options)
        air_of(options)
