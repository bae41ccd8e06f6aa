"""Every block of docs/plugging_in.md runs as it stands."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "plugging_in.md"
BLOCKS = (
    re.findall(r"## ([^\n]*)\n(?:(?!\n## ).)*?```python\n(.*?)```", PAGE.read_text("utf-8"), re.S)
    if PAGE.exists()
    else []
)


@pytest.mark.parametrize(("title", "code"), BLOCKS, ids=[title for title, _ in BLOCKS])
def test_block_of_the_page_runs(title, code):
    for package in ("dymos", "aviary"):
        if re.search(rf"^import {package}\b", code, re.M):
            pytest.importorskip(package)
    exec(compile(code, f"{PAGE.name}: {title}", "exec"), {"__name__": "block"})


def test_every_block_is_found(checkout):
    assert len(BLOCKS) == PAGE.read_text("utf-8").count("```python") > 3
