"""The page of an analysis: its numbers, its figures and its sounds are those of the analysis."""

from __future__ import annotations

import dataclasses
import io

import numpy as np
import pytest
import soundfile

pytest.importorskip("jinja2")
pytest.importorskip("plotly")

from propmdao.figures.pages import tables
from propmdao.figures.pages.analysis_page import analysis_page
from propmdao.figures.pages.parts import Figure, Player, Table
from propmdao.figures.pages.rendering import html


def parts(page, kind):
    return [part for section in page.sections for part in section.parts if isinstance(part, kind)]


def figure(page, title):
    (found,) = (part for part in parts(page, Figure) if part.title.startswith(title))
    return found


def test_sections_and_first_numbers(page, hostile_analysis):
    assert [section.heading for section in page.sections] == ["Noise", "Loads", "Blades", "Inputs"]
    assert page.numbers["rotation speed"] == "4200.0 rpm"
    assert page.numbers["thrust"] == f"{float(hostile_analysis.loads.thrust):.4f} N"
    loudest = max(o["oaspl_total_dba"] for o in hostile_analysis.to_dict()["observers"])
    assert page.numbers["loudest observer"] == f"{loudest:.1f} dBA"
    assert "figure of merit" in page.numbers and "efficiency" not in page.numbers  # hover
    assert page.doubts == []


def test_sounds_have_the_level_of_their_observer(page, hostile_analysis):
    observers = hostile_analysis.to_dict()["observers"]
    players = parts(page, Player)
    assert len(players) == 3
    for player in players:
        number = int(player.label.split(":")[0].removeprefix("observer "))
        full_scale = float(player.detail.rpartition("full scale ")[2].removesuffix(" Pa"))
        samples, rate = soundfile.read(io.BytesIO(player.flac))
        assert rate == 48000
        # Tones and the bands that are heard, rounded to 16 bits.
        level = 20.0 * np.log10(full_scale * np.sqrt(np.mean(samples**2)) / 2e-5)
        assert level == pytest.approx(observers[number - 1]["oaspl_total_db"], abs=0.3)


def test_spectra_are_those_of_the_observers(page, hostile_analysis):
    observers = hostile_analysis.to_dict()["observers"]
    panels = figure(page, "Spectrum").panels
    assert [place.split(":")[0] for place in panels][0] == "observer 2"  # of the loudest tones
    for place, (tones, bands, _) in panels.items():
        heard = observers[int(place.split(":")[0].removeprefix("observer ")) - 1]
        (total,) = (t for t in tones.data if t.get("name") == "total" and "marker" in t)
        drawn = [tone["spl_db"] for tone in heard["harmonics"]][: len(total["y"])]
        np.testing.assert_allclose(total["y"], drawn, rtol=1e-5)
        (tip,) = (trace for trace in bands.data if trace["name"] == "suction side")
        known = [band["suction_side_db"] for band in heard["broadband"]]
        bottom = bands.layout["yaxis"]["range"][0]
        for level, of_analysis in zip(tip["y"], known, strict=True):
            assert of_analysis <= bottom if level is None else abs(level - of_analysis) < 1e-3


def test_directions_and_loads_are_those_of_the_analysis(page, hostile_analysis):
    (arc,) = figure(page, "Level over direction").panels["dBA re 20 µPa"]
    (total,) = (trace for trace in arc.data if trace["name"] == "total")
    observers = hostile_analysis.to_dict()["observers"]
    assert total["theta"] == [-45.0, 0.0, 45.0]
    np.testing.assert_allclose(total["r"], [o["oaspl_total_dba"] for o in observers], rtol=1e-5)
    (panels,) = figure(page, "Loads over span").panels.values()
    (thrust,) = (panel for panel in panels if panel.label == "thrust over span, N/m")
    strips = hostile_analysis.loads.strips
    total_thrust = np.sum(np.array(thrust.data[0]["y"]) * np.asarray(strips.width))
    assert 2.0 * total_thrust == pytest.approx(float(hostile_analysis.loads.thrust), rel=1e-4)


def test_the_blade_in_space_has_one_scale_and_its_size(page):
    (space,) = figure(page, "Blades in space").panels["all"]
    x = np.concatenate([np.ravel(trace["x"]) for trace in space.data])
    y = np.concatenate([np.ravel(trace["y"]) for trace in space.data])
    assert len(space.data) == 2
    assert np.hypot(x, y).max() == pytest.approx(139.7, abs=0.5)  # mm, half of 11 inch
    scene = space.layout["scene"]
    scales = [scene["aspectratio"][axis] / np.ptp(scene[f"{axis}axis"]["range"]) for axis in "xyz"]
    np.testing.assert_allclose(scales, scales[0])


def test_inputs_have_meaning_and_unit(page):
    (inputs,) = (table for table in parts(page, Table) if table.caption == "Inputs")
    assert ["rotation speed", "4200", "rpm"] in inputs.rows
    assert ["density of the air", "1.225", "kg/m³"] in inputs.rows
    assert ["lattice held to the polars of the sections", "yes", ""] in inputs.rows
    assert ["fidelity n spanwise", "8", ""] in inputs.rows


def test_a_band_has_both_ends_of_every_input_and_what_is_left_out():
    effect = {"name": "blade angle", "unit": "deg", "ends": [-1.0, 1.0], "left_out": None}
    effect["changes"] = [{"thrust": -0.1, "spl_bpf_db": [-0.5, -0.6]}, None]
    band = {"above": {"thrust": 0.0, "spl_bpf_db": [0.0, 0.0]}, "below": effect["changes"][0]}
    observers = [{"spl_bpf_db": 40.0}, {"spl_bpf_db": 50.0}]
    table = tables.band(
        {"thrust": 2.0, "observers": observers, "band": band | {"effects": [effect]}}
    )
    assert table.head == ["", "value", "blade angle -1 to 1 deg", "band"]
    assert table.rows == [
        ["thrust, N", "2.0000", "- / -0.1000", "+0.0000 / -0.1000"],
        ["tone at blade passage, observer 1, dB", "40.00", "- / -0.50", "+0.00 / -0.50"],
        ["tone at blade passage, observer 2, dB", "50.00", "- / -0.60", "+0.00 / -0.60"],
    ]


def test_silence_is_a_page_too(hostile_analysis, origin):
    tones = hostile_analysis.tones
    quiet = dataclasses.replace(
        hostile_analysis,
        tones=type(tones)(tones.frequency_hz, {k: 1e-17 * p for k, p in tones.parts.items()}),
        broadband=None,
    )
    page = analysis_page(quiet, quiet.to_dict(), origin, 0.5)
    assert page.numbers["loudest observer, tones"] == "silent"
    (stems, pressure) = figure(page, "Spectrum").panels["observer 2: elevation 0°, 1.905 m"]
    assert not any(trace["y"] for trace in stems.data) and pressure.data == []
    assert len(parts(page, Player)) == 3 and len(html(page)) > 1e6
