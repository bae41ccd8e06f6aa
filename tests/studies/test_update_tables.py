"""The tables of docs/verification.md: each has its place there, and verdicts follow the targets."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")

from propmdao.components.drivers.gradient_search import Search
from propmdao.components.drivers.search_history import SearchHistory

NAMES = ("update_tables", "gradient_tables")


@pytest.fixture(scope="module")
def script(checkout: Path, import_study: Callable[[str], ModuleType]) -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(checkout / "docs")
        yield import_study("update_tables")
        for name in NAMES:
            sys.modules.pop(name, None)


def test_every_table_has_its_place(script: ModuleType, checkout: Path) -> None:
    places = []
    for name in ("verification.md", "thesis.md"):
        page = (checkout / "docs" / name).read_text(encoding="utf-8")
        places += re.findall(r"<!-- table: (.*?) -->\n.*?<!-- end of table -->", page, re.DOTALL)
    assert sorted(places) == sorted(script.TABLES)


def test_names_and_what_they_begin_with(
    script: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A name that others begin with is that one table."""
    names = ("wake", "wake transport", "gradient thesis", "gradient cost")
    empty = "<!-- table: {} -->\n<!-- end of table -->\n"
    (tmp_path / "verification.md").write_text("".join(map(empty.format, names)))
    monkeypatch.setattr(script, "HERE", tmp_path)
    tables = {name: lambda: [("head", "b"), ("row", "1")] for name in names}
    monkeypatch.setattr(script, "TABLES", tables)
    monkeypatch.setattr("sys.argv", ["update_tables.py", "wake", "gradient"])
    script.main()
    filled = (
        "<!-- table: {} -->\n| head | b |\n| --- | ---: |\n| row | 1 |\n<!-- end of table -->\n"
    )
    expected = [filled, empty, filled, filled]
    written = "".join(text.format(name) for text, name in zip(expected, names, strict=True))
    assert (tmp_path / "verification.md").read_text() == written


def test_verdicts_of_searches(script: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    def search(objective: float, violation: float, seconds: float) -> Search:
        history = SearchHistory(np.array([50.0, objective]), np.array([0.0, violation]), ["", ""])
        return Search(history, seconds, 5.0)

    searches = {
        "thesis' problem": search(41.0, 0.0, 56.0),
        "evolution": search(41.01, 0.0, 0.0),
        "quiet tones, coarse": search(40.0, 1e-5, 250.0),
        "quiet tones": search(40.0, 1e-5, 30.0),
        "quiet total, coarse": search(40.0, 2e-4, 1.0),
        "quiet total": search(40.0, 2e-4, 1.0),
    }
    tables = script.gradient_tables
    monkeypatch.setattr(tables, "results", lambda: SimpleNamespace(searches=searches))
    shown = {label: (value, verdict) for label, _, value, verdict in tables.targets()}
    assert shown == {
        "search by gradients": ("measured", ""),
        "thesis' problem: designs analysed": ("2", "met"),
        "thesis' problem: time": ("61 s", "missed"),
        "thesis' problem: time, compiling apart": ("56 s", "met"),
        "thesis' problem: above the best of 1200 designs": ("-0.010 dB", "met"),
        "29 variables, quiet tones: time": ("290 s", "met"),
        "29 variables, quiet tones: largest violation": ("1.0e-05", "met"),
        "29 variables, quiet total: time": ("12 s", "met"),
        "29 variables, quiet total: largest violation": ("2.0e-04", "missed"),
    }
