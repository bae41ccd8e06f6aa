"""Broadband noise of an analysed propeller: what the strips hand over, and the levels reported."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from shared_mesh import COARSE

from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.weighting import a_weighting
from propmdao.analysis.self_noise import BANDS_HZ, strip_flow
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.geometry.trailing_edge import trailing_edge
from propmdao.propeller.description import Propeller
from propmdao.records.quantities import BROADBAND_LEVELS, LEVELS

PROPELLER = load_propeller("apcsf_11x4.7_uiuc")
OBSERVERS = arc([1.905, 3.81], -45.0)
RADII = strip_interpolation(PROPELLER.r_over_R, COARSE.n_spanwise)
MECHANISMS = [field.name for field in dataclasses.fields(SelfNoise)]
BLADE = Blade.from_propeller(PROPELLER)


def run(rpm, speed=5.0):
    return analyze(
        PROPELLER, rpm=rpm, speed=speed, broadband=True, observers=OBSERVERS, fidelity=COARSE
    )


@pytest.fixture(scope="module")
def cruise():
    return run(4200.0)


@pytest.fixture(scope="module")
def strips(cruise):
    states = cruise.loads.sections
    flow = states.relative_speed, states.lift_coefficient
    return strip_flow(cruise.loads.strips, *flow, BLADE, RADII)


@pytest.fixture(scope="module")
def observer(cruise):
    return cruise.to_dict()["observers"][0]


def energy(levels):
    return np.sum(10 ** (np.asarray(levels) / 10))


def column(rows, key):
    return np.array([row[key] for row in rows])


def test_positions_lie_on_the_trailing_edge(cruise, strips):
    # Three quarters of a chord behind the quarter line, downstream of it, within the blade.
    behind = strips.position - cruise.loads.strips.quarter_chord
    chord = np.asarray(strips.section.chord)
    assert_allclose(np.linalg.norm(behind, axis=1), 0.75 * chord, rtol=1e-12)
    assert np.all(np.asarray(behind)[:, 1:] < 0)  # the blade turns toward +y, lift toward +z
    radius = np.hypot(*np.asarray(strips.position).T[:2])
    assert np.all(np.diff(radius) > 0)
    assert radius[0] > PROPELLER.r_over_R[0] * float(BLADE.radius)


def test_directions_are_a_right_angle_and_their_normal_is_up(strips):
    c, s = np.asarray(strips.chord_direction), np.asarray(strips.span_direction)
    for unit in (c, s):
        assert_allclose(np.linalg.norm(unit, axis=1), 1.0, rtol=1e-12)
    assert_allclose(np.sum(c * s, axis=1), 0.0, atol=1e-12)
    assert np.all(s[:, 0] > 0.95)  # outward
    assert np.all(np.cross(c, s)[:, 2] > 0.8)  # c is backward: toward -y


def test_sections_are_those_of_the_lattice(cruise, strips):
    section, states = strips.section, cruise.loads.sections
    assert_allclose(section.angle_of_attack, states.lift_coefficient / (2 * np.pi))
    assert_allclose(section.speed, states.relative_speed)
    blunt, angle = trailing_edge(BLADE, RADII)
    assert_allclose(section.trailing_edge_thickness, np.asarray(blunt) * section.chord)
    assert_allclose(section.trailing_edge_angle, angle)
    span = (1 - PROPELLER.r_over_R[0]) * float(BLADE.radius)
    assert float(section.span.sum()) == pytest.approx(span, rel=0.02)


def test_lift_of_the_strips_is_the_thrust(cruise, strips):
    # The angle carries the loads: what follows from it is the thrust, but for inflow and drag.
    section = strips.section
    lift = np.pi * 1.225 * section.speed**2 * section.chord * section.angle_of_attack
    thrust = PROPELLER.n_blades * float(np.sum(lift * section.span))
    assert thrust == pytest.approx(float(cruise.loads.thrust), rel=0.1)


def test_every_mechanism_is_reported_in_every_band(observer):
    assert_allclose(column(observer["broadband"], "frequency_hz"), BANDS_HZ)
    keys = {f"{name}_db" for name in MECHANISMS} | {"frequency_hz", "spl_db"}
    assert all(set(row) == keys for row in observer["broadband"])


def test_energies_of_mechanisms_add_up_to_the_broadband_level(observer):
    for row in observer["broadband"]:
        parts = [row[f"{name}_db"] for name in MECHANISMS]
        assert 10 * np.log10(energy(parts)) == pytest.approx(row["spl_db"], abs=1e-6)
    together = 10 * np.log10(energy(column(observer["broadband"], "spl_db")))
    assert together == pytest.approx(observer["oaspl_broadband_db"], abs=1e-6)


def test_a_weighted_levels_of_mechanisms_add_up(observer):
    assert list(observer["broadband_dba"]) == MECHANISMS
    together = 10 * np.log10(energy(list(observer["broadband_dba"].values())))
    assert together == pytest.approx(observer["oaspl_broadband_dba"], abs=1e-6)
    loudest = max(observer["broadband_dba"], key=observer["broadband_dba"].get)
    assert loudest == "suction_side"


def test_sections_outside_of_the_measurements_are_told(cruise, strips):
    found = cruise.to_dict()["broadband_range"]
    section = strips.section
    reynolds = np.asarray(section.speed * section.chord) * 1.225 / 1.789e-5
    assert found["reynolds"]["least"] == pytest.approx(reynolds.min())
    assert found["reynolds"]["largest"] == pytest.approx(reynolds.max())
    low = np.asarray(section.span)[reynolds < 5.5e4].sum() / float(section.span.sum())
    assert 0.1 < low < 0.9
    assert found["reynolds"]["outside"] == pytest.approx(low)
    assert found["mach"]["outside"] == found["angle_deg"]["outside"] == 0.0
    assert found["mach"]["largest"] == pytest.approx(float(section.speed.max()) / 340.294)


def test_third_octaves_hold_tones_and_broadband_noise(cruise, observer):
    level = 10 * np.log10(energy(column(observer["third_octave"], "spl_db")))
    assert level == pytest.approx(observer["oaspl_total_db"], abs=1e-6)
    tones = energy(column(observer["harmonics"], "spl_db"))
    noise = energy(column(observer["broadband"], "spl_db"))
    assert 10 * np.log10(tones) == pytest.approx(observer["oaspl_db"], abs=1e-6)
    assert 10 * np.log10(tones + noise) == pytest.approx(observer["oaspl_total_db"], abs=1e-6)
    # Without tones a band is the noise alone.
    passage = observer["harmonics"][0]["frequency_hz"]
    bands = {round(row["frequency_hz"]): row["spl_db"] for row in observer["third_octave"]}
    for row in observer["broadband"]:
        if row["frequency_hz"] < 0.8 * passage or row["frequency_hz"] > 6 * passage:
            assert bands[round(row["frequency_hz"])] == pytest.approx(row["spl_db"], abs=1e-9)


def test_a_weighted_levels_are_of_the_tones_of_the_noise_and_of_both(observer):
    tones, noise = observer["harmonics"], observer["broadband"]
    for rows, name in ((tones, ""), (noise, "broadband_"), ([*tones, *noise], "total_")):
        weight = 20 * np.log10(np.asarray(a_weighting(column(rows, "frequency_hz"))))
        level = 10 * np.log10(energy(column(rows, "spl_db") + weight))
        assert level == pytest.approx(observer[f"oaspl_{name}dba"], abs=1e-6)


def test_level_falls_by_six_decibels_where_the_distance_doubles(cruise):
    near, far = (one["oaspl_broadband_db"] for one in cruise.to_dict()["observers"])
    assert near - far == pytest.approx(20 * np.log10(2), abs=0.15)


def test_tones_are_the_same_with_and_without(cruise):
    alone = analyze(PROPELLER, rpm=4200.0, speed=5.0, observers=OBSERVERS, fidelity=COARSE)
    assert alone.broadband is None
    assert "broadband" not in alone.to_dict()["observers"][0]
    assert_allclose(alone.tones.total, cruise.tones.total, rtol=1e-9)


def test_standing_still_is_silence():
    still = run(0.0, speed=0.0).to_dict()["observers"][0]
    for key in (*LEVELS, *BROADBAND_LEVELS):
        assert still[key] == pytest.approx(-200.0, abs=1e-3)
    assert_allclose(column(still["third_octave"], "spl_db"), -200.0, atol=1e-3)


def test_noise_rises_with_about_the_fifth_power_of_speed(cruise):
    # At the same advance ratio; mean squares of turbulent trailing edges go with U^5.
    faster = run(1.2 * 4200.0, 1.2 * 5.0).to_dict()["observers"][0]["oaspl_broadband_db"]
    slower = cruise.to_dict()["observers"][0]["oaspl_broadband_db"]
    assert 4.0 < (faster - slower) / (10 * np.log10(1.2)) < 6.0


def test_a_root_as_thick_as_half_its_chord_is_finite():
    """The angle of its trailing edge, 61 deg, is far beyond the report's formulas of bluntness."""

    def level(root):
        thickness = np.array([root, 0.20, 0.12, 0.10])
        blade = Propeller(
            name="thick root",
            diameter=0.30,
            n_blades=2,
            r_over_R=np.array([0.15, 0.30, 0.60, 1.0]),
            c_over_R=np.array([0.12, 0.20, 0.18, 0.05]),
            beta_deg=np.array([30.0, 22.0, 14.0, 9.0]),
            airfoils=[(0.15, "naca4412")],
            thickness_over_chord=thickness,
        )
        with pytest.warns(UserWarning, match="outside the polars"):
            result = analyze(
                blade, rpm=5000.0, broadband=True, observers=arc(1.9, -45.0), fidelity=COARSE
            )
        return result.to_dict()["observers"][0]["oaspl_broadband_db"]

    thin, thick = level(0.45), level(0.50)
    assert thick == pytest.approx(56.0, abs=0.5)
    assert thick == pytest.approx(thin, abs=0.05)
