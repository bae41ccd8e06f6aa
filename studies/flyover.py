"""What is heard on the ground when a propeller flies over: levels against time, SEL and EPNL.

The propeller of a small aircraft in level flight, its axis along the path, over a microphone flush
with hard ground. Tones come as a pressure record with its Doppler shift, broadband noise in third
octaves that shift with it; both are absorbed by the air on their way. A study to copy and change.

At the small angles of cruise, vortices shed by laminar boundary layers are loudest by far in the
self-noise model, at 10 to 20 kHz. Real blades may shed fewer: the total with tripped boundary
layers, which shed none, is shown as the other limit.
"""

import argparse
import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np

from propmdao import acoustic_plots, directivity_plots
from propmdao.acoustics.broadband import rotor_self_noise
from propmdao.acoustics.broadband.boundary_layer import Trip
from propmdao.acoustics.epnl import effective_perceived_noise_level
from propmdao.acoustics.flyover import flyover_histories
from propmdao.acoustics.ground import Sight, fixed_observers, flyover_track, line_of_sight
from propmdao.acoustics.levels import level_db, level_dba
from propmdao.acoustics.motion import poses
from propmdao.acoustics.observers import directions, sphere
from propmdao.acoustics.perceived_noise import PERCEIVED_BANDS_HZ
from propmdao.acoustics.propagation import Air, absorb
from propmdao.acoustics.rotors import Rotor, equally_spaced
from propmdao.acoustics.time_levels import sound_exposure_level_db, third_octave_history
from propmdao.aerodynamics.section_laws import AIR_VISCOSITY
from propmdao.aerodynamics.strips import strip_radii
from propmdao.analysis import SOUND_SPEED, Analysis, analyze
from propmdao.fidelity import Fidelity
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.meshes import blade_meshes, mesh_radii
from propmdao.geometry.surface import surface_panels
from propmdao.propeller import load_propeller
from propmdao.self_noise import BANDS_HZ, strip_flow

PROPELLER = load_propeller("apcsf_11x4.7")
THRUST, SPEED, DENSITY = 1.2, 8.0, 1.225  # N, m/s, kg/m3
HEIGHT = 20.0  # m
DURATION, STEP = 30.0, 0.5  # s, the aircraft being overhead in the middle; of the levels
SAMPLE_RATE, MAX_TONE = 8000, 1500.0  # Hz, of the tones
AIR = Air()
RESOLUTION = Fidelity()
TRACK = flyover_track(HEIGHT, SPEED)
MICROPHONE = fixed_observers([[0.0, 0.0, 0.0]])
GROUND = 4.0  # mean square on hard ground over that without it
ARC = np.linspace(-90.0, 90.0, 37)  # deg
TRIPPED = "total, tripped"
PARTS = ("thickness", "loading", "broadband", "total", TRIPPED)


class Flyover(NamedTuple):
    """What the microphone hears in each step.

    Attributes
    ----------
    time : (n_times,) array
        Middle of the steps; overhead at 0 [s].
    mean_square : dict of str to (n_times, n_bands) array
        In the bands `BANDS_HZ`, by noise source [Pa^2].
    """

    time: np.ndarray
    mean_square: dict[str, np.ndarray]


def sight(times: np.ndarray) -> Sight:
    """From where the microphone hears the propeller."""
    return line_of_sight(TRACK, MICROPHONE, times, SOUND_SPEED)


def tone_bands(found: Analysis) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times and third octaves of thickness, loading and all tones without ground or absorption."""
    r = PROPELLER.r_over_R
    _, surface = blade_meshes(
        Blade.from_propeller(PROPELLER),
        mesh_radii(r, RESOLUTION.n_spanwise, RESOLUTION.n_surface_span),
        RESOLUTION.n_chordwise, RESOLUTION.n_contour,
    )  # fmt: skip
    rotor = Rotor(equally_spaced(PROPELLER.n_blades), found.rpm * np.pi / 30.0,
                  surface_panels(surface), found.steady.point_loads)  # fmt: skip
    clock = np.arange(-0.5 * DURATION, 0.5 * DURATION, 1.0 / SAMPLE_RATE)
    record = flyover_histories(
        [rotor], MICROPHONE, clock, DENSITY, SOUND_SPEED, TRACK, max_frequency_hz=MAX_TONE
    )
    held = BANDS_HZ[BANDS_HZ < 0.8 * SAMPLE_RATE / 2]
    bands = {}
    for part in ("thickness", "loading", "total"):
        time, heard = third_octave_history(getattr(record, part)[0], SAMPLE_RATE, held, STEP)
        bands[part] = np.pad(heard, ((0, 0), (0, BANDS_HZ.size - held.size)))
    return clock[0] + time, bands


def broadband_bands(found: Analysis, times: np.ndarray, trip: Trip = "none") -> np.ndarray:
    """Third octaves of the self-noise without ground or absorption, (n_times, n_bands) [Pa^2]."""
    r = PROPELLER.r_over_R
    at = span_interpolation(r, strip_radii(r[0], RESOLUTION.n_spanwise))
    states = found.steady.sections
    strips = strip_flow(found.steady.strips, states.relative_speed, states.lift_coefficient,
                        Blade.from_propeller(PROPELLER), at)  # fmt: skip
    doppler = np.asarray(sight(times).doppler)[0]
    # Whoever flies along is for a moment where the microphone is: pressure is the same for both,
    # frequencies are those of flying along times Doppler's factor.
    pose = poses(TRACK, times)
    beside = np.einsum("tij,ti->tj", pose.rotation, MICROPHONE.position[0] - pose.origin)
    heard = [
        rotor_self_noise(
            strips, PROPELLER.n_blades, found.rpm * np.pi / 30.0, SPEED, SOUND_SPEED,
            AIR_VISCOSITY / DENSITY, place[None], BANDS_HZ / factor, trip=trip,
        ).total[0]
        for place, factor in zip(beside, doppler, strict=True)
    ]  # fmt: skip
    return np.array(heard)


def fly_over(found: Analysis) -> Flyover:
    """All that the microphone hears."""
    time, parts = tone_bands(found)
    parts["broadband"] = broadband_bands(found, time)
    parts[TRIPPED] = parts["total"] + broadband_bands(found, time, "heavy")
    parts["total"] = parts["total"] + parts["broadband"]
    distance = np.asarray(sight(time).distance)[0]
    heard = {name: np.asarray(absorb(GROUND * parts[name], BANDS_HZ, distance, AIR))
             for name in PARTS}  # fmt: skip
    return Flyover(time, heard)


def hemisphere(found: Analysis) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Elevations, azimuths from the nose [deg] and levels below the aircraft, flying along [dB]."""
    assert found.broadband is not None
    heard = acoustic_plots.Heard(found.tones, BANDS_HZ, np.asarray(found.broadband.total))
    elevation, azimuth = np.linspace(-90.0, 0.0, 31), np.linspace(0.0, 360.0, 73)
    axes = np.asarray(poses(TRACK, np.zeros(1)).rotation)[0]
    seen = directions(sphere(HEIGHT, elevation, azimuth) @ axes)
    # In axial flight it is the same all around the rotor's axis.
    level = np.interp(seen.elevation_deg, ARC, acoustic_plots.source_levels(heard)["total"])
    return elevation, azimuth, level.reshape(elevation.size, azimuth.size)


def main() -> None:
    """Fly over, print the levels, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default="results/flyover",
                        help="folder, default %(default)s")  # fmt: skip
    output = parser.parse_args().output.absolute()
    output.mkdir(parents=True, exist_ok=True)

    found = analyze(PROPELLER, thrust=THRUST, speed=SPEED, density=DENSITY, broadband=True,
                    observers=[(HEIGHT, angle) for angle in ARC], fidelity=RESOLUTION)  # fmt: skip
    heard = fly_over(found)
    levels = {part: np.asarray(level_dba(BANDS_HZ, heard.mean_square[part])) for part in PARTS}
    with (output / "levels_dba.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["time_s", *PARTS])
        for row in zip(heard.time, *levels.values(), strict=True):
            writer.writerow([f"{value:.2f}" for value in row])
    print(f"{PROPELLER.name} at {found.rpm:.0f} rpm, {SPEED:g} m/s, {HEIGHT:g} m above the ground:")
    for part in ("total", TRIPPED):
        exposure = sound_exposure_level_db(levels[part], STEP)
        bands = np.asarray(level_db(heard.mean_square[part]))
        perceived = effective_perceived_noise_level(bands[:, : PERCEIVED_BANDS_HZ.size], STEP)
        print(f"{part}: LAmax {levels[part].max():.1f} dBA, SEL {exposure:.1f} dBA, "
              f"EPNL {perceived.epnl:.1f} EPNdB")  # fmt: skip
    acoustic_plots.level_history(
        heard.time, levels, f"A-weighted level of {STEP:g} s, dB re 20 µPa",
        {"heard from overhead": HEIGHT / SOUND_SPEED},
    ).savefig(output / "levels.png")  # fmt: skip
    directivity_plots.hemisphere_map(
        *hemisphere(found), f"OASPL at {HEIGHT:g} m, dB re 20 µPa; azimuth from the nose"
    ).savefig(output / "hemisphere.png")
    print(f"Levels and figures: {output}")


if __name__ == "__main__":
    main()
