"""The page on clusters: what SLURM and Kubernetes would be given, without one to give it to."""

import re
from pathlib import Path
from typing import Any

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "howto" / "clusters.md"


def names_of_block(package: str) -> dict[str, Any]:
    """What the page's block has made that imports a package."""
    pytest.importorskip(package, reason=f"{package} is not installed")
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.S)
    (block,) = (code for code in blocks if f"from {package}" in code)
    namespace: dict[str, Any] = {}
    exec(compile(block, PAGE.name, "exec"), namespace)
    return namespace


def test_the_job_script_has_one_worker_for_each_core_of_a_node() -> None:
    cluster = names_of_block("dask_jobqueue")["cluster"]
    try:
        script = cluster.job_script()
    finally:
        cluster.close()
    for line in ("#SBATCH -p compute", "#SBATCH -A rotors", "#SBATCH --cpus-per-task=32",
                 "#SBATCH -t 04:00:00", "source ~/rotors/bin/activate"):  # fmt: skip
        assert line in script.splitlines()
    assert re.search(r"--nthreads 1 .*--nworkers 32\b", script)


def test_the_pods_have_a_core_and_a_thread_each() -> None:
    specification = names_of_block("dask_kubernetes")["specification"]
    assert specification["kind"] == "DaskCluster"
    worker = specification["spec"]["worker"]
    (container,) = worker["spec"]["containers"]
    assert worker["replicas"] == 64
    assert container["args"][:4] == ["dask", "worker", "--nthreads", "1"]
    assert container["resources"]["requests"]["cpu"] == "1"
