"""The study of tones and broadband noise: its tables, verdicts and files, on its quick subset."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import soundfile

pytest.importorskip("matplotlib")

FIGURES = {
    "figure_4_12_spectrum.png",
    "figure_4_13_third_octaves.png",
    "figure_4_14a_sources.png",
    "figure_4_14b_total.png",
    "figure_4_15_blade_passage.png",
    "pressure.png",
}
SOUNDS = {"apcsf_11x4.7.wav", "apcsf_10x4.7.wav"}


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("acoustic_validation")


@pytest.fixture(scope="module")
def run(study, tmp_path_factory) -> tuple[Path, str]:
    """Folder and what was printed."""
    output = tmp_path_factory.mktemp("study")
    with pytest.MonkeyPatch.context() as patch:
        lines: list[str] = []
        patch.setattr("sys.argv", ["acoustic_validation.py", "--quick", "--output", str(output)])
        patch.setattr(
            "builtins.print", lambda *of, sep=" ", **_: lines.append(sep.join(map(str, of)))
        )
        study.main()
    return output, "\n".join(lines)


def read(file: Path) -> list[dict[str, str]]:
    with file.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.slow
def test_files(run):
    names = {file.name for file in run[0].iterdir()}
    assert names == FIGURES | SOUNDS | {"table_4_7.csv", "third_octaves.csv"}


@pytest.mark.slow
def test_table_has_every_microphone_beside_the_thesis(run):
    rows = read(run[0] / "table_4_7.csv")
    assert [row["elevation, deg"] for row in rows] == [
        "+45.0", "+22.5", "+0.0", "-22.5", "-45.0", "mean size"
    ]  # fmt: skip
    at_45 = rows[4]
    assert at_45["4200 rpm, measured"] == "48.95"
    assert at_45["4200 rpm, size in thesis"] == "1.82"
    error = float(at_45["4200 rpm, computed"]) - 48.95
    assert error == pytest.approx(float(at_45["4200 rpm, error"]), abs=0.011)
    sizes = [abs(float(row["4200 rpm, error"])) for row in rows[:-1]]
    assert np.mean(sizes) == pytest.approx(float(rows[-1]["4200 rpm, error"]), abs=0.01)


@pytest.mark.slow
def test_bands_are_compared_where_they_were_measured(run):
    rows = read(run[0] / "third_octaves.csv")
    counts = {
        (row["noise"], row["elevation_deg"]): sum(
            (one["noise"], one["elevation_deg"]) == (row["noise"], row["elevation_deg"])
            for one in rows
        )
        for row in rows
    }
    # The measured totals end at 31.5 kHz, what is computed at 20 kHz.
    assert counts == {
        ("broadband", "-45.0"): 21,
        ("broadband", "-22.5"): 21,
        ("total", "-45.0"): 24,
    }
    for row in rows:
        error = float(row["computed_db"]) - float(row["measured_db"])
        assert error == pytest.approx(float(row["error_db"]), abs=0.06)


def test_verdicts_say_by_how_much(study):
    assert study._verdict("x", 1.5, 1.0) == "x: 1.50 dB, target 1.0 dB: MISSED by 0.50 dB"
    assert study._verdict("x", 0.5, 1.0) == "x: 0.50 dB, target 1.0 dB: met"


@pytest.mark.slow
def test_what_is_missed_stands_beside_its_target(run):
    text = run[1]
    (tone,) = (line for line in text.splitlines() if line.startswith("tone at blade passage"))
    size = float(tone.split(": ")[1].split(" dB")[0])
    assert "target 1.0 dB" in tone
    assert ("MISSED" in tone) == (size > 1.0)
    assert text.count("target 4.0 dB") == 2


@pytest.mark.slow
def test_sounds_have_one_full_scale_and_the_levels_that_are_printed(run):
    folder, text = run
    scales = set()
    for name in SOUNDS:
        (line,) = (one for one in text.splitlines() if one.startswith(name))
        level, full = float(line.split(", ")[1].split()[0]), float(line.split()[-2])
        with soundfile.SoundFile(folder / name) as file:
            comment, record = file.comment, file.read()
        assert comment == f"full scale = {full:.9g} Pa"
        scales.add(full)
        assert record.size == pytest.approx(5.0 * 48000, rel=1e-3)
        heard = 20 * np.log10(full * np.std(record) / 20e-6)
        assert heard == pytest.approx(level, abs=0.1)
    assert len(scales) == 1
