"""Fixtures of the benchmarks: the models that workers build."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def models():
    """The module worker_models; workers find it by the path that they inherit."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(Path(__file__).parent)
        yield importlib.import_module("worker_models")
