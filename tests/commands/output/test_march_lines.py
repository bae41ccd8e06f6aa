"""Words on how a march has gone."""

from __future__ import annotations

from typing import Any

from propmdao.commands.output.marches import march_lines


def result(*turns: tuple[float, float | None]) -> dict[str, Any]:
    revolutions = [{"thrust": t, "torque": 0.01 * t, "change": change} for t, change in turns]
    loads = {"unsteady": {"tolerance": 0.01}}
    return {"rpm": 4000.0, "model": {"loads": loads}, "revolutions": revolutions}


def test_revolutions_are_told_with_what_changes_from_one_to_the_next() -> None:
    assert march_lines([result((2.5, None), (2.0, 0.25), (2.01, 0.005))]) == [
        "March at 4000.0 rpm, revolutions 1 to 3: thrust 2.500, 2.000, 2.010 N,",
        "  torque 0.02500, 0.02000, 0.02010 N m,",
        "  change of the thrust from one to the next 25, 0.5 %; 1 % counts as none.",
    ]


def test_one_revolution_is_compared_with_none() -> None:
    lines = march_lines([result((2.5, None))])
    assert lines[0] == "March at 4000.0 rpm, its revolution: thrust 2.500 N,"
    assert lines[2] == "  no revolution before it to compare with."


def test_of_a_long_march_the_last_revolutions_are_told() -> None:
    lines = march_lines([result((9.0, None), *((float(n), 0.0) for n in range(8)))])
    assert "revolutions 2 to 9: thrust 0.000, 1.000" in lines[0] and "9.000" not in lines[0]


def test_what_was_not_marched_has_no_such_lines() -> None:
    assert march_lines([{"rpm": 4000.0}]) == []
