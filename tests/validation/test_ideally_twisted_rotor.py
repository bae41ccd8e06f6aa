"""Ideally twisted rotor in hover, mechanism by mechanism, against the authors' predictions.

N. S. Pettingill, N. S. Zawodny, C. Thurman, L. V. Lopes, Acoustic and performance characteristics
of an ideally twisted rotor in hover, AIAA 2021-1928: four blades of NACA 0012, chord 0.2 R, twist
6.9 deg / (r/R), R 0.1588 m. Figure 22b: 5465 rpm, an observer at 2.27 m, 35 deg below the rotor,
tripped boundary layers, a trailing edge of 0.8 mm and 16 deg, bands of 20 Hz; read from print
within about 0.5 dB. Their angles are of a blade-element method, ours of the lattice.
"""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

import propmdao as pm
from propmdao.acoustics.broadband.rotor import rotor_self_noise
from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.levels.decibels import level_db
from propmdao.analysis.self_noise import strip_flow
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.air import Air
from propmdao.records.fidelity import Fidelity
from propmdao.records.models import SelfNoiseModel
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S

RADIUS, RPM = 0.1588, 5465.0
BANDS = third_octave_centers(200.0, 60e3)
OBSERVERS = pm.arc(2.27, [-35.0])


@pytest.fixture(scope="module")
def heard():
    """Level of each mechanism in bands of 20 Hz."""
    r = np.array([0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
    rotor = pm.Propeller(
        name="ideally twisted rotor",
        diameter=2 * RADIUS,
        n_blades=4,
        r_over_R=r,
        c_over_R=0.2 + 0 * r,
        beta_deg=6.9 / r,
        thickness_over_chord=0.12 + 0 * r,
        airfoils=[(1.0, "naca0012")],
    )
    loads = pm.analyze(rotor, rpm=RPM, observers=OBSERVERS).loads
    strips = strip_flow(
        loads.strips,
        loads.sections.relative_speed,
        loads.sections.lift_coefficient,
        Blade.from_propeller(rotor),
        strip_interpolation(rotor.r_over_R, Fidelity().n_spanwise),
    )
    edge = dataclasses.replace(
        strips.section,
        trailing_edge_thickness=jnp.asarray(0.8e-3),
        trailing_edge_angle=jnp.asarray(np.radians(16.0)),
    )
    strips = dataclasses.replace(strips, section=edge)
    model = SelfNoiseModel(trip="heavy", tip="square")
    noise = rotor_self_noise(
        strips, 4, RotorState(RPM * RAD_PER_S, 0.0, Air()), OBSERVERS, BANDS, model
    )
    narrow = 20.0 / (BANDS * (10**0.05 - 10**-0.05))
    return {name: np.asarray(level_db(p[0] * narrow)) for name, p in vars(noise).items()}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mechanism", "peak_db", "peak_hz", "low", "high"),
    [
        ("pressure_side", 28.2, 10e3, -0.3, 0.4),
        ("suction_side", 34.4, 5e3, -0.2, 0.5),
        ("separation", 31.6, 5e3, 0.1, 0.9),
        ("bluntness", 35.8, 16e3, 0.3, 1.0),
        ("tip", 17.2, 25e3, -1.0, -0.5),
    ],
)
def test_peaks(heard, mechanism, peak_db, peak_hz, low, high):
    level = heard[mechanism]
    assert low < level.max() - peak_db < high
    # The tip's spectrum is flat: 0.2 dB between neighbours.
    bands_off = 10 * np.log10(BANDS[level.argmax()] / peak_hz)
    assert abs(bands_off) < (1.5 if mechanism == "tip" else 0.5)


@pytest.mark.slow
def test_spectrum_of_the_boundary_layers(heard, drawn):
    read = {
        "pressure_side": (
            [2.5e3, 4e3, 6.3e3, 10e3, 16e3, 25e3, 40e3],
            [17.1, 23.4, 27.0, 28.2, 25.2, 19.2, 10.4],
        ),
        "suction_side": (
            [1.6e3, 2.5e3, 4e3, 6.3e3, 8e3, 12.5e3, 20e3],
            [27.6, 32.1, 34.1, 34.0, 32.3, 27.2, 18.9],
        ),
    }
    for mechanism, (frequency, level) in read.items():
        at = np.abs(np.log(BANDS[:, None] / frequency)).argmin(axis=0)
        drawn(
            mechanism.replace("_", " "), ("frequency, Hz", "dB re 20 µPa, 20 Hz"), frequency,
            {"propmdao": heard[mechanism][at]}, {"Pettingill et al., predicted": level}, log=True,
        )  # fmt: skip
        assert np.abs(heard[mechanism][at] - level).max() < 0.8
