"""What an analysis found, with all that was asked, and its levels as plain numbers."""

from __future__ import annotations

import dataclasses
from typing import Any

import jax
import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.acoustics.broadband.self_noise import SelfNoise, third_octave_centers
from propmdao.acoustics.kinematics.observers import directions
from propmdao.acoustics.levels.bands import third_octave, tones_in_bands
from propmdao.acoustics.levels.decibels import level_db, mean_square, oaspl_db, spl_db
from propmdao.acoustics.levels.weighting import level_dba, oaspl_dba
from propmdao.acoustics.signals import Tones
from propmdao.aerodynamics.coefficients import Coefficients
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads, failure
from propmdao.analysis.elastic.deflections import Deflection
from propmdao.analysis.request import Request
from propmdao.analysis.self_noise import BANDS_HZ, noise_range
from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.propeller.identity import checksum
from propmdao.records.listening import Listening
from propmdao.records.models import Model
from propmdao.records.plain import to_plain
from propmdao.records.quantities import HUB_LOADS
from propmdao.records.states import OperatingPoint, RotorState
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.compilation import compiled

#: Mechanisms of broadband noise, by their key in the results.
MECHANISMS = tuple(field.name for field in dataclasses.fields(SelfNoise))


@dataclasses.dataclass(frozen=True, kw_only=True)
class Analysis:
    """Loads and noise of a propeller at one operating point.

    Attributes
    ----------
    propeller : Propeller
        The described blade, before the change.
    request : Request
        All that was asked; `point`, `change`, `model` and `listening` are its records.
    rpm : float
        Rotation speed [rev/min], asked for or found.
    loads : RotorLoads or TiltedLoads
        Loads of the vortex lattice; at an incidence those of a turn.
    coefficients : Coefficients
        J, CT, CQ, CP, eta, figure of merit.
    tones : Tones
        Complex pressure amplitudes at the observers.
    broadband : SelfNoise or None
        Mean squares in the third octaves `propmdao.analysis.self_noise.BANDS_HZ`, where asked for.
    polars : dict of str to str
        Where the polars of each airfoil come from; empty for inviscid flow.
    deflection : Deflection or None
        How far the blade has given, where an elastic one was asked for.
    """

    propeller: Propeller
    request: Request
    rpm: float
    loads: RotorLoads | TiltedLoads
    coefficients: Coefficients
    tones: Tones
    broadband: SelfNoise | None
    polars: dict[str, str] = dataclasses.field(default_factory=dict)
    deflection: Deflection | None = None

    @property
    def point(self) -> OperatingPoint:
        """Operating point that was asked for."""
        return self.request.point

    @property
    def change(self) -> Change:
        """Change of the described propeller."""
        return self.request.change

    @property
    def model(self) -> Model:
        """How loads and noise were computed."""
        return self.request.model

    @property
    def listening(self) -> Listening:
        """Who listens, and what is around."""
        return self.request.listening

    @property
    def state(self) -> RotorState:
        """How the rotor turns and flies."""
        return self.point.at(self.rpm * RAD_PER_S)

    @property
    def changed_propeller(self) -> Propeller:
        """The blade that was analysed, the described one with its change, as far as it gives."""
        changed = self.change.applied_to(self.propeller)
        return changed if self.deflection is None else self.deflection.applied_to(changed)

    def spl_bpf_db(self) -> npt.NDArray[np.float64]:
        """Level at the blade passage frequency at every observer [dB]."""
        return np.asarray(_levels(self.tones)["spl_db"])[:, 0]

    def to_dict(self) -> dict[str, Any]:
        """Results as plain numbers, with the keys of ``propmdao analyze --json``.

        Returns
        -------
        dict
            What was asked: propeller (name, diameter, n_blades, checksum of the description,
            source), change, point, model, listening, and where the polars come from; then rpm,
            speed, rho, J, thrust, torque, shaft_power, CT, CQ, CP, eta, figure_of_merit, converged,
            failure (None, or why it did not converge), deflection (None, or r_over_R, twist_deg,
            sweep_over_R and rake_over_R of an elastic blade), hub_force [N] and hub_moment [N m],
            means over a turn in the axes of the rotor that do not turn, and a list of observers
            with their levels. At an incidence also azimuths, with force and moment of blade 1 at
            each; of a march its revolutions, with mean thrust [N] and torque [N m] and the change
            of the thrust since the one before, root of the mean square over the turn, over that of
            the thrust, and its history: azimuth of blade 1, thrust and torque at each step. With
            broadband noise broadband_range, of `noise_range`.
        """
        levels = jax.device_get(_levels(self.tones))
        loads = jax.device_get(self.loads)
        places = directions(self.listening.observers).rounded()
        propeller = {key: getattr(self.propeller, key) for key in ("name", "diameter", "n_blades")}
        propeller |= {"checksum": checksum(self.propeller), "source": self.propeller.source}
        return {
            "propeller": propeller,
            **self.request.to_dict(),
            "polars": self.polars,
            "rpm": self.rpm,
            "speed": float(self.point.speed),
            "rho": float(self.point.air.density),
            "J": float(self.coefficients.J),
            "thrust": float(self.loads.thrust),
            "torque": float(self.loads.torque),
            "shaft_power": float(self.loads.torque) * self.rpm * RAD_PER_S,
            "CT": float(self.coefficients.CT),
            "CQ": float(self.coefficients.CQ),
            "CP": float(self.coefficients.CP),
            "eta": float(self.coefficients.eta),
            "figure_of_merit": float(self.coefficients.figure_of_merit),
            "converged": bool(self.loads.converged),
            "failure": failure(self.loads),
            "deflection": to_plain(self.deflection),
            **{name: np.asarray(getattr(loads, name)).tolist() for name in HUB_LOADS},
            **self._around_the_turn(),
            **self._over_revolutions(),
            **self._range_of_noise(),
            "observers": [
                {
                    "elevation_deg": float(places.elevation_deg[i]),
                    "azimuth_deg": float(places.azimuth_deg[i]),
                    "radius": float(places.radius[i]),
                    **self._heard(i, levels),
                }
                for i in range(len(self.listening.observers))
            ],
        }

    def _range_of_noise(self) -> dict[str, Any]:
        """How far the blade is outside of the measurements of broadband noise."""
        if self.broadband is None:
            return {}
        return {"broadband_range": noise_range(self.loads, self.point.air)}

    def _around_the_turn(self) -> dict[str, Any]:
        """Loads of blade 1 at its azimuths, at an incidence."""
        loads = self.loads
        if not isinstance(loads, TiltedLoads):
            return {}
        vectors = np.asarray(loads.blade_force), np.asarray(loads.blade_moment)
        return {
            "azimuths": [
                {
                    "azimuth_deg": 360.0 * number / len(vectors[0]),
                    "blade_force": force.tolist(),
                    "blade_moment": moment.tolist(),
                }
                for number, (force, moment) in enumerate(zip(*vectors, strict=True))
            ],
        }

    def _over_revolutions(self) -> dict[str, Any]:
        """Thrust and torque of each revolution of a march, and how far they repeat."""
        loads = self.loads
        if not isinstance(loads, MarchedLoads):
            return {}
        change = [None, *np.asarray(loads.change).tolist()]
        step_deg = 360.0 / len(loads.blade_force)
        means = loads.thrust_by_revolution.tolist(), loads.torque_by_revolution.tolist()
        return {
            "revolutions": [
                {"thrust": thrust, "torque": torque, "change": since}
                for thrust, torque, since in zip(*means, change, strict=True)
            ],
            "history": {
                "azimuth_deg": (np.arange(loads.thrust_history.size) * step_deg).tolist(),
                "thrust": np.asarray(loads.thrust_history).tolist(),
                "torque": np.asarray(loads.torque_history).tolist(),
            },
        }

    def _heard(self, i: int, levels: dict[str, np.ndarray]) -> dict[str, Any]:
        """Levels at an observer."""
        frequency = np.asarray(self.tones.frequency_hz)
        spectra = [name for name in levels if name.startswith("spl")]
        result = {
            "spl_bpf_db": float(levels["spl_db"][i, 0]),
            **{name: float(levels[name][i]) for name in levels if name not in spectra},
            "harmonics": [
                {"m": m + 1, "frequency_hz": float(f)}
                | {name: float(levels[name][i, m]) for name in spectra}
                for m, f in enumerate(frequency)
            ],
        }
        if self.broadband is None:
            center, bands = third_octave(frequency, self.tones.total[i])
        else:
            noise = {name: np.asarray(getattr(self.broadband, name))[i] for name in MECHANISMS}
            noise["spl"] = np.asarray(self.broadband.total)[i]
            center, bands = _bands_with_noise(self.tones, i, noise["spl"])
            result |= _levels_with_noise(self.tones, i, noise["spl"])
            result["broadband_dba"] = {
                name: float(level_dba(BANDS_HZ, noise[name])) for name in MECHANISMS
            }
            in_bands = {name: np.asarray(level_db(power)) for name, power in noise.items()}
            result["broadband"] = [
                {"frequency_hz": float(f)}
                | {f"{name}_db": float(level[k]) for name, level in in_bands.items()}
                for k, f in enumerate(BANDS_HZ)
            ]
        result["third_octave"] = [
            {"frequency_hz": float(f), "spl_db": float(level)}
            for f, level in zip(center, bands, strict=True)
        ]
        return result


def _bands_with_noise(
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


def _levels_with_noise(tones: Tones, i: int, noise: npt.NDArray[np.float64]) -> dict[str, float]:
    """Overall levels of the noise, and of tones and noise together."""
    power = np.concatenate([np.asarray(mean_square(tones.total[i])), noise])
    frequency = np.concatenate([np.asarray(tones.frequency_hz), BANDS_HZ])
    return {
        "oaspl_broadband_db": float(level_db(noise.sum())),
        "oaspl_broadband_dba": float(level_dba(BANDS_HZ, noise)),
        "oaspl_total_db": float(level_db(power.sum())),
        "oaspl_total_dba": float(level_dba(frequency, power)),
    }


@compiled
def _levels(tones: Tones) -> dict[str, Array]:
    """Levels of the tones by their key: of all observers, and harmonics where it begins by spl."""
    parts = {"": tones.total} | {f"{name}_": part for name, part in tones.parts.items()}
    levels = {f"oaspl_{part}db": oaspl_db(pressure) for part, pressure in parts.items()}
    levels |= {f"spl_{part}db": spl_db(pressure) for part, pressure in parts.items()}
    return levels | {"oaspl_dba": oaspl_dba(tones.frequency_hz, tones.total)}
