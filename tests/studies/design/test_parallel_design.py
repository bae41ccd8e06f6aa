"""The example of executors: the same search on processes, Dask and MPI, with local workers."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from propmdao.runtime.locks import locked

pytestmark = pytest.mark.slow


def search(checkout: Path, folder: Path, *arguments: str, launcher: tuple[str, ...] = ()) -> str:
    """The last line of what the study prints: its design."""
    study = str(checkout / "studies" / "design" / "parallel_design.py")
    few = ("--generations", "2", "--population", "8")
    command = [*(launcher or (sys.executable,)), study, *few, *arguments]
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(sys.path),
        "OPENMDAO_USE_MPI": "0",
        "OPENMDAO_WORKDIR": str(folder),
    }
    result = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300
    )
    assert result.returncode == 0, result.stderr
    return result.stdout.splitlines()[-1]


@pytest.fixture(scope="module")
def by_processes(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("processes")
    found = search(checkout, folder, "--checkpoint", "checkpoint")
    assert found.startswith("torque 0.0")
    # And again, from the checkpoint, on one worker.
    assert search(checkout, folder, "--checkpoint", "checkpoint", "--workers", "1") == found
    return found


def test_dask(checkout: Path, tmp_path: Path, by_processes: str) -> None:
    pytest.importorskip("distributed", reason="Dask's distributed, an extra, is not installed")
    assert search(checkout, tmp_path, "--on", "dask") == by_processes


def test_mpi(checkout: Path, tmp_path: Path, by_processes: str) -> None:
    pytest.importorskip("mpi4py", reason="mpi4py, an extra, is not installed")
    mpiexec = shutil.which("mpiexec", path=f"{Path(sys.executable).parent}{os.pathsep}{os.defpath}")
    if mpiexec is None:
        pytest.skip("there is no mpiexec")
    launcher = (mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures")
    assert search(checkout, tmp_path, "--on", "mpi", launcher=launcher) == by_processes


def test_a_checkpoint_that_is_in_use_is_told_in_one_line(checkout: Path, tmp_path: Path) -> None:
    with locked(tmp_path / "checkpoint"), pytest.raises(AssertionError) as caught:
        search(checkout, tmp_path, "--checkpoint", "checkpoint")
    assert "Traceback" not in str(caught.value)
    assert "parallel_design.py: error: " in str(caught.value)
