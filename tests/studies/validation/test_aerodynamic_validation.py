"""The comparisons with the wind tunnel and with hover noise, run on a few points."""

from __future__ import annotations

import csv
import dataclasses

import pytest

pytest.importorskip("matplotlib")

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.single_point import analyze
from propmdao.analysis.wind_tunnel import calibrated_twist_deg
from propmdao.formats.propellers import load_propeller
from propmdao.records.wake_law import WakeLaw

CASE = "apcsf_11x4.7"


@pytest.fixture(autouse=True)
def _terminal(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")


def run(study, monkeypatch, capsys, folder, *arguments) -> str:
    monkeypatch.setattr("sys.argv", [study.__name__, "--output", str(folder), *arguments])
    study.main()
    return capsys.readouterr().out


def rows(file) -> list[dict[str, str]]:
    with file.open(newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture
def few_points(import_study):
    """Two static points and two with flight speed, one propeller."""
    validation = import_study("aerodynamic_validation")
    whole = validation.measurements(CASE)
    few = dataclasses.replace(whole, static=whole.static[[2, 9]], dynamic=whole.dynamic[[18, 29]])
    validation.CASES = {CASE: validation.CASES[CASE]}
    validation.measurements = lambda case, quick=False: few
    return validation, few


def test_published_and_calibrated_columns(few_points, monkeypatch, capsys, tmp_path):
    validation, few = few_points
    printed = run(validation, monkeypatch, capsys, tmp_path)
    first = next(line for line in printed.splitlines() if line.startswith(CASE))
    assert len(first.split()) == 8  # propeller, geometry, twist, four errors, trend
    assert len(first.rstrip()) <= 80
    published, calibrated, *targets = rows(tmp_path / "summary.csv")
    assert (published["geometry"], float(published["twist"])) == ("published", 0.0)
    assert float(calibrated["twist"]) == pytest.approx(
        calibrated_twist_deg(load_propeller(CASE), few.static), abs=1e-9
    )
    assert float(calibrated["static CT, mean"]) == pytest.approx(0.0, abs=0.01)
    assert [target["geometry"] for target in targets] == ["published", "calibrated"]

    points = rows(tmp_path / f"{CASE}.csv")
    assert len(points) == 4
    last = analyze(
        load_propeller(CASE), rpm=float(points[-1]["rpm"]),
        speed=float(points[-1]["J"]) * float(points[-1]["rpm"]) / 60.0 * 0.2794,
        twist_offset_deg=float(calibrated["twist"]),
    ).coefficients  # fmt: skip
    assert float(points[-1]["CT calibrated"]) == pytest.approx(float(last.CT), rel=1e-9)
    assert float(points[-1]["CT measured"]) == few.dynamic.CT[-1]
    for figure in (f"{CASE}.png", f"{CASE}_static.png"):
        assert (tmp_path / figure).read_bytes()[16:20] == (1200).to_bytes(4, "big")


def test_quick_takes_points_of_every_kind(import_study):
    tunnel = import_study("aerodynamic_validation").measurements(CASE, quick=True)
    assert 2 <= tunnel.static.rpm.size <= 4
    assert tunnel.dynamic.J.min() <= 0.5 < tunnel.dynamic.J.max()


@pytest.mark.slow
def test_sensitivities_and_the_twist_each_point_needs(
    few_points, import_study, monkeypatch, capsys, tmp_path
):
    validation, few = few_points
    sensitivity = import_study("aerodynamic_sensitivity")
    sensitivity.PITCH = {CASE: sensitivity.PITCH[CASE]}
    sensitivity.measurements = validation.measurements
    every = sensitivity.variants
    chosen = {"nothing", "twist +1 deg", "drift of the wake x 1.5"}
    sensitivity.variants = lambda *of: (one for one in every(*of) if one[0] in chosen)
    printed = run(sensitivity, monkeypatch, capsys, tmp_path, "--quick")
    assert "n_crit is left out" in printed
    as_is, twisted, wake = rows(tmp_path / f"{CASE}.csv")
    # Calibrated, a blade of other twist is the same blade.
    assert float(twisted["twist"]) == pytest.approx(float(as_is["twist"]) - 1.0, abs=2e-3)
    assert float(twisted["then CT"]) == pytest.approx(float(as_is["then CT"]), abs=0.02)
    # A wake that leaves faster induces less.
    assert float(wake["static CT"]) > float(as_is["static CT"]) + 5.0
    needed = rows(tmp_path / f"{CASE}_twist_needed.csv")
    assert len(needed) == few.static.rpm.size + (few.dynamic.J <= 0.5).sum()


def test_prescribed_wake_has_the_thrust_of_the_one_that_moves_as_it_says(import_study):
    transport = import_study("wake_transport")
    (row,) = transport.compare([(CASE, 2, 0.0)], steps=12)
    assert abs(row["CT, %"]) < 1.5 and abs(row["CP, %"]) < 2.0
    assert row["before"] == pytest.approx(0.35, abs=0.05)
    assert row["after"] == pytest.approx(1.0, abs=0.1)
    assert 1.1 < row["P/ideal"] < 1.2  # as rotors have it


def test_drift_of_the_wake_is_changed_in_all_its_parts(import_study):
    sensitivity = import_study("aerodynamic_sensitivity")
    variants = {label: how for label, _, how in sensitivity.variants(load_propeller(CASE), False)}
    wake = variants["drift of the wake x 1.5"].keywords["wake"]
    default = WakeLaw()
    for name in ("before_passage", "after_passage", "inside"):
        assert getattr(wake, name) == pytest.approx(1.5 * getattr(default, name))
    assert (wake.passage_width, wake.inner_edge) == (default.passage_width, default.inner_edge)


def test_hover_noise_table_is_that_of_its_tones(import_study, monkeypatch, capsys, tmp_path):
    hover = import_study("hover_noise")
    printed = run(hover, monkeypatch, capsys, tmp_path)
    assert "4200 rpm: thrust" in printed
    table = rows(tmp_path / "hover_noise.csv")
    assert len(table) == 17
    found = analyze(
        hover.PROPELLER, rpm=4200, density=hover.DENSITY, observers=arc(1.905, [-45.0])
    ).to_dict()["observers"][0]["spl_bpf_db"]
    (row,) = (row for row in table if (row["rpm"], row["elevation, deg"]) == ("4200", "-45.0"))
    assert float(row["computed, dB"]) == pytest.approx(found, abs=0.006)
    assert row["thesis: size of error, dB"] == "1.82"
    assert (tmp_path / "directivity.png").read_bytes()[16:20] == (1200).to_bytes(4, "big")


def test_loads_that_need_no_scaling_keep_their_tone(import_study):
    hover = import_study("hover_noise")
    found = analyze(hover.PROPELLER, rpm=4200, density=hover.DENSITY, observers=arc(1.905, [-45.0]))
    (same,) = hover.scaled_tone(found, 1.0, 1.0)
    assert same == pytest.approx(found.to_dict()["observers"][0]["spl_bpf_db"], abs=1e-9)
