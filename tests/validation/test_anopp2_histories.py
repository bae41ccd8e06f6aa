"""Pressure histories against ANOPP2, NASA's system noise code, fixed and flying observers.

The rotor of `test_anopp2`, here by advanced-time marching: at 5 m/s it climbs past an observer that
stays where it is, or flies along. Line loads and section areas become point forces and volumes.
"""

from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.advanced_time import loading_history, thickness_history
from propmdao.acoustics.motion import blade_motions, translation
from propmdao.acoustics.reception import Observers, source_times
from propmdao.geometry.surface import Panels
from propmdao.records import PointLoads

DENSITY, SOUND_SPEED, FLIGHT = 1.226, 340.0, np.array([0.0, 0.0, 5.0])


@pytest.mark.parametrize("rpm", [600, 1400, 2200])
@pytest.mark.parametrize(
    "record", ["const_vel_theta-45", "stationary_theta-45", "stationary_theta+0"]
)
def test_first_blade_passage(reference_data: Path, rpm: int, record: str):
    def table(path: str) -> np.ndarray:
        return np.genfromtxt(reference_data / "f1a" / path, delimiter=",", names=True)

    shape, line = table("geometry_crotor_blade.csv"), table(f"anopp2/loads_rpm{rpm:04d}.csv")
    history = table(f"anopp2/apth_rpm{rpm:04d}_{record}.csv")
    r, length, area = shape["r_m"], shape["dr_m"], shape["cs_area_m2"]
    position = np.stack([r, 0 * r, 0 * r], axis=-1)
    along, down = line["Tp_N_per_m"] * length, line["Np_N_per_m"] * length
    loads = PointLoads(jnp.asarray(position), jnp.asarray(np.stack([0 * r, along, -down], axis=-1)))
    # a point volume is a cube of 1 mm with its areas scaled up
    size, sides = 1e-3, np.vstack([np.eye(3), -np.eye(3)])
    panels = Panels(
        jnp.asarray((position[:, None] + size / 2 * sides).reshape(-1, 3)),
        jnp.asarray(((area * length)[:, None, None] / size * sides).reshape(-1, 3)),
    )
    elevation = np.radians(float(record[-3:].lstrip("a")))
    observers = Observers(
        jnp.asarray(30.48 * np.array([[np.cos(elevation), 0.0, np.sin(elevation)]])),
        jnp.asarray(FLIGHT if "const_vel" in record else 0 * FLIGHT),
    )
    passage = history["t_s"] - history["t_s"][0] < 30.0 / rpm
    t = history["t_s"][passage]

    monopole, dipole = np.zeros_like(t), np.zeros_like(t)
    outer = (translation(velocity=FLIGHT),)
    for motion in blade_motions(np.pi * np.array([0.5, 1.5]), rpm * np.pi / 30, outer):
        tau = source_times(motion, panels.center, observers, t, SOUND_SPEED)
        monopole += thickness_history(panels, motion, tau, observers, t, DENSITY, SOUND_SPEED)[0]
        dipole += loading_history(loads, motion, tau, observers, t, SOUND_SPEED)[0]
    for product, name in ((monopole, "p_monopole_Pa"), (dipole, "p_dipole_Pa")):
        expected = history[name][passage]
        error = product - expected
        # measured: monopole 0.29 to 0.35 %, dipole 0.03 to 0.16 %
        assert np.abs(error).max() < 0.01 * np.ptp(expected)
