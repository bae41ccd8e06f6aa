"""Broadband noise of a propeller from its aerodynamic solution."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import SelfNoise, third_octave_centers
from propmdao.acoustics.inflow.rotor import rotor_inflow_noise
from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.geometry.trailing_edge import trailing_edge
from propmdao.records.air import Turbulence
from propmdao.records.models import SelfNoiseModel
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

#: Mid-band frequencies of the third octaves that are heard [Hz].
BANDS_HZ = third_octave_centers(50.0, 20e3)


@compiled
def strip_flow(
    strips: Strips,
    relative_speed: Array,
    lift_coefficient: Array,
    blade: Blade,
    section_radii: SpanInterpolation,
) -> StripFlow:
    """Strips of the lattice as broadband noise sees them.

    Parameters
    ----------
    strips : Strips
        Sections of blade 1.
    relative_speed, lift_coefficient : (ns,) or (n_azimuths, ns) arrays
        How they work: speed of the air over them [m/s], and lift.
    blade : Blade
        The blade that was solved, for the shape of its trailing edge.
    section_radii : SpanInterpolation
        From the blade's stations to the middle of the strips.

    Returns
    -------
    StripFlow
        Strips of blade 1 at azimuth 0.

    Notes
    -----
    The angle from zero lift is cl / (2 pi). Deep in stall, where lift no longer tells the angle,
    separation noise comes out low.
    """
    # The report's angles are those of a symmetric section to its stream. A cambered section loads
    # its boundary layers alike at the same lift: the angle at which a thin section has it.
    blunt, angle = trailing_edge(blade, section_radii)
    section = Section(
        chord=strips.chord,
        span=strips.width,
        speed=relative_speed,
        angle_of_attack=lift_coefficient / (2.0 * jnp.pi),
        trailing_edge_thickness=blunt * strips.chord,
        trailing_edge_angle=angle,
    )
    edge = strips.quarter_chord + 0.75 * strips.chord[:, None] * strips.backward
    return StripFlow(edge, strips.backward, jnp.cross(strips.upward, strips.backward), section)


def self_noise(
    flow: StripFlow,
    n_blades: int,
    state: RotorState,
    observers: ArrayLike,
    model: SelfNoiseModel = SelfNoiseModel(),  # noqa: B008 - frozen
    bands_hz: ArrayLike = BANDS_HZ,
    turbulence: Turbulence | None = None,
) -> SelfNoise:
    """Self-noise in third octaves, and the noise of turbulence that flows in.

    Parameters
    ----------
    flow : StripFlow
        Strips of blade 1, of `strip_flow`.
    n_blades : int
        Number of equally spaced blades.
    state : RotorState
        How the rotor turns and flies.
    observers : (n_observers, 3) array
        Positions from the rotor centre, flying along [m].
    model : SelfNoiseModel
        Tripping of the boundary layers, planform of the tip.
    bands_hz : (n_bands,) array
        Mid-band frequencies as the observers hear them [Hz].
    turbulence : Turbulence, optional
        Turbulence that flows in; by default none does.

    Returns
    -------
    SelfNoise
        Mean squares of each mechanism, (n_observers, n_bands) [Pa^2].
    """
    speed = flow.section.speed
    azimuths = {"n_azimuths": len(speed)} if speed.ndim == 2 else {}
    noise = rotor_self_noise(flow, n_blades, state, observers, bands_hz, model=model, **azimuths)
    if turbulence is None:
        return noise
    inflow = rotor_inflow_noise(flow, n_blades, state, turbulence, observers, bands_hz, **azimuths)
    return dataclasses.replace(noise, inflow_turbulence=inflow)
