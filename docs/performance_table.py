"""Write the tables of docs/performance.md from a run of ``make bench``.

``python docs/performance_table.py RUN.json`` keeps of the run what the tables need, in
docs/performance.json, and writes them; without a file they are written from what has been kept.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

HERE = Path(__file__).parent
PAGE, KEPT = HERE / "performance.md", HERE / "performance.json"

Run = dict[str, Any]


class Work(NamedTuple):
    """A row of the table of times.

    Attributes
    ----------
    label : str
        What is done.
    benchmark : str
        Name of the benchmark, with its parameters.
    wanted : float or None
        What is aimed at [s]; None where the benchmark says it, or nothing does.
    part : int
        Parts of the benchmark that the row is one of.
    """

    label: str
    benchmark: str
    wanted: float | None = None
    part: int = 1


WORK = (
    Work("steady viscous lattice at a rotation speed", "test_steady_lattice[viscous]", 10e-3),
    Work("steady inviscid lattice", "test_steady_lattice[inviscid]"),
    Work("its trim to a thrust, viscous", "test_trim[viscous]"),
    Work("velocities of as many pairs as the reference kernel's", "test_wake_kernel"),
    Work("trim, tones at 1 microphone", "test_full_evaluation[one-viscous-tones]"),
    Work("trim, tones at 9 microphones", "test_full_evaluation[nine-viscous-tones]", 30e-3),
    Work("the same with broadband", "test_full_evaluation[nine-viscous-broadband]", 40e-3),
    Work("60 points of rpm and speed, table", "test_sweep_of_60_points[lattice]", 0.5),
    Work("60 points by blade elements, table", "test_sweep_of_60_points[elements]"),
    Work("16 rotation speeds", "test_analyses_at_16_rotation_speeds[0]"),
    Work("16 rotation speeds, 9 microphones", "test_analyses_at_16_rotation_speeds[9]"),
    Work("group of 16 nodes, trimmed", "test_nodes_of_a_group"),
    Work("the same with a gradient over all", "test_gradient_over_nodes"),
    Work("blade elements, a point of 1,000", "test_blade_elements", 0.2e-3, 1000),
    Work("gradient of 3 responses by 30 variables", "test_gradient_of_a_design"),
    Work("first `analyze` with noise, nothing kept", "test_command_line[cold]", 6.0),
    Work("first `analyze` with noise, compiled before", "test_command_line[warm]", 1.5),
)


def kept_of(run: Mapping[str, Any]) -> Run:
    """What is kept of a run.

    Parameters
    ----------
    run : dict
        JSON that ``make bench`` has written.

    Returns
    -------
    dict
        Machine, commit, versions, seconds of the reference kernel, and of each benchmark its median
        [s], its ratios and what else it says.
    """
    commit = run["commit_info"]
    return {
        "date": run["datetime"][:10],
        "commit": str(commit["id"])[:7] + (" and changes" if commit["dirty"] else ""),
        "machine": run["propmdao"],
        "benchmarks": {
            benchmark["name"]: {"median_s": benchmark["stats"]["median"], **benchmark["extra_info"]}
            for benchmark in run["benchmarks"]
        },
    }


def tables(kept: Mapping[str, Any]) -> dict[str, str]:
    """Tables of the page by their names.

    Parameters
    ----------
    kept : dict
        What `kept_of` has returned.

    Returns
    -------
    dict of str to str
        In Markdown; a benchmark that was not run has no row.
    """
    machine, benchmarks = kept["machine"], kept["benchmarks"]
    reference = machine["reference_kernel_s"]
    times = [("work", "time", "wanted", "reference kernels")]
    for work in WORK:
        if work.benchmark in benchmarks:
            said = benchmarks[work.benchmark]
            seconds, aim = said["median_s"] / work.part, work.wanted or said.get("wanted_s")
            wanted = "" if aim is None else _time(aim)
            ratio = "" if reference is None else _ratio(seconds / reference)
            times.append((work.label, _time(seconds), wanted, ratio))
    floors = [("work", "over its floor")]
    floors += [
        (f"`{name}`", _ratio(values["over_floor"]))
        for name, values in benchmarks.items()
        if "over_floor" in values
    ]
    blades = [("at once", "blades a second", "memory of a blade, MiB")]
    for name, values in benchmarks.items():
        if name.startswith("test_population"):
            size = values["blade_bytes"] / 2**20 if "blade_bytes" in values else None
            blades.append(
                (re.sub(r"\D", "", name), f"{values['blades_per_second']:.1f}",
                 "" if size is None else f"{size:.0f}")
            )  # fmt: skip
    shown = {"date": kept["date"], "commit": kept["commit"], **machine}
    if reference is not None:
        shown["reference_kernel_s"] = _time(reference)
    about = [
        ("", ""),
        *((name.replace("_s", "").replace("_", " "), str(v)) for name, v in shown.items()),
    ]
    return {
        name: _markdown(rows)
        for name, rows in (("run", about), ("times", times), ("floors", floors), ("blades", blades))
    }


def page(text: str, kept: Mapping[str, Any]) -> str:
    """Page with its tables written anew.

    Parameters
    ----------
    text : str
        The page as it stands.
    kept : dict
        What `kept_of` has returned.

    Returns
    -------
    str
        The page with new tables between their marks.
    """
    for name, table in tables(kept).items():
        begin, end = f"<!-- table: {name} -->\n", "<!-- end of table -->"
        new = re.subn(
            f"({begin}).*?({end})", lambda m, t=table: f"{m[1]}{t}{m[2]}", text, flags=re.S
        )
        text, n = new
        if n != 1:
            raise SystemExit(f"{PAGE.name} must have the table {name!r} once; it has it {n} times")
    return text


def _time(seconds: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-6:.3g} µs"


def _ratio(value: float) -> str:
    return f"{value:.2g}" if value < 100.0 else f"{value:.0f}"


def _markdown(rows: list[tuple[str, ...]]) -> str:
    head, *body = rows
    rule = ("---", *("---:" for _ in head[1:]))
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, rule, *body))


def main() -> None:
    """Keep what a run says, if one is given, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("run", nargs="?", type=Path, help="JSON of a run of 'make bench'")
    given = parser.parse_args().run
    if given is not None:
        kept = kept_of(json.loads(given.read_text(encoding="utf-8")))
        KEPT.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8"), kept), encoding="utf-8")


if __name__ == "__main__":
    main()
