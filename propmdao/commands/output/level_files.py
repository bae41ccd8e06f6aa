"""Results as CSV files, with names and units in their heads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from propmdao.acoustics.levels.bands import bands_in_bins, tones_in_bins
from propmdao.acoustics.levels.decibels import REFERENCE_PRESSURE, level_db
from propmdao.acoustics.levels.weighting import a_weighting
from propmdao.commands.output.output_files import write_csv
from propmdao.records.quantities import BROADBAND_LEVELS, LEVELS, RESULTS

Result = Mapping[str, Any]
#: Width of the bins of narrowband spectra [Hz], and the highest of them.
BIN_HZ, HIGHEST_HZ = 5.0, 22.5e3
_PLACE = {"elevation_deg": "deg", "azimuth_deg": "deg", "radius": "m"}
_SILENCE = -190.0  # dB; what is below is silent: -200 dB, and what rounding leaves of it


def write_levels(path: Path, results: Sequence[Result]) -> None:
    """Write operating points and levels, a row for each observer of each point.

    Parameters
    ----------
    path : Path
        CSV file.
    results : sequence of dict
        With the keys of ``propmdao analyze --json``. A point without observers has one row.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    of_point = {"rpm": "rpm", "speed": "m/s", "rho": "kg/m3"}
    of_point |= {name: quantity.unit for name, quantity in RESULTS.items()}
    levels = {**LEVELS, **BROADBAND_LEVELS}
    observers = [observer for result in results for observer in result["observers"]]
    names = [name for name in levels if any(name in observer for observer in observers)]
    units = {**of_point, "incidence_deg": "deg", "observer": "", **_PLACE}
    units |= {name: levels[name].unit for name in names}
    rows = []
    for result in results:
        point = {name: result[name] for name in of_point}
        point["incidence_deg"] = result["point"]["incidence_deg"]
        for number, observer in enumerate(result["observers"] or [{}], start=1):
            place = {"observer": number, **observer} if observer else {}
            rows.append([(point | place).get(name) for name in units])
    write_csv(path, [_head(name, unit) for name, unit in units.items()], rows)


def write_spectra(path: Path, results: Sequence[Result]) -> None:
    """Write the spectra at every observer: tones, narrow bands and third octaves.

    Parameters
    ----------
    path : Path
        CSV file.
    results : sequence of dict
        With the keys of ``propmdao analyze --json``, with observers.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    parts = {"spl_thickness_db": "dB", "spl_loading_db": "dB", "spl_broadband_db": "dB"}
    units = {"rpm": "rpm", "observer": "", **_PLACE, "spectrum": "", "frequency": "Hz"}
    units |= {"spl_db": "dB", "spl_dba": "dBA", **parts}
    rows = []
    for result in results:
        for number, observer in enumerate(result["observers"], start=1):
            place = {name: observer[name] for name in _PLACE}
            same = {"rpm": result["rpm"], "observer": number, **place}
            for spectrum, lines in _spectra(observer).items():
                for line in lines:
                    shown = {**same, "spectrum": spectrum, **line}
                    rows.append([shown.get(name) for name in units])
    write_csv(path, [_head(name, unit) for name, unit in units.items()], rows)


def _spectra(observer: Result) -> dict[str, list[dict[str, float]]]:
    """Spectra of an observer by their kind, silence left out."""
    tones = [
        {"frequency": tone["frequency_hz"], **{k: v for k, v in tone.items() if k != "m"}}
        for tone in observer["harmonics"]
    ]
    noise = {band["frequency_hz"]: band["spl_db"] for band in observer.get("broadband", [])}
    bands = [
        {"frequency": band["frequency_hz"], "spl_db": band["spl_db"]}
        | ({"spl_broadband_db": noise[f]} if (f := band["frequency_hz"]) in noise else {})
        for band in observer["third_octave"]
    ]
    bins = BIN_HZ * np.arange(1, round(HIGHEST_HZ / BIN_HZ) + 1)
    frequencies, levels = (
        np.array([tone[key] for tone in tones]) for key in ("frequency", "spl_db")
    )
    power = np.asarray(tones_in_bins(frequencies, _mean_square(levels), bins))
    in_bins = None
    if noise:
        in_bins = bands_in_bins(np.array([*noise]), _mean_square(np.array([*noise.values()])), bins)
        power = power + in_bins
    narrow = [
        {"frequency": float(f), "spl_db": float(level)}
        for f, level in zip(bins, np.asarray(level_db(power)), strict=True)
    ]
    if in_bins is not None:
        for line, level in zip(narrow, np.asarray(level_db(in_bins)), strict=True):
            line["spl_broadband_db"] = float(level)
    spectra = {"tone": tones, f"bin of {BIN_HZ:g} Hz": narrow, "third octave": bands}
    return {
        kind: [_weighted(line) for line in lines if line["spl_db"] > _SILENCE]
        for kind, lines in spectra.items()
    }


def _weighted(line: dict[str, float]) -> dict[str, float]:
    weighting = 20.0 * float(np.log10(np.asarray(a_weighting(line["frequency"]))))
    return {**line, "spl_dba": line["spl_db"] + weighting}


def _mean_square(levels_db: np.ndarray) -> np.ndarray:
    return REFERENCE_PRESSURE**2 * 10.0 ** (levels_db / 10.0)


def _head(name: str, unit: str) -> str:
    unit = unit.replace("N*m", "N m")
    return f"{name} [{unit}]" if unit else name
