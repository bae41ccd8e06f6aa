"""Broadband noise of APC-SF 11x4.7 hovering at 4200 rpm, against the anechoic chamber.

Measured by Zawodny, Boyd and Burley (AHS Forum 72, 2016), rotor broadband alone. Loads and strips
are those of `analyze`, nothing is tuned. The density is that at which the thrusts of the test are
those of the wind tunnel. Where nothing else is said, the boundary layers are the report's fits.
"""

from __future__ import annotations

import csv
import dataclasses

import numpy as np
import pytest

from propmdao.acoustics.broadband.rotor import rotor_self_noise
from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.decibels import level_db
from propmdao.analysis.self_noise import BANDS_HZ, strip_flow
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.air import Air
from propmdao.records.fidelity import Fidelity
from propmdao.records.models import SelfNoiseModel
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S

DENSITY, RPM, DISTANCE = 1.18, 4200.0, 1.905
ELEVATIONS = (-45.0, -22.5)
OBSERVERS = arc(DISTANCE, ELEVATIONS)
HEARD: dict = {"broadband": True, "observers": OBSERVERS}
STATE = RotorState(RPM * RAD_PER_S, 0.0, Air(density=DENSITY))
BANDS = third_octave_centers(500, 10e3)


@pytest.fixture(scope="module")
def hover():
    propeller = load_propeller("apcsf_11x4.7_uiuc")
    return analyze(propeller, rpm=RPM, density=DENSITY, layers="bpm", **HEARD)


@pytest.fixture(scope="module")
def strips(hover):
    propeller = load_propeller("apcsf_11x4.7_uiuc")
    section_radii = strip_interpolation(propeller.r_over_R, Fidelity().n_spanwise)
    steady, states = hover.loads, hover.loads.sections
    flow = steady.strips, states.relative_speed, states.lift_coefficient
    return strip_flow(*flow, Blade.from_propeller(propeller), section_radii)


@pytest.fixture(scope="module")
def measured(reference_data):
    """Level in each band by elevation."""
    path = reference_data / "acoustics" / "apc_sf_11x4.7_broadband_third_octave_exp.csv"
    with open(path) as file:
        rows = [row for row in csv.DictReader(file) if row["rpm"] == "4200"]
    return np.array(
        [
            [
                float(row["spl_third_octave_dB"])
                for row in rows
                if float(row["elevation_deg"]) == elevation
                and 490 < float(row["band_center_hz"]) < 10100
            ]
            for elevation in ELEVATIONS
        ]
    )


def test_third_octaves_with_the_thrust_of_the_wind_tunnel(measured):
    # One twist offset, fitted to the wind tunnel's static thrust and to no noise.
    turned = analyze(
        load_propeller("apcsf_11x4.7_uiuc"), rpm=RPM, density=DENSITY, layers="bpm",
        twist_offset_deg=2.25, **HEARD,
    )  # fmt: skip
    assert 0.97 < float(turned.loads.thrust) / 4.037 < 1.02
    heard = np.asarray(level_db(turned.broadband.total))
    low, high = np.searchsorted(BANDS_HZ, (490, 10100))
    found = error(heard[:, low:high], measured)
    assert 1.3 < found[0] < 2.0
    assert 3.2 < found[1] < 3.9


def of_strips(strips, angle=0.0, trip="none"):
    """Levels with every angle from zero lift changed by so much [rad]."""
    section = strips.section
    section = dataclasses.replace(section, angle_of_attack=section.angle_of_attack + angle)
    strips = dataclasses.replace(strips, section=section)
    heard = rotor_self_noise(strips, 2, STATE, OBSERVERS, BANDS, SelfNoiseModel(trip))
    return np.asarray(level_db(heard.total))


def error(level, measured):
    """Mean absolute error at each microphone [dB]."""
    return np.abs(level - measured).mean(axis=1)


def test_thrust(hover):
    assert 0.84 < float(hover.loads.thrust) / 4.037 < 0.88


def test_third_octaves_from_500_hz_to_10_khz(hover, measured, drawn):
    heard = np.asarray(level_db(hover.broadband.total))
    low, high = np.searchsorted(BANDS_HZ, (490, 10100))
    found = error(heard[:, low:high], measured)
    for elevation, ours, theirs in zip(ELEVATIONS, heard[:, low:high], measured, strict=True):
        drawn(
            f"third octaves at {elevation:g} deg", ("frequency, Hz", "dB re 20 µPa"),
            BANDS_HZ[low:high], {"propmdao": ours}, {"anechoic chamber": theirs}, log=True,
        )  # fmt: skip
    assert 3.3 < found[0] < 3.9
    assert 4.4 < found[1] < 5.0


def test_level_together_is_within_two_decibels(hover, measured):
    low, high = np.searchsorted(BANDS_HZ, (490, 10100))
    heard = 10 * np.log10(np.asarray(hover.broadband.total)[:, low:high].sum(axis=1) / 4e-10)
    off = heard - 10 * np.log10(np.sum(10 ** (measured / 10), axis=1))
    assert np.all(np.abs(off) < 2.0)


@pytest.mark.slow
def test_tripped_boundary_layers_make_up_for_missing_thrust(strips, measured):
    # Nobody tripped the blades; tripped ones would be louder where the measured thrust is met.
    found = error(of_strips(strips, trip="heavy"), measured)
    assert 2.6 < found[0] < 3.2
    assert 4.5 < found[1] < 5.3


@pytest.mark.slow
@pytest.mark.parametrize(("degrees", "low", "high"), [(-1.0, -2.9, -1.8), (1.0, 2.0, 3.2)])
def test_a_degree_of_angle_from_zero_lift_is_worth_two_and_a_half_decibels(
    strips, degrees, low, high
):
    # Below 4 kHz the report's noise of separation dominates: its angles are those of a symmetric
    # section, and the inner half of the blade is beyond its stall.
    change = of_strips(strips, np.radians(degrees)) - of_strips(strips)
    assert np.all((low < change.mean(axis=1)) & (change.mean(axis=1) < high))


@pytest.mark.slow
def test_geometric_angle_from_zero_lift_is_too_loud(hover, strips, measured):
    # Where boundary layers take lift away, the angle at which a thin section of the same camber
    # would stand is larger than that at which it has the lift.
    steady = hover.loads
    geometric = steady.sections.angle_of_attack - steady.strips.zero_lift_angle
    angle = np.asarray(geometric - strips.section.angle_of_attack)
    assert angle.mean() > np.radians(1.0)
    found = error(of_strips(strips, angle), measured)
    assert 5.6 < found[0] < 6.5
    assert 5.3 < found[1] < 6.1


def test_layers_of_the_sections_leave_the_low_bands_silent(measured):
    # By the maker's geometry. Above 3 kHz the sections' own layers are no worse than the fits;
    # below 2 kHz no mechanism of a trailing edge is left: the fits have some there because a NACA
    # 0012 would have stalled at the lift of the inner sections.
    low, high = np.searchsorted(BANDS_HZ, (490, 10100))
    off = {}
    for layers in ("sections", "bpm"):
        maker = load_propeller("apcsf_11x4.7")
        heard = analyze(maker, rpm=RPM, density=DENSITY, layers=layers, **HEARD)
        off[layers] = np.asarray(level_db(heard.broadband.total))[:, low:high] - measured
    above = {layers: np.abs(d[:, 8:]).mean(axis=1) for layers, d in off.items()}
    assert np.all(above["sections"] < above["bpm"] + 0.2)
    assert 2.2 < above["sections"][0] < 2.8
    assert 4.5 < above["sections"][1] < 5.1
    every = np.abs(off["sections"]).mean(axis=1)
    assert 11.0 < every[0] < 11.8
    assert 12.2 < every[1] < 13.0


@pytest.mark.parametrize(("rpm", "low", "high"), [(3600.0, 3.6, 4.3), (4800.0, 2.9, 3.6)])
def test_third_octaves_at_speeds_that_nobody_had_looked_at(reference_data, drawn, rpm, low, high):
    # Everything that was heard 45 deg below the plane, above the motor's range, 3 to 20 kHz; by the
    # maker's geometry with the default model. Found in one run, after the model stood.
    path = reference_data / "acoustics" / "apc_sf_11x4.7_third_octave_-45deg_exp.csv"
    with open(path) as file:
        rows = [row for row in csv.DictReader(file) if float(row["rpm"]) == rpm]
    bands = {float(row["band_center_hz"]): float(row["spl_third_octave_dB"]) for row in rows}
    chamber = {f: level for f, level in bands.items() if 3000.0 < f < 20500.0}
    asked: dict = {"density": DENSITY, "broadband": True, "observers": arc(DISTANCE, [-45.0])}
    heard = analyze(load_propeller("apcsf_11x4.7"), rpm=rpm, **asked)
    first = int(np.argmin(np.abs(np.log(BANDS_HZ / min(chamber)))))
    ours = np.asarray(level_db(heard.broadband.total))[0, first : first + len(chamber)]
    theirs = np.array(list(chamber.values()))
    drawn(
        f"all that is heard at {rpm:g} rpm", ("frequency, Hz", "dB re 20 µPa"),
        BANDS_HZ[first : first + len(chamber)], {"propmdao": ours}, {"anechoic chamber": theirs},
        log=True,
    )  # fmt: skip
    assert low < np.abs(ours - theirs).mean() < high
