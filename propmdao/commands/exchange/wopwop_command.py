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
from propmdao.runtime.output_files import require_folder

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from propmdao.analysis.wopwop.foreign_case import CaseResult

DESCRIPTION = """\
Run the cases of a PSU-WOPWOP folder and print the levels that its observers hear.

Reads cases.nam, the case files it names and their geometry and loading files (structured or not,
constant, periodic or aperiodic); computes thickness and loading noise by Formulation 1A in the time
domain, broadband noise of blade sections (BPMNoiseFlag) and of rotors by Pegg's method. Levels are
in dB re 20 uPa, without the mean, over the record or its segments, with window and absorption as
the case has them; tones are the peaks of the spectrum. Keys without effect are named on stderr; a
case that asks for what is not done is refused.
"""

EXAMPLES = """\
examples:
  propmdao wopwop my_case
  propmdao wopwop my_case --json
  propmdao wopwop my_case --out pressure.csv
  propmdao wopwop my_case --levels results

Exit status: 0, or 2 with one line on stderr about what cannot be read or computed.
"""

_PEAKS, _PEAK_RANGE_DB = 10, 60.0
_COLUMNS = {
    "oaspl_thickness_db": "thick-\nness\ndB",
    "oaspl_loading_db": "load-\ning\ndB",
    "oaspl_db": "OASPL\ndB",
    "oaspl_dba": "tones\ndBA",
    "oaspl_broadband_dba": "broad-\nband\ndBA",
    "oaspl_total_dba": "total\ndBA",
    "sel_dba": "SEL\ndBA",
    "epnl": "EPNL\nEPNdB",
}


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
    command.add_argument(
        "--levels",
        type=Path,
        metavar="FOLDER",
        help="write spectra and overall levels that the case asks for, as PSU-WOPWOP writes them",
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
        One for each group of observers: case, title, n_times, duration [s], n_segments,
        bin_width_hz, observers; each of these has position at the start [m], oaspl_thickness_db,
        oaspl_loading_db, oaspl_db, oaspl_dba and peaks: the ten highest of the spectrum within
        60 dB, each frequency_hz, spl_thickness_db, spl_loading_db, spl_db. Levels are of the mean
        square over the segments. With broadband noise there are oaspl_broadband_db and _dba,
        oaspl_total_db and _dba, and where the case asks for it third_octave (each frequency_hz,
        spl_db), sel_dba, pnltm and epnl.

    Raises
    ------
    ValueError
        If EPNL is asked for of a record that does not begin and end 10 dB below its maximum.
    """
    return [_group(result) for result in results]


def _group(result: CaseResult) -> dict[str, Any]:
    import numpy as np

    from propmdao.acoustics.levels.decibels import level_db
    from propmdao.analysis.wopwop.case_levels import ALL, BROADBAND, TONES, case_levels

    segments, n = case_levels(result), result.pressure.time.shape[1]
    frequency = segments.frequency_hz
    keys = dict(zip(TONES, ("thickness_", "loading_", ""), strict=True))
    spectra = {
        key: np.asarray(level_db(segments.narrowband[part].mean(axis=1)))
        for part, key in keys.items()
    }
    sums = keys | ({BROADBAND: "broadband_", ALL: "total_"} if result.broadband else {})
    overall = {
        f"oaspl_{key}db": np.asarray(level_db(segments.overall(part).mean(axis=1)))
        for part, key in sums.items()
    }
    weighted = {key: part for part, key in sums.items() if key not in ("thickness_", "loading_")}
    overall |= {
        f"oaspl_{key}dba": 10.0
        * np.log10(np.mean(10.0 ** (0.1 * segments.overall_dba(part)), axis=1))
        for key, part in weighted.items()
    }
    if result.wanted.exposure:
        overall["sel_dba"] = segments.exposure_db()
    observers: list[dict[str, Any]] = []
    for i, position in enumerate(result.pressure.position[:, 0]):
        observer: dict[str, Any] = {"observer": i + 1, "position": [float(x) for x in position]}
        observer |= {name: float(value[i]) for name, value in overall.items()}
        if result.wanted.effective or result.wanted.perceived:
            perceived = segments.perceived(i)
            observer |= {"pnltm": perceived.pnltm, "epnl": perceived.epnl}
        if result.listening.third_octaves:
            bands = np.asarray(level_db(segments.bands[ALL][i].mean(axis=0)))
            observer["third_octave"] = [
                {"frequency_hz": float(center), "spl_db": float(level)}
                for center, level in zip(segments.center_hz, bands, strict=True)
            ]
        observer["peaks"] = _peaks(
            frequency, {key: spectrum[i] for key, spectrum in spectra.items()}
        )
        observers.append(observer)
    return {
        "case": result.case,
        "title": result.observers,
        "n_times": n,
        "duration": n * float(np.ptp(result.pressure.time[0])) / (n - 1),
        "n_segments": len(segments.time),
        "bin_width_hz": float(frequency[0]),
        "observers": observers,
    }


def _peaks(
    frequency: npt.NDArray[np.float64], spectra: dict[str, npt.NDArray[np.float64]]
) -> list[dict[str, float]]:
    """The highest peaks of a spectrum, by frequency."""
    import numpy as np
    from scipy.signal import find_peaks

    level = spectra[""]
    # The first and the last bin may be peaks, too.
    edged = np.pad(level, 1, constant_values=-np.inf)
    peak_bins = find_peaks(edged, height=level.max() - _PEAK_RANGE_DB)[0] - 1
    loudest = np.sort(peak_bins[np.argsort(level[peak_bins])[-_PEAKS:]])
    return [
        {"frequency_hz": float(frequency[k])}
        | {f"spl_{key}db": float(spectrum[k]) for key, spectrum in spectra.items()}
        for k in loudest
    ]


def _wopwop(options: argparse.Namespace) -> None:
    if options.out is not None:
        require_output("--out", options.out)
    if options.levels is not None:
        require_folder(options.levels)
    # Slow to import, so only once it is wanted.
    from propmdao.analysis.wopwop.foreign_case import run_case

    with warning_lines("wopwop"):
        results = run_case(options.folder)
    if options.out is not None:
        write_pressure_csv(options.out, results)
    if options.levels is not None:
        from propmdao.analysis.wopwop.level_output import write_levels

        write_levels(options.levels, results)
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
        columns = {key: head for key, head in _COLUMNS.items() if key in observers[0]}
        overall = table("obs.", "x\nm", "y\nm", "z\nm", *columns.values(), "loudest\nHz")
        for observer in observers:
            loudest = max(observer["peaks"], key=_loudness, default=None)
            overall.add_row(
                str(observer["observer"]),
                *map(_metres, observer["position"]),
                *(level_cell(observer[key]) for key in columns),
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
