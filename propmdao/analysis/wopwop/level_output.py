"""Levels of cases as PSU-WOPWOP writes them: spectra, third octaves, overall levels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from jax import Array as JaxArray
from numpy.typing import NDArray

from propmdao.acoustics.levels.decibels import level_db
from propmdao.acoustics.levels.weighting import a_weighting
from propmdao.analysis.wopwop.case_levels import ALL, BROADBAND, TONES, CaseLevels, case_levels
from propmdao.analysis.wopwop.foreign_case import CaseResult
from propmdao.formats.wopwop.outputs.level_files import write_level_files
from propmdao.runtime.output_files import replacing_in

Array = NDArray[np.float64]

# What PSU-WOPWOP calls the parts; of rotors by Pegg's method no file of it was seen.
_NAMES = {
    "thickness": "Thickness",
    "loading": "Loading",
    "total": "Total",
    ALL: "Total",
    "pressure_side": "BPM-TBLTEp",
    "suction_side": "BPM-TBLTEs",
    "separation": "BPM-TBLTEalpha",
    "laminar_shedding": "BPM-LBLVS",
    "bluntness": "BPM-Blunt",
    "tip": "BPM-Tip",
    "pegg": "Pegg",
    BROADBAND: "Broadband-Total",
}


def write_levels(folder: Path, results: Sequence[CaseResult]) -> list[Path]:
    """Write the levels that cases ask for, in files of PSU-WOPWOP.

    Parameters
    ----------
    folder : Path
        Folder for the files, made where it is missing; with several groups of observers each has a
        folder of its own in it, ``CASE_NUMBER``.
    results : sequence of CaseResult
        From `run_case`.

    Returns
    -------
    list of Path
        Stems of the files: ``spl_spectrum`` (spectrumFlag), ``spl_octFilt_spectrum`` (octaveFlag),
        ``spl_mspBB`` (mean squares of broadband noise), ``OASPLdB`` and ``OASPLdBA`` (of each
        segment). Spectra are of the mean square over the segments.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    stems: list[Path] = []
    for number, result in enumerate(results, start=1):
        home = folder
        if len(results) > 1:
            home = folder / f"{Path(result.case).stem}_{number}"
        grid, files = result.listening, _files(result, case_levels(result))
        with replacing_in(home) as made:
            for name, functions in files.items():
                place = grid.position, grid.shape
                write_level_files(made / name, functions, *place, text=result.wanted.text)
        stems += [home / name for name in files]
    return stems


def _files(result: CaseResult, levels: CaseLevels) -> dict[str, dict[str, Array]]:
    """Functions of the files that are wanted, each (n_observers, n)."""
    wanted, files = result.wanted, {}
    mechanisms = [part for part in _NAMES if part in result.broadband]
    sums = [*mechanisms, BROADBAND] if mechanisms else []
    if wanted.spectrum:
        spectra = {part: levels.narrowband[part] for part in TONES}
        files["spl_spectrum"] = _spectrum(result, levels.frequency_hz, spectra)
    if wanted.spectrum and result.listening.third_octaves:
        bands = {part: levels.bands[part] for part in (*TONES[:2], ALL, *sums)}
        files["spl_octFilt_spectrum"] = _spectrum(result, levels.center_hz, bands)
    if mechanisms:
        functions = {"Frequency": _everywhere(levels.center_hz, result)}
        for part in sums:
            functions[_NAMES[part]] = levels.bands[part].mean(axis=1)
        files["spl_mspBB"] = functions
    overall: dict[str, tuple[bool, Callable[[str], Array | JaxArray]]] = {
        "OASPLdB": (wanted.oaspl, lambda part: level_db(levels.overall(part))),
        "OASPLdBA": (wanted.weighted_oaspl, levels.overall_dba),
    }
    for name, (is_wanted, level) in overall.items():
        if is_wanted:
            files[name] = {"Observer Time (s)": _everywhere(levels.time, result)} | {
                f"{_NAMES[part]}_{name[5:]}": np.asarray(level(part))
                for part in (*TONES[:2], ALL, *sums)
            }
    return files


def _spectrum(result: CaseResult, frequency_hz: Array, parts: dict[str, Array]) -> dict[str, Array]:
    """Levels over frequency, and A-weighted ones where they are wanted, too."""
    functions = {"Frequency": _everywhere(frequency_hz, result)}
    spectra = {part: mean_square.mean(axis=1) for part, mean_square in parts.items()}
    for part, spectrum in spectra.items():
        functions[f"{_NAMES[part]}_dB"] = np.asarray(level_db(spectrum))
    if result.wanted.weighted_spectrum:
        weight = np.asarray(a_weighting(frequency_hz)) ** 2
        for part, spectrum in spectra.items():
            functions[f"{_NAMES[part]}_dBA"] = np.asarray(level_db(weight * spectrum))
    return functions


def _everywhere(values: Array, result: CaseResult) -> Array:
    """The same values for all observers, (n_observers, n)."""
    return np.broadcast_to(values, (len(result.listening.position), len(values)))
