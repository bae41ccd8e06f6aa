"""One call from a described propeller to its loads and its noise."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import partial
from typing import Any

import jax
import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.acoustics.broadband import SelfNoise
from propmdao.acoustics.formulation1a import Tones, require_subsonic_tip, tones
from propmdao.acoustics.levels import (
    REFERENCE_PRESSURE,
    a_weighting,
    level_db,
    mean_square,
    oaspl_db,
    oaspl_dba,
    spl_db,
    third_octave,
)
from propmdao.acoustics.observers import arc, require_outside_rotor
from propmdao.aerodynamics.coefficients import Coefficients, coefficients
from propmdao.aerodynamics.polars import (
    SectionPolars,
    polars_for,
    warn_outside,
    warn_outside_sections,
)
from propmdao.aerodynamics.section_coupling import ViscousSections, viscous_sections
from propmdao.aerodynamics.steady import SteadySolution, failure, solve_steady
from propmdao.aerodynamics.strips import strip_radii
from propmdao.aerodynamics.trim import rotation_bounds, steady_for_thrust
from propmdao.fidelity import Fidelity
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.meshes import MeshRadii, blade_meshes, mesh_radii
from propmdao.geometry.surface import Panels, surface_panels
from propmdao.propeller import Propeller
from propmdao.self_noise import BANDS_HZ, self_noise

SOUND_SPEED = 340.294
#: Mechanisms of broadband noise, by their key in the results.
MECHANISMS = tuple(field.name for field in dataclasses.fields(SelfNoise))
_RAD_PER_S = np.pi / 30.0


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
    observers : (n_observers, 2) array
        Radius [m] and elevation [deg] of the observers.
    tones : Tones
        Their complex pressure amplitudes.
    broadband : SelfNoise or None
        Mean squares in the third octaves `propmdao.self_noise.BANDS_HZ`, where asked for.
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

    def to_dict(self) -> dict[str, Any]:
        """Results as plain numbers, with the keys of ``propmdao analyze --json``.

        Returns
        -------
        dict
            rpm, speed, rho, J, thrust, torque, shaft_power, CT, CQ, CP, eta, viscous, converged,
            failure (None, or why it did not converge) and a list of observers with their levels.
        """
        levels = jax.tree.map(np.asarray, _levels(self.tones))
        return {
            "rpm": self.rpm,
            "speed": self.speed,
            "rho": self.density,
            "J": float(self.coefficients.J),
            "thrust": float(self.steady.thrust),
            "torque": float(self.steady.torque),
            "shaft_power": float(self.steady.torque) * self.rpm * _RAD_PER_S,
            "CT": float(self.coefficients.CT),
            "CQ": float(self.coefficients.CQ),
            "CP": float(self.coefficients.CP),
            "eta": float(self.coefficients.eta),
            "viscous": self.viscous,
            "converged": bool(self.steady.converged),
            "failure": failure(self.steady),
            "observers": [self._observer(i, levels) for i in range(len(self.observers))],
        }

    def _observer(self, i: int, levels: dict[str, np.ndarray]) -> dict[str, Any]:
        frequency = np.asarray(self.tones.frequency_hz)
        spectra = [name for name in levels if name.startswith("spl")]
        result = {
            "elevation_deg": float(self.observers[i, 1]),
            "radius": float(self.observers[i, 0]),
            "spl_bpf_db": float(levels["spl_db"][i, 0]),
            **{name: float(levels[name][i]) for name in levels if name not in spectra},
            "harmonics": [
                {"m": m + 1, "frequency_hz": float(f)}
                | {name: float(levels[name][i, m]) for name in spectra}
                for m, f in enumerate(frequency)
            ],
        }
        center, band = third_octave(frequency, self.tones.total[i])
        if self.broadband is not None:
            noise = {name: np.asarray(getattr(self.broadband, name))[i] for name in MECHANISMS} | {
                "spl": np.asarray(self.broadband.total)[i]
            }
            center, band = _with_noise(center, band, noise["spl"])
            result |= _total(self.tones, i, noise["spl"])
            in_bands = {name: np.asarray(level_db(power)) for name, power in noise.items()}
            result["broadband"] = [
                {"frequency_hz": float(f)}
                | {f"{name}_db": float(level[k]) for name, level in in_bands.items()}
                for k, f in enumerate(BANDS_HZ)
            ]
        result["third_octave"] = [
            {"frequency_hz": float(f), "spl_db": float(level)}
            for f, level in zip(center, band, strict=True)
        ]
        return result


def _with_noise(
    center: npt.NDArray[np.float64], band: npt.NDArray[np.float64], noise: npt.NDArray[np.float64]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Levels in all bands of tones or noise."""
    # Both are exact mid-band frequencies, but computed in two ways.
    numbers, known = (np.rint(10.0 * np.log10(f / 1000.0)) for f in (center, BANDS_HZ))
    everywhere = np.union1d(numbers, known)
    power = np.zeros(everywhere.size)
    power[np.searchsorted(everywhere, numbers)] += REFERENCE_PRESSURE**2 * 10 ** (band / 10)
    power[np.searchsorted(everywhere, known)] += noise
    return 1000.0 * 10.0 ** (everywhere / 10.0), np.asarray(level_db(power))


def _total(tones: Tones, i: int, noise: npt.NDArray[np.float64]) -> dict[str, float]:
    """Overall levels of tones and broadband noise together, and of the noise alone."""
    power = np.concatenate([np.asarray(mean_square(tones.total[i])), noise])
    frequency = np.concatenate([np.asarray(tones.frequency_hz), BANDS_HZ])
    weighted = power * 10 ** (np.asarray(a_weighting(np.maximum(frequency, 1e-3))) / 10.0)
    return {
        "oaspl_db": float(level_db(power.sum())),
        "oaspl_dba": float(level_db(weighted.sum())),
        "oaspl_broadband_db": float(level_db(noise.sum())),
    }


@jax.jit
def _levels(tones: Tones) -> dict[str, Array]:
    """Levels of the tones by their key: of all observers, and harmonics where it begins by spl."""
    parts = {"": tones.total, "thickness_": tones.thickness, "loading_": tones.loading}
    levels = {f"oaspl_{part}db": oaspl_db(pressure) for part, pressure in parts.items()}
    levels |= {f"spl_{part}db": spl_db(pressure) for part, pressure in parts.items()}
    return levels | {"oaspl_dba": oaspl_dba(tones.frequency_hz, tones.total)}


def analyze(
    propeller: Propeller,
    *,
    rpm: float | None = None,
    thrust: float | None = None,
    speed: float = 0.0,
    density: float = 1.225,
    twist_offset_deg: float = 0.0,
    viscous: bool = True,
    stall_delay: bool = True,
    polars: SectionPolars | None = None,
    broadband: bool = False,
    observers: Sequence[tuple[float, float]] = (),
    fidelity: Fidelity = Fidelity(),  # noqa: B008 - frozen
) -> Analysis:
    """Analyse a propeller at a rotation speed, or at the one that gives a thrust.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    rpm, thrust : float
        Rotation speed [rev/min] or required thrust of all blades [N]; one of the two.
    speed : float
        Axial flight speed, 0 is hover [m/s].
    density : float
        Air density [kg/m^3].
    twist_offset_deg : float
        Added to the blade angle all over the span [deg].
    viscous : bool
        Hold the lattice to the polars of the sections; False for inviscid flow.
    stall_delay : bool
        Whether rotation delays the stall of the sections.
    polars : SectionPolars, optional
        Of `propmdao.aerodynamics.polars.polars_for`, for tables of one's own; by default the
        catalogue's.
    broadband : bool
        Add the broadband self-noise of the blades to the tones.
    observers : sequence of (radius, elevation_deg)
        Microphones flying along with the rotor, on an arc around its centre: distance [m] and
        elevation from the rotor plane, negative on the wake's side [deg].
    fidelity : Fidelity
        Numbers of panels and harmonics.

    Returns
    -------
    Analysis
        Loads and tones.

    Raises
    ------
    ValueError
        Bad input, in one line; `TrimError` among them when the thrust is out of reach within
        `rotation_bounds`.
    """
    _check(rpm, thrust, speed, density)
    # Of the description, which refuses blade angles beyond its range.
    propeller = dataclasses.replace(propeller, beta_deg=propeller.beta_deg + twist_offset_deg)
    blade = Blade.from_propeller(propeller)
    stations = propeller.r_over_R
    radii = mesh_radii(stations, fidelity.n_spanwise, fidelity.n_surface_span)
    nodes, panels = _meshes(blade, radii, fidelity.n_chordwise, fidelity.n_contour)
    section_radii = span_interpolation(stations, strip_radii(stations[0], fidelity.n_spanwise))
    sections = None
    if viscous:
        polars = polars or polars_for(propeller)
        sections = viscous_sections(polars, blade, section_radii, SOUND_SPEED, float(stall_delay))
    radius = 0.5 * propeller.diameter
    points = np.asarray(observers, float).reshape(-1, 2)
    positions = arc(points[:, 0], points[:, 1])
    require_outside_rotor(positions, radius)
    air = float(speed), float(density)
    if thrust is not None:
        bounds = rotation_bounds(radius, speed)
        found, steady = steady_for_thrust(
            nodes, propeller.n_blades, radius, *air, thrust, bounds, sections
        )
        omega = float(found)
        rpm = omega / _RAD_PER_S
    else:
        assert rpm is not None
        omega = rpm * _RAD_PER_S
        require_subsonic_tip(radius, omega, speed, SOUND_SPEED)
        steady = solve_steady(nodes, propeller.n_blades, radius, omega, *air, sections)
    if sections is not None and polars is not None:
        _warn_outside_polars(polars, sections, blade, stations, steady, float(density))
    heard = tones(
        panels,
        steady.point_loads,
        propeller.n_blades,
        omega,
        *air,
        SOUND_SPEED,
        positions,
        fidelity.n_harmonics,
    )
    noise = None
    if broadband:
        noise = self_noise(
            steady, blade, section_radii, propeller.n_blades, omega, *air, SOUND_SPEED, positions
        )
    of = coefficients(steady.thrust, steady.torque, omega, *air, propeller.diameter)
    return Analysis(float(rpm), *air, viscous, steady, of, points, heard, noise)


@partial(jax.jit, static_argnames=("n_chordwise", "n_contour"))
def _meshes(
    blade: Blade, radii: MeshRadii, n_chordwise: int, n_contour: int
) -> tuple[Array, Panels]:
    """Lattice and closed surface of a blade."""
    nodes, surface = blade_meshes(blade, radii, n_chordwise, n_contour)
    return nodes, surface_panels(surface)


def _warn_outside_polars(
    polars: SectionPolars,
    sections: ViscousSections,
    blade: Blade,
    stations: npt.NDArray[np.float64],
    steady: SteadySolution,
    density: float,
) -> None:
    """Tell of sections that the polars do not reach."""
    warn_outside_sections(polars, blade, stations)
    w, strips = steady.sections.relative_speed, steady.strips
    if np.all(np.asarray(w) > 0.0):
        reynolds = density * w * strips.chord / sections.dynamic_viscosity
        warn_outside(sections.polars, reynolds, strips.r_over_R, w / sections.sound_speed)


def _check(
    rpm: float | None,
    thrust: float | None,
    speed: float,
    density: float,
) -> None:
    """Refuse bad input with one line."""
    if (rpm is None) == (thrust is None):
        raise ValueError("give either rpm or thrust")
    if rpm is not None and not 0.0 <= rpm < np.inf:
        raise ValueError(f"rpm must be 0 or more; it is {rpm:g}")
    if thrust is not None and not 0.0 < thrust < np.inf:
        raise ValueError(f"thrust must be positive; it is {thrust:g} N")
    if not 0.0 <= speed < np.inf:
        raise ValueError(f"speed must be 0 m/s or more; it is {speed:g}")
    if not 0.0 < density < np.inf:
        raise ValueError(f"density must be positive; it is {density:g} kg/m3")
