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
#: Each compiles a lattice, or derivatives of one, of its own; what they show is held by tests of
#: components, and that of Dymos by those of the study of a climb.
LONG = {
    "The diameter",
    "Several operating points",
    "Flight at an incidence",
    "Minutes of hover: motor and battery",
    "Dymos: a segment of a mission",
}


@pytest.mark.parametrize(
    ("title", "code"),
    [
        pytest.param(*block, id=block[0], marks=[pytest.mark.slow] if block[0] in LONG else [])
        for block in BLOCKS
    ],
)
def test_block_of_the_page_runs(title, code):
    for package in ("dymos", "aviary"):
        if re.search(rf"^import {package}\b", code, re.M):
            pytest.importorskip(package)
    exec(compile(code, f"{PAGE.name}: {title}", "exec"), {"__name__": "block"})


def test_every_block_is_found(checkout):
    assert {title for title, _ in BLOCKS} > LONG
    assert len(BLOCKS) == PAGE.read_text("utf-8").count("```python") > 3
