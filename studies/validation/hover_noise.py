"""The tone of a hovering propeller against microphones in an anechoic chamber.

APC-SF 11x4.7 at three rotation speeds and five elevations, standing still: no free stream is made
up and nothing is fitted. Each level has its band, of what is not known for sure of blade angle,
chord, transition and section drag. Beside it stand the errors that the thesis reports for these
microphones, with a free stream of J 0.3. To tell loads from acoustics, the same tone is shown twice
more: with the one twist offset that gives zero thrust where the wind tunnel has it in flight, and
with the computed loads scaled to the thrust of the test and to the torque of the wind tunnel.
"""

import argparse
import csv
import dataclasses
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

import propmdao as pm
from propmdao.acoustics.levels.decibels import spl_db
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.analysis.wind_tunnel import read_wind_tunnel, zero_thrust, zero_thrust_twist_deg
from propmdao.figures.measured import performance
from propmdao.figures.style import save
from propmdao.geometry.meshes import propeller_surface
from propmdao.geometry.surface import surface_panels
from propmdao.records.loads import PointLoads
from propmdao.runtime.output_files import replacing

PROPELLER = pm.load_propeller("apcsf_11x4.7")
MEASURED = Path(__file__).parent / "measurements" / "hover_noise_apcsf_11x4.7.toml"
WIND_TUNNEL = MEASURED.with_name("uiuc_apcsf_11x4.7.toml")
DENSITY = 1.18  # kg/m3: the test states none, with this its thrusts are those of the wind tunnel
ARC = np.arange(-67.5, 68.0, 2.5)  # deg


@dataclasses.dataclass(frozen=True)
class HoverTones:
    """Levels at blade passage in hover, a row for each rotation speed.

    Attributes
    ----------
    rpm, elevation_deg : arrays
        Rotation speeds [rev/min], elevations of the microphones [deg].
    spl_db, measured_db, turned_db, scaled_db : (n_rpm, n_microphones) arrays
        Levels computed, measured, computed with the twist offset, and computed with the loads
        scaled to thrust and torque measured.
    below_db, above_db : (n_rpm, n_microphones) arrays
        How far the computed levels may be lower (0 or less) and higher, by `propmdao.band`.
    left_out : list of str
        What the bands lack.
    thesis_db : (n_rpm, n_microphones) array
        Absolute errors of the thesis.
    loads, measured_loads : (n_rpm, 2) arrays
        Thrust [N] and torque [N m], computed and measured.
    arc_db : (n_rpm, n_arc) array
        Levels computed on `ARC`.
    """

    rpm: np.ndarray
    elevation_deg: np.ndarray
    spl_db: np.ndarray
    measured_db: np.ndarray
    turned_db: np.ndarray
    scaled_db: np.ndarray
    below_db: np.ndarray
    above_db: np.ndarray
    left_out: list[str]
    thesis_db: np.ndarray
    loads: np.ndarray
    measured_loads: np.ndarray
    arc_db: np.ndarray


def hover_tones() -> HoverTones:
    """Compute the tones where they were measured."""
    test: dict[str, Any] = tomllib.loads(MEASURED.read_text(encoding="utf-8"))
    rpm, elevation = (np.array(test["blade_passage"][key]) for key in ("rpm", "elevation_deg"))
    measured = measured_loads(rpm, test["thrust"])
    everywhere = pm.arc(test["radius"], [*elevation, *ARC])
    published = [
        pm.analyze(PROPELLER, rpm=value, density=DENSITY, observers=everywhere) for value in rpm
    ]
    twist = zero_thrust_twist_deg(PROPELLER, zero_thrust(read_wind_tunnel(WIND_TUNNEL).dynamic))
    at_microphones, turned = (
        [
            pm.analyze(PROPELLER, rpm=value, density=DENSITY, twist_offset_deg=offset,
                       observers=pm.arc(test["radius"], elevation))
            for value in rpm
        ]
        for offset in (0.0, twist)
    )  # fmt: skip
    bands = [pm.band(analysis) for analysis in at_microphones]
    loads = np.array([(a.loads.thrust, a.loads.torque) for a in published])
    level = np.array([spl_db(a.tones.total[:, 0]) for a in published])
    ratios = measured / loads
    scaled = [scaled_tone(a, *ratio) for a, ratio in zip(published, ratios, strict=True)]
    return HoverTones(
        rpm=rpm,
        elevation_deg=elevation,
        spl_db=level[:, : elevation.size],
        measured_db=np.array(test["blade_passage"]["spl_db"]),
        turned_db=np.array([spl_db(a.tones.total[:, 0]) for a in turned]),
        scaled_db=np.array(scaled)[:, : elevation.size],
        below_db=np.array([band.below["spl_bpf_db"] for band in bands]),
        above_db=np.array([band.above["spl_bpf_db"] for band in bands]),
        left_out=list(dict.fromkeys(reason for band in bands for reason in band.left_out)),
        thesis_db=np.array(test["thesis"]["absolute_error_db"]),
        loads=loads,
        measured_loads=measured,
        arc_db=level[:, elevation.size :],
    )


def measured_loads(rpm: np.ndarray, test: dict[str, list[float]]) -> np.ndarray:
    """Thrust of the test [N] and torque of the wind tunnel [N m]; the test has no torque."""
    static = read_wind_tunnel(WIND_TUNNEL).static
    cp, n = np.interp(rpm, static.rpm, static.CP), rpm / 60.0
    torque = cp / (2.0 * np.pi) * DENSITY * n**2 * PROPELLER.diameter**5
    return np.stack([np.interp(rpm, test["rpm"], test["thrust"]), torque], axis=1)


def scaled_tone(analysis: pm.Analysis, thrust: float, torque: float) -> np.ndarray:
    """Level of the first tone with the loads along and about the axis multiplied."""
    fidelity = analysis.model.fidelity
    surface = propeller_surface(PROPELLER, fidelity.n_contour, fidelity.n_surface_span)
    force = analysis.loads.point_loads.force * np.array([torque, torque, thrust])
    loads = PointLoads(analysis.loads.point_loads.position, force)
    scaled = tones(
        surface_panels(surface), loads, PROPELLER.n_blades, analysis.state,
        analysis.listening.observers, 1,
    )  # fmt: skip
    return np.asarray(spl_db(scaled.total[:, 0]))


def off_power_law_db(levels: HoverTones) -> float:
    """Largest distance of the measured levels from a power of rotation speed at each microphone."""
    x = np.log(levels.rpm)
    fits = [np.polyval(np.polyfit(x, level, 1), x) for level in levels.measured_db.T]
    return float(np.abs(np.array(fits).T - levels.measured_db).max())


def within_band(levels: HoverTones) -> int:
    """Count the measured levels that lie within the band of the computed ones."""
    off = levels.measured_db - levels.spl_db
    return int(((levels.below_db <= off) & (off <= levels.above_db)).sum())


def rows(levels: HoverTones) -> list[tuple[str, ...]]:
    """Tabulate the errors at each microphone, the head first, mean and largest at the end."""
    head = ("rpm", "elevation, deg", "measured, dB", "computed, dB", "its band, dB", "error, dB",
            "own zero thrust: error, dB", "measured loads: error, dB",
            "thesis: size of error, dB")  # fmt: skip
    table: list[tuple[str, ...]] = [head]
    error, turned, scaled = (
        computed - levels.measured_db
        for computed in (levels.spl_db, levels.turned_db, levels.scaled_db)
    )
    for i, rpm in enumerate(levels.rpm):
        for k, angle in enumerate(levels.elevation_deg):
            table.append(
                (f"{rpm}", f"{angle:+.1f}", f"{levels.measured_db[i, k]:.2f}",
                 f"{levels.spl_db[i, k]:.2f}",
                 f"{levels.below_db[i, k]:+.1f} {levels.above_db[i, k]:+.1f}",
                 f"{error[i, k]:+.2f}", f"{turned[i, k]:+.2f}", f"{scaled[i, k]:+.2f}",
                 f"{levels.thesis_db[i, k]:.2f}")
            )  # fmt: skip
    for label, measure in (("mean size", np.mean), ("largest", np.max)):
        sizes = [f"{measure(np.abs(values)):.2f}" for values in
                 (error, turned, scaled, levels.thesis_db)]  # fmt: skip
        table.append((label, "", "", "", "", *sizes))
    return table


def main() -> None:
    """Compute, print the table, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default="results/hover_noise",
                        help="folder, default %(default)s")  # fmt: skip
    output = parser.parse_args().output.absolute()
    output.mkdir(parents=True, exist_ok=True)

    levels = hover_tones()
    head, *body = rows(levels)
    with (
        replacing(output / "hover_noise.csv") as beside,
        beside.open("w", newline="", encoding="utf-8") as stream,
    ):
        csv.writer(stream).writerows([head, *body])
    table = Table(*head, box=None, padding=(0, 1, 0, 0))
    for row in body:
        table.add_row(*row)
    Console(highlight=False).print(table)
    for rpm, loads, measured in zip(levels.rpm, levels.loads, levels.measured_loads, strict=True):
        print(f"{rpm} rpm: thrust {loads[0]:.2f} N, measured {measured[0]:.2f}; "
              f"torque {loads[1]:.4f} N m, measured {measured[1]:.4f}")  # fmt: skip
    print(f"{within_band(levels)} of {levels.spl_db.size} measured levels lie within the band.")
    for reason in levels.left_out:
        print(f"The band lacks {reason}.")
    print(f"Measured levels are up to {off_power_law_db(levels):.1f} dB off a power of rpm.")
    names = [f"{rpm} rpm" for rpm in levels.rpm]
    save(performance.tone_directivity(
        ARC, dict(zip(names, levels.arc_db, strict=True)),
        levels.elevation_deg, dict(zip(names, levels.measured_db, strict=True)),
    ), output / "directivity.png")  # fmt: skip
    print(f"Table and figure: {output}")


if __name__ == "__main__":
    main()
