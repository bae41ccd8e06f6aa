"""The option --report: what it needs, and that it writes the page of what was asked."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from propmdao.commands.program import main

PROPELLER = "apcsf_11x4.7"


def test_without_its_libraries_one_line_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, refused: Callable[..., str], recorder: Any, tmp_path: Path
) -> None:
    known = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "plotly" else known(name)
    )
    file = tmp_path / "a.html"
    line = refused("analyze", PROPELLER, "--rpm", "4000", "--report", str(file))
    assert line.endswith("--report needs Jinja and Plotly: pip install 'propmdao[report]'\n")
    assert recorder.asked == [] and not file.exists()


@pytest.mark.parametrize(
    "command",
    [
        f"analyze {PROPELLER} --rpm 4000",
        f"compare {PROPELLER} apcsf_10x4.7 --rpm 4000",
        f"sweep {PROPELLER} --rpm 3000:4000:500 --out sweep.csv",
        f"flyover {PROPELLER} --rpm 4000 --speed 8 --height 20",
        f"optimise {PROPELLER} --thrust 2 --arc 2 -45 --results quiet",
    ],
)
def test_a_file_that_is_no_page_is_refused_before_the_work(
    recorder: Any, refused: Callable[..., str], command: str
) -> None:
    if command.startswith("optimise"):
        pytest.importorskip("matplotlib")
    line = refused(*command.split(), "--report", "a.pdf")
    assert "--report a.pdf: the file must end in .html" in line
    assert recorder.asked == []


def test_the_page_tells_the_command_and_the_warnings(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("jinja2")
    pytest.importorskip("plotly")
    file = tmp_path / "page.html"
    words = ["analyze", PROPELLER, "--rpm", "0", "--report", str(file)]  # nothing to compile
    assert main(words) == 0
    output = capsys.readouterr()
    assert f"Report: {file}" in output.out
    text = file.read_text(encoding="utf-8")
    assert f"<code>propmdao analyze {PROPELLER} --rpm 0 --report {file}</code>" in text
    for line in output.err.splitlines():
        assert line.partition("warning: ")[2] in text
