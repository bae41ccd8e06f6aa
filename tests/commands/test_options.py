"""Options of what may be asked come from the table of quantities, in every command."""

from __future__ import annotations

import argparse

import pytest

from propmdao.commands.options import asked_of
from propmdao.commands.program import build_parser
from propmdao.records.quantities import ASKED
from propmdao.records.units import Quantity

OPTIONS = {quantity.option: quantity for quantity in ASKED.values() if quantity.option}
COMMANDS = ("analyze", "sweep", "flyover", "export")
#: Options that are of a command, not of what is asked of an analysis.
OTHERS = {
    "analyze": "--band --polar --json --wav --seconds --full-scale --figures --figure-at"
    " --figure-dba --out --spectra --vtk --report --motor --battery-wh --usable-share",
    "sweep": "--points --samples --seed --workers --out --figures --report",
    "flyover": "--height --sideline --microphone --duration --no-absorption --absorption --json"
    " --out --figures --report --wav --full-scale",
    "export": "--to --section --reynolds --units --hub",
}
LISTENING = "--arc --point --circle --hemisphere --grid"
SURROUNDINGS = "--ground --level --absorption"


def actions(command: str) -> dict[str, argparse.Action]:
    """Options of a command by what is typed."""
    (commands,) = (
        action
        for action in build_parser()._actions
        if isinstance(action, argparse._SubParsersAction)
    )
    return {
        option: action
        for action in commands.choices[command]._actions
        for option in action.option_strings
        if option not in ("-h", "--help")
    }


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_is_of_the_table_or_of_the_command(command: str) -> None:
    others = {"--quiet", *OTHERS[command].split()}
    if command != "flyover":
        others |= set(LISTENING.split())
    if command in ("analyze", "sweep"):
        others |= set(SURROUNDINGS.split())
    options = actions(command)
    assert options.keys() - OPTIONS.keys() == others
    for option in options.keys() & OPTIONS.keys():
        quantity, action = OPTIONS[option], options[option]
        assert (action.help or "").startswith(quantity.help)
        if quantity.placeholder.startswith("{"):
            assert quantity.placeholder == "{" + ",".join(action.choices or ()) + "}"
        else:
            assert (action.metavar or "") == quantity.placeholder


def test_analyze_and_sweep_together_ask_all_that_the_table_has() -> None:
    assert OPTIONS.keys() <= actions("analyze").keys() | actions("sweep").keys()


@pytest.mark.parametrize("quantity", OPTIONS.values(), ids=OPTIONS)
def test_an_option_that_is_not_typed_is_the_default_of_the_table(quantity: Quantity) -> None:
    for command in COMMANDS:
        action = actions(command).get(quantity.option)
        if action is not None and command != "sweep":
            assert action.dest == quantity.name and action.default == quantity.default


def test_a_switch_turns_the_default_over() -> None:
    arguments = "analyze p --rpm 1 --inviscid --no-stall-delay --broadband"
    asked = asked_of(build_parser().parse_args(arguments.split()))
    assert (asked["viscous"], asked["stall_delay"], asked["broadband"]) == (False, False, True)
    asked = asked_of(build_parser().parse_args("analyze p --rpm 1".split()))
    assert (asked["viscous"], asked["stall_delay"], asked["broadband"]) == (True, True, False)


def test_trip_knows_its_words(refused) -> None:
    said = refused(*"analyze p --rpm 1 --broadband --trip some".split())
    assert "invalid choice: 'some' (choose from" in said
