"""Pressure histories of PSU-WOPWOP cases, computed by advanced-time marching."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from propmdao.acoustics.kinematics.reception import Observers, require_outside, source_times
from propmdao.acoustics.signals import PressureHistory
from propmdao.acoustics.sources.advanced_time import source_history
from propmdao.acoustics.sources.rotors import segments, silence
from propmdao.analysis.wopwop.broadband_sources import broadband_noise, distances
from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.cases import read_cases
from propmdao.formats.wopwop.geometry_file import read_geometry
from propmdao.formats.wopwop.loading_file import LoadingFile, read_loading
from propmdao.formats.wopwop.namelists.case_records import Case, Container, ObserverGrid, Wanted
from propmdao.formats.wopwop.outputs.pressure_file import PressureHistories
from propmdao.formats.wopwop.sources import (
    is_line,
    loading_sources,
    source_points,
    thickness_sources,
)
from propmdao.formats.wopwop.zones import Zone
from propmdao.records.air import Air
from propmdao.runtime.finite import require_finite

# Observers at once: what is the same for all is done once for so many, and progress is seen.
_AT_ONCE = 16


@dataclass(frozen=True)
class CaseResult:
    """Pressure at a group of observers of a case.

    Attributes
    ----------
    case : str
        Namelist file of the case.
    observers : str
        Title of the observers.
    pressure : PressureHistories
        Pressure at each of them.
    listening : ObserverGrid
        How they listen: segments of the record, filters, absorption.
    wanted : Wanted
        Results that the case asks for.
    air : Air
        The air.
    distance : (n_observers, n_segments) array
        Way of the sound that is heard in the middle of a segment, from the sources' middle [m].
    broadband : dict of (n_observers, n_segments, n_bands) arrays
        Mean squares of the parts of the broadband noise in the third octaves of
        `broadband_sources.BANDS_HZ`, without absorption [Pa^2]; empty where there is none.
    """

    case: str
    observers: str
    pressure: PressureHistories
    listening: ObserverGrid
    wanted: Wanted
    air: Air
    distance: NDArray[np.float64]
    broadband: dict[str, NDArray[np.float64]]


def run_case(folder: str | Path) -> list[CaseResult]:
    """Compute all cases of a PSU-WOPWOP folder.

    Parameters
    ----------
    folder : str or Path
        Folder that holds ``cases.nam``.

    Returns
    -------
    list of CaseResult
        One for each group of observers of each case.

    Raises
    ------
    WopwopFileError
        If a file is missing, broken or asks for what is not computed, in one line.
    NotFiniteError
        If a pressure would be no number.

    Notes
    -----
    Progress is shown on stderr where that is a terminal.
    """
    cases = read_cases(folder)
    n_observers = sum(len(grid.position) for case in cases for grid in case.observers)
    # On stderr, where that is a terminal.
    with tqdm(total=n_observers, desc="wopwop", unit="observer", disable=None) as progress:
        return [result for case in cases for result in _run(case, progress)]


class _Patch(NamedTuple):
    """Zone of a geometry file, as a surface if it is heard as one, and its loads."""

    name: str
    container: Container
    zone: Zone
    surface: Zone | None
    load: Zone | None
    file: LoadingFile | None

    @contextlib.contextmanager
    def named(self) -> Iterator[None]:
        """Name the zone in what is raised about it."""
        try:
            yield
        except ValueError as error:
            raise WopwopFileError(f"{self.name}: {error}") from None


def _run(case: Case, progress: tqdm) -> list[CaseResult]:
    patches = [patch for container in case.containers for patch in _patches(case, container)]
    for grid in case.observers:
        for patch in patches:
            with patch.named():
                observers = _observers(grid.position, grid.velocity)
                points = source_points(patch.zone)
                require_outside(
                    patch.container.motion, points, observers, grid.times, "the sources"
                )
    histories = [silence(_observers(q.position, q.velocity), q.times) for q in case.observers]
    for batch, together in _heard(case, patches):
        for name, pressure in together.parts.items():
            for (number, row), own in zip(batch, pressure, strict=True):
                histories[number].parts[name][row] = own
        progress.update(len(set(batch)))
    return [
        CaseResult(
            case.name,
            grid.title,
            _pressure(case, grid, history),
            grid,
            case.wanted,
            case.air,
            distances(case, grid),
            broadband_noise(case, grid),
        )
        for grid, history in zip(case.observers, histories, strict=True)
    ]


def _heard(
    case: Case, patches: Sequence[_Patch]
) -> Iterator[tuple[list[tuple[int, int]], PressureHistory]]:
    """Batches of observers and what they hear, on all processors: the work is in compiled code."""

    def hear(batch: list[tuple[int, int]]) -> PressureHistory:
        grid = case.observers[batch[0][0]]
        position = np.array([case.observers[number].position[row] for number, row in batch])
        return _batch_history(case, patches, _observers(position, grid.velocity), grid.times)

    batches = list(_batches(case.observers))
    # The first by itself: it compiles what the others run.
    yield batches[0], hear(batches[0])
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield from zip(batches[1:], pool.map(hear, batches[1:]), strict=True)


def _observers(position: NDArray[np.float64], velocity: NDArray[np.float64]) -> Observers:
    return Observers(jnp.asarray(position), jnp.asarray(velocity))


def _batches(grids: Sequence[ObserverGrid]) -> Iterator[list[tuple[int, int]]]:
    """Observers of all grids that move alike and listen at the same times, some at once.

    Each is the number of its grid and its row there. Neighbours in distance go together, for all
    of a batch hear the same source times. The last batch of several is filled up with its last
    observer: it runs the same compiled code.
    """
    alike: dict[bytes, list[tuple[float, int, int]]] = {}
    for number, grid in enumerate(grids):
        key = np.array([*grid.velocity, grid.times.size, *grid.times[[0, -1]]]).tobytes()
        distance = np.linalg.norm(grid.position, axis=1)
        alike.setdefault(key, []).extend((d, number, row) for row, d in enumerate(distance))
    for members in alike.values():
        places = [(number, row) for _, number, row in sorted(members)]
        size = min(len(places), _AT_ONCE)
        for start in range(0, len(places), size):
            batch = places[start : start + size]
            yield batch + batch[-1:] * (size - len(batch))


def _pressure(case: Case, grid: ObserverGrid, history: PressureHistory) -> PressureHistories:
    times = [f"{t:g} s" for t in grid.times]
    for name, pressure in history.parts.items():
        require_finite(f"{name} noise", pressure, "observer", times, where=f", in {case.name}")
    history = history.each(lambda pressure: _filtered(pressure, grid))
    return PressureHistories(
        grid.position[:, None] + grid.velocity * grid.times[:, None],
        np.broadcast_to(grid.times, history.total.shape),
        total=history.total,
        **history.parts,
    )


def _patches(case: Case, container: Container) -> Iterator[_Patch]:
    geometry = read_geometry(container.geometry)
    data = None if container.loading is None else read_loading(container.loading)
    loads = {} if data is None else dict(zip(data.zone_numbers, data.zones, strict=True))
    if data is not None and data.n_geometry_zones != len(geometry.zones):
        raise WopwopFileError(
            f"{container.loading}: made for {data.n_geometry_zones} zones; "
            f"{container.geometry} has {len(geometry.zones)}"
        )
    for number, zone in enumerate(geometry.zones, start=1):
        surface = None if is_line(zone) or -number in loads or not case.thickness else zone
        load = loads.get(number, loads.get(-number)) if case.loading else None
        if surface is not None or load is not None:
            name = f"{container.geometry}: zone {number} {zone.name!r}"
            yield _Patch(name, container, zone, surface, load, data)


def _batch_history(
    case: Case, patches: Sequence[_Patch], observers: Observers, times: NDArray[np.float64]
) -> PressureHistory:
    history = silence(observers, times)
    for patch in patches:
        with patch.named():
            history = history + _patch_history(case, patch, observers, times)
    return history


def _patch_history(
    case: Case, patch: _Patch, observers: Observers, times: NDArray[np.float64]
) -> PressureHistory:
    """Thickness noise of a zone if it is a surface, loading noise if it has loads."""
    _, container, zone, surface, load, file = patch
    motion, offset = container.motion, container.key_offset
    sound_speed = float(case.air.sound_speed)
    points = source_points(zone)
    changing = any(q is not None and q.keys is not None for q in (zone, load))
    turned = file is not None and file.frame == 1
    history = silence(observers, times)
    for part in segments(times.size, zone.values[0, 0].size if changing or turned else 0):
        t = times[part]
        multiple = max(128, t.size // 8)
        tau = source_times(motion, points, observers, t, sound_speed, container.step, multiple)
        sources = {}
        if surface is not None:
            sources["thickness"] = thickness_sources(surface, tau, offset)
        if load is not None and file is not None:
            sources["loading"] = loading_sources(zone, load, file, tau, motion, offset)
        for name, moving in sources.items():
            history.parts[name][:, part] = source_history(
                name, moving, motion, tau, observers, t, case.air
            )
    return history


def _filtered(pressure: NDArray[np.float64], grid: ObserverGrid) -> NDArray[np.float64]:
    """Leave out what lies outside the band, as PSU-WOPWOP does: the record is taken as periodic."""
    high_pass, low_pass = grid.band_hz
    n, step = grid.times.size, grid.times[1] - grid.times[0]
    frequency = np.fft.rfftfreq(n, step)
    outside = (frequency < high_pass) | (frequency > low_pass)
    if not outside.any():
        return pressure
    return np.fft.irfft(np.where(outside, 0.0, np.fft.rfft(pressure)), n)
