"""Broadband noise of APC-SF 11x4.7 hovering at 4200 rpm, against the anechoic chamber.

Measured by Zawodny, Boyd and Burley (AHS Forum 72, 2016), rotor broadband alone. The flow over the
strips is blade element momentum theory with thin-airfoil lift, without any tuning: it gives the
measured thrust within 2 %, at a density at which the other thrusts of the test agree best.
"""

from __future__ import annotations

import csv
import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest
from scipy.optimize import brentq

from propmdao.acoustics import arc
from propmdao.acoustics.broadband import (
    Section,
    StripFlow,
    band_level_db,
    rotor_self_noise,
    third_octave_centers,
)
from propmdao.geometry.airfoil import CHORD_FRACTION
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.propeller import load_propeller

DENSITY, VISCOSITY, SOUND_SPEED = 1.18, 1.55e-5, 345.0  # about 25 C
OMEGA, N_BLADES = 4200 * np.pi / 30, 2
BANDS = third_octave_centers(500, 10e3)


def zero_lift_angle(camber_line):
    """Thin-airfoil theory, (1 / pi) int dz/dx (1 - cos t) dt."""
    t = np.arccos(1 - 2 * CHORD_FRACTION)
    slope = np.diff(camber_line) / np.diff(CHORD_FRACTION)
    return np.sum(slope * (1 - np.cos((t[1:] + t[:-1]) / 2)) * np.diff(t)) / np.pi


@pytest.fixture(scope="module")
def hover():
    """Strips with momentum inflow, and the thrust of all blades [N]."""
    propeller = load_propeller("apcsf_11x4.7")
    blade, root = Blade.from_propeller(propeller), propeller.r_over_R[0]
    edges = (1 + root) / 2 - (1 - root) / 2 * np.cos(np.linspace(0, np.pi, 25))
    x = (edges[1:] + edges[:-1]) / 2
    at = span_interpolation(propeller.r_over_R, x)
    radius = float(blade.radius)
    r, span = x * radius, np.diff(edges) * radius
    chord, beta = (np.asarray(at.smooth @ q) for q in (blade.chord_over_R * radius, blade.beta))
    camber = np.asarray(at.linear @ (blade.camber_shape * blade.camber_over_chord[:, None]))
    thickness = np.asarray(
        at.linear @ (blade.thickness_shape * blade.thickness_over_chord[:, None])
    )
    zero_lift = np.array([zero_lift_angle(line) for line in camber])

    def flow(i, inflow):
        phi, speed = np.arctan2(inflow, OMEGA * r[i]), np.hypot(inflow, OMEGA * r[i])
        alpha = beta[i] - zero_lift[i] - phi
        lift = 0.5 * DENSITY * speed**2 * chord[i] * 2 * np.pi * np.sin(alpha)
        return alpha, speed, N_BLADES * lift * np.cos(phi), phi

    def imbalance(inflow, i):
        thrust, phi = flow(i, inflow)[2:]
        loss = 2 / np.pi * np.arccos(np.exp(-N_BLADES / 2 * (1 - x[i]) / (x[i] * np.sin(phi))))
        return thrust - 4 * np.pi * r[i] * DENSITY * inflow**2 * loss

    inflow = [brentq(imbalance, 1e-2, 30.0, args=(i,)) for i in range(r.size)]
    alpha, speed, thrust, _ = np.transpose([flow(i, v) for i, v in enumerate(inflow)])
    c = np.stack([0 * r, -np.cos(beta), -np.sin(beta)], axis=-1)
    quarter_chord = np.stack([r, 0 * r, 0 * r], axis=-1)
    near_edge = (thickness[:, -2] - thickness[:, -1]) / (1 - CHORD_FRACTION[-2])
    section = Section(*map(jnp.asarray, (chord, span, speed, alpha)), *map(
        jnp.asarray, (thickness[:, -1] * chord, np.arctan(near_edge))
    ))  # fmt: skip
    strips = StripFlow(
        position=jnp.asarray(quarter_chord + 0.75 * chord[:, None] * c),
        chord_direction=jnp.asarray(c),
        span_direction=jnp.asarray(np.tile([1.0, 0.0, 0.0], (r.size, 1))),
        section=section,
    )
    return strips, float(thrust @ span)


@pytest.fixture(scope="module")
def measured(reference_data):
    """Level in each band by elevation."""
    path = reference_data / "acoustics" / "apc_sf_11x4.7_broadband_third_octave_exp.csv"
    with open(path) as file:
        rows = [row for row in csv.DictReader(file) if row["rpm"] == "4200"]
    return {
        elevation: np.array(
            [
                float(row["spl_third_octave_dB"])
                for row in rows
                if float(row["elevation_deg"]) == elevation
                and 490 < float(row["band_center_hz"]) < 10100
            ]
        )
        for elevation in (-45.0, -22.5)
    }


def predicted(strips, trip="none"):
    observers = arc(1.905, [-45.0, -22.5])
    heard = rotor_self_noise(
        strips, N_BLADES, OMEGA, 0.0, SOUND_SPEED, VISCOSITY, observers, BANDS, trip=trip
    )
    return np.asarray(band_level_db(heard.total))


def test_thrust(hover):
    assert hover[1] == pytest.approx(4.037, rel=0.02)


@pytest.mark.parametrize(
    ("trip", "errors"),
    [
        ("none", [(1.1, 1.9), (2.1, 3.0)]),
        ("heavy", [(2.9, 4.0), (3.3, 4.6)]),
    ],
)
def test_third_octaves_from_500_hz_to_10_khz(hover, measured, trip, errors):
    # Mean absolute error [dB] at -45 and -22.5 deg.
    for level, elevation, (low, high) in zip(
        predicted(hover[0], trip), measured, errors, strict=True
    ):
        assert low < np.abs(level - measured[elevation]).mean() < high


def test_all_rests_on_the_angle_from_zero_lift(hover, measured):
    # The report's noise of separation dominates below 4 kHz, for strips at 9 to 14 deg from zero
    # lift are stalled to it. With three degrees less, the prediction falls by about 5 dB.
    strips = hover[0]
    less = strips.section.angle_of_attack - np.radians(3.0)
    section = dataclasses.replace(strips.section, angle_of_attack=less)
    drop = predicted(strips) - predicted(dataclasses.replace(strips, section=section))
    assert 3.0 < drop[0].mean() < 8.0
