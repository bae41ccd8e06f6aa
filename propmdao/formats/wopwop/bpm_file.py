"""Files of blade sections for the self-noise of a PSU-WOPWOP container."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.runtime.input_files import read_bytes

Array = NDArray[np.float64]

#: What a file may hold of each section, constant in time, in the order of the file.
SECTION_VALUES = ("chord", "length", "edge_thickness", "edge_angle")
_MAGIC = 42
_CONSTANT, _PERIODIC, _APERIODIC = 1, 2, 3
_MOST_SECTIONS, _MOST_TIMES = 10_000, 1 << 20


@dataclass(frozen=True)
class BpmFile:
    """Sections of a blade, from the inner to the outermost one; None for what the file has not.

    Attributes
    ----------
    n_sections : int
        Number of sections.
    chord, length, edge_thickness : (n_sections,) array or None
        Chord, length of the strip and thickness of the trailing edge [m].
    edge_angle : (n_sections,) array or None
        Angle between the surfaces at the trailing edge [rad].
    tip_slope : (n_times,) array or None
        Factor of the angle of the tip.
    angle_of_attack, speed : (n_times, n_sections) array or None
        Angle of attack [rad] and speed of the flow [m/s].
    times : (n_times,) array or None
        Source times [s]; None where the flow is constant, with one row.
    period : float or None
        Period in which the flow repeats itself [s], None if it does not.
    """

    n_sections: int
    chord: Array | None
    length: Array | None
    edge_thickness: Array | None
    edge_angle: Array | None
    tip_slope: Array | None
    angle_of_attack: Array | None
    speed: Array | None
    times: Array | None
    period: float | None


def read_bpm_file(path: str | Path) -> BpmFile:
    """Read a file of blade sections, constant, periodic or aperiodic, in either byte order.

    Parameters
    ----------
    path : str or Path
        File, ``BPMNoiseFile`` of a case.

    Returns
    -------
    BpmFile
        The sections.

    Raises
    ------
    WopwopFileError
        If the file cannot be read, is not of this kind, or is shorter or longer than its head says.

    Notes
    -----
    Eleven whole numbers: 42, sections, whether they are all alike, seven times whether a quantity
    is there, and the kind of time. Then for periodic data the turns, the period and the steps of a
    turn, for aperiodic data the steps; the constant quantities section by section; and for each
    time the time itself (not in constant data), the angles, the factor of the tip and the speeds.
    Constant files are read as PSU-WOPWOP reads them: its levels follow from them. Periodic ones are
    read as VSP2WOPWOP writes them; levels that it has made of one could not be followed.
    """
    path = Path(path)
    data = read_bytes(path, WopwopFileError, complaint=str(path))
    order = _byte_order(path, data)
    head = [int(n) for n in np.frombuffer(data, f"{order}i4", 11)]
    n, uniform, kind = head[1], head[2], head[10]
    flags = dict(
        zip((*SECTION_VALUES, "tip_slope", "angle_of_attack", "speed"), head[3:10], strict=True)
    )
    if not 1 <= n <= _MOST_SECTIONS or set(flags.values()) - {0, 1}:
        raise WopwopFileError(f"{path}: not a file of blade sections: its head is {head}")
    if uniform:
        raise WopwopFileError(f"{path}: sections that are all alike in a file are not read")
    period, n_times, start = None, 1, 44
    if kind == _PERIODIC:
        turns, steps = (int(k) for k in np.frombuffer(data, f"{order}i4", 3, 44)[[0, 2]])
        period = float(np.frombuffer(data, f"{order}f4", 1, 48)[0])
        n_times, start = turns * steps, 56
    elif kind == _APERIODIC:
        n_times, start = int(np.frombuffer(data, f"{order}i4", 1, 44)[0]), 48
    elif kind != _CONSTANT:
        raise WopwopFileError(f"{path}: data must be constant, periodic or aperiodic (1, 2, 3)")
    if not 1 <= n_times <= _MOST_TIMES or (period is not None and not period > 0.0):
        raise WopwopFileError(f"{path}: {n_times} times with a period of {period} s")
    values = np.frombuffer(data[start : start + (len(data) - start) // 4 * 4], f"{order}f4")
    n_constant = n * sum(flags[name] for name in SECTION_VALUES)
    widths = {"time": int(kind != _CONSTANT), "angle_of_attack": n, "tip_slope": 1, "speed": n}
    widths = {name: width * flags.get(name, 1) for name, width in widths.items()}
    wanted = n_constant + n_times * sum(widths.values())
    if start + 4 * wanted != len(data):
        raise WopwopFileError(
            f"{path}: {len(data)} bytes, its head speaks of {start + 4 * wanted}: {n} sections,"
            f" {n_times} times"
        )
    values = values.astype(float)
    if not np.isfinite(values).all():
        raise WopwopFileError(f"{path}: a value is not finite")
    there = [name for name in SECTION_VALUES if flags[name]]
    constant = dict(zip(there, values[:n_constant].reshape(n, len(there)).T, strict=True))
    ends = np.cumsum(list(widths.values()))[:-1]
    rows = np.split(values[n_constant:].reshape(n_times, -1), ends, axis=1)
    changing = {name: row for (name, width), row in zip(widths.items(), rows, strict=True) if width}
    slope, times = (changing.get(name) for name in ("tip_slope", "time"))
    return BpmFile(
        n,
        **{name: constant.get(name) for name in SECTION_VALUES},
        tip_slope=None if slope is None else slope[:, 0],
        angle_of_attack=changing.get("angle_of_attack"),
        speed=changing.get("speed"),
        times=None if times is None else times[:, 0],
        period=period,
    )


def _byte_order(path: Path, data: bytes) -> str:
    """Order in which the first number is 42."""
    if len(data) >= 56:  # the longest head
        for order in "<>":
            if int(np.frombuffer(data, f"{order}i4", 1)[0]) == _MAGIC:
                return order
    raise WopwopFileError(f"{path}: not a file of blade sections: it does not begin with 42")
