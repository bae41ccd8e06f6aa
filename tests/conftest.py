"""What every test may count on."""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.formats.wopwop.geometry_file import GeometryFile, write_geometry
from propmdao.formats.wopwop.loading_file import LoadingFile, write_loading
from propmdao.formats.wopwop.namelists.groups import write_namelists
from propmdao.formats.wopwop.zones import Zone
from propmdao.runtime import compilation

# Read when OpenMDAO is imported, so set before any test module is.
os.environ["OPENMDAO_REPORTS"] = "0"
os.environ.setdefault("MPLBACKEND", "Agg")

VALIDATION = Path(__file__).parent / "validation"


# Tests wait for XLA's compiler, not for what it makes: without optimisations they take three
# quarters of the time. The other flag is what `propmdao.runtime.compilation` asks for; programs of
# the tests' own have it, too.
_SOON_COMPILED = "--xla_cpu_use_fusion_emitters=false --xla_backend_optimization_level=0"


def pytest_configure() -> None:
    """Compile without optimisation, where this version of XLA can, and seldom look for garbage.

    Tracing makes a great many objects that stay: looking through them takes a sixth of the time.
    """
    gc.set_threshold(50_000, 20, 20)
    with_options = compilation._options
    compilation._options = lambda _: with_options(0)
    if "XLA_FLAGS" in os.environ:  # the user's own, or those of the process that began this one
        return
    settings = os.environ | {"XLA_FLAGS": _SOON_COMPILED}
    starts = [sys.executable, "-c", "import jax; jax.devices()"]  # or aborts: it knows the flag not
    if subprocess.run(starts, env=settings, capture_output=True).returncode == 0:
        os.environ |= settings


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.path.is_relative_to(VALIDATION):
            item.add_marker(pytest.mark.validation)


@pytest.fixture(autouse=True)
def _openmdao_writes_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep OpenMDAO's output folders out of the folder that the tests are run from."""
    monkeypatch.setenv("OPENMDAO_WORKDIR", str(tmp_path))


def _resident_bytes() -> int:
    """Memory that the process holds; 0 where the system does not say."""
    statm = Path("/proc/self/statm")
    return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if statm.exists() else 0


_held = [0]  # memory held after compiled code was last let go


def _most_bytes() -> int:
    """Memory that compiled code may take: the processes of a run together half of the machine's."""
    n_processes = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    if "SC_PHYS_PAGES" not in os.sysconf_names:
        return 3 * 2**30
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // (2 * n_processes)


@pytest.fixture(autouse=True, scope="module")
def _compiled_code_fits_in_memory() -> Iterator[None]:
    """Let compiled code go where it has grown large: what was traced has to be traced again."""
    yield
    if _resident_bytes() - _held[0] > _most_bytes():
        import jax

        jax.clear_caches()
        gc.collect()
        _held[0] = _resident_bytes()


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


@pytest.fixture(scope="session")
def on_devices() -> Callable[[int, str, str], Any]:
    """Gives what a function of a test's module returns, as JSON, where JAX has so many devices."""

    def on_devices(n_devices: int, path: str, function: str) -> Any:
        place = Path(path)
        code = f"import json, {place.stem} as module; print(json.dumps(module.{function}()))"
        run = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", code],
            cwd=place.parent,
            env=os.environ
            | {
                "XLA_FLAGS": f"--xla_force_host_platform_device_count={n_devices}",
                "PYTHONPATH": os.pathsep.join(sys.path),  # with what pytest has put there
            },
            capture_output=True,
            text=True,
        )
        assert run.returncode == 0, run.stderr
        return json.loads(run.stdout)

    return on_devices


# A case of PSU-WOPWOP, for its formats and for the analysis that runs it.
N_SPAN = 9  # nodes along the blade


def box(size: tuple[float, float, float], center: tuple[float, float, float]) -> Zone:
    """A closed box along x: a loop of 5 nodes around it, ends drawn together."""
    y, z = (np.array(q) for q in ([-1, 1, 1, -1, -1], [-1, -1, 1, 1, -1]))
    x = np.array([-1, *np.linspace(-1, 1, N_SPAN), 1])
    shrink = np.array([0, *np.ones(N_SPAN), 0])[:, None]
    nodes = np.stack([np.broadcast_to(x[:, None], (x.size, 5)), shrink * y, shrink * z])
    half = np.array(size)[:, None, None] / 2
    normals = nodes / np.linalg.norm(nodes, axis=0)
    values = np.concatenate([half * nodes + np.array(center)[:, None, None], normals])
    return Zone("box", values[None].astype(np.float32))


def line(r: np.ndarray) -> Zone:
    """A line of nodes along x."""
    normal = np.stack([0 * r, 0 * r, 1 + 0 * r])
    return Zone("line", np.concatenate([[r, 0 * r, 0 * r], normal])[None, :, :, None].astype("f4"))


@pytest.fixture
def geometry() -> GeometryFile:
    radius = np.linspace(0.2, 0.5, N_SPAN)
    return GeometryFile((box((0.3, 0.04, 0.01), (0.35, 0, 0)), line(radius)), comment="two zones")


@pytest.fixture
def loading() -> LoadingFile:
    """10 N/m of lift and 1 N/m of drag on the blade, turning along +y."""
    force = np.array([0.0, -1.0, 10.0])[:, None, None] * np.ones((N_SPAN, 1))
    return LoadingFile((Zone("line loads", force[None].astype(np.float32)),), (-2,), 2)


@pytest.fixture
def make_case(tmp_path: Path, geometry: GeometryFile, loading: LoadingFile) -> Callable[..., Path]:
    """Write a case of one rotor with two blades; groups can be changed or added to."""

    def make(
        loading: LoadingFile = loading,
        n_blades: int = 2,
        omega: float = 100.0,
        behind_rotor: Sequence[tuple[str, dict]] = (),
        **changes: Any,
    ) -> Path:
        write_geometry(tmp_path / "geometry.dat", geometry)
        write_loading(tmp_path / "loading.dat", loading)
        groups: dict[str, dict] = {
            "EnvironmentIn": {"nbSourceContainers": 1, "nbObserverContainers": 1},
            "EnvironmentConstants": {"rho": 1.2, "c": 340.0},
            "ObserverIn": {
                "title": "microphones",
                "nt": 128,
                "tMin": 0.0,
                "tMax": 2 * np.pi / 100.0 * 127 / 128,
                "nbx": 2,
                "xMin": 3.0,
                "xMax": 4.0,
                "nby": 1,
                "yMin": 0.0,
                "yMax": 0.0,
                "nbz": 1,
                "zMin": -2.0,
                "zMax": -2.0,
                "highPassFrequency": 5.0,
            },
        }
        rotor = {"title": "rotor", "nbContainer": n_blades, "nbBase": 1, "dTau": 2e-4}
        turn = {"AngleType": "KnownFunction", "Omega": omega, "Psi0": 0.0, "AxisValue": [0, 0, 1]}
        groups |= {"ContainerIn": rotor, "CB": turn | {"rotation": True}}
        for name, values in changes.items():
            merged = groups[name] | values
            groups[name] = {key: value for key, value in merged.items() if value is not None}
        case = [*groups.items(), *behind_rotor]
        for blade in range(n_blades):
            angle = 2 * np.pi * blade / n_blades
            files = {"patchGeometryFile": "geometry.dat", "patchLoadingFile": "loading.dat"}
            offset = {"nbBase": 1, "periodicKeyOffset": angle}
            case.append(("ContainerIn", {"title": f"blade {blade + 1}"} | files | offset))
            fixed = {"AngleType": "TimeIndependent", "AxisValue": [0, 0, 1], "AngleValue": angle}
            case.append(("CB", fixed))
        write_namelists(tmp_path / "case.nam", case)
        names = {"globalFolderName": "./", "caseNameFile": "case.nam"}
        write_namelists(tmp_path / "cases.nam", [("casename", names)])
        return tmp_path

    return make
