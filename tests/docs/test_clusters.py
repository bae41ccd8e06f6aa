"""The page on clusters: its job script is what SLURM takes, without a SLURM to submit it to."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "howto" / "clusters.md"


def test_the_job_script_has_one_worker_for_each_core_of_a_node() -> None:
    pytest.importorskip("dask_jobqueue", reason="dask-jobqueue is not installed")
    (block,) = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.S)
    namespace: dict[str, object] = {}
    exec(compile(block, PAGE.name, "exec"), namespace)
    cluster = namespace["cluster"]
    try:
        script = cluster.job_script()  # type: ignore[attr-defined]
    finally:
        cluster.close()  # type: ignore[attr-defined]
    for line in ("#SBATCH -p compute", "#SBATCH -A rotors", "#SBATCH --cpus-per-task=32",
                 "#SBATCH -t 04:00:00", "source ~/rotors/bin/activate"):  # fmt: skip
        assert line in script.splitlines()
    assert re.search(r"--nthreads 1 .*--nworkers 32\b", script)
