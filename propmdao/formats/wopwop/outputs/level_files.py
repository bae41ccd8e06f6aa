"""Levels in the files of PSU-WOPWOP: PLOT3D functions on a grid of observers, with their names."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def write_level_files(
    stem: Path,
    functions: Mapping[str, Array],
    position: Array,
    shape: tuple[int, int],
    text: bool = True,
) -> None:
    """Write functions at a grid of observers: ``STEM.x``, ``STEM.fn`` and ``STEM.nam``.

    Parameters
    ----------
    stem : Path
        Path without ending, as in ``folder/spl_spectrum``; whoever calls sees to what it replaces.
    functions : mapping of str to (n_observers, n) arrays
        Functions by name, the first of which is what they are over: frequencies or times.
    position : (n_observers, 3) array
        Positions of the observers [m].
    shape : tuple of int
        Numbers of observers along the first and the second index of the grid, i fastest.
    text : bool
        Text of six digits, as it writes on demand, or 32-bit binary numbers.
    """
    values = np.stack(list(functions.values()))  # (n_functions, n_observers, n)
    n_functions, _, n = values.shape
    places = np.broadcast_to(position.T[:, :, None], (3, len(position), n))
    sizes = (*shape, n)
    for ending, head, numbers in (
        (".fn", (*sizes, n_functions), values),
        (".x", sizes, places),
    ):
        ordered = numbers.swapaxes(1, 2).ravel()  # functions, then times, then observers
        file = Path(f"{stem}{ending}")
        if text:
            lines = ["".join(f"{size:12d}" for size in head)]
            lines += [f"{number:15.6G}" for number in ordered]
            file.write_text("\n".join(lines) + "\n", encoding="ascii")
        else:
            file.write_bytes(np.array(head, "<i4").tobytes() + ordered.astype("<f4").tobytes())
    names = "".join(f" {name}\n" for name in functions)
    Path(f"{stem}.nam").write_text(names, encoding="ascii")
