"""Fixtures of the studies' tests: scripts imported as when they are run, coarse meshes."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest

from propmdao.records.fidelity import Fidelity


@pytest.fixture(scope="module")
def import_study(checkout: Path) -> Iterator[Callable[[str], ModuleType]]:
    """Import a script anew; those it builds on lie beside it, once for a file of tests."""
    scripts = list((checkout / "studies").glob("*/*.py"))
    with pytest.MonkeyPatch.context() as patch:
        for folder in {script.parent for script in scripts}:
            patch.syspath_prepend(folder)

        def anew(name: str) -> ModuleType:
            sys.modules.pop(name, None)
            return importlib.import_module(name)

        yield anew
        for script in scripts:
            sys.modules.pop(script.stem, None)


@pytest.fixture(scope="session")
def coarse() -> Fidelity:
    """Meshes on which a blade can be told from another."""
    return Fidelity(n_chordwise=4, n_spanwise=8, n_contour=15, n_surface_span=12, n_harmonics=3)


@pytest.fixture(scope="session")
def coarsest() -> Fidelity:
    """Meshes for what does not depend on them."""
    return Fidelity(n_chordwise=2, n_spanwise=4, n_contour=5, n_surface_span=4, n_harmonics=2)
