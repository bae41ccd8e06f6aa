"""Binary files of PSU-WOPWOP: 32-bit words without record markers, in either byte order.

The opening that geometry and loading files share is here, too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from propmdao.runtime.input_files import read_bytes
from propmdao.runtime.output_files import replacing

MAGIC = 42
TIMES = {1: "constant", 2: "periodic", 3: "aperiodic"}
GRIDS = {1: "structured", 2: "unstructured"}
CENTRED = {1: "at nodes", 2: "at faces"}
CONSTANT, PERIODIC, APERIODIC = TIMES
STRUCTURED, UNSTRUCTURED = GRIDS
_AT_NODES, _AT_FACES = CENTRED

Floats = NDArray[np.float32]


class WopwopFileError(ValueError):
    """A PSU-WOPWOP file that cannot be read, in one line that names the file and why."""


class FileKind(NamedTuple):
    """A kind of file.

    Attributes
    ----------
    name : str
        Name of the kind, for messages.
    number : int
        Number of the kind in the file.
    text_sizes : tuple of int
        Lengths of the texts at the beginning.
    """

    name: str
    number: int
    text_sizes: tuple[int, ...]


GEOMETRY = FileKind("geometry", 1, (32, 1024))
LOADING = FileKind("loading", 2, (1024,))


class Layout(NamedTuple):
    """Grids and times of all zones of a file, which are alike.

    Attributes
    ----------
    grid : int
        Kind of the zones' grids, a key of `GRIDS`.
    time : int
        Kind of the zones' dependence on time, a key of `TIMES`.
    at_faces : bool
        True if normals or loads belong to faces, False if to nodes.
    """

    grid: int
    time: int
    at_faces: bool


class Reader:
    """Reads a whole file and hands out words and texts one after another.

    Parameters
    ----------
    path : Path
        Binary file that begins with the magic number 42.

    Raises
    ------
    WopwopFileError
        If the file cannot be read or does not begin with 42 in either byte order.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._data = read_bytes(path, WopwopFileError, complaint=str(path))
        orders = [o for o in "<>" if self._data[:4] == np.array(MAGIC, f"{o}i4").tobytes()]
        if not orders:
            raise WopwopFileError(
                f"{path}: not a PSU-WOPWOP binary file; it begins with "
                f"{self._data[:4].hex(' ') or 'nothing'}, not with {MAGIC} as a 32-bit integer"
            )
        self.byte_order = orders[0]
        #: Byte that fills up texts, a blank or zero.
        self.padding = b" "
        self._position = 4

    def ints(self, n: int) -> list[int]:
        """Return the next n integers."""
        return [int(i) for i in np.frombuffer(self._take(4 * n), f"{self.byte_order}i4")]

    def floats(self, *shape: int) -> Floats:
        """Return the next floats in an array of a shape, last axis fastest."""
        raw = self._take(4 * math.prod(shape))  # NumPy's product overflows
        return np.frombuffer(raw, f"{self.byte_order}f4").reshape(shape).astype(np.float32)

    def text(self, n: int) -> str:
        """Return a text of n bytes without the bytes that fill it up."""
        raw = self._take(n)
        if raw.endswith(b"\0"):
            self.padding = b"\0"
        return raw.rstrip(b" \0").decode("latin-1")

    def expect(self, wanted: int, what: str) -> None:
        """Refuse the file if the next integer is not the one wanted."""
        (value,) = self.ints(1)
        if value != wanted:
            raise self.error(f"{what} must be {wanted}; it is {value}")

    def choose(self, options: dict[int, str], what: str) -> int:
        """Return the next integer if it is one of the options, refuse the file otherwise."""
        (value,) = self.ints(1)
        if value not in options:
            known = ", ".join(f"{number} ({meaning})" for number, meaning in options.items())
            raise self.error(f"{what} must be one of {known}; it is {value}")
        return value

    def count(self, what: str) -> int:
        """Return the next integer, a count of at least 1."""
        (value,) = self.ints(1)
        if value < 1:
            raise self.error(f"{what} must be at least 1; it is {value}")
        return value

    def end(self) -> None:
        """Refuse a file that goes on after all that its header promised."""
        if left := len(self._data) - self._position:
            raise self.error(f"{left} bytes more than its header says")

    def error(self, message: str) -> WopwopFileError:
        """Return the error to raise about this file."""
        return WopwopFileError(f"{self.path}: {message}")

    def _take(self, n: int) -> bytes:
        start, stop = self._position, self._position + n
        if stop > len(self._data):
            raise self.error(
                f"truncated: {stop} bytes or more expected, the file has {len(self._data)}"
            )
        self._position = stop
        return self._data[start:stop]


class Writer:
    """Collects words and texts; the counterpart of `Reader`.

    Parameters
    ----------
    byte_order : str
        Byte order: "<" little-endian or ">" big-endian.
    padding : bytes
        The byte that fills up texts.
    """

    def __init__(self, byte_order: str, padding: bytes) -> None:
        self._order, self._padding = byte_order, padding
        self._parts: list[bytes] = []
        self.ints(MAGIC)

    def ints(self, *values: int) -> None:
        """Append integers."""
        self._parts.append(np.array(values, f"{self._order}i4").tobytes())

    def floats(self, values: Floats | float) -> None:
        """Append floats, last axis fastest."""
        self._parts.append(np.asarray(values, f"{self._order}f4").tobytes())

    def text(self, value: str, n: int) -> None:
        """Append a text filled up to n bytes."""
        raw = value.encode("latin-1")
        if len(raw) > n:
            raise ValueError(f"text must be at most {n} bytes; {value[:20]!r}... has {len(raw)}")
        self._parts.append(raw.ljust(n, self._padding))

    def save(self, path: Path) -> None:
        """Write the file."""
        with replacing(path) as file:
            file.write_bytes(b"".join(self._parts))


def read_opening(file: Reader, kind: FileKind) -> tuple[list[str], int, Layout]:
    """Read the beginning of a file, which both kinds have alike.

    Parameters
    ----------
    file : Reader
        Reader at the version.
    kind : FileKind
        Kind of file that is expected, `GEOMETRY` or `LOADING`.

    Returns
    -------
    texts : list of str
        Texts of the kind.
    n_zones : int
        Number of zones of the geometry.
    layout : Layout
        Layout of the zones.

    Raises
    ------
    WopwopFileError
        If the file is of another version or kind, or has a layout that is not known.
    """
    file.expect(1, "version")
    file.expect(0, "second number of the version")
    texts = [file.text(size) for size in kind.text_sizes]
    file.expect(kind.number, f"file type ({kind.number} is a {kind.name})")
    n_zones = file.count("number of zones")
    grid = file.choose(GRIDS, "grid")
    time = file.choose(TIMES, f"time dependence of the {kind.name}")
    at_faces = file.choose(CENTRED, f"place of the {kind.name}'s values") == _AT_FACES
    return texts, n_zones, Layout(grid, time, at_faces)


def write_opening(
    out: Writer, kind: FileKind, texts: Sequence[str], n_zones: int, layout: Layout
) -> None:
    """Write the beginning of a file; the counterpart of `read_opening`.

    Parameters
    ----------
    out : Writer
        Writer of a new file.
    kind : FileKind
        Kind of the file, `GEOMETRY` or `LOADING`.
    texts : sequence of str
        Texts of the kind.
    n_zones : int
        Number of zones of the geometry.
    layout : Layout
        Layout of the zones.

    Raises
    ------
    ValueError
        If a text is too long.
    """
    out.ints(1, 0)  # version
    for text, size in zip(texts, kind.text_sizes, strict=True):
        out.text(text, size)
    centred = _AT_FACES if layout.at_faces else _AT_NODES
    out.ints(kind.number, n_zones, layout.grid, layout.time, centred)
