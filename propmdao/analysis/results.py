"""What an analysis found, and its levels as plain numbers."""

from __future__ import annotations

import dataclasses
from typing import Any

import jax
import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.acoustics.broadband.boundary_layer import Trip
from propmdao.acoustics.broadband.self_noise import SelfNoise, third_octave_centers
from propmdao.acoustics.levels.bands import third_octave, tones_in_bands
from propmdao.acoustics.levels.decibels import level_db, mean_square, oaspl_db, spl_db
from propmdao.acoustics.levels.weighting import level_dba, oaspl_dba
from propmdao.acoustics.signals import Tones
from propmdao.aerodynamics.coefficients import Coefficients
from propmdao.aerodynamics.solutions.result import SteadySolution, failure
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.records.listening import Surroundings
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.compilation import compiled

#: Mechanisms of broadband noise, by their key in the results.
MECHANISMS = tuple(field.name for field in dataclasses.fields(SelfNoise))


@dataclasses.dataclass(frozen=True)
class Analysis:
    """Loads and tones of a propeller at one operating point.

    Attributes
    ----------
    rpm, speed, density : float
        Rotation speed [rev/min], axial flight speed [m/s], air density [kg/m^3].
    viscous : bool
        Whether the lattice was held to section polars.
    steady : SteadySolution
        Loads of the vortex lattice.
    coefficients : Coefficients
        J, CT, CQ, CP, eta.
    observers : (n_observers, 3) array
        Radius [m], elevation and azimuth [deg] of the observers; `observers.point` gives their
        positions.
    tones : Tones
        Their complex pressure amplitudes.
    broadband : SelfNoise or None
        Mean squares in the third octaves `propmdao.analysis.self_noise.BANDS_HZ`, where asked for.
    trip : str
        How the boundary layers are tripped in the broadband noise.
    surroundings : Surroundings
        Ground and air on the way to the observers.
    """

    rpm: float
    speed: float
    density: float
    viscous: bool
    steady: SteadySolution
    coefficients: Coefficients
    observers: npt.NDArray[np.float64]
    tones: Tones
    broadband: SelfNoise | None
    trip: Trip
    surroundings: Surroundings

    def to_dict(self) -> dict[str, Any]:
        """Results as plain numbers, with the keys of ``propmdao analyze --json``.

        Returns
        -------
        dict
            rpm, speed, rho, J, thrust, torque, shaft_power, CT, CQ, CP, eta, viscous, converged,
            failure (None, or why it did not converge), trip (None without broadband noise),
            surroundings and a list of observers with their levels.
        """
        levels = jax.tree.map(np.asarray, _levels(self.tones))
        return {
            "rpm": self.rpm,
            "speed": self.speed,
            "rho": self.density,
            "J": float(self.coefficients.J),
            "thrust": float(self.steady.thrust),
            "torque": float(self.steady.torque),
            "shaft_power": float(self.steady.torque) * self.rpm * RAD_PER_S,
            "CT": float(self.coefficients.CT),
            "CQ": float(self.coefficients.CQ),
            "CP": float(self.coefficients.CP),
            "eta": float(self.coefficients.eta),
            "viscous": self.viscous,
            "converged": bool(self.steady.converged),
            "failure": failure(self.steady),
            "trip": self.trip if self.broadband is not None else None,
            "surroundings": dataclasses.asdict(self.surroundings),
            "observers": [self._observer(i, levels) for i in range(len(self.observers))],
        }

    def _observer(self, i: int, levels: dict[str, np.ndarray]) -> dict[str, Any]:
        frequency = np.asarray(self.tones.frequency_hz)
        spectra = [name for name in levels if name.startswith("spl")]
        result = {
            "elevation_deg": float(self.observers[i, 1]),
            "azimuth_deg": float(self.observers[i, 2]),
            "radius": float(self.observers[i, 0]),
            "spl_bpf_db": float(levels["spl_db"][i, 0]),
            **{name: float(levels[name][i]) for name in levels if name not in spectra},
            "harmonics": [
                {"m": m + 1, "frequency_hz": float(f)}
                | {name: float(levels[name][i, m]) for name in spectra}
                for m, f in enumerate(frequency)
            ],
        }
        if self.broadband is not None:
            noise = {name: np.asarray(getattr(self.broadband, name))[i] for name in MECHANISMS} | {
                "spl": np.asarray(self.broadband.total)[i]
            }
            center, band = _with_noise(self.tones, i, noise["spl"])
            result |= _total(self.tones, i, noise["spl"])
            in_bands = {name: np.asarray(level_db(power)) for name, power in noise.items()}
            result["broadband"] = [
                {"frequency_hz": float(f)}
                | {f"{name}_db": float(level[k]) for name, level in in_bands.items()}
                for k, f in enumerate(BANDS_HZ)
            ]
        else:
            center, band = third_octave(frequency, self.tones.total[i])
        result["third_octave"] = [
            {"frequency_hz": float(f), "spl_db": float(level)}
            for f, level in zip(center, band, strict=True)
        ]
        return result


def _with_noise(
    tones: Tones, i: int, noise: npt.NDArray[np.float64]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Levels in all bands of tones or noise, and those between."""
    frequency = np.asarray(tones.frequency_hz)
    known = np.concatenate([BANDS_HZ, frequency[frequency > 0.0]])
    center = third_octave_centers(known.min(), known.max())
    power = np.array(tones_in_bands(frequency, mean_square(tones.total[i]), center))
    first = int(np.argmin(np.abs(center - BANDS_HZ[0])))
    power[first : first + BANDS_HZ.size] += noise
    return center, np.asarray(level_db(power))


def _total(tones: Tones, i: int, noise: npt.NDArray[np.float64]) -> dict[str, float]:
    """Overall levels of tones and broadband noise together, and of the noise alone."""
    power = np.concatenate([np.asarray(mean_square(tones.total[i])), noise])
    frequency = np.concatenate([np.asarray(tones.frequency_hz), BANDS_HZ])
    return {
        "oaspl_db": float(level_db(power.sum())),
        "oaspl_dba": float(level_dba(frequency, power)),
        "oaspl_broadband_db": float(level_db(noise.sum())),
    }


@compiled
def _levels(tones: Tones) -> dict[str, Array]:
    """Levels of the tones by their key: of all observers, and harmonics where it begins by spl."""
    parts = {"": tones.total, "thickness_": tones.thickness, "loading_": tones.loading}
    levels = {f"oaspl_{part}db": oaspl_db(pressure) for part, pressure in parts.items()}
    levels |= {f"spl_{part}db": spl_db(pressure) for part, pressure in parts.items()}
    return levels | {"oaspl_dba": oaspl_dba(tones.frequency_hz, tones.total)}
