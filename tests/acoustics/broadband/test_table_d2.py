"""Table D2 of NASA RP-1218: what the report's own program prints for an untripped airfoil."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.boundary_layer import boundary_layer
from propmdao.acoustics.broadband.directivity import radiation
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import trailing_edge_noise
from propmdao.acoustics.levels.decibels import level_db
from propmdao.records.air import Air

# only the kinematic viscosity counts
AIR = Air(density=1.0, sound_speed=340.46, dynamic_viscosity=1.4529e-5)
# Hz, dB: pressure side, suction side, separation, laminar shedding, total. Below -100 dB the
# program prints -100.
TABLE = np.array(
    [
        [100.0, 20.654, 28.704, -100.0, -17.142, 29.336],
        [250.0, 34.309, 40.400, -27.506, -1.304, 41.356],
        [500.0, 41.761, 46.859, 17.532, 10.677, 48.034],
        [1000.0, 47.581, 52.106, 38.756, 22.658, 53.568],
        [1600.0, 50.987, 55.368, 46.294, 30.782, 57.106],
        [2000.0, 52.533, 56.907, 49.334, 37.725, 58.817],
        [2500.0, 54.074, 57.750, 51.298, 47.262, 60.167],
        [3150.0, 55.570, 57.500, 50.766, 48.959, 60.496],
        [4000.0, 56.044, 56.082, 47.711, 41.796, 59.455],
        [5000.0, 55.399, 54.541, 44.617, 32.428, 58.208],
        [8000.0, 52.190, 51.253, 36.227, 24.304, 54.821],
        [16000.0, 47.202, 45.851, 11.842, 12.323, 49.591],
        [40000.0, 39.065, 36.522, -62.593, -3.515, 40.987],
    ]
)


@pytest.fixture(scope="module")
def levels():
    section = Section(
        *(jnp.asarray(v) for v in (0.3048, 0.4572, 71.3, np.radians(1.516), 0.0, 0.0))
    )
    layer = boundary_layer(
        section.chord, section.speed, section.angle_of_attack, AIR.kinematic_viscosity
    )
    toward = radiation(0.0, 0.0, 1.22, 71.3 / AIR.sound_speed)
    edge = trailing_edge_noise(TABLE[:, 0], section, layer, toward, AIR)
    return {
        name: np.asarray(level_db(p)) for name, p in (edge._asdict() | {"total": sum(edge)}).items()
    }


@pytest.mark.parametrize(
    ("column", "mechanism", "tolerance_db"),
    [
        (1, "pressure_side", 0.01),
        (2, "suction_side", 0.01),
        (3, "separation", 0.01),
        (4, "laminar_shedding", 0.08),  # 3150 Hz lies on a rounded corner of G1
        (5, "total", 0.01),
    ],
)
def test_every_band(levels, column, mechanism, tolerance_db):
    error = np.maximum(levels[mechanism], -100) - TABLE[:, column]
    assert np.abs(error).max() < tolerance_db


def test_a_sharp_edge_sheds_nothing(levels):
    assert levels["bluntness"].max() < -190
