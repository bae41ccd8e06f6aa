"""What the studies of mesh, time step and revolutions share: one flight, three microphones.

They are those of sections 4.3 to 4.5 of the thesis (tables 4.3 and 4.4): APC-SF 11x4.7 with the
thesis' geometry at 4003 rpm and J 0.525, inviscid, and an arc of 1.905 m at 0, -22.5 and -45 deg.
"""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, get_args

import numpy as np
from aerodynamic_validation import show, write_csv

import propmdao as pm
from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.acoustics.signals import Tones
from propmdao.figures.flow.refinement import refinement
from propmdao.figures.style import save
from propmdao.records.fidelity import Marching, Start

PROPELLER = pm.load_propeller("apcsf_11x4.7_thesis")
RPM, SPEED = 4003.0, 9.79
AIR = pm.Air(density=1.225, dynamic_viscosity=1.225 * 1.516e-5)
ELEVATION_DEG = (0.0, -22.5, -45.0)
MICROPHONES = pm.arc(1.905, ELEVATION_DEG)
SOURCES = ("thickness", "loading", "total")
# Loading noise with other forces between the time steps, in `temporal_convergence.py`.
STRAIGHT = "straight"
SHOWN = {f"total {elevation:g}, dB": ".2f" for elevation in ELEVATION_DEG}
SHOWN |= {f"{source} -45, dB": ".2f" for source in ("BPF", "thickness", "loading", STRAIGHT)}


def add_start(parser: argparse.ArgumentParser, schedule: Marching) -> None:
    """Add the option of how a march starts."""
    parser.add_argument(
        "--start", choices=get_args(Start), default=schedule.start,
        help="from the wake of the steady solution or without any, default %(default)s",
    )  # fmt: skip


def analysis_with(model: pm.Model) -> pm.Analysis:
    """Analysis of the flight, with the microphones."""
    point = pm.OperatingPoint(rpm=RPM, speed=SPEED, air=AIR)
    return pm.analyze(PROPELLER, point, model=model, listening=pm.Listening(MICROPHONES))


def levels_of(tones: Tones) -> dict[str, float]:
    """OASPL by source and microphone, and the total at the blade passage frequency [dB]."""
    pressure = {**tones.parts, "total": tones.total}
    levels = {
        f"{source} {elevation:g}, dB": float(level)
        for source in SOURCES
        for elevation, level in zip(ELEVATION_DEG, oaspl_db(pressure[source]), strict=True)
    }
    of_bpf = spl_db(tones.total[:, 0])
    return levels | {
        f"BPF {elevation:g}, dB": float(level)
        for elevation, level in zip(ELEVATION_DEG, of_bpf, strict=True)
    }


def spreads_db(rows: Sequence[Mapping[str, Any]]) -> list[float]:
    """Highest less lowest total level of each microphone [dB]."""
    return [
        float(np.ptp([row[f"total {elevation:g}, dB"] for row in rows]))
        for elevation in ELEVATION_DEG
    ]


def print_spread(rows: Sequence[Mapping[str, Any]]) -> None:
    """Print by how much thrust and total levels differ."""
    levels = ", ".join(f"{spread:.3f}" for spread in spreads_db(rows))
    thrust = np.array([row["thrust, N"] for row in rows])
    percent = 100.0 * np.ptp(thrust) / thrust.mean()
    print(
        f"From lowest to highest: thrust {percent:.2g} %, total OASPL at 0, -22.5 and -45 deg"
        f" {levels} dB."
    )


def report(
    rows: Sequence[Mapping[str, Any]], resolution: str, shown: Mapping[str, str], folder: Path
) -> None:
    """Print the table, write it with its figures.

    Parameters
    ----------
    rows : sequence of mapping
        Results by column, among them thrust and levels.
    resolution : str
        Column of what is varied.
    shown : mapping of str to str
        Formats of the columns in front of the levels.
    folder : Path
        Folder of the files, which is made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(folder / f"{folder.name}.csv", rows)
    show(rows, {**shown, **{name: form for name, form in SHOWN.items() if name in rows[0]}})
    steps = [row[resolution] for row in rows]
    title = f"{PROPELLER.name}, {RPM:.0f} rpm, {SPEED:g} m/s, inviscid"
    of_run = {name: {"": [row[name] for row in rows]} for name in shown if name != resolution}
    save(refinement(steps, of_run, resolution, title), folder / "thrust.png")
    labels = {source: f"{source}, dB" for source in SOURCES}
    if f"{STRAIGHT} 0, dB" in rows[0]:
        labels[STRAIGHT] = "loading, dB,\nstraight between steps"
    of_sources = {
        label: {
            f"{elevation:g}°": [row[f"{source} {elevation:g}, dB"] for row in rows]
            for elevation in ELEVATION_DEG
        }
        for source, label in labels.items()
    }
    save(
        refinement(steps, of_sources, resolution, f"{title}; OASPL re 20 µPa"), folder / "oaspl.png"
    )
    print(f"Table and figures: {folder}")
