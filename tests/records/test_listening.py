"""Observers come in groups that together are all of them."""

from __future__ import annotations

import numpy as np
import pytest

from propmdao.records.listening import Listening, ObserverGroup, Surroundings


def test_by_default_nobody_listens_in_a_free_field():
    listening = Listening()
    assert listening.observers.shape == (0, 3)
    assert listening.surroundings == Surroundings() and listening.groups == ()


def test_groups_hold_all_observers():
    groups = (ObserverGroup("ahead", "arc", 3), ObserverGroup("below", "hemisphere", 2))
    assert Listening(np.zeros((5, 3)), groups=groups).groups == groups
    with pytest.raises(ValueError, match="groups must hold all 4 observers; they hold 5"):
        Listening(np.zeros((4, 3)), groups=groups)


def test_what_is_no_group_or_no_position():
    with pytest.raises(ValueError, match="kind of observers must be one of .*; it is 'sphere'"):
        ObserverGroup("around", "sphere", 3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="group of observers 'nobody' needs at least 1; it has 0"):
        ObserverGroup("nobody", "arc", 0)


@pytest.mark.parametrize(
    "observers",
    [np.zeros(3), np.zeros((4, 2)), [(1.905, -45.0)], [(1.905, -45.0), (1.905, 0.0)], 1.905],
)
def test_radius_and_elevation_are_refused_with_what_makes_positions(observers):
    with pytest.raises(ValueError) as error:
        Listening(observers)
    message = str(error.value)
    assert "an (n, 3) array [m]" in message and "propmdao.arc(radius, elevation_deg)" in message
    assert str(np.shape(observers)) in message and "\n" not in message


def test_a_position_that_is_not_finite_is_named():
    with pytest.raises(ValueError, match="observer 2 must be at a finite position"):
        Listening([(1.0, 0.0, 0.0), (np.nan, 0.0, 1.0)])
