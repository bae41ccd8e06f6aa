"""What tests of drivers share: the models that workers build."""

import importlib
from pathlib import Path

import pytest


@pytest.fixture
def models(monkeypatch):
    """The module worker_models; workers find it by the path that they inherit."""
    monkeypatch.syspath_prepend(Path(__file__).parent)
    return importlib.import_module("worker_models")
