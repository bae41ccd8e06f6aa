"""What every test may count on."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

# Read when OpenMDAO is imported, so set before any test module is.
os.environ["OPENMDAO_REPORTS"] = "0"
os.environ.setdefault("MPLBACKEND", "Agg")

VALIDATION = Path(__file__).parent / "validation"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.path.is_relative_to(VALIDATION):
            item.add_marker(pytest.mark.validation)


@pytest.fixture(autouse=True)
def _openmdao_writes_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep OpenMDAO's output folders out of the folder that the tests are run from."""
    monkeypatch.setenv("OPENMDAO_WORKDIR", str(tmp_path))


@pytest.fixture(scope="session")
def reference_data() -> Path:
    """Folder of published measurements and other codes' results; the test is skipped without it."""
    folder = os.environ.get("PROPMDAO_REFERENCE_DATA")
    if not folder:
        pytest.skip("PROPMDAO_REFERENCE_DATA is not set: no reference data to compare with")
    return Path(folder)


@pytest.fixture(scope="session")
def checkout() -> Path:
    """Root of the source checkout; skipped where only the installed package is tested."""
    root = Path(__file__).parents[1]
    if not (root / "propmdao").is_dir():
        pytest.skip("not run from a source checkout")
    return root
