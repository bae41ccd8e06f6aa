"""Write docs/validation_book.md: comparisons with experiment and other codes, from their tests.

Run it from the repository: ``python docs/validation_book.py``. The tests in ``tests/validation``
are run, and every statement that they hold is written down with the numbers found, so the page
cannot say anything else than they do. What a test keeps by the fixture ``drawn`` becomes the figure
of its case, in ``docs/figures/validation``. With words, as in ``python docs/validation_book.py
wind_tunnel``, only the cases of these are run and their figures drawn; the page stays as it is.
``PROPMDAO_REFERENCE_DATA`` names the folder of
reference data; tests that need it are listed as left out where it is not set.
"""

from __future__ import annotations

import ast
import dataclasses
import os
import re
import subprocess
import sys
import tempfile
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.ticker import EngFormatter, LogLocator, NullLocator

from propmdao.figures.contents.palette import LINE_STYLES, MARKERS, RUN_COLORS
from propmdao.figures.style import GRID, page, save

ROOT = Path(__file__).parents[1]
PAGE = Path(__file__).with_suffix(".md")
FIGURES = Path(__file__).parent / "figures" / "validation"
TESTS = "tests/validation"
LONGEST = 90  # characters of a statement in the table
MOST_DOTS = 30  # of a curve in a figure, as far as whole steps go
# Left out of an explanation: the type that NumPy and JAX write around a number.
_TYPES = re.compile(
    r"(?:np\.|jnp\.)?(?:float64|float32|int64|bool_?|Array)\(([^()]*?)(?:, dtype=\w+)?\)"
)
_DIGITS = re.compile(r"-?\d+\.\d{4,}(?:e[-+]?\d+)?")


@dataclasses.dataclass
class Check:
    """A test: what it held, and how it ended.

    Attributes
    ----------
    name : str
        Name of the test with its parameters.
    statements : list of (str, str)
        Each assertion as the test has it, and with the numbers found.
    outcome : str
        "passed", "failed" or "skipped".
    reason : str
        Reason of a failure, or for leaving it out.
    drawn : list of dict
        What it keeps for the figure of its case (``tests/validation/conftest.py``).
    """

    name: str
    statements: list[tuple[str, str]] = dataclasses.field(default_factory=list)
    outcome: str = "passed"
    reason: str = ""
    drawn: list[Mapping[str, Any]] = dataclasses.field(default_factory=list)


class Recorder:
    """Plugin of pytest that keeps every assertion that holds."""

    def __init__(self) -> None:
        self.cases: dict[str, dict[str, Check]] = {}

    def check(self, nodeid: str) -> Check:
        """Record of a test, made where there is none."""
        file, _, name = nodeid.partition("::")
        return self.cases.setdefault(file, {}).setdefault(name, Check(name))

    def pytest_assertion_pass(self, item: pytest.Item, lineno: int, orig: str, expl: str) -> None:
        """Keep a statement that held."""
        self.check(item.nodeid).statements.append((orig, expl.splitlines()[0]))

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Keep how a test ended."""
        check = self.check(report.nodeid)
        if report.when == "call":
            check.drawn = [value for name, value in report.user_properties if name == "drawn"]
        if report.failed:
            check.outcome, check.reason = "failed", report.longreprtext.splitlines()[-1]
        elif report.skipped:
            check.outcome, check.reason = "skipped", str(report.longrepr[2])


def book(cases: dict[str, dict[str, Check]]) -> str:
    """Text of the book.

    Parameters
    ----------
    cases : dict of dict of Check
        Checks by file and name.

    Returns
    -------
    str
        Markdown.
    """
    summary = ["| case | checks | hold | fail | left out |", "| --- | ---: | ---: | ---: | ---: |"]
    sections = []
    for file, checks in cases.items():
        title, text = described(file)
        outcomes = [check.outcome for check in checks.values()]
        counts = (outcomes.count(name) for name in ("passed", "failed", "skipped"))
        summary.append(_row(f"[{title}](#{_anchor(title)})", f"{len(checks)}", *map(str, counts)))
        sections += [
            f"## {title}\n",
            f"`{file}`\n",
            *([f"{text}\n"] if text else []),
            *([_image(file, title)] if curves(checks) else []),
            _table(checks),
        ]
    return "\n".join([HEAD, *summary, "", *sections])


HEAD = """# Validation book

Comparisons with experiment and other codes, case by case: source and conditions, every statement
that its test holds, and the numbers found. Statements are held from both sides where a change for
the better should be noticed, too. Written by `python docs/validation_book.py` from a run of
`tests/validation`; [verification](verification.md) has the tables and their discussion,
[the thesis beside ours](thesis.md) its tables and figures, [known failures](known_failures.md) what
is missed.
"""


def described(file: str) -> tuple[str, str]:
    """Title and text of a case, from the docstring of its tests.

    Parameters
    ----------
    file : str
        Path of the tests from the repository.

    Returns
    -------
    title, text : str
        First sentence without its full stop, and the rest.
    """
    docstring = ast.get_docstring(ast.parse((ROOT / file).read_text(encoding="utf-8"))) or file
    title, _, text = docstring.partition("\n\n")
    return " ".join(title.split()).rstrip("."), text.strip()


def curves(checks: Mapping[str, Check]) -> dict[str, list[Mapping[str, Any]]]:
    """Comparisons that the tests of a case have kept, by panel.

    Parameters
    ----------
    checks : dict of Check
        Checks of the case by name.

    Returns
    -------
    dict of list of dict
        What the fixture ``drawn`` was given, of each panel in the order of the tests.
    """
    panels: dict[str, list[Mapping[str, Any]]] = {}
    for check in checks.values():
        for comparison in check.drawn:
            panels.setdefault(comparison["panel"], []).append(comparison)
    return panels


def figure(panels: Mapping[str, Sequence[Mapping[str, Any]]]) -> Any:
    """Figure of a case: computed lines or dots, what they are compared with as rings, by panel.

    Parameters
    ----------
    panels : dict of list of dict
        Comparisons by panel, as `curves` has them.

    Returns
    -------
    Figure
        The figure.
    """
    n_rows = (len(panels) + 1) // 2
    drawing = page(0.6 + 3.6 * n_rows)
    places = drawing.subplots(n_rows, 2, squeeze=False).ravel()
    for axes, (name, comparisons) in zip(places, panels.items(), strict=False):
        axes.set_title(name, fontsize="medium")
        axes.set_xlabel(comparisons[0]["labels"][0])
        axes.set_ylabel(comparisons[0]["labels"][1])
        axes.grid(**GRID)
        if comparisons[0]["log"]:
            axes.set_xscale("log")
            axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axes.xaxis.set_major_formatter(EngFormatter(sep=""))
            axes.xaxis.set_minor_locator(NullLocator())
        for kind in ("computed", "compared with"):
            for k, (label, (x, y)) in enumerate(_joined(comparisons, kind).items()):
                form: dict[str, Any] = {"color": RUN_COLORS[-3 + k % 3], "label": label}
                if kind == "computed" and comparisons[0]["joined"]:
                    form |= {"linestyle": LINE_STYLES[1 - k % 4], "zorder": 2.1}
                elif kind == "computed":
                    form |= {"linestyle": "", "marker": ".", "zorder": 2.1}
                else:
                    form |= {"linestyle": "", "marker": MARKERS[k % len(MARKERS)]}
                    form |= {"markersize": 5, "markerfacecolor": "none"}
                    form |= {"markevery": max(1, len(x) // MOST_DOTS)}
                axes.plot(x, y, **form)
        below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.2), "frameon": False}
        axes.legend(fontsize="small", ncols=2, **below)
    for axes in places[len(panels) :]:
        axes.remove()
    return drawing


def _joined(
    comparisons: Sequence[Mapping[str, Any]], kind: str
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Curves of a panel by name, the points of all tests in the order of their abscissa."""
    points: dict[str, tuple[list[float], list[float]]] = {}
    for comparison in comparisons:
        for name, values in comparison[kind].items():
            x, y = points.setdefault(name, ([], []))
            x += comparison["x"]
            y += values
    joined = {}
    for name, (x, y) in points.items():
        order = np.argsort(x, kind="stable")
        joined[name] = (np.array(x)[order], np.array(y)[order])
    return joined


def _image(file: str, title: str) -> str:
    name = f"figures/validation/{Path(file).stem.removeprefix('test_')}.png"
    return f"```{{image}} {name}\n:alt: {title}\n:width: 900px\n```\n"


def _anchor(title: str) -> str:
    kept = re.sub(r"[^\w\- ]", "", title.lower())
    return kept.replace(" ", "-")


def _table(checks: dict[str, Check]) -> str:
    rows = ["| check | holds | found | verdict |", "| --- | --- | --- | --- |"]
    for check in checks.values():
        name = check.name.removeprefix("test_").replace("_", " ")
        verdict = {"passed": "met", "failed": "**missed**", "skipped": "left out"}[check.outcome]
        if check.reason:
            rows.append(_row(name, check.reason, "", verdict))
            name, verdict = "", ""
        for statement, found in check.statements:
            rows.append(_row(name, _code(statement), _code(_plain(found)), verdict))
            name = ""
    return "\n".join(rows) + "\n"


def _row(*cells: str) -> str:
    escaped = (cell.replace("|", r"\|") for cell in cells)
    return f"| {' | '.join(escaped)} |"


def _plain(text: str) -> str:
    """An explanation without types and the folder of the data, with four digits."""
    text = text.replace(os.environ.get("PROPMDAO_REFERENCE_DATA", "\0"), "...")
    return _DIGITS.sub(lambda number: f"{float(number[0]):.4g}", _TYPES.sub(r"\1", text))


def _code(text: str) -> str:
    """A line of code, shortened."""
    words = " ".join(text.split()).replace("`", "'")
    return f"`{textwrap.shorten(words, LONGEST, placeholder=' ...')}`"


def main() -> None:
    """Run the tests and write the page, or only the figures of the cases that are named."""
    words = [word for word in sys.argv[1:] if word != "--run"]
    if "--run" in sys.argv:
        recorder = Recorder()
        arguments = [f"{TESTS}/test_{word}.py" for word in words] or [TESTS]
        arguments += ["-vv", "-p", "no:cacheprovider"]  # -vv: numbers in full
        arguments += ["-o", "enable_assertion_pass_hook=true"]
        pytest.main(arguments, plugins=[recorder])
        if not words:
            PAGE.write_text(book(recorder.cases), encoding="utf-8")
        FIGURES.mkdir(parents=True, exist_ok=True)
        for file, checks in recorder.cases.items():
            if panels := curves(checks):
                save(figure(panels), FIGURES / Path(_image(file, "").split()[1]).name)
        return
    # Rewritten tests that are cached know of no such hook: this run has a cache of its own.
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"PYTHONPYCACHEPREFIX": folder}
        command = [sys.executable, __file__, "--run", *words]
        subprocess.run(command, cwd=ROOT, env=environment, check=True)


if __name__ == "__main__":
    main()
