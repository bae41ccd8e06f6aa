"""CSV files of levels and spectra: heads with units, levels that add up."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.commands.output.level_files import write_levels, write_spectra
from propmdao.commands.program import main


def observer(bpf_hz: float, **more: Any) -> dict[str, Any]:
    place = {"elevation_deg": -45.0, "azimuth_deg": 0.0, "radius": 2.0}
    levels = {"spl_bpf_db": 60.0, "oaspl_db": 60.4, "oaspl_thickness_db": 50.0}
    levels |= {"oaspl_loading_db": 60.0, "oaspl_dba": 45.0}
    harmonics = [
        {"m": m, "frequency_hz": m * bpf_hz, "spl_db": level}
        | {"spl_thickness_db": level - 10.0, "spl_loading_db": level - 0.5}
        for m, level in ((1, 60.0), (2, 50.0), (3, -200.0))
    ]
    bands = [{"frequency_hz": 1000.0, "spl_db": 50.0}]
    return {**place, **levels, "harmonics": harmonics, "third_octave": bands, **more}


def result(*observers: dict[str, Any]) -> dict[str, Any]:
    numbers = dict.fromkeys(
        "rpm speed rho J thrust torque shaft_power CT CQ CP eta figure_of_merit".split(), 0.5
    )
    words = {"converged": True, "failure": None}
    point = {"incidence_deg": 0.0}
    return {**numbers, **words, "point": point, "observers": list(observers)}


def read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_levels_have_a_row_for_each_observer_and_units_in_the_heads(tmp_path: Path) -> None:
    file = tmp_path / "levels.csv"
    write_levels(file, [result(observer(100.0), observer(100.0)), result(observer(200.0))])
    rows = read(file)
    assert [row["observer"] for row in rows] == ["1", "2", "1"]
    assert rows[0]["thrust [N]"] == "0.5" and rows[0]["torque [N m]"] == "0.5"
    assert rows[0]["radius [m]"] == "2.0" and rows[0]["oaspl_dba [dBA]"] == "45.0"
    assert "oaspl_total_dba [dBA]" not in rows[0]  # no broadband noise was asked for
    write_levels(file, [result()])
    (row,) = read(file)
    assert row["CT"] == "0.5" and row["observer"] == ""


def test_spectra_are_those_of_the_tones_and_weighted_by_a(tmp_path: Path) -> None:
    file = tmp_path / "spectra.csv"
    write_spectra(file, [result(observer(1000.0))])
    rows = read(file)
    tones = [row for row in rows if row["spectrum"] == "tone"]
    assert [float(row["frequency [Hz]"]) for row in tones] == [1000.0, 2000.0]  # silence is none
    assert float(tones[0]["spl_loading_db [dB]"]) == 59.5
    # A-weighting is 0 at 1 kHz and +1.2 dB at 2 kHz (IEC 61672-1).
    assert float(tones[0]["spl_dba [dBA]"]) == pytest.approx(60.0, abs=0.02)
    assert float(tones[1]["spl_dba [dBA]"]) == pytest.approx(51.2, abs=0.05)
    narrow = {
        float(row["frequency [Hz]"]): float(row["spl_db [dB]"])
        for row in rows
        if row["spectrum"] == "bin of 5 Hz"
    }
    assert narrow == pytest.approx({1000.0: 60.0, 2000.0: 50.0})
    assert [row["spl_db [dB]"] for row in rows if row["spectrum"] == "third octave"] == ["50.0"]


def test_narrow_bands_hold_the_energy_of_the_broadband_noise(tmp_path: Path) -> None:
    noise = [{"frequency_hz": float(f), "spl_db": 40.0} for f in BANDS_HZ]
    thirds = [{"frequency_hz": float(f), "spl_db": 40.0} for f in BANDS_HZ]
    file = tmp_path / "spectra.csv"
    write_spectra(file, [result(observer(100.0, broadband=noise, third_octave=thirds))])
    rows = [row for row in read(file) if row["spectrum"] == "bin of 5 Hz"]
    frequency, level = (
        np.array([float(row[head]) for row in rows])
        for head in ("frequency [Hz]", "spl_broadband_db [dB]")
    )
    # The bins at the ends of the lowest and the highest band reach beyond them; not these ten.
    within = (frequency > 1000 * 10**-0.05) & (frequency < 1000 * 10**0.95)
    total = 10.0 * np.log10(np.sum(10.0 ** (level[within] / 10.0)))
    assert total == pytest.approx(50.0, abs=0.02)


def test_analyze_writes_tables_and_says_so(
    recorder: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "levels.csv"
    asked = ["analyze", "apcsf_11x4.7", "--rpm", "4000:5000:1000", "--arc", "2", "-45", "0"]
    assert main([*asked, "--out", str(file)]) == 0
    assert f"Tables: {file}" in capsys.readouterr().out
    assert [row["rpm [rpm]"] for row in read(file)] == ["4000.0", "4000.0", "5000.0", "5000.0"]
    assert main([*asked, "--out", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["tables"] == [str(file)]


def test_a_folder_of_figures_says_what_they_were_made_of(
    recorder: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("matplotlib")
    from propmdao.figures.rotor import of_rotor

    monkeypatch.setattr(of_rotor, "rotor_figures", lambda analysis, polars: {})
    asked = ["analyze", "apcsf_11x4.7", "--rpm", "4000", "--figures", str(tmp_path)]
    assert main(asked) == 0
    record = json.loads((tmp_path / "record.json").read_text())
    assert record["arguments"] == asked and record["command"].startswith("propmdao analyze ")
    assert record["results"][0]["rpm"] == 4000.0
    assert record["propellers"]["apcsf_11x4.7"]["diameter"] == 0.2794
    assert set(record["versions"]) == {"propmdao", "python", "jax", "numpy", "scipy", "openmdao"}
