"""What an analysis found, with all that was asked, and its levels as plain numbers."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.acoustics.kinematics.observers import directions
from propmdao.acoustics.levels.bands import band_number, middle_hz, tones_in_bands
from propmdao.acoustics.levels.decibels import (
    SILENCE_DB,
    level_db,
    mean_square,
    oaspl_db,
    spl_db,
)
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
        return np.asarray(_levels(self.tones, self.broadband).harmonics["spl_db"])[:, 0]

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
        levels: _Levels = jax.device_get(_levels(self.tones, self.broadband))
        third_octaves, loads = levels.third_octaves, jax.device_get(self.loads)
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
                    **self._heard(i, levels, third_octaves),
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

    def _heard(
        self, i: int, levels: _Levels, third_octaves: tuple[np.ndarray, np.ndarray]
    ) -> dict[str, Any]:
        """Levels at an observer."""
        center, bands = third_octaves
        frequency = np.asarray(self.tones.frequency_hz)
        result = {
            "spl_bpf_db": float(levels.harmonics["spl_db"][i, 0]),
            **{name: float(level[i]) for name, level in levels.overall.items()},
            "harmonics": [
                {"m": m + 1, "frequency_hz": float(f)}
                | {name: float(level[i, m]) for name, level in levels.harmonics.items()}
                for m, f in enumerate(frequency)
            ],
        }
        if levels.noise is not None:
            result |= {name: float(level[i]) for name, level in levels.noise.overall.items()}
            result["broadband_dba"] = {
                name: float(levels.noise.overall_dba[name][i]) for name in MECHANISMS
            }
            spectra = {
                f"{name}_db": levels.noise.bands[name][i].tolist() for name in (*MECHANISMS, "spl")
            }
            result["broadband"] = [
                {"frequency_hz": f} | {name: level[k] for name, level in spectra.items()}
                for k, f in enumerate(BANDS_HZ.tolist())
            ]
        result["third_octave"] = [
            {"frequency_hz": float(f), "spl_db": float(level)}
            for f, level in zip(center, bands[i], strict=True)
        ]
        return result


class _NoiseLevels(NamedTuple):
    """Levels where there is broadband noise: by observer, of bands by observer and band."""

    overall: dict[str, Array]  # of the noise, and of tones and noise, by their key
    overall_dba: dict[str, Array]  # of mechanisms
    bands: dict[str, Array]  # of mechanisms, and of their sum as "spl"
    bands_with_tones: Array


class _Levels(NamedTuple):
    """Levels by their key: of all observers, and of all harmonics."""

    overall: dict[str, Array]
    harmonics: dict[str, Array]
    band: Array  # number of the third octave that each harmonic is in
    in_band: Array  # level there
    noise: _NoiseLevels | None

    @property
    def third_octaves(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Mid-band frequencies and levels of what the observers hear.

        Of tones alone the bands that hold one; with noise all bands of tones or noise, and those
        between.
        """
        turning = np.isfinite(self.band)  # at 0 Hz is no band
        held, first = np.unique(np.asarray(self.band)[turning], return_index=True)
        of_tones = np.asarray(self.in_band)[:, turning][:, first]
        if self.noise is None:
            return middle_hz(held), of_tones
        of_noise = np.round(10.0 * np.log10(BANDS_HZ / 1000.0))
        both = np.concatenate([of_noise, held])
        numbers = np.arange(both.min(), both.max() + 1.0)
        level = np.full((len(of_tones), numbers.size), SILENCE_DB)
        level[:, (held - numbers[0]).astype(int)] = of_tones
        level[:, (of_noise - numbers[0]).astype(int)] = self.noise.bands_with_tones
        return middle_hz(numbers), level


@compiled
def _levels(tones: Tones, noise: SelfNoise | None) -> _Levels:
    """Levels of everything in one program: many small ones would take longer than the noise."""
    parts = {"": tones.total} | {f"{name}_": part for name, part in tones.parts.items()}
    overall = {f"oaspl_{part}db": oaspl_db(pressure) for part, pressure in parts.items()}
    harmonics = {f"spl_{part}db": spl_db(pressure) for part, pressure in parts.items()}
    frequency, power = tones.frequency_hz, mean_square(tones.total)
    number = band_number(frequency)
    together = (number[:, None] == number).astype(float)
    return _Levels(
        overall | {"oaspl_dba": oaspl_dba(frequency, tones.total)},
        harmonics,
        number,
        level_db(power @ together),
        None if noise is None else _noise_levels(frequency, power, noise),
    )


def _noise_levels(frequency: Array, power: Array, noise: SelfNoise) -> _NoiseLevels:
    """Levels of the noise, and of tones and noise together."""
    mechanisms = {name: getattr(noise, name) for name in MECHANISMS}
    every = jnp.concatenate([power, noise.total], axis=-1)
    return _NoiseLevels(
        {
            "oaspl_broadband_db": level_db(noise.total.sum(axis=-1)),
            "oaspl_broadband_dba": level_dba(BANDS_HZ, noise.total),
            "oaspl_total_db": level_db(every.sum(axis=-1)),
            "oaspl_total_dba": level_dba(jnp.concatenate([frequency, BANDS_HZ]), every),
        },
        {name: level_dba(BANDS_HZ, bands) for name, bands in mechanisms.items()},
        {name: level_db(bands) for name, bands in (mechanisms | {"spl": noise.total}).items()},
        level_db(noise.total + tones_in_bands(frequency, power, BANDS_HZ)),
    )
