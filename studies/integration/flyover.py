"""Sound on the ground when a propeller flies over: levels against time, SEL and EPNL.

The propeller of a small aircraft in level flight, its axis along the path, over a microphone flush
with hard ground. Tones come as a pressure record with its Doppler shift, broadband noise in third
octaves that shift with it; both are absorbed by the air on their way. A study to copy and change.

At the small angles of cruise much hangs on whether boundary layers are laminar at the trailing
edge: the total with tripped ones is shown as the other limit.
"""

import argparse
import csv
from pathlib import Path

import numpy as np

import propmdao as pm
from propmdao.acoustics.kinematics.motion import poses
from propmdao.acoustics.kinematics.observers import directions, sphere
from propmdao.acoustics.kinematics.tracks import flyover_track
from propmdao.analysis.flights.flyover_results import STEP
from propmdao.figures.contents.sound import analysis_sound, source_levels
from propmdao.figures.directivity import hemisphere_map
from propmdao.figures.histories import level_history
from propmdao.figures.style import save
from propmdao.records.models import Trip
from propmdao.runtime.output_files import replacing

PROPELLER = pm.load_propeller("apcsf_11x4.7")
THRUST, SPEED, DENSITY = 1.2, 8.0, 1.225  # N, m/s, kg/m3
FLIGHT = pm.Flight(height=20.0, duration=30.0)  # m, s
TRACK = flyover_track(FLIGHT.height, SPEED)
ARC = np.linspace(-90.0, 90.0, 37)  # deg
TRIPPED = "total, tripped"


def analyze(trip: Trip) -> pm.Analysis:
    """Analyse the propeller in cruise, on an arc; the trip changes the broadband noise only."""
    return pm.analyze(PROPELLER, thrust=THRUST, speed=SPEED, density=DENSITY, broadband=True,
                      trip=trip, observers=pm.arc(FLIGHT.height, ARC))  # fmt: skip


def hemisphere(analysis: pm.Analysis) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Elevations, azimuths from the nose [deg] and levels below the aircraft, flying along [dB]."""
    elevation, azimuth = np.linspace(-90.0, 0.0, 31), np.linspace(0.0, 360.0, 73)
    axes = np.asarray(poses(TRACK, np.zeros(1)).rotation)[0]
    direction = directions(sphere(FLIGHT.height, elevation, azimuth) @ axes)
    # In axial flight the sound is the same all around the rotor's axis.
    total = source_levels(analysis_sound(analysis))["total"]
    level = np.interp(direction.elevation_deg, ARC, total)
    return elevation, azimuth, level.reshape(elevation.size, azimuth.size)


def main() -> None:
    """Fly over, print the levels, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default="results/flyover",
                        help="folder, default %(default)s")  # fmt: skip
    output = parser.parse_args().output.absolute()
    output.mkdir(parents=True, exist_ok=True)

    analysis = analyze("none")
    untripped = pm.fly_over(analysis, FLIGHT)
    tripped = pm.fly_over(analyze("heavy"), FLIGHT)
    levels = {part: untripped.level_dba(part) for part in untripped.mean_square}
    levels[TRIPPED] = tripped.level_dba()
    with (
        replacing(output / "levels_dba.csv") as beside,
        beside.open("w", newline="", encoding="utf-8") as stream,
    ):
        writer = csv.writer(stream)
        writer.writerow(["time_s", *levels])
        for row in zip(untripped.time, *levels.values(), strict=True):
            writer.writerow([f"{value:.2f}" for value in row])
    print(f"{PROPELLER.name} at {analysis.rpm:.0f} rpm, {SPEED:g} m/s, {FLIGHT.height:g} m above "
          "the ground:")  # fmt: skip
    for name, flyover in (("total", untripped), (TRIPPED, tripped)):
        summary = flyover.to_dict()
        level = summary["levels"]["total"]
        print(f"{name}: LAmax {level['lamax_dba']:.1f} dBA, SEL {level['sel_dba']:.1f} dBA, "
              f"EPNL {summary['epnl']:.1f} EPNdB")  # fmt: skip
    save(level_history(
        untripped.time, levels, f"A-weighted level of {STEP:g} s, dB re 20 µPa",
        {"heard from overhead": FLIGHT.miss_distance / float(analysis.state.air.sound_speed)},
    ), output / "levels.png")  # fmt: skip
    save(
        hemisphere_map(
            *hemisphere(analysis),
            f"OASPL at {FLIGHT.height:g} m, dB re 20 µPa; azimuth from the nose",
        ),
        output / "hemisphere.png",
    )
    print(f"Levels and figures: {output}")


if __name__ == "__main__":
    main()
