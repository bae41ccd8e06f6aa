"""The fixed kernel in C that benchmarks are compared with, built when they run."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import time
from pathlib import Path

import numpy as np

N_POINTS, N_SEGMENTS = 584, 3850  # of one solution of the lattice at the default resolution
_SOURCE = Path(__file__).with_suffix(".c")
_FLAGS = ["-O3", "-march=native", "-ffast-math", "-shared", "-fPIC"]


def reference_seconds(folder: Path) -> float | None:
    """Least time of 2.25 million pairs on one core [s]; None where no C compiler is found."""
    compiler = shutil.which("cc")
    if compiler is None:
        return None
    library = folder / "reference_kernel.so"
    subprocess.run([compiler, *_FLAGS, str(_SOURCE), "-o", str(library), "-lm"], check=True)
    velocities = ctypes.CDLL(str(library)).velocities
    points, starts, ends, result = _problem()
    arguments = [
        ctypes.c_int(N_POINTS),
        *map(_address, points),
        ctypes.c_int(N_SEGMENTS),
        *map(_address, (*starts, *ends)),
        _address(result),
    ]
    times = []
    for _ in range(30):
        began = time.perf_counter()
        velocities(*arguments)
        times.append(time.perf_counter() - began)
    expected = _velocity_at_first_point(points, starts, ends)
    np.testing.assert_allclose(result[0], expected, rtol=1e-9)
    return min(times)


def _problem() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    points, starts = rng.normal(size=(3, N_POINTS)), rng.normal(size=(3, N_SEGMENTS))
    ends = starts + 0.05 * rng.normal(size=(3, N_SEGMENTS))
    return points, starts, ends, np.zeros((N_POINTS, 3))


def _velocity_at_first_point(
    points: np.ndarray, starts: np.ndarray, ends: np.ndarray
) -> np.ndarray:
    a, b = (points[:, :1] - end for end in (starts, ends))
    long_a, long_b = np.linalg.norm(a, axis=0), np.linalg.norm(b, axis=0)
    k = (long_a + long_b) / (long_a * long_b * (long_a * long_b + (a * b).sum(axis=0)))
    return (k * np.cross(a, b, axis=0)).sum(axis=1)


def _address(vector: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(vector.ctypes.data)
