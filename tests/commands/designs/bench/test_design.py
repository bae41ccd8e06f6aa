"""Sliders, the blade that follows from them, undo."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from propmdao.commands.designs.bench.design import Board, Design, History
from propmdao.commands.designs.bench.sliders import slider
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.catalog import catalog_names
from propmdao.propeller.design_choices import FREE


@pytest.fixture(scope="module")
def board(propeller, asked) -> Board:
    return Board(propeller, asked, (1.905, -45.0), (4200.0, 2.5))


def moved(board: Board, held: str = "rpm", **steps: int) -> Design:
    named = {name.replace("_at_", " "): k for name, k in steps.items()}
    assert named.keys() <= board.sliders.keys()
    return board.design({"held": held, "steps": {**board.start.steps, **named}})


def test_a_slider_has_its_start_among_its_values_and_ends_within():
    made = slider("diameter", "rotor", "", "m", 0.2794, (0.19, 0.4))
    assert made.value(0) == 0.2794
    assert made.step == 0.002  # 121 mm to the further end, a hundred steps at most
    assert 0.19 <= made.value(-made.below) < 0.192 and 0.398 < made.value(made.above) <= 0.4
    assert made.nearest(0.3) == 10 and made.nearest(9.0) == made.above
    for wrong in (made.above + 1, 0.5, True, "1", None):
        with pytest.raises(ValueError, match="steps of diameter must be a whole number within"):
            made.require(wrong)


def test_changes_stay_within_the_ranges_of_optimise(board, propeller):
    for word, free in FREE.items():
        of_word = [each for each in board.sliders.values() if each.group == word]
        assert len(of_word) == (4 if word == "sweep" else 5)
        for each in of_word:
            assert free.default[0] - 1e-9 <= each.value(-each.below) <= each.start
            assert each.start <= each.value(each.above) <= free.default[1] + 1e-9
    thin = np.interp(1.0, propeller.r_over_R, propeller.thickness_over_chord)
    least = board.sliders["thickness 5"]
    assert thin + least.value(-least.below) >= FREE["thickness"].within[0] - 1e-9


def test_nothing_moved_is_the_described_blade_itself(board, propeller):
    assert board.blade(board.start) is propeller
    assert board.blade(moved(board, rpm=3, speed=2, elevation=-4)) is propeller


def test_a_blade_is_bent_by_the_curves_of_optimise(board, propeller):
    from openmdao.components.interp_util.interp import InterpND

    design = moved(board, chord_at_2=10, twist_at_3=-20, twist_at_5=5, sweep_at_5=8, n_blades=1)
    blade = board.blade(design)
    r = propeller.r_over_R
    radii = np.linspace(r[0], 1.0, 5)

    def curve(*values: float) -> np.ndarray:
        return InterpND(method="cubic", points=radii, x_interp=r).evaluate_spline(np.array(values))

    np.testing.assert_allclose(
        blade.c_over_R, propeller.c_over_R * np.ravel(curve(1.0, 1.1, 1.0, 1.0, 1.0)), rtol=1e-12
    )
    np.testing.assert_allclose(
        blade.beta_deg, propeller.beta_deg + np.ravel(curve(0.0, 0.0, -2.0, 0.0, 0.5)), rtol=1e-12
    )
    assert blade.sweep_over_R[-1] == pytest.approx(propeller.sweep_over_R[-1] + 0.04)
    assert blade.sweep_over_R[0] == pytest.approx(propeller.sweep_over_R[0])
    assert blade.n_blades == propeller.n_blades + 1
    assert blade.camber_over_chord is propeller.camber_over_chord
    assert "twist 0 0 -2 0 0.5" in blade.source and propeller.source in blade.source


def test_camber_and_thickness_of_the_airfoils_are_where_changes_begin(propeller, asked):
    plain = dataclasses.replace(propeller, thickness_over_chord=None, camber_over_chord=None)
    board = Board(plain, asked, (1.905, -45.0), (4200.0, 2.5))
    blade = board.blade(moved(board, camber_at_1=4, thickness_at_5=2))
    camber, thickness = plain.sections()
    assert blade.camber_over_chord[0] == pytest.approx(camber[0].max() + 0.002)
    assert blade.thickness_over_chord[-1] == pytest.approx(thickness[-1].max() + 0.001)


def test_the_described_blade_follows_operating_point_and_microphone(board, asked):
    design = moved(board, "thrust", twist_at_1=9, diameter=2, thrust=-5, speed=4, distance=3)
    described = board.described(design)
    assert described == moved(board, "thrust", thrust=-5, speed=4, distance=3)
    request = board.request(described, asked.model)
    assert request.point.rpm is None
    assert request.point.thrust == pytest.approx(board.sliders["thrust"].value(-5))
    assert request.point.speed == pytest.approx(board.sliders["speed"].value(4))
    seen = np.linalg.norm(request.listening.observers[0])
    assert seen == pytest.approx(board.sliders["distance"].value(3))


def test_loads_do_not_depend_on_the_microphone_nor_on_what_is_not_held(board):
    loads, place = board.keys(board.start)
    expected = {
        "distance": (False, True),
        "thrust": (False, False),
        "rpm": (True, False),
        "chord 1": (True, False),
    }
    for name, changes in expected.items():
        design = Design("rpm", {**board.start.steps, name: 1})
        other = board.keys(design)
        assert (other[0] != loads, other[1] != place) == changes, name


def test_the_other_of_thrust_and_rotation_speed_is_held_where_it_is(board):
    design = board.holding(board.start, "thrust", 2.73)
    assert design.held == "thrust"
    assert board.value(design, "thrust") == pytest.approx(2.73, abs=board.sliders["thrust"].step)


@pytest.mark.parametrize(
    ("plain", "message"),
    [
        ({}, "held must be one of rpm, thrust; it is None"),
        ({"held": "torque", "steps": {}}, "held must be one of"),
        ({"held": "rpm", "steps": {"chord 1": 0}}, "steps of all sliders: chord 1, chord 2"),
        ({"held": "rpm", "steps": [1]}, "steps of all sliders"),
    ],
)
def test_what_is_no_design_is_refused(board, plain, message):
    with pytest.raises(ValueError, match=message):
        board.design(plain)


def test_a_brake_has_no_slider_of_thrust(propeller, asked):
    board = Board(propeller, asked, (1.905, -45.0), (4200.0, -0.4))
    assert "thrust" not in board.sliders
    with pytest.raises(ValueError, match=r"held must be one of rpm; it is 'thrust'"):
        board.design({"held": "thrust", "steps": board.start.steps})


def test_undo_and_redo():
    a, b, c = (Design("rpm", {"x": k}) for k in range(3))
    history = History(a)
    history.undo()
    history.add(b)
    history.add(b)  # a drag that ends where it began is no step
    history.undo()
    assert history.now == a and history.to_dict()["can_redo"]
    history.redo()
    assert history.now == b
    history.undo()
    history.add(c)
    assert history.to_dict() == {"held": "rpm", "steps": {"x": 2}, "can_undo": True,
                                 "can_redo": False}  # fmt: skip
    history.redo()
    assert history.now == c


@pytest.mark.parametrize("name", catalog_names())
def test_every_blade_of_the_catalogue_can_be_bent_to_the_ends_of_a_slider(name, asked):
    described = load_propeller(name)
    board = Board(described, asked, (10.0 * described.diameter, -45.0), (4200.0, 2.5))
    for each in board.sliders.values():
        for steps in (-each.below, each.above):
            blade = board.blade(moved(board, **{each.name.replace(" ", "_at_"): steps}))
            assert blade.c_over_R.min() > 0.0
            request = board.request(moved(board, **{each.name.replace(" ", "_at_"): steps}),
                                    asked.model)  # fmt: skip
            assert request.point.rpm > 0.0 and request.point.speed >= 0.0
