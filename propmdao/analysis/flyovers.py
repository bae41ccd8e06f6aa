"""What is heard on the ground when a propeller flies over, from its analysis to EPNL."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.broadband.boundary_layer import Trip
from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.kinematics.motion import poses
from propmdao.acoustics.kinematics.tracks import fixed_observers, flyover_track, line_of_sight
from propmdao.acoustics.levels.time_levels import third_octave_history
from propmdao.acoustics.propagation.absorption import absorb
from propmdao.acoustics.propagation.reflection import bands_with_reflection
from propmdao.acoustics.signals import PressureHistory
from propmdao.acoustics.sounds.changing_sound import absorbed_record, changing_noise
from propmdao.acoustics.sounds.recordings import SAMPLE_RATE
from propmdao.acoustics.sources.flyover import flyover_histories
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.aerodynamics.lattice.strips import strip_radii
from propmdao.aerodynamics.sections.laws import AIR_VISCOSITY
from propmdao.analysis.flyover_results import PARTS, STEP, Flight, Flyover
from propmdao.analysis.results import Analysis
from propmdao.analysis.self_noise import BANDS_HZ, strip_flow
from propmdao.analysis.single_point import SOUND_SPEED
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.meshes import propeller_surface
from propmdao.geometry.surface import surface_panels
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity
from propmdao.records.units import RAD_PER_S

_MAX_SAMPLES = 30_000_000
_MAX_DURATION = 1200.0  # s

Floats = npt.NDArray[np.float64]


def fly_over(
    propeller: Propeller,
    analysis: Analysis,
    flight: Flight,
    *,
    trip: Trip = "none",
    sound: bool = False,
    fidelity: Fidelity = Fidelity(),  # noqa: B008 - frozen
) -> Flyover:
    """Hear an analysed propeller fly over.

    Parameters
    ----------
    propeller : Propeller
        The described blade, as it was analysed.
    analysis : Analysis
        Its loads, at the speed of the flight.
    flight : Flight
        Where it flies, where the microphone is.
    trip : {"none", "light", "heavy"}
        How the boundary layers are tripped in the broadband noise.
    sound : bool
        Whether the pressure record is wanted.
    fidelity : Fidelity
        Of the analysis.

    Returns
    -------
    Flyover
        Tones with their Doppler shift and broadband noise.

    Raises
    ------
    ValueError
        If the propeller does not fly or turn, or the record would be too long.

    Notes
    -----
    Of the ways by the ground and straight, the first is as long as the second to absorption.
    """
    if not analysis.speed > 0.0:
        raise ValueError(f"speed of a flyover must be positive [m/s]; it is {analysis.speed:g}")
    if not analysis.rpm > 0.0:
        raise ValueError(f"rpm of a flyover must be positive; it is {analysis.rpm:g}")
    passage = propeller.n_blades * analysis.rpm / 60.0
    # As it is heard from ahead.
    highest = fidelity.n_harmonics * passage / (1.0 - analysis.speed / SOUND_SPEED)
    rate = SAMPLE_RATE if sound else max(2000, 2 * round(2.0 * highest))
    each = 2 * round(0.5 * STEP * rate)
    duration = flight.duration or max(20.0, 12.0 * flight.miss_distance / analysis.speed)
    n_steps = int(np.ceil(duration / STEP - 1e-9))
    longest = min(_MAX_DURATION, _MAX_SAMPLES / rate)
    if duration > longest:
        raise ValueError(
            f"a flyover of {duration:.0f} s is too long: at most {longest:.0f} s; give a duration"
        )
    start = flight.miss_distance / SOUND_SPEED - 0.5 * n_steps * STEP
    places = [[0.0, flight.sideline, flight.microphone_height]]
    if flight.microphone_height > 0.0:
        places.append([0.0, flight.sideline, -flight.microphone_height])
    track = flyover_track(flight.height, analysis.speed)
    clock = start + np.arange(n_steps * each) / rate
    tones = _tones(propeller, analysis, fidelity, places, clock, track, highest)
    held = BANDS_HZ[BANDS_HZ * 10**0.06 < 0.5 * rate]
    parts = {}
    for part in ("thickness", "loading", "total"):
        time, heard = third_octave_history(getattr(tones, part)[0], rate, held, STEP)
        parts[part] = np.pad(heard, ((0, 0), (0, BANDS_HZ.size - held.size)))
    time = time + start

    sights = [line_of_sight(track, fixed_observers([x]), time, SOUND_SPEED) for x in places]
    flow = _flow(propeller, analysis, fidelity)
    noises = [
        _broadband(propeller, analysis, flow, x, np.asarray(sight.doppler)[0], time, track, trip)
        for x, sight in zip(places, sights, strict=True)
    ]
    if len(noises) == 1:
        parts["broadband"] = 4.0 * noises[0]  # on the ground itself pressure is doubled
    else:
        delay = (sights[1].distance - sights[0].distance)[0] / SOUND_SPEED
        parts["broadband"] = np.asarray(
            bands_with_reflection(noises[0], noises[1], BANDS_HZ, delay)
        )
    parts["total"] = parts["total"] + parts["broadband"]
    distance = np.asarray(sights[0].distance)[0]
    if flight.air is not None:
        for part, power in parts.items():
            parts[part] = np.asarray(absorb(power, BANDS_HZ, distance, flight.air))
    pressure = None
    if sound:
        pressure = tones.total[0]
        if flight.air is not None:
            pressure = absorbed_record(pressure, distance, flight.air, each, rate)
        pressure = pressure + changing_noise(BANDS_HZ, parts["broadband"], each, rate)
    return Flyover(time, {part: parts[part] for part in PARTS}, sights[0], pressure)


def _tones(
    propeller: Propeller,
    analysis: Analysis,
    fidelity: Fidelity,
    places: list[list[float]],
    clock: Floats,
    track: Any,
    highest: float,
) -> PressureHistory:
    """Record of the tones at the microphone, over ground, (1, n_times)."""
    surface = propeller_surface(propeller, fidelity.n_contour, fidelity.n_surface_span)
    rotor = Rotor(
        equally_spaced(propeller.n_blades),
        analysis.rpm * RAD_PER_S,
        surface_panels(surface),
        analysis.steady.point_loads,
    )
    emitted = highest * (1.0 - analysis.speed / SOUND_SPEED)
    heard = flyover_histories(
        [rotor], fixed_observers(places), clock, analysis.density, SOUND_SPEED, track, emitted
    )
    factor = 2.0 / len(places)
    return PressureHistory(
        heard.time,
        factor * heard.thickness.sum(axis=0, keepdims=True),
        factor * heard.loading.sum(axis=0, keepdims=True),
    )


def _flow(propeller: Propeller, analysis: Analysis, fidelity: Fidelity) -> StripFlow:
    states, stations = analysis.steady.sections, propeller.r_over_R
    radii = span_interpolation(stations, strip_radii(stations[0], fidelity.n_spanwise))
    return strip_flow(
        analysis.steady.strips,
        states.relative_speed,
        states.lift_coefficient,
        Blade.from_propeller(propeller),
        radii,
    )


def _broadband(
    propeller: Propeller,
    analysis: Analysis,
    flow: StripFlow,
    place: list[float],
    doppler: Floats,
    times: Floats,
    track: Any,
    trip: Trip,
) -> Floats:
    """Third octaves without ground or absorption, (n_times, n_bands) [Pa^2]."""
    # Whoever flies along is for a moment where the microphone is: pressure is the same for both,
    # frequencies are those of flying along times Doppler's factor.
    pose = poses(track, times)
    beside = np.einsum("tij,ti->tj", np.asarray(pose.rotation), place - np.asarray(pose.origin))
    heard = [
        rotor_self_noise(
            flow,
            propeller.n_blades,
            analysis.rpm * RAD_PER_S,
            analysis.speed,
            SOUND_SPEED,
            AIR_VISCOSITY / analysis.density,
            at[None],
            BANDS_HZ / factor,
            trip=trip,
        ).total[0]
        for at, factor in zip(beside, doppler, strict=True)
    ]
    return np.array(heard)
