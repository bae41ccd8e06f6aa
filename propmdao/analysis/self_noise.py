"""Broadband noise of a propeller from its aerodynamic solution."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.acoustics.broadband.boundary_layer import LIGHT_TRIP, boundary_layer
from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.section_layers import layer_of_sections
from propmdao.acoustics.broadband.self_noise import SelfNoise, third_octave_centers
from propmdao.acoustics.inflow.rotor import rotor_inflow_noise
from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.sections.edge_layers.propeller_layers import layers_for
from propmdao.aerodynamics.sections.edge_layers.tables import (
    QUANTITIES,
    EdgeLayerTable,
    SectionLayers,
    blade_layers,
    edge_sides,
)
from propmdao.aerodynamics.sections.polars.shipped import SHIPPED_TRIPPED
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.geometry.trailing_edge import trailing_edge
from propmdao.propeller.description import Propeller
from propmdao.records.air import Air, Turbulence
from propmdao.records.models import Model, SelfNoiseModel, Trip
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

#: Mid-band frequencies of the third octaves that are heard [Hz].
BANDS_HZ = third_octave_centers(50.0, 20e3)
#: Smallest and largest of NASA RP-1218: chords of 25.4 to 304.8 mm at 31.7 to 71.3 m/s, NACA 0012
#: from 0 to 25.2 deg from zero lift.
MEASURED = {"reynolds": (5.5e4, 1.5e6), "mach": (0.0, 0.21), "angle_deg": (0.0, 25.2)}

_MOMENTUM = QUANTITIES.index("momentum")


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


def section_layers(propeller: Propeller, model: Model) -> SectionLayers | None:
    """Find the boundary layers that a model's broadband noise takes.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    model : Model
        Model with broadband noise, completed.

    Returns
    -------
    SectionLayers or None
        Boundary layers of the sections, at each station at the transition of the loads or tripped;
        None for the fits of NASA RP-1218. The heavy trip adds to the thicknesses what the report's
        adds to those of its light one.

    Raises
    ------
    PolarError
        If layers at this transition take NeuralFoil and it is not installed.
    """
    noise = model.noise.broadband
    if noise is None or noise.layers == "bpm":
        return None
    parts = []
    for trip, here in _stations_by_trip(noise, propeller.r_over_R.size).items():
        tripped = trip != "none"
        layers = layers_for(propeller, SHIPPED_TRIPPED if tripped else model.loads.transition)
        if trip == "heavy":
            momentum = layers.values[..., _MOMENTUM, :, :] - np.log(LIGHT_TRIP)
            values = layers.values.at[..., _MOMENTUM, :, :].set(momentum)
            layers = dataclasses.replace(layers, values=values)
        parts.append(dataclasses.replace(layers, weights=layers.weights * here[:, None]))
    return dataclasses.replace(
        parts[0],
        values=jnp.concatenate([part.values for part in parts]),
        weights=jnp.concatenate([part.weights for part in parts], axis=1),
    )


def _stations_by_trip(noise: SelfNoiseModel, n_stations: int) -> dict[Trip, NDArray[np.float64]]:
    """Stations that have each trip of a model, as 1 and 0."""
    trips = noise.trips(n_stations)
    return {
        trip: np.array([float(each == trip) for each in trips]) for trip in dict.fromkeys(trips)
    }


@compiled
def with_layers(
    flow: StripFlow, layers: EdgeLayerTable, angle_of_attack: Array, air: Air
) -> StripFlow:
    """Give strips the boundary layers of their own sections.

    Parameters
    ----------
    flow : StripFlow
        Strips of blade 1, of `strip_flow`.
    layers : EdgeLayerTable
        Boundary layers of their sections, `blade_layers` at the middle of the strips.
    angle_of_attack : (ns,) or (n_azimuths, ns) array
        Angle of attack of the sections from their chord line [rad].
    air : Air
        The undisturbed air.

    Returns
    -------
    StripFlow
        The same strips with their layer.
    """
    section = flow.section
    reynolds = section.speed * section.chord / air.kinematic_viscosity
    sides = edge_sides(layers, angle_of_attack, reynolds)
    layer = layer_of_sections(section.chord, section.angle_of_attack, *sides)
    return dataclasses.replace(flow, layer=layer)


@partial(compiled, static_argnames=("noise",))
def with_fitted_layers(
    flow: StripFlow, noise: SelfNoiseModel, section_radii: SpanInterpolation, air: Air
) -> StripFlow:
    """Give strips the boundary layers that the fits of NASA RP-1218 have with a blade's trips.

    Parameters
    ----------
    flow : StripFlow
        Strips of blade 1, of `strip_flow`.
    noise : SelfNoiseModel
        Trips, everywhere or at the blade's stations; between two stations thicknesses and share of
        laminar shedding go over from those of the one trip to those of the other (static).
    section_radii : SpanInterpolation
        From the blade's stations to the middle of the strips.
    air : Air
        The undisturbed air.

    Returns
    -------
    StripFlow
        The same strips with their layer.
    """
    section, to_strips = flow.section, section_radii.linear
    state = section.chord, section.speed, section.angle_of_attack, air.kinematic_viscosity
    parts = [
        jax.tree.map(partial(jnp.multiply, to_strips @ here), boundary_layer(*state, trip))
        for trip, here in _stations_by_trip(noise, to_strips.shape[1]).items()
    ]
    return dataclasses.replace(flow, layer=jax.tree.map(lambda *q: sum(q), *parts))


def flow_of(
    loads: RotorLoads | TiltedLoads,
    blade: Blade,
    section_radii: SpanInterpolation,
    layers: SectionLayers | None,
    air: Air,
    noise: SelfNoiseModel,
) -> StripFlow:
    """Strips of solved loads as broadband noise sees them.

    Parameters
    ----------
    loads : RotorLoads or TiltedLoads
        Loads of the blade.
    blade : Blade
        The blade that was solved.
    section_radii : SpanInterpolation
        From the blade's stations to the middle of the strips.
    layers : SectionLayers or None
        Boundary layers of `section_layers`.
    air : Air
        The undisturbed air.
    noise : SelfNoiseModel
        Trips of the layers, which those of `section_layers` have already.

    Returns
    -------
    StripFlow
        Strips of blade 1 at azimuth 0, with the layer of their sections or that of the fits.
    """
    states = loads.sections
    flow = strip_flow(
        loads.strips, states.relative_speed, states.lift_coefficient, blade, section_radii
    )
    if layers is None:
        return with_fitted_layers(flow, noise, section_radii, air)
    table = blade_layers(layers, blade, section_radii)
    return with_layers(flow, table, states.angle_of_attack, air)


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
        Planform of the tip, and the trip of boundary layers that `flow` has not.
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


def noise_range(loads: RotorLoads | TiltedLoads, air: Air) -> dict[str, dict[str, Any]]:
    """Compare the flow over the sections with the measurements of NASA RP-1218.

    Parameters
    ----------
    loads : RotorLoads or TiltedLoads
        Loads of the blade.
    air : Air
        The undisturbed air.

    Returns
    -------
    dict of dict
        By quantity of `MEASURED`: "least" and "largest" of all sections (and azimuths), "measured",
        the two ends of the measurements, and "outside", the share of the span that lies beyond.
    """
    strips, states = loads.strips, loads.sections
    speed = np.atleast_2d(np.asarray(states.relative_speed))
    angle = np.degrees(np.abs(np.atleast_2d(states.lift_coefficient))) / (2.0 * np.pi)
    values = {
        "reynolds": speed * np.asarray(strips.chord) / float(air.kinematic_viscosity),
        "mach": speed / float(air.sound_speed),
        "angle_deg": angle,
    }
    width = np.broadcast_to(np.asarray(strips.width), speed.shape)
    ranges = {}
    for name, (low, high) in MEASURED.items():
        value = values[name]
        beyond = (value < low) | (value > high)
        ranges[name] = {
            "least": float(value.min()),
            "largest": float(value.max()),
            "measured": [low, high],
            "outside": float(width[beyond].sum() / width.sum()),
        }
    return ranges
