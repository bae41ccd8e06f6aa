"""One call from a described propeller to its loads and its noise."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import partial

import jax
import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.acoustics.broadband.boundary_layer import Trip
from propmdao.acoustics.kinematics.limits import require_outside_rotor, require_subsonic_tip
from propmdao.acoustics.kinematics.observers import point
from propmdao.acoustics.propagation.paths import bands_by_paths, sound_paths, tones_by_paths
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.lattice.strips import strip_radii
from propmdao.aerodynamics.sections.laws import ViscousSections, viscous_sections
from propmdao.aerodynamics.sections.polars.family import SectionPolars, warn_outside_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import warn_outside
from propmdao.aerodynamics.solutions.axial import solve_steady
from propmdao.aerodynamics.solutions.result import SteadySolution
from propmdao.aerodynamics.trim import rotation_bounds, steady_for_thrust
from propmdao.analysis.results import Analysis
from propmdao.analysis.self_noise import BANDS_HZ, self_noise, strip_flow
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.meshes import MeshRadii, blade_meshes, mesh_radii
from propmdao.geometry.surface import surface_panels
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity
from propmdao.records.listening import Surroundings
from propmdao.records.panels import Panels
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.compilation import compiled

SOUND_SPEED = 340.294


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
    trip: Trip = "none",
    observers: Sequence[Sequence[float]] = (),
    surroundings: Surroundings = Surroundings(),  # noqa: B008 - frozen
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
        Of `polars_for`, for tables of one's own; by default the
        catalogue's.
    broadband : bool
        Add the broadband self-noise of the blades to the tones.
    trip : {"none", "light", "heavy"}
        How the boundary layers are tripped: of broadband noise, not of the loads.
    observers : sequence of (radius, elevation_deg) or (radius, elevation_deg, azimuth_deg)
        Microphones flying along with the rotor: distance from its centre [m], elevation from the
        rotor plane, negative on the wake's side, and azimuth about its axis [deg], 0 where none is
        given.
    surroundings : Surroundings
        Ground that reflects and air that absorbs.
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
    points = np.array([(*place, 0.0)[:3] for place in observers], float).reshape(-1, 3)
    positions = point(*points.T)
    require_outside_rotor(positions, radius)
    paths = sound_paths(positions, surroundings)
    ends = paths.reshape(-1, 3)
    air = float(speed), float(density)
    if thrust is not None:
        bounds = rotation_bounds(radius, speed)
        found, steady = steady_for_thrust(
            nodes, propeller.n_blades, radius, *air, thrust, bounds, sections
        )
        omega = float(found)
        rpm = omega / RAD_PER_S
    else:
        assert rpm is not None
        omega = rpm * RAD_PER_S
        require_subsonic_tip(radius, omega, speed, SOUND_SPEED)
        steady = solve_steady(nodes, propeller.n_blades, radius, omega, *air, sections)
    if sections is not None and polars is not None:
        _warn_outside_polars(polars, sections, blade, stations, steady, float(density))
    mach = speed / SOUND_SPEED
    heard = tones(
        panels,
        steady.point_loads,
        propeller.n_blades,
        omega,
        *air,
        SOUND_SPEED,
        ends,
        fidelity.n_harmonics,
    )
    heard = tones_by_paths(heard, paths, mach, surroundings)
    noise = None
    if broadband:
        states = steady.sections
        flow = strip_flow(
            steady.strips, states.relative_speed, states.lift_coefficient, blade, section_radii
        )
        noise = self_noise(flow, propeller.n_blades, omega, *air, SOUND_SPEED, ends, trip)
        if surroundings != Surroundings():
            way = BANDS_HZ, paths, mach, SOUND_SPEED, surroundings
            noise = jax.tree.map(lambda power: bands_by_paths(power, *way), noise)
    of = coefficients(steady.thrust, steady.torque, omega, *air, propeller.diameter)
    return Analysis(float(rpm), *air, viscous, steady, of, points, heard, noise, trip, surroundings)


@partial(compiled, static_argnames=("n_chordwise", "n_contour"))
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
