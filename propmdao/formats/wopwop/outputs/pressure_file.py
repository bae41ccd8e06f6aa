"""Pressures that PSU-WOPWOP has written: PLOT3D files for a grid of observers, Tecplot for one."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.runtime.input_files import read_bytes, read_text


@dataclass(frozen=True)
class PressureHistories:
    """Pressure at observers over time.

    Attributes
    ----------
    position : (n_observers, n_times, 3) array
        Positions of each observer at each time [m]; NaN if the file does not hold them.
    time : (n_observers, n_times) array
        Observer times [s].
    thickness, loading, total : (n_observers, n_times) arrays
        Pressure of thickness noise, of loading noise and of both [Pa].
    """

    position: NDArray[np.float64]
    time: NDArray[np.float64]
    thickness: NDArray[np.float64]
    loading: NDArray[np.float64]
    total: NDArray[np.float64]


def read_pressure(stem: str | Path) -> PressureHistories:
    """Read pressures of a grid of observers, or of a single one.

    Parameters
    ----------
    stem : str or Path
        Path without ending, as in ``folder/pressure``: ``STEM.x`` (positions), ``STEM.fn``
        (functions), text or binary, and ``STEM.nam`` (names). Or the path of a ``.tec`` file.

    Returns
    -------
    PressureHistories
        Pressures of the observers, in the order of the grid with i fastest, then j.

    Raises
    ------
    WopwopFileError
        If a file is missing, or holds no numbers or another count of them than its header says.
    """
    if Path(stem).suffix == ".tec":
        return _single(Path(stem))
    labels = _lines(Path(f"{stem}.nam"))
    shape, functions = _table(Path(f"{stem}.fn"), n_sizes=4)
    observers, positions = _table(Path(f"{stem}.x"), n_sizes=3)
    if len(labels) != shape[3] or observers != shape[:3]:
        raise WopwopFileError(
            f"{stem}.x, .fn and .nam do not go together: sizes {observers}, {shape} and "
            f"{len(labels)} names"
        )
    parts = _by_name(Path(f"{stem}.nam"), labels, functions)
    return PressureHistories(positions.transpose(2, 1, 0), *(part.T for part in parts))


def _single(path: Path) -> PressureHistories:
    """Read a Tecplot text file: title, variables, a text, then a row for each time."""
    lines = _lines(path)
    heads = [line for line in lines if line.upper().startswith("VARIABLES")]
    rows = [line for line in lines if line[0] in "+-.0123456789"]
    if not heads:
        raise WopwopFileError(f"{path}: not a Tecplot file: it names no VARIABLES")
    labels = heads[0].split('"')[1::2]
    try:
        table = np.array([row.split() for row in rows], float)
    except ValueError as error:
        raise WopwopFileError(f"{path}: not a Tecplot file: {error}") from None
    if table.ndim != 2 or table.shape[1] != len(labels):
        raise WopwopFileError(f"{path}: rows must have {len(labels)} numbers, as it has variables")
    parts = _by_name(path, labels, table.T)
    return PressureHistories(np.full((1, len(rows), 3), np.nan), *(part[None] for part in parts))


def _by_name(
    path: Path, labels: list[str], functions: NDArray[np.float64]
) -> list[NDArray[np.float64]]:
    """Return time, thickness, loading and total pressure out of functions in any order."""
    parts = []
    for word in ("time", "thickness", "loading", "total"):
        indices = [k for k, label in enumerate(labels) if word in label.lower()]
        if not indices:
            raise WopwopFileError(f"{path}: no {word!r} among {', '.join(labels)}")
        parts.append(functions[indices[0]])
    return parts


def _table(path: Path, n_sizes: int) -> tuple[list[int], NDArray[np.float64]]:
    """Return the sizes and an array (functions, times, observers)."""
    data = read_bytes(path, WopwopFileError, complaint=str(path))
    if b"\0" in data[: 4 * n_sizes]:  # sizes have high bytes that are zero
        sizes, values = _binary(path, data, n_sizes)
    else:
        sizes, values = _text(path, n_sizes)
    i_max, j_max, n_times, n_functions = (*sizes, 3)[:4]
    if values.size != n_functions * n_times * j_max * i_max:
        raise WopwopFileError(f"{path}: {values.size} numbers do not fill its sizes {sizes}")
    return sizes, values.reshape(n_functions, n_times, j_max * i_max)


def _text(path: Path, n_sizes: int) -> tuple[list[int], NDArray[np.float64]]:
    words = " ".join(_lines(path)).split()
    try:
        sizes = [int(word) for word in words[:n_sizes]]
        values = np.array(words[n_sizes:], float)
    except ValueError as error:
        raise WopwopFileError(f"{path}: not a PLOT3D text file: {error}") from None
    if len(sizes) != n_sizes:
        raise WopwopFileError(f"{path}: the numbers do not fill its sizes {sizes}")
    return sizes, values


def _binary(path: Path, data: bytes, n_sizes: int) -> tuple[list[int], NDArray[np.float64]]:
    """Sizes as 32-bit integers and values as 32-bit floats, in either byte order."""
    if len(data) % 4 or len(data) < 4 * n_sizes:
        raise WopwopFileError(f"{path}: truncated: {len(data)} bytes are no whole 32-bit numbers")
    # In the wrong order small sizes are millions.
    order = min("<>", key=lambda o: int(np.frombuffer(data, f"{o}u4", 1)[0]))
    sizes = [int(n) for n in np.frombuffer(data, f"{order}i4", n_sizes)]
    return sizes, np.frombuffer(data, f"{order}f4", offset=4 * n_sizes).astype(float)


def _lines(path: Path) -> list[str]:
    text = read_text(path, WopwopFileError, complaint=str(path), encoding="ascii")
    return [line.strip() for line in text.splitlines() if line.strip()]
