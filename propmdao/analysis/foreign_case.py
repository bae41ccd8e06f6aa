"""Pressure histories of PSU-WOPWOP cases, computed by advanced-time marching."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.reception import Observers, require_outside, source_times
from propmdao.acoustics.signals import PressureHistory
from propmdao.acoustics.sources.advanced_time import source_history
from propmdao.acoustics.sources.rotors import segments, silence
from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.cases import Case, Container, ObserverGrid, read_cases
from propmdao.formats.wopwop.geometry_file import read_geometry
from propmdao.formats.wopwop.loading_file import LoadingFile, read_loading
from propmdao.formats.wopwop.pressure_file import PressureHistories
from propmdao.formats.wopwop.sources import (
    is_line,
    loading_sources,
    source_points,
    thickness_sources,
)
from propmdao.formats.wopwop.zones import Zone
from propmdao.records.air import Air
from propmdao.runtime.finite import require_finite


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
    """

    case: str
    observers: str
    pressure: PressureHistories


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
    """
    return [
        CaseResult(case.name, grid.title, _pressure(case, grid))
        for case in read_cases(folder)
        for grid in case.observers
    ]


def _pressure(case: Case, grid: ObserverGrid) -> PressureHistories:
    observers = Observers(jnp.asarray(grid.position), jnp.asarray(grid.velocity))
    history = silence(observers, grid.times)
    for container in case.containers:
        history = history + _container(case, container, observers, grid.times)
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


class _Patch(NamedTuple):
    """Zone of a geometry file, as a surface if it is heard as one, and its loads."""

    zone: Zone
    surface: Zone | None
    load: Zone | None
    file: LoadingFile | None


def _container(
    case: Case, container: Container, observers: Observers, times: NDArray[np.float64]
) -> PressureHistory:
    geometry = read_geometry(container.geometry)
    data = None if container.loading is None else read_loading(container.loading)
    loads = {} if data is None else dict(zip(data.zone_numbers, data.zones, strict=True))
    if data is not None and data.n_geometry_zones != len(geometry.zones):
        raise WopwopFileError(
            f"{container.loading}: made for {data.n_geometry_zones} zones; "
            f"{container.geometry} has {len(geometry.zones)}"
        )
    history = silence(observers, times)
    for number, zone in enumerate(geometry.zones, start=1):
        surface = None if is_line(zone) or -number in loads or not case.thickness else zone
        load = loads.get(number, loads.get(-number)) if case.loading else None
        if surface is None and load is None:
            continue
        try:
            patch = _Patch(zone, surface, load, data)
            history = history + _patch_history(case, container, patch, observers, times)
        except ValueError as error:
            raise WopwopFileError(
                f"{container.geometry}: zone {number} {zone.name!r}: {error}"
            ) from None
    return history


def _patch_history(
    case: Case,
    container: Container,
    patch: _Patch,
    observers: Observers,
    times: NDArray[np.float64],
) -> PressureHistory:
    """Thickness noise of a zone if it is a surface, loading noise if it has loads."""
    motion, offset = container.motion, container.key_offset
    air = Air(density=case.density, sound_speed=case.sound_speed)
    zone, surface, load, file = patch
    points = source_points(zone)
    require_outside(motion, points, observers, times, "the sources")
    changing = any(q is not None and q.keys is not None for q in (zone, load))
    turned = file is not None and file.frame == 1
    history = silence(observers, times)
    for part in segments(times.size, zone.values[0, 0].size if changing or turned else 0):
        t = times[part]
        multiple = max(128, t.size // 4)
        tau = source_times(motion, points, observers, t, case.sound_speed, container.step, multiple)
        sources = {}
        if surface is not None:
            sources["thickness"] = thickness_sources(surface, tau, offset)
        if load is not None and file is not None:
            sources["loading"] = loading_sources(zone, load, file, tau, motion, offset)
        for name, moving in sources.items():
            history.parts[name][:, part] = source_history(
                name, moving, motion, tau, observers, t, air
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
