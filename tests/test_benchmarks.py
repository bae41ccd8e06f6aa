"""The benchmarks run: nobody else would notice until somebody wants their numbers."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
def test_each_runs_once(checkout: Path) -> None:
    pytest.importorskip("pytest_benchmark")
    fast = {name: value for name, value in os.environ.items() if name != "XLA_FLAGS"}
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "--benchmark-disable", "benchmarks"],
        cwd=checkout,
        env=fast,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stdout[-5000:]
