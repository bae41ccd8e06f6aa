"""Tones and broadband noise of a hovering propeller against an anechoic chamber.

APC-SF 11x4.7 as it was measured by Zawodny, Boyd and Burley (2016): in hover, so without the free
stream of J 0.3 that the thesis made up for want of hover. Figures 4.12 to 4.15 and table 4.7 of the
thesis are made from our own results, with broadband noise, which the thesis left out; third octaves
are compared with those measured, of the rotor alone and of all that was heard, the motor with it.
Nothing is tuned. What misses its target stands beside it. `hover_noise.py` shows how much of the
error of the tones is that of the loads.

Two blades of the same thrust are written as sound files of the same full scale, to be heard.
"""

import argparse
import csv
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import propmdao as pm
from propmdao.acoustics.levels.decibels import energy_sum_db, level_db, spl_db
from propmdao.acoustics.sounds.recordings import (
    SAMPLE_RATE,
    broadband_record,
    common_full_scale,
    tone_record,
)
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.contents.pressures import sampled
from propmdao.figures.contents.sound import (
    Sound,
    analysis_sound,
    band_levels,
    mechanism_levels,
    source_levels,
)
from propmdao.figures.directivity import directivity
from propmdao.figures.pressure import pressure
from propmdao.figures.spectra import narrowband_spectrum, third_octaves
from propmdao.figures.style import save
from propmdao.formats.wav import write_wav
from propmdao.runtime.output_files import replacing

PROPELLER = "apcsf_11x4.7"
OTHER = "apcsf_10x4.7"  # to be heard beside it, at the same thrust
MEASURED = Path(__file__).parent / "measurements" / "hover_noise_apcsf_11x4.7.toml"
DENSITY = 1.18  # kg/m3: the test states none, with this its thrusts are those of the wind tunnel
RPM, MICROPHONE = 4200, -45.0  # what the thesis shows in full
SECONDS = 5.0  # of sound
TARGET_TONE_DB, TARGET_BAND_DB = 1.0, 4.0  # mean absolute errors aimed at
BANDS = (500.0, 10e3)  # Hz, in which broadband noise is judged
MOTOR = 2000.0  # Hz, below which the motor's tones stand out of all that was heard


class Comparison(NamedTuple):
    """Computed and measured levels at one rotation speed and microphone; noise: total or part."""

    noise: str
    rpm: int
    elevation_deg: float
    frequency_hz: np.ndarray
    computed_db: np.ndarray
    measured_db: np.ndarray

    @property
    def error_db(self) -> np.ndarray:
        """Computed less measured level."""
        return self.computed_db - self.measured_db

    def within(self, low_hz: float, high_hz: float = BANDS[1]) -> np.ndarray:
        """Errors in the bands between two frequencies, both included."""
        inside = (self.frequency_hz > low_hz / 1.03) & (self.frequency_hz < high_hz * 1.03)
        return self.error_db[inside]


class Hover(NamedTuple):
    """Analysis at one rotation speed: observers at the microphones, then on the arc."""

    analysis: pm.Analysis
    elevation_deg: np.ndarray
    n_microphones: int

    @property
    def sound(self) -> Sound:
        """Tones and broadband noise at all of them."""
        return analysis_sound(self.analysis)

    def observer(self, elevation_deg: float) -> int:
        """Index of the first observer at an elevation."""
        return int(np.flatnonzero(self.elevation_deg == elevation_deg)[0])

    def on_arc(self, level: np.ndarray) -> np.ndarray:
        """Leave the microphones' levels out."""
        return level[self.n_microphones :]


def hover(rpm: float, test: Mapping[str, Any], arc_deg: np.ndarray) -> Hover:
    """Analyse the propeller where it was measured, and on an arc."""
    microphones = test["blade_passage"]["elevation_deg"]
    elevation = np.array([*microphones, *arc_deg])
    analysis = pm.analyze(
        pm.load_propeller(PROPELLER), rpm=rpm, density=DENSITY, broadband=True,
        observers=pm.arc(test["radius"], elevation),
    )  # fmt: skip
    return Hover(analysis, elevation, len(microphones))


def tone_errors(hovers: Mapping[int, Hover], test: Mapping[str, Any]) -> list[list[str]]:
    """Table 4.7: errors at blade passage, ours and the thesis', the mean sizes at the end."""
    passage = test["blade_passage"]
    head = ["elevation, deg"]
    for rpm in hovers:
        head += [f"{rpm} rpm, measured", f"{rpm} rpm, computed", f"{rpm} rpm, error",
                 f"{rpm} rpm, size in thesis"]  # fmt: skip
    table = [head]
    ours, theirs = [], []
    for k, angle in enumerate(passage["elevation_deg"]):
        row = [f"{angle:+.1f}"]
        for rpm, hovering in hovers.items():
            i = passage["rpm"].index(rpm)
            measured, thesis = passage["spl_db"][i][k], test["thesis"]["absolute_error_db"][i][k]
            level = float(spl_db(hovering.analysis.tones.total[k, 0]))
            ours.append(abs(level - measured))
            theirs.append(thesis)
            row += [f"{measured:.2f}", f"{level:.2f}", f"{level - measured:+.2f}", f"{thesis:.2f}"]
        table.append(row)
    sizes = np.reshape(ours, (-1, len(hovers))).mean(axis=0)
    reported = np.reshape(theirs, (-1, len(hovers))).mean(axis=0)
    mean = ["mean size"]
    for size, thesis in zip(sizes, reported, strict=True):
        mean += ["", "", f"{size:.2f}", f"{thesis:.2f}"]
    return [*table, mean]


def band_comparisons(hovers: Mapping[int, Hover], test: Mapping[str, Any]) -> list[Comparison]:
    """Third octaves where they were measured: of the rotor's broadband noise, and of all noise."""
    comparisons = []
    for noise, key in (("broadband", "broadband_third_octave"), ("total", "third_octave")):
        for spectrum in (bands for bands in test[key] if bands["rpm"] in hovers):
            hovering, angle = hovers[spectrum["rpm"]], spectrum["elevation_deg"]
            sound, i = hovering.sound, hovering.observer(angle)
            power = sound.broadband[i]
            level = level_db(power) if noise == "broadband" else band_levels(sound, i)
            nominal, spl = np.array(spectrum["frequency_hz"], float), np.array(spectrum["spl_db"])
            # Nominal frequencies and exact ones have the same number.
            number, ours = (np.round(10 * np.log10(f / 1000)) for f in (nominal, BANDS_HZ))
            _, here, there = np.intersect1d(number, ours, return_indices=True)
            comparisons.append(
                Comparison(noise, spectrum["rpm"], angle, nominal[here],
                           np.asarray(level)[there], spl[here])
            )  # fmt: skip
    return comparisons


def verdicts(tones: Sequence[Sequence[str]], bands: Iterable[Comparison]) -> list[str]:
    """Say what was aimed at and what was reached."""
    sizes = [float(cell) for cell in tones[-1][3::4]]
    lines = [
        _verdict(
            "tone at blade passage, mean absolute error", float(np.mean(sizes)), TARGET_TONE_DB
        )
    ]
    for comparison in bands:
        place = f"{comparison.rpm} rpm, {comparison.elevation_deg:+.1f} deg"
        if comparison.noise == "broadband":
            error = comparison.within(*BANDS)
            name = f"broadband third octaves 500 Hz to 10 kHz, {place}, mean absolute error"
            lines.append(_verdict(name, float(np.abs(error).mean()), TARGET_BAND_DB))
        else:
            with_motor, without = comparison.within(*BANDS), comparison.within(1.1 * MOTOR)
            lines.append(
                f"all that was heard, the motor with it, {place}: third octaves 500 Hz to 10 kHz "
                f"{with_motor.mean():+.1f} dB on average, 2.5 to 10 kHz {without.mean():+.1f} dB"
            )
    return lines


def _verdict(name: str, size: float, target: float) -> str:
    verdict = "met" if size <= target else f"MISSED by {size - target:.2f} dB"
    return f"{name}: {size:.2f} dB, target {target:.1f} dB: {verdict}"


def records(sound: Sound, observer: int) -> dict[str, np.ndarray]:
    """Pressure of a propeller's sound, with its noise and the tones alone [Pa]."""
    tones = tone_record(sound.tones.frequency_hz, sound.tones.total[observer], SECONDS)
    noise = broadband_record(sound.bands_hz, sound.broadband[observer], tones.size)
    return {"with broadband noise": tones + noise, "tones alone": tones}


def two_blades(thrust: float, distance: float, output: Path) -> dict[str, dict[str, np.ndarray]]:
    """Write the sound of two propellers of the same thrust, with one full scale."""
    blades, analyses = {}, {}
    for name in (PROPELLER, OTHER):
        analysis = pm.analyze(
            pm.load_propeller(name), thrust=thrust, density=DENSITY, broadband=True,
            observers=pm.arc(distance, MICROPHONE),
        )  # fmt: skip
        analyses[name] = analysis
        blades[f"{name}, {analysis.rpm:.0f} rpm"] = records(analysis_sound(analysis), 0)
    full = common_full_scale(*(sound["with broadband noise"] for sound in blades.values()))
    for (name, analysis), sound in zip(analyses.items(), blades.values(), strict=True):
        file = write_wav(output / f"{name}.wav", sound["with broadband noise"], full)
        level = source_levels(analysis_sound(analysis))
        print(f"{file.path.name}: {thrust:.2f} N at {analysis.rpm:.0f} rpm, "
              f"{level['total'][0]:.1f} dB, full scale {full:g} Pa")  # fmt: skip
    return blades


def draw(hovers: Mapping[int, Hover], bands: Sequence[Comparison], test: Mapping[str, Any],
         output: Path) -> None:  # fmt: skip
    """Draw figures 4.12 to 4.15 of the thesis."""
    shown = hovers[RPM]
    arc = shown.on_arc(shown.elevation_deg)
    names = {rpm: f"{rpm} rpm" for rpm in hovers}
    observer = shown.observer(MICROPHONE)
    save(narrowband_spectrum(
        {names[rpm]: hovering.sound for rpm, hovering in hovers.items()}, observer
    ), output / "figure_4_12_spectrum.png")  # fmt: skip

    measured = {comparison.noise: (comparison.frequency_hz, comparison.measured_db)
                for comparison in bands
                if (comparison.rpm, comparison.elevation_deg) == (RPM, MICROPHONE)}  # fmt: skip
    save(
        third_octaves(BANDS_HZ, mechanism_levels(shown.analysis, observer), measured),
        output / "figure_4_13_third_octaves.png",
    )

    sources = source_levels(shown.sound)
    save(directivity(
        arc, {name: shown.on_arc(level) for name, level in sources.items()}
    ), output / "figure_4_14a_sources.png")  # fmt: skip
    overall = {names[rpm]: hovering.on_arc(source_levels(hovering.sound)["total"])
               for rpm, hovering in hovers.items()}  # fmt: skip
    measured_overall = {
        names[comparison.rpm]: (
            [comparison.elevation_deg],
            [float(energy_sum_db(comparison.measured_db))],
        )
        for comparison in bands
        if comparison.noise == "total"
    }
    save(directivity(arc, overall, measured_overall), output / "figure_4_14b_total.png")

    passage = test["blade_passage"]
    tone = {names[rpm]: hovering.on_arc(np.asarray(spl_db(hovering.analysis.tones.total[:, 0])))
            for rpm, hovering in hovers.items()}  # fmt: skip
    measured_tone = {
        f"{rpm} rpm": (passage["elevation_deg"], level)
        for rpm, level in zip(passage["rpm"], passage["spl_db"], strict=True)
    }
    save(
        directivity(arc, tone, measured_tone, "SPL at blade passage"),
        output / "figure_4_15_blade_passage.png",
    )


def write(output: Path, tones: Iterable[Sequence[str]], bands: Iterable[Comparison]) -> None:
    """Write the tables."""
    with (
        replacing(output / "table_4_7.csv") as beside,
        beside.open("w", newline="", encoding="utf-8") as stream,
    ):
        csv.writer(stream).writerows(tones)
    with (
        replacing(output / "third_octaves.csv") as beside,
        beside.open("w", newline="", encoding="utf-8") as stream,
    ):
        writer = csv.writer(stream)
        writer.writerow(["noise", "rpm", "elevation_deg", "frequency_hz", "measured_db",
                         "computed_db", "error_db"])  # fmt: skip
        for comparison in bands:
            for f, measured, level in zip(
                comparison.frequency_hz, comparison.measured_db, comparison.computed_db, strict=True
            ):
                writer.writerow([*comparison[:3], f"{f:g}", f"{measured:.1f}", f"{level:.2f}",
                                 f"{level - measured:+.2f}"])  # fmt: skip


def main() -> None:
    """Compute, print the tables, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="one rotation speed, a coarse arc")
    parser.add_argument("--output", type=Path, default="results/acoustic_validation",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)

    test: dict[str, Any] = tomllib.loads(MEASURED.read_text(encoding="utf-8"))
    speeds = [RPM] if options.quick else test["blade_passage"]["rpm"]
    arc = np.linspace(-90.0, 90.0, 13 if options.quick else 73)
    hovers = {rpm: hover(rpm, test, arc) for rpm in speeds}
    tones, bands = tone_errors(hovers, test), band_comparisons(hovers, test)
    write(output, tones, bands)
    print("Errors of the SPL at blade passage, and sizes of those of the thesis, dB")
    columns = [k for k in range(len(tones[0])) if k == 0 or k % 4 in (3, 0)]
    table = Table(*(tones[0][k] for k in columns), box=None, padding=(0, 1, 0, 0))
    for row in tones[1:]:
        table.add_row(*(row[k] for k in columns))
    Console(highlight=False).print(table)
    print(*verdicts(tones, bands), sep="\n")
    draw(hovers, bands, test, output)
    blades = two_blades(float(hovers[RPM].analysis.loads.thrust), test["radius"], output)
    turns = {name: sampled(sound, SAMPLE_RATE, 60.0 / RPM) for name, sound in blades.items()}
    save(pressure(turns), output / "pressure.png")
    print(f"Tables, figures and sound: {output}")


if __name__ == "__main__":
    main()
