"""Pressure histories of PSU-WOPWOP cases, computed by advanced-time marching."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.reception import Observers, require_outside, source_times
from propmdao.acoustics.sources.advanced_time import loading_history, thickness_history
from propmdao.acoustics.sources.rotors import segments
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


@dataclass(frozen=True)
class CaseResult:
    """What the observers of a case hear.

    Attributes
    ----------
    case : str
        Namelist file of the case.
    observers : str
        Title of the observers.
    pressure : PressureHistories
        At each of them.
    """

    case: str
    observers: str
    pressure: PressureHistories


def run_case(folder: str | Path) -> list[CaseResult]:
    """Compute all cases of a PSU-WOPWOP folder.

    Parameters
    ----------
    folder : str or Path
        Where ``cases.nam`` is.

    Returns
    -------
    list of CaseResult
        One for each group of observers of each case.

    Raises
    ------
    WopwopFileError
        If a file is missing, broken or asks for what is not computed, in one line.
    """
    return [
        CaseResult(case.name, grid.title, _pressure(case, grid))
        for case in read_cases(folder)
        for grid in case.observers
    ]


def _pressure(case: Case, grid: ObserverGrid) -> PressureHistories:
    observers = Observers(jnp.asarray(grid.position), jnp.asarray(grid.velocity))
    thickness = np.zeros((len(grid.position), grid.times.size))
    loading = np.zeros_like(thickness)
    for container in case.containers:
        thickness_part, loading_part = _container(case, container, observers, grid.times)
        thickness += thickness_part
        loading += loading_part
    thickness, loading = (_filtered(p, grid) for p in (thickness, loading))
    return PressureHistories(
        grid.position[:, None] + grid.velocity * grid.times[:, None],
        np.broadcast_to(grid.times, thickness.shape),
        thickness,
        loading,
        thickness + loading,
    )


def _container(
    case: Case, container: Container, observers: Observers, times: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    geometry = read_geometry(container.geometry)
    data = None if container.loading is None else read_loading(container.loading)
    loads = {} if data is None else dict(zip(data.zone_numbers, data.zones, strict=True))
    if data is not None and data.n_geometry_zones != len(geometry.zones):
        raise WopwopFileError(
            f"{container.loading}: made for {data.n_geometry_zones} zones; "
            f"{container.geometry} has {len(geometry.zones)}"
        )
    heard = np.zeros((2, len(observers.position), times.size))
    for number, zone in enumerate(geometry.zones, start=1):
        surface = None if is_line(zone) or -number in loads or not case.thickness else zone
        load = loads.get(number, loads.get(-number)) if case.loading else None
        if surface is None and load is None:
            continue
        try:
            heard += _zone(case, container, zone, surface, load, data, observers, times)
        except ValueError as error:
            raise WopwopFileError(
                f"{container.geometry}: zone {number} {zone.name!r}: {error}"
            ) from None
    return heard[0], heard[1]


def _zone(
    case: Case,
    container: Container,
    zone: Zone,
    surface: Zone | None,
    load: Zone | None,
    file: LoadingFile | None,
    observers: Observers,
    times: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Thickness noise of a zone if it is a surface, loading noise if it has loads."""
    motion, c, offset = container.motion, case.sound_speed, container.key_offset
    points = source_points(zone)
    require_outside(motion, points, observers, times, "the sources")
    changing = any(q is not None and q.keys is not None for q in (zone, load))
    turned = file is not None and file.frame == 1
    heard = np.zeros((2, len(observers.position), times.size))
    for part in segments(times.size, zone.values[0, 0].size if changing or turned else 0):
        t = times[part]
        multiple = max(128, t.size // 4)
        tau = source_times(motion, points, observers, t, c, container.step, multiple)
        if surface is not None:
            panels = thickness_sources(surface, tau, offset)
            heard[0, :, part] = thickness_history(
                panels, motion, tau, observers, t, case.density, c
            )
        if load is not None and file is not None:
            forces = loading_sources(zone, load, file, tau, motion, offset)
            heard[1, :, part] = loading_history(forces, motion, tau, observers, t, c)
    return heard


def _filtered(pressure: NDArray[np.float64], grid: ObserverGrid) -> NDArray[np.float64]:
    """Leave out what lies outside the band, as PSU-WOPWOP does: the record is taken as periodic."""
    high_pass, low_pass = grid.band_hz
    n, step = grid.times.size, grid.times[1] - grid.times[0]
    frequency = np.fft.rfftfreq(n, step)
    outside = (frequency < high_pass) | (frequency > low_pass)
    if not outside.any():
        return pressure
    return np.fft.irfft(np.where(outside, 0.0, np.fft.rfft(pressure)), n)
