"""Broadband self-noise of a propeller from its aerodynamic solution."""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.acoustics.broadband import (
    Section,
    SelfNoise,
    StripFlow,
    rotor_self_noise,
    third_octave_centers,
)
from propmdao.aerodynamics.section_laws import AIR_VISCOSITY
from propmdao.aerodynamics.solution import SteadySolution
from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.geometry.trailing_edge import trailing_edge
from propmdao.records import Scalar

#: Mid-band frequencies of the third octaves that are heard [Hz].
BANDS_HZ = third_octave_centers(50.0, 20e3)


def strip_flow(steady: SteadySolution, blade: Blade, section_radii: SpanInterpolation) -> StripFlow:
    """Strips of the lattice as broadband noise sees them.

    Parameters
    ----------
    steady : SteadySolution
        Loads.
    blade : Blade
        The blade that was solved, for the shape of its trailing edge.
    section_radii : SpanInterpolation
        From the blade's stations to the middle of the strips.

    Returns
    -------
    StripFlow
        Of blade 1 at azimuth 0.

    Notes
    -----
    The angle from zero lift is cl / (2 pi). Deep in stall, where lift no longer tells the angle,
    separation noise comes out low.
    """
    strips, states = steady.strips, steady.sections
    # The report's angles are those of a symmetric section to its stream. A cambered section loads
    # its boundary layers alike at the same lift: the angle at which a thin section has it.
    blunt, angle = trailing_edge(blade, section_radii)
    section = Section(
        chord=strips.chord,
        span=strips.width,
        speed=states.relative_speed,
        angle_of_attack=states.lift_coefficient / (2.0 * jnp.pi),
        trailing_edge_thickness=blunt * strips.chord,
        trailing_edge_angle=angle,
    )
    edge = strips.quarter_chord + 0.75 * strips.chord[:, None] * strips.backward
    return StripFlow(edge, strips.backward, jnp.cross(strips.upward, strips.backward), section)


@partial(jax.jit, static_argnames="n_blades")
def self_noise(
    steady: SteadySolution,
    blade: Blade,
    section_radii: SpanInterpolation,
    n_blades: int,
    rotation_speed: Scalar,
    speed: Scalar,
    density: Scalar,
    sound_speed: Scalar,
    observers: Array,
) -> SelfNoise:
    """Self-noise in the bands `BANDS_HZ`.

    Parameters
    ----------
    steady, blade, section_radii
        As `strip_flow` takes them.
    n_blades : int
        Number of equally spaced blades.
    rotation_speed, speed, density, sound_speed : float
        Rotation speed [rad/s], axial flight speed [m/s], air density [kg/m^3], speed of
        sound [m/s].
    observers : (n_observers, 3) array
        From the rotor centre, flying along [m].

    Returns
    -------
    SelfNoise
        Mean squares of each mechanism, (n_observers, n_bands) [Pa^2].
    """
    return rotor_self_noise(
        strip_flow(steady, blade, section_radii),
        n_blades,
        rotation_speed,
        speed,
        sound_speed,
        AIR_VISCOSITY / density,
        observers,
        BANDS_HZ,
    )
