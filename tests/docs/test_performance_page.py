"""The page of what things cost: its tables are those of the run that is kept beside it."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest


@pytest.fixture(scope="module")
def script(checkout: Path) -> ModuleType:
    path = checkout / "docs" / "performance_table.py"
    spec = importlib.util.spec_from_file_location("performance_table", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def run() -> dict[str, Any]:
    """A run as pytest-benchmark writes it, with what `benchmarks/conftest.py` adds."""

    def benchmark(name: str, median: float, **said: float) -> dict[str, Any]:
        return {"name": name, "stats": {"median": median, "min": 0.0}, "extra_info": said}

    return {
        "datetime": "2026-11-27T13:40:00+00:00",
        "commit_info": {"id": "0123456789", "dirty": False},
        "propmdao": {"processor": "a processor", "cores": 2, "reference_kernel_s": 0.004},
        "benchmarks": [
            benchmark("test_steady_lattice[viscous]", 0.0096),
            benchmark("test_blade_elements", 0.17, floor_s=0.024, over_floor=7.08),
            benchmark("test_gradient_of_a_design", 0.048, wanted_s=0.036),
            benchmark("test_population[8]", 1.0, blades_per_second=8.0, blade_bytes=2**21),
        ],
    }


def test_the_page_has_the_tables_of_the_run_that_is_kept(script: ModuleType) -> None:
    kept, text = (path.read_text(encoding="utf-8") for path in (script.KEPT, script.PAGE))
    assert script.page(text, json.loads(kept)) == text


def test_a_run_becomes_tables(script: ModuleType, run: dict[str, Any]) -> None:
    tables = script.tables(script.kept_of(run))
    assert "| processor | a processor |" in tables["run"]
    assert "| commit | 0123456 |" in tables["run"]
    rows = tables["times"].splitlines()[2:]
    assert rows == [
        "| steady viscous lattice at a rotation speed | 9.6 ms | 10 ms | 2.4 |",
        "| blade elements, a point of 1,000 | 170 µs | 200 µs | 0.043 |",
        "| gradient of 3 responses by 30 variables | 48 ms | 36 ms | 12 |",
    ]
    assert tables["floors"].splitlines()[2:] == ["| `test_blade_elements` | 7.1 |"]
    assert tables["blades"].splitlines()[2:] == ["| 8 | 8.0 | 2 |"]


def test_without_a_compiler_there_is_no_ratio(script: ModuleType, run: dict[str, Any]) -> None:
    run["propmdao"]["reference_kernel_s"] = None
    run["commit_info"]["dirty"] = True
    tables = script.tables(script.kept_of(run))
    assert "| 9.6 ms | 10 ms |  |" in tables["times"]
    assert "| commit | 0123456 and changes |" in tables["run"]


def test_every_row_is_of_a_benchmark_that_there_is(script: ModuleType, checkout: Path) -> None:
    benchmarks = "".join(
        path.read_text(encoding="utf-8") for path in (checkout / "benchmarks").glob("test_*.py")
    )
    for work in script.WORK:
        assert f"def {work.benchmark.split('[')[0]}(" in benchmarks, work.benchmark


def test_a_page_without_a_place_is_refused(script: ModuleType, run: dict[str, Any]) -> None:
    with pytest.raises(SystemExit, match="must have the table 'run' once; it has it 0 times"):
        script.page("nothing", script.kept_of(run))
