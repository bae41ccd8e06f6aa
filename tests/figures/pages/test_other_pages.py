"""Pages of comparisons, sweeps, flyovers and optimisations: what they show is what was found."""

from __future__ import annotations

import io

import numpy as np
import pytest
import soundfile

pytest.importorskip("jinja2")
pytest.importorskip("plotly")

import propmdao as pm
from propmdao.acoustics.kinematics.tracks import Sight
from propmdao.analysis.flights.flyover_results import Flight, Flyover
from propmdao.analysis.request import Request
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.pages.comparison_page import comparison_page
from propmdao.figures.pages.design_page import design_page, search_section
from propmdao.figures.pages.flyover_page import flyover_page
from propmdao.figures.pages.parts import Figure, Player, Table
from propmdao.figures.pages.rendering import html
from propmdao.figures.pages.sweep_page import sweep_page
from propmdao.propeller.changes import Change


def parts(page, kind):
    return [part for section in page.sections for part in section.parts if isinstance(part, kind)]


def headings(page):
    return [section.heading for section in page.sections]


@pytest.fixture(scope="module")
def two(hostile_analysis):
    """The blade, and the same with more twist."""
    other = pm.analyze(
        hostile_analysis.propeller,
        hostile_analysis.point,
        change=Change(twist_offset_deg=2.0),
        model=hostile_analysis.model,
        listening=hostile_analysis.listening,
    )
    return {hostile_analysis.propeller.name: hostile_analysis, "steep": other}


def test_a_comparison_has_numbers_changes_and_sounds_of_one_full_scale(two, origin):
    page = comparison_page(two, 1, origin, 0.5)
    assert headings(page) == ["Numbers", "Noise", "Loads", "Blades", "Inputs"]
    first, other = two.values()
    (numbers,) = page.sections[0].parts
    row = next(row for row in numbers.rows if row[0] == "thrust, N")
    thrust, thrust_of_other = (float(a.loads.thrust) for a in (first, other))
    assert row[1:] == [
        f"{thrust:.4f}", f"{thrust_of_other:.4f}", f"{thrust_of_other - thrust:+.4f}"
    ]  # fmt: skip
    scales = {p.detail.rpartition("full scale ")[2] for p in parts(page, Player)}
    rms = [np.std(soundfile.read(io.BytesIO(p.flac))[0]) for p in parts(page, Player)]
    assert len(scales) == 1 and len(rms) == 2
    levels = [a.to_dict()["observers"][1]["oaspl_total_db"] for a in two.values()]
    assert 20.0 * np.log10(rms[1] / rms[0]) == pytest.approx(levels[1] - levels[0], abs=0.3)
    assert len(html(page)) < 5e6


def test_a_comparison_that_nobody_hears_has_no_noise(two, origin):
    page = comparison_page(two, None, origin, 0.5)
    assert "Noise" not in headings(page) and parts(page, Player) == []


def test_the_page_of_a_design_has_its_search(two, origin):
    objective, violation = [50.0, np.nan, 47.0, 46.0], [0.0, np.inf, 0.0, 0.2]
    search = search_section(objective, violation, "tones, dB", 1e-4)
    page = design_page([two, two], [1, 1], search, origin)
    assert page.title.startswith("steep, from ")
    assert "Search" in headings(page) and search.notes == [
        "4 designs were evaluated, 1 of them failed."
    ]
    (history,) = search.parts
    (found, missed) = history.panels["all"]
    dots, best = found.data
    assert dots["y"] == [50.0, None, 47.0, 46.0]
    assert best["y"] == [50.0, 50.0, 47.0, 47.0]  # the last one misses a limit
    assert missed.data[0]["y"] == [1e-7, None, 1e-7, 0.2]
    # Sounds of five seconds each would be the most of the page.
    assert len(parts(page, Player)) == 4 and len(html(page)) < 5e6


def test_a_sweep_over_two_variables_is_lines_or_a_map(origin):
    propeller = pm.load_propeller("apcsf_11x4.7")
    results = {"thrust": 2.0, "shaft_power": 5.0, "CT": 0.1, "CP": 0.05, "figure_of_merit": 0.5}
    rows = [
        {"rpm": str(rpm), "speed": str(speed), "eta": str(0.1 * speed - 0.2), "J": "0.1"}
        | {name: str(value) for name, value in results.items()}
        | {"oaspl_dba@1m-45deg": str(50.0 + rpm / 1000.0), "oaspl_db@1m-45deg": "60.0"}
        for rpm in (3000.0, 4000.0, 5000.0)
        for speed in np.arange(6.0)
    ]
    asked = Request.of(rpm=0.0).to_dict()
    asked = {name: asked[name] for name in ("model", "listening")}
    maps = sweep_page(propeller, rows[:-1], ("rpm", "speed"), asked, ["too <fast>"], origin)
    assert maps.numbers == {"points": "18", "analysed": "17", "failed": "1"}
    assert maps.doubts == ["Failed: too <fast>"]
    first, heard = parts(maps, Figure)[:2]
    (eta,) = (panel for panel in first.panels["all"] if panel.label == "efficiency")
    assert eta.data[0]["z"][-1] == [0.3, 0.3, None]  # the point that has failed
    assert eta.data[0]["z"][0] == [0.0, 0.0, 0.0]  # a brake
    assert [panel.label for panel in heard.panels["1m-45deg"]] == ["tones, dBA", "tones, dB"]
    lines = sweep_page(propeller, rows, ("speed", "rpm"), asked, [], origin)
    (eta,) = (p for p in parts(lines, Figure)[0].panels["all"] if p.label == "efficiency")
    assert [trace["name"] for trace in eta.data] == [
        f"rotation speed, rpm: {rpm}" for rpm in (3000, 4000, 5000)
    ]
    np.testing.assert_allclose(eta.data[0]["y"], 0.1 * np.arange(6.0) - 0.2)
    (points,) = (table for table in parts(lines, Table) if table.caption == "Points")
    assert len(points.rows) == 18 and "oaspl dba 1m-45deg, dBA" in points.head
    assert "too &lt;fast&gt;" in html(maps)


def test_a_flyover_is_heard_around_its_loudest_moment(hostile_analysis, origin):
    time = np.arange(-30.0, 30.0, 0.5) + 0.25
    power = 1e-6 / (1.0 + (time - 5.0) ** 2)
    bands = np.zeros((time.size, BANDS_HZ.size))
    bands[:, 13] = power
    sight = Sight(*[time[None]] * 5)
    pressure = np.repeat(np.sqrt(power), 24000) * np.sin(np.arange(time.size * 24000) * 0.13)
    flyover = Flyover(time, {"loading": bands, "total": bands}, sight, pressure)
    result = hostile_analysis.to_dict()
    del result["observers"], result["listening"]
    flight = Flight(20.0, 5.0)
    page = flyover_page(hostile_analysis, flight, flyover, result | flyover.to_dict(), origin)
    (player,) = parts(page, Player)
    assert player.detail.startswith("20.0 s, from -5.2") and not player.repeats
    samples, _ = soundfile.read(io.BytesIO(player.flac))
    assert samples.size == 20 * 48000
    assert np.argmax(np.abs(samples)) == pytest.approx(10.0 * 48000, abs=0.5 * 48000)
    assert page.numbers["loudest"] == f"{flyover.level_dba().max():.1f} dBA"
    assert "beside the track" in page.subtitle and "window.hit" in html(page)
