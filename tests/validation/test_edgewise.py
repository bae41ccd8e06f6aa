"""Thrust of a small propeller in oblique and edgewise flow against the wind tunnel.

APC 8x4.5MR at 10 m/s (B. Davoudi, AIAA 2019; University of Michigan), by the maker's table as it
is listed, sweep included, with TWIST as the blade angle. The errors are sums of |T - T measured|
over sums of measured thrust for advance ratios V sin(i) / (Omega R) up to 0.31, each held from both
sides. Aimed at: 4 % edgewise, 8 % at 60 deg. The second is missed by what the same blade has too
much in hover, where wake and angles play no part; without its sweep hover is 3 % lower, and the two
are 1.8 and 6.1 %; by the blade angle of the chord line they are 2.8 and 9.0 %.
"""

import csv
import dataclasses

import numpy as np
import pytest

from propmdao.aerodynamics.solutions.result import failure
from propmdao.analysis.single_point import analyze
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity

pytestmark = [
    pytest.mark.validation,
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore::UserWarning"),  # low Reynolds numbers, fast edgewise flight
]

SPEED = 10.0
COARSE = Fidelity(n_chordwise=4, n_spanwise=16, n_contour=9, n_surface_span=4)
WITHIN = 0.5  # per cent
INCH = 0.0254


@pytest.fixture(scope="module")
def blade(reference_data):
    """The propeller of the maker's table: rows of 13 numbers, inches and degrees."""
    rows = []
    for line in (reference_data / "apc_pe0" / "8x45MR-PERF.PE0").read_text().splitlines():
        words = line.split()
        if len(words) == 13 and all(word.replace(".", "").lstrip("-").isdigit() for word in words):
            rows.append([float(word) for word in words])
    table = np.array(rows)
    radius, chord, leading_edge, thickness, twist = table[:, [0, 1, 5, 6, 7]].T
    tip = radius[-1]
    return Propeller(
        name="apc_8x4.5mr",
        diameter=2.0 * tip * INCH,
        n_blades=2,
        r_over_R=radius / tip,
        c_over_R=chord / tip,
        beta_deg=twist,
        airfoils=[(2.28 / tip, "e63"), (3.72 / tip, "naca4412")],
        thickness_over_chord=thickness,
        sweep_over_R=(0.25 * chord - leading_edge) / tip,
    )


def measured(reference_data, incidence_deg):
    """Rotation speeds [rev/min] and thrusts [N] of the curve over rotation speed."""
    with open(reference_data / "edgewise" / "apc_8x4.5mr_thrust.csv", newline="") as file:
        rows = [
            row
            for row in csv.DictReader(file)
            if float(row["incidence_deg"]) == incidence_deg
            and float(row["speed_m_s"]) == SPEED
            and row["figure"] == "thrust over rpm"
        ]
    return np.array([[float(row["rpm"]), float(row["thrust_n"])] for row in rows]).T


@pytest.mark.parametrize(("incidence_deg", "error"), [(90.0, 2.5), (60.0, 8.5)])
def test_thrust_at_an_incidence(reference_data, blade, incidence_deg, error, drawn):
    rpm, thrust = measured(reference_data, incidence_deg)
    edgewise = SPEED * np.sin(np.radians(incidence_deg))
    slow = edgewise / (rpm * np.pi / 30 * 0.5 * blade.diameter) < 0.31
    found = [
        analyze(blade, rpm=n, speed=SPEED, incidence_deg=incidence_deg, fidelity=COARSE).loads
        for n in rpm[slow]
    ]
    assert all(loads.converged for loads in found)
    computed = np.array([float(loads.thrust) for loads in found])
    drawn(
        f"incidence {incidence_deg:g} deg", ("rotation speed, rpm", "thrust, N"), rpm[slow],
        {"propmdao": computed}, {"wind tunnel": thrust[slow]},
    )  # fmt: skip
    relative = 100.0 * np.abs(computed - thrust[slow]).sum() / thrust[slow].sum()
    assert relative == pytest.approx(error, abs=WITHIN)


@pytest.mark.parametrize("rpm", [276.0, 1739.0])
def test_even_beyond_what_a_propeller_does_there_is_a_solution(blade, rpm):
    # Advance ratios of 3.4 and 0.54: the air comes from behind over most of the retreating side.
    analysis = analyze(blade, rpm=rpm, speed=SPEED, incidence_deg=90.0, fidelity=COARSE)
    assert analysis.loads.converged and analysis.loads.thrust > 0.0


@pytest.mark.parametrize("n_azimuths", [36, 48])
def test_every_advance_ratio_up_to_a_half_has_a_solution(blade, n_azimuths):
    fidelity = dataclasses.replace(COARSE, n_azimuths=n_azimuths)
    failed, rpm = [], 8000.0
    tip_speed = rpm * np.pi / 30 * 0.5 * blade.diameter
    for ratio in (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5):
        speed = ratio * tip_speed
        analysis = analyze(blade, rpm=rpm, speed=speed, incidence_deg=90.0, fidelity=fidelity)
        if not analysis.loads.converged:
            failed.append((ratio, failure(analysis.loads)))
    assert not failed
