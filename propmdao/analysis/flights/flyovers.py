"""What is heard on the ground when a propeller flies over, from its analysis to EPNL."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.broadband.rotor import StripFlow
from propmdao.acoustics.kinematics.motion import Motion, poses
from propmdao.acoustics.kinematics.tracks import fixed_observers, flyover_track, line_of_sight
from propmdao.acoustics.levels.time_levels import third_octave_history
from propmdao.acoustics.propagation.absorption import absorb
from propmdao.acoustics.propagation.reflection import bands_with_reflection
from propmdao.acoustics.signals import PressureHistory
from propmdao.acoustics.sounds.changing_sound import absorbed_record, changing_noise
from propmdao.acoustics.sounds.recordings import MOST_SAMPLES, SAMPLE_RATE
from propmdao.acoustics.sources.flyover import flyover_histories
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.analysis.flights.flyover_results import STEP, Flight, Flyover
from propmdao.analysis.results import Analysis
from propmdao.analysis.self_noise import BANDS_HZ, flow_of, section_layers, self_noise
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.geometry.meshes import propeller_surface
from propmdao.geometry.surface import surface_panels
from propmdao.propeller.description import Propeller
from propmdao.records.air import require_known_air
from propmdao.records.models import Model, NoiseModel, SelfNoiseModel
from propmdao.runtime.finite import require_finite

Floats = npt.NDArray[np.float64]


def fly_over(analysis: Analysis, flight: Flight, *, sound: bool = False) -> Flyover:
    """Hear an analysed propeller fly over.

    Parameters
    ----------
    analysis : Analysis
        Analysis at the speed of the flight. Boundary layers are tripped in the broadband noise,
        which is always part of a flyover, as the analysis' noise model says, or as in its loads
        where it has none.
    flight : Flight
        Height of the flight, place of the microphone.
    sound : bool
        Whether the pressure record is wanted.

    Returns
    -------
    Flyover
        Tones with their Doppler shift and broadband noise.

    Raises
    ------
    ValueError
        If the propeller does not fly or turn, the record would be too long, or a result would be
        no number (`NotFiniteError`).

    Notes
    -----
    At an incidence the shaft leans forward by 90 degrees less it; elevations in the result are from
    the plane of the rotor that leans. Absorption uses the direct path's length for the reflected
    path as well.
    """
    state = analysis.state
    air, sound_speed = state.air, float(state.air.sound_speed)
    speed = float(state.speed)
    if flight.absorption:
        require_known_air(air)
    if not speed > 0.0:
        raise ValueError(f"speed of a flyover must be positive [m/s]; it is {speed:g}")
    if not analysis.rpm > 0.0:
        raise ValueError(f"rpm of a flyover must be positive; it is {analysis.rpm:g}")
    propeller = analysis.changed_propeller
    emitted = _highest_tone(analysis, propeller)
    highest = emitted / (1.0 - speed / sound_speed)  # heard from ahead
    rate = SAMPLE_RATE if sound else max(2000, 2 * round(2.0 * highest))
    each = 2 * round(0.5 * STEP * rate)
    duration = flight.heard_for(speed)
    n_steps = int(np.ceil(duration / STEP - 1e-9))
    if duration * rate > MOST_SAMPLES:
        raise ValueError(
            f"a flyover of {duration:.0f} s is too long: at most {MOST_SAMPLES / rate:.0f} s at"
            f" {rate} samples per second; give a duration"
        )
    start = flight.miss_distance / sound_speed - 0.5 * n_steps * STEP
    places = [[0.0, flight.sideline, flight.microphone_height]]
    if flight.microphone_height > 0.0:
        places.append([0.0, flight.sideline, -flight.microphone_height])
    track = flyover_track(flight.height, speed, 90.0 - analysis.point.incidence_deg)
    clock: Floats = start + np.arange(n_steps * each) / rate
    tones = _tones(analysis, propeller, places, clock, track)
    held = BANDS_HZ[BANDS_HZ * 10**0.06 < 0.5 * rate]
    records = {**tones.parts, "total": tones.total}
    parts = {}
    for part, record in records.items():
        time, power = third_octave_history(record[0], rate, held, STEP)
        parts[part] = np.pad(power, ((0, 0), (0, BANDS_HZ.size - held.size)))
    time = time + start

    sights = [line_of_sight(track, fixed_observers([x]), time, sound_speed) for x in places]
    model = _with_noise(analysis.model, propeller)
    flow = _flow(analysis, propeller, model)
    dopplers = [np.asarray(sight.doppler)[0] for sight in sights]
    noises = [
        _broadband(analysis, flow, model, np.asarray(place), doppler, time, track)
        for place, doppler in zip(places, dopplers, strict=True)
    ]
    if len(noises) == 1:
        parts["broadband"] = 4.0 * noises[0]  # on the ground itself pressure is doubled
    else:
        delay = (sights[1].distance - sights[0].distance)[0] / sound_speed
        parts["broadband"] = np.asarray(
            bands_with_reflection(noises[0], noises[1], BANDS_HZ, delay)
        )
    parts["total"] = parts.pop("total") + parts["broadband"]
    distance = np.asarray(sights[0].distance)[0]
    if flight.absorption:
        for part, power in parts.items():
            parts[part] = np.asarray(absorb(power, BANDS_HZ, distance, air))
    where = f", at {analysis.rpm:g} rpm and {speed:g} m/s"
    bands = [f"{frequency:g} Hz" for frequency in BANDS_HZ]
    for part, power in parts.items():
        require_finite(f"{part} noise", power, [f"{t:.1f} s" for t in time], bands, where=where)
    pressure = None
    if sound:
        pressure = tones.total[0]
        if flight.absorption:
            pressure = absorbed_record(pressure, distance, air, each, rate)
        pressure = pressure + changing_noise(BANDS_HZ, parts["broadband"], each, rate)
        require_finite("pressure", pressure, "sample", where=where)
    return Flyover(time, parts, sights[0], pressure)


def _highest_tone(analysis: Analysis, propeller: Propeller) -> float:
    """Frequency of the highest tone that is resolved, as the rotor emits it [Hz]."""
    passage = propeller.n_blades * analysis.rpm / 60.0
    return float(analysis.model.fidelity.n_harmonics * passage)


def _tones(
    analysis: Analysis,
    propeller: Propeller,
    places: list[list[float]],
    clock: Floats,
    track: Motion,
) -> PressureHistory:
    """Record of the tones at the microphone, over ground, (1, n_times)."""
    fidelity = analysis.model.fidelity
    surface = propeller_surface(propeller, fidelity.n_contour, fidelity.n_surface_span)
    rotor = Rotor(
        equally_spaced(propeller.n_blades),
        float(analysis.state.rotation_speed),
        surface_panels(surface),
        analysis.loads.point_loads,
    )
    highest = _highest_tone(analysis, propeller)
    histories = flyover_histories(
        [rotor], fixed_observers(places), clock, analysis.point.air, track, highest
    )
    # Two ways are added; flush with the ground both are one.
    factor = 2.0 / len(places)
    return histories.each(lambda pressure: factor * pressure.sum(axis=0, keepdims=True))


def _flow(analysis: Analysis, propeller: Propeller, model: Model) -> StripFlow:
    """Strips of the blade as broadband noise sees them."""
    noise = model.noise.broadband
    assert noise is not None
    return flow_of(
        analysis.loads,
        Blade.from_propeller(propeller),
        strip_interpolation(propeller.r_over_R, model.fidelity.n_spanwise),
        section_layers(propeller, model),
        analysis.point.air,
        noise,
    )


def _with_noise(model: Model, propeller: Propeller) -> Model:
    """Model of an analysis, with the broadband noise that a flyover has in any case."""
    noise = model.noise.broadband or SelfNoiseModel()
    model = dataclasses.replace(model, noise=NoiseModel(noise))
    return model.completed(propeller.transition, propeller.tip, propeller.trip)


def _broadband(
    analysis: Analysis,
    flow: StripFlow,
    model: Model,
    place: Floats,
    doppler: Floats,
    times: Floats,
    track: Motion,
) -> Floats:
    """Third octaves without ground or absorption, (n_times, n_bands) [Pa^2]."""
    # Whoever flies along is for a moment where the microphone is: pressure is the same for both,
    # frequencies are those of flying along times Doppler's factor.
    pose = poses(track, times)
    beside = np.einsum("tij,ti->tj", np.asarray(pose.rotation), place - np.asarray(pose.origin))
    n_blades, state = int(analysis.changed_propeller.n_blades), analysis.state
    noise, turbulence = model.noise.broadband, analysis.point.turbulent
    assert noise is not None
    noises = (
        self_noise(flow, n_blades, state, position[None], noise, BANDS_HZ / factor, turbulence)
        for position, factor in zip(beside, doppler, strict=True)
    )
    return np.array([each.total[0] for each in noises])
