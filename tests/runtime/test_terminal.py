"""Text of files and users on a terminal: shown, not obeyed."""

from __future__ import annotations

import pytest
from rich.table import Table

from propmdao.runtime.terminal import plain_console, print_line, printable


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("apcsf 11x4.7, Prüfling 1, µ, 翼", "apcsf 11x4.7, Prüfling 1, µ, 翼"),
        ("\x1b[31mred\x1b[0m", r"\x1b[31mred\x1b[0m"),
        ("two\nlines\r", r"two\nlines\r"),
        ("bell\a, NUL\0, delete\x7f, C1\x9b", r"bell\x07, NUL\x00, delete\x7f, C1\x9b"),
        ("turned\u202ebackwards", r"turned\u202ebackwards"),
        ("half a character \udc80", r"half a character \udc80"),
        (ValueError("a\nb"), r"a\nb"),
    ],
)
def test_what_a_terminal_would_act_on_is_escaped(text: object, shown: str) -> None:
    assert printable(text) == shown


def test_a_line_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    print_line("a\n\x1b[2Jb")
    assert capsys.readouterr().out == "a\\n\\x1b[2Jb\n"


def test_brackets_and_colons_are_text(capsys: pytest.CaptureFixture[str]) -> None:
    table = Table("name")
    table.add_row("[bold]x[/bold][/foo] :smile:")
    plain_console().print(table)
    plain_console().print("[/foo] :smile:")
    output = capsys.readouterr().out
    assert "[bold]x[/bold][/foo] :smile:" in output and "\n[/foo] :smile:\n" in output
