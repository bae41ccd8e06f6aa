"""Command line: ``propmdao wopwop CASEDIR`` runs a case of PSU-WOPWOP and says how loud it is."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.options import add_command
from propmdao.commands.output.json_output import print_json
from propmdao.commands.output.output_files import require_output, write_csv
from propmdao.commands.output.warning_lines import warning_lines

if TYPE_CHECKING:
    from propmdao.analysis.wopwop.foreign_case import CaseResult

DESCRIPTION = """\
Run the cases of a PSU-WOPWOP folder and print the levels that its observers hear.

Reads cases.nam, the case files it names and their geometry and loading files (structured or not,
constant, periodic or aperiodic); computes thickness and loading noise by Formulation 1A in the time
domain. Levels are in dB re 20 uPa of the whole record, without its mean and without a window; tones
are the peaks of its spectrum. Keys without effect here are named on stderr.
"""

EXAMPLES = """\
examples:
  propmdao wopwop my_case
  propmdao wopwop my_case --json
  propmdao wopwop my_case --out pressure.csv

Exit status: 0, or 2 with one line on stderr about what cannot be read or computed.
"""

_PEAKS, _PEAK_RANGE_DB = 10, 60.0


def add_wopwop(commands: argparse._SubParsersAction[Any]) -> None:
    """Add ``wopwop`` to the commands of the program.

    Parameters
    ----------
    commands : argparse subparsers
        Commands of ``propmdao``.
    """
    command = add_command(
        commands, "wopwop", _wopwop, "run a case of PSU-WOPWOP", DESCRIPTION, EXAMPLES
    )
    command.add_argument("folder", metavar="CASEDIR", type=Path, help="folder with cases.nam in it")
    command.add_argument("--json", action="store_true", help="print JSON instead of tables")
    command.add_argument(
        "--out",
        type=Path,
        metavar="FILE.csv",
        help="write the pressure of every observer over time [s, m, Pa]",
    )


def levels(results: Sequence[CaseResult]) -> list[dict[str, Any]]:
    """Levels at the observers of cases.

    Parameters
    ----------
    results : sequence of CaseResult
        From `run_case`.

    Returns
    -------
    list of dict
        One for each group of observers: case, title, n_times, duration [s], bin_width_hz,
        observers; each of these has position at the start [m], oaspl_thickness_db,
        oaspl_loading_db, oaspl_db, oaspl_dba and peaks: the ten highest of the spectrum within
        60 dB, each frequency_hz, spl_thickness_db, spl_loading_db, spl_db.
    """
    return [_group(result) for result in results]


def _group(result: CaseResult) -> dict[str, Any]:
    import numpy as np
    from scipy.signal import find_peaks

    from propmdao.acoustics.levels.decibels import level_db
    from propmdao.acoustics.levels.spectrum import narrowband
    from propmdao.acoustics.levels.weighting import level_dba

    pressure = result.pressure
    n = pressure.time.shape[1]
    rate = float((n - 1) / np.ptp(pressure.time[0]))
    parts = {"thickness_": pressure.thickness, "loading_": pressure.loading, "": pressure.total}
    power = {}
    for part, history in parts.items():
        frequency, power[part] = narrowband(history, rate, rate / n, "boxcar")
    spectra = {part: np.asarray(level_db(q)) for part, q in power.items()}
    overall = {part: np.asarray(level_db(q.sum(axis=-1))) for part, q in power.items()}
    weighted = np.asarray(level_dba(frequency, power[""]))
    observers = []
    for i, position in enumerate(pressure.position[:, 0]):
        level = spectra[""][i]
        # The first and the last bin may be peaks, too.
        edged = np.pad(level, 1, constant_values=-np.inf)
        peak_bins = find_peaks(edged, height=level.max() - _PEAK_RANGE_DB)[0] - 1
        loudest = np.sort(peak_bins[np.argsort(level[peak_bins])[-_PEAKS:]])
        peaks = [
            {"frequency_hz": float(frequency[k])}
            | {f"spl_{part}db": float(spectrum[i, k]) for part, spectrum in spectra.items()}
            for k in loudest
        ]
        observers.append(
            {"observer": i + 1, "position": [float(x) for x in position]}
            | {f"oaspl_{part}db": float(value[i]) for part, value in overall.items()}
            | {"oaspl_dba": float(weighted[i]), "peaks": peaks}
        )
    return {
        "case": result.case,
        "title": result.observers,
        "n_times": n,
        "duration": n / rate,
        "bin_width_hz": rate / n,
        "observers": observers,
    }


def _wopwop(options: argparse.Namespace) -> None:
    if options.out is not None:
        require_output("--out", options.out)
    # Slow to import, so only once it is wanted.
    from propmdao.analysis.wopwop.foreign_case import run_case

    with warning_lines("wopwop"):
        results = run_case(options.folder)
    if options.out is not None:
        write_pressure_csv(options.out, results)
    groups = levels(results)
    if options.json:
        print_json(groups)
    else:
        _print(groups)


def write_pressure_csv(path: Path, results: Sequence[CaseResult]) -> None:
    """Write pressure histories, one line for each observer and time.

    Parameters
    ----------
    path : Path
        Where to.
    results : sequence of CaseResult
        From `run_case`.

    Raises
    ------
    ValueError
        If the file cannot be written.
    """
    heads = "case title observer time_s x_m y_m z_m thickness_pa loading_pa total_pa".split()
    write_csv(path, heads, _pressure_rows(results))


def _pressure_rows(results: Sequence[CaseResult]) -> Iterator[list[Any]]:
    """Cells of `write_pressure_csv`, one row after the other: there are many."""
    for result in results:
        p = result.pressure
        for i in range(len(p.time)):
            rows = zip(
                p.time[i], *p.position[i].T, p.thickness[i], p.loading[i], p.total[i], strict=True
            )
            for row in rows:
                yield [result.case, result.observers, i + 1, *map(float, row)]


def _print(groups: Sequence[dict[str, Any]]) -> None:
    from rich.table import Table

    from propmdao.commands.output.tables import level_cell, narrow_table
    from propmdao.runtime.terminal import plain_console, printable

    def table(*headings: str) -> Table:
        made = narrow_table()
        for heading in headings:
            made.add_column(heading, justify="right", overflow="fold")
        return made

    console = plain_console()
    for group in groups:
        observers = group["observers"]
        console.print(
            printable(
                f"{group['case']}: {group['title'] or 'observers'}, {group['n_times']} times in"
                f" {group['duration']:.4g} s, bins of {group['bin_width_hz']:.4g} Hz"
            ),
            highlight=False,
        )
        overall = table(
            "observer", "x\nm", "y\nm", "z\nm", "thickness\ndB", "loading\ndB", "OASPL\ndB",
            "tones\ndBA", "loudest\nHz",
        )  # fmt: skip
        keys = ("oaspl_thickness_db", "oaspl_loading_db", "oaspl_db", "oaspl_dba")
        for observer in observers:
            loudest = max(observer["peaks"], key=_loudness, default=None)
            overall.add_row(
                str(observer["observer"]),
                *map(_metres, observer["position"]),
                *(level_cell(observer[key]) for key in keys),
                "-" if loudest is None else f"{loudest['frequency_hz']:.1f}",
            )
        console.print(overall)
        top = max(observers, key=lambda observer: float(observer["oaspl_db"]))
        peaks = table("tone\nHz", "thickness\ndB", "loading\ndB", "total\ndB")
        for peak in top["peaks"]:
            frequency, *peak_levels = peak.values()
            peaks.add_row(f"{frequency:.1f}", *map(level_cell, peak_levels))
        console.print(f"Tones at observer {top['observer']}, the loudest:", highlight=False)
        console.print(peaks)


def _loudness(peak: dict[str, float]) -> float:
    return peak["spl_db"]


def _metres(value: float) -> str:
    # Tenths of a millimetre: what rounding leaves of a sine or cosine is 0.
    return f"{round(value, 4) + 0.0:.5g}"
