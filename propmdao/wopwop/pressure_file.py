"""Pressure histories that PSU-WOPWOP has written: PLOT3D text files of a grid of observers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from propmdao.wopwop.binary import WopwopFileError


@dataclass(frozen=True)
class PressureHistories:
    """Pressure at observers over time.

    Attributes
    ----------
    position : (n_observers, n_times, 3) array
        Of each observer at each time [m].
    time : (n_observers, n_times) array
        Observer times [s].
    thickness, loading, total : (n_observers, n_times) arrays
        Pressure [Pa].
    """

    position: NDArray[np.float64]
    time: NDArray[np.float64]
    thickness: NDArray[np.float64]
    loading: NDArray[np.float64]
    total: NDArray[np.float64]


def read_pressure(stem: str | Path) -> PressureHistories:
    """Read the text files ``STEM.x`` (positions), ``STEM.fn`` (functions) and ``STEM.nam`` (names).

    Parameters
    ----------
    stem : str or Path
        Path without ending, as in ``folder/pressure``.

    Returns
    -------
    PressureHistories
        Observers with i fastest, then j.

    Raises
    ------
    WopwopFileError
        If a file is missing, holds no numbers or not as many as its header says.
    """
    labels = _lines(Path(f"{stem}.nam"))
    shape, functions = _table(Path(f"{stem}.fn"), n_sizes=4)
    observers, positions = _table(Path(f"{stem}.x"), n_sizes=3)
    if len(labels) != shape[3] or observers != shape[:3]:
        raise WopwopFileError(
            f"{stem}.x, .fn and .nam do not go together: sizes {observers}, {shape} and "
            f"{len(labels)} names"
        )

    def function(word: str) -> NDArray[np.float64]:
        found = [k for k, label in enumerate(labels) if word in label.lower()]
        if not found:
            raise WopwopFileError(f"{stem}.nam: no {word!r} among {', '.join(labels)}")
        return functions[found[0]].T

    names = ("time", "thickness", "loading", "total")
    return PressureHistories(positions.transpose(2, 1, 0), *(function(word) for word in names))


def _table(path: Path, n_sizes: int) -> tuple[list[int], NDArray[np.float64]]:
    """Return the sizes and an array (functions, times, observers)."""
    words = " ".join(_lines(path)).split()
    try:
        sizes = [int(word) for word in words[:n_sizes]]
        values = np.array(words[n_sizes:], float)
    except ValueError as error:
        raise WopwopFileError(f"{path}: not a PLOT3D text file: {error}") from None
    if len(sizes) != n_sizes:
        raise WopwopFileError(f"{path}: the numbers do not fill its sizes {sizes}")
    i_max, j_max, n_times, n_functions = (*sizes, 3)[:4]
    if values.size != n_functions * n_times * j_max * i_max:
        raise WopwopFileError(f"{path}: {values.size} numbers do not fill its sizes {sizes}")
    return sizes, values.reshape(n_functions, n_times, j_max * i_max)


def _lines(path: Path) -> list[str]:
    try:
        lines = path.read_text(encoding="ascii").splitlines()
    except UnicodeDecodeError:
        raise WopwopFileError(f"{path}: not a text file (PLOT3D binary is not read)") from None
    except OSError as error:
        raise WopwopFileError(f"{path}: {error.strerror or error}") from None
    return [line.strip() for line in lines if line.strip()]
