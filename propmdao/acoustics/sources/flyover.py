"""Records of uniform flight past observers, from tones at a few positions along the track.

Rotors whose every turn is like the one before carry a pressure field that is periodic for whoever
flies along: at the place X relative to the aircraft it is the sum of P_n(X) exp(-1j n Omega t). An
observer on the ground is at the time t just where somebody who flies along is, and pressure is the
same for both. So its record is::

    p(t) = 2 Re sum_n P_n(X(t)) exp(-1j n Omega t),    X(t) = x(t) - (position of the hub)

exactly, Doppler shift included: it is in the phase of P_n, exp(1j n Omega d / c) with the distance
d from the hub at emission. Without that phase and the spreading 1/d, P_n changes slowly along the
track and a few dozen positions say all, where marching takes every sample of every panel.
"""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray
from scipy.fft import dct

from propmdao.acoustics.kinematics.limits import require_air
from propmdao.acoustics.kinematics.motion import Motion, poses, rotation
from propmdao.acoustics.kinematics.reception import Observers, observer_clock, require_outside
from propmdao.acoustics.signals import PressureHistory
from propmdao.acoustics.sources.kernels import TONAL_SOURCES
from propmdao.acoustics.sources.periodic import rotor_tones, symmetry
from propmdao.acoustics.sources.rotors import Rotor, silence
from propmdao.records.air import Air

_TOLERANCE = 1e-3  # of the amplitudes: 0.009 dB
_FLOOR = 1e-3  # below the loudest position, at the same distance, by 60 dB: need not be followed
_MOST_POSITIONS = 1024
_TOGETHER = 8  # positions in one compiled call
_CHUNK = 1 << 14  # samples

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]


def flyover_histories(
    rotors: list[Rotor],
    observers: Observers,
    times: ArrayLike,
    air: Air,
    flight: Motion,
    max_frequency_hz: float,
) -> PressureHistory:
    """Pressure that observers hear of rotors in uniform flight whose turns are all alike.

    Parameters
    ----------
    rotors : list of Rotor
        Rotors of one aircraft, whose loads are constant or repeat every turn.
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array_like
        Uniform observer times [s].
    air : Air
        The undisturbed air.
    flight : Motion
        Motion of the aircraft; it neither turns nor accelerates.
    max_frequency_hz : float
        Highest frequency of the tones, as the rotor emits them [Hz].

    Returns
    -------
    PressureHistory
        Pressure of all rotors together, without the steady pressure field that they carry along
        (which `rotor_histories` has besides the tones).

    Raises
    ------
    ValueError
        If the flight is not uniform, sources reach the speed of sound, an observer comes into a
        rotor's region, the record is too coarse for the tones it would hold, or they change too
        fast along the track.

    Notes
    -----
    The amplitudes are interpolated by Chebyshev polynomials in asinh(way / miss distance), at
    twice as many positions as leave an error of 0.01 dB. Cost: panels x harmonics^2 x positions
    for the amplitudes, harmonics x times for the record.
    """
    require_air(air)
    clock, step = observer_clock(times)
    start = np.asarray(observers.position, float).reshape(-1, 3)
    sound_speed = float(air.sound_speed)
    history = silence(observers, clock)
    for rotor in rotors:
        chain = (*flight, *rotor.mount)
        if not all(frame.uniform for frame in chain):
            raise ValueError("flight must be uniform here: neither turning nor accelerating")
        if rotor.rotation_speed == 0:
            continue
        turning = rotation((0, 0, 1), rate=rotor.rotation_speed)
        require_outside((*chain, turning), rotor.points, observers, clock, rotor.name)
        pose = poses(chain, np.zeros(1))
        to_hub, hub, velocity = pose.rotation[0], pose.origin[0], pose.velocity[0]
        passing = (np.asarray(observers.velocity, float) - velocity) @ to_hub
        alone = dataclasses.replace(rotor, mount=())
        fundamental = symmetry(rotor.azimuths) * abs(rotor.rotation_speed)
        n_harmonics = int(max_frequency_hz * 2 * np.pi / fundamental * (1 + 1e-12))
        if n_harmonics < 1:
            raise ValueError(
                f"max_frequency_hz must reach the first tone of {rotor.name}, "
                f"{fundamental / (2 * np.pi):g} Hz; it is {max_frequency_hz:g}"
            )
        for i, x in enumerate((start - hub) @ to_hub):
            track = _Track(x, passing, velocity @ to_hub / sound_speed)
            amplitudes = functools.partial(_amplitudes, alone, track, fundamental, n_harmonics, air)
            series = _along(amplitudes, track, clock)
            record = _record(series, track, clock, step, fundamental, sound_speed, max_frequency_hz)
            for name, pressure in zip(TONAL_SOURCES, record, strict=True):
                history.parts[name][i] += pressure
    return history


@dataclasses.dataclass(frozen=True)
class _Track:
    """An observer's way past the hub, in the hub's axes: x + v t; the hub flies with mach * c."""

    x: Floats
    velocity: Floats
    mach: Floats

    @property
    def _miss(self) -> tuple[Floats, Floats]:
        speed = np.linalg.norm(self.velocity)
        direction = self.velocity / speed if speed > 0 else np.array([0.0, 0.0, 1.0])
        return self.x - direction * (self.x @ direction), direction

    def ways(self, times: Floats) -> Floats:
        return np.asarray(self._miss[1] @ self.x + np.linalg.norm(self.velocity) * times)

    def positions(self, ways: Floats) -> Floats:
        miss, direction = self._miss
        return np.asarray(miss + ways[:, None] * direction)

    def distance(self, ways: Floats) -> Floats:
        """Distance of the hub at emission [m], as by `emission_distance`.

        The arithmetic is numpy's: JAX would compile it for every length of a record.
        """
        miss, direction = self._miss
        ahead = miss @ self.mach + ways * (direction @ self.mach)
        beta2 = 1 - self.mach @ self.mach
        return np.asarray((ahead + np.sqrt(ahead**2 + beta2 * (miss @ miss + ways**2))) / beta2)


@dataclasses.dataclass(frozen=True)
class _Series:
    """Chebyshev series over asinh(way / scale) of P_n exp(-1j n Omega d / c) d, all sources."""

    scale: float
    ends: tuple[float, float]
    coefficients: Complex  # (degree + 1, n_sources, n_harmonics)

    def __call__(self, ways: Floats) -> Complex:
        low, high = self.ends
        middle, half = 0.5 * (high + low), max(0.5 * (high - low), 1e-12)
        u = np.clip((np.arcsinh(ways / self.scale) - middle) / half, -1, 1)
        shape = self.coefficients.shape
        flat = self.coefficients.reshape(shape[0], -1)
        values = chebyshev.chebvander(u, shape[0] - 1) @ flat.view(float)
        return np.ascontiguousarray(values).view(complex).reshape(-1, *shape[1:])


def _amplitudes(
    rotor: Rotor,
    track: _Track,
    fundamental: float,
    n_harmonics: int,
    air: Air,
    ways: Floats,
) -> Complex:
    """P_n exp(-1j n Omega d / c) d of all sources, (n_ways, n_sources, n_harmonics)."""
    sound_speed = float(air.sound_speed)
    full = np.concatenate([ways, np.repeat(ways[-1:], -ways.size % _TOGETHER)])
    pieces = []
    for few in full.reshape(-1, _TOGETHER):
        tones = rotor_tones(rotor, track.mach * sound_speed, air, track.positions(few), n_harmonics)
        pieces.append(np.stack([np.asarray(tones.parts[name]) for name in TONAL_SOURCES], axis=1))
    distance = track.distance(ways)
    wave = np.outer(distance, fundamental / sound_speed * np.arange(1, n_harmonics + 1))
    amplitude = np.concatenate(pieces)[: ways.size]
    return np.asarray(amplitude * (distance[:, None] * np.exp(-1j * wave))[:, None])


def _along(amplitudes: functools.partial[Complex], track: _Track, times: Floats) -> _Series:
    """Double the number of positions until the new ones change nothing."""
    ends = track.ways(times[[0, -1]])
    nearest = float(np.linalg.norm(track.positions(np.clip([0.0], *ends))[0]))
    miss = float(np.linalg.norm(track.positions(np.zeros(1))[0]))
    scale = max(miss, 0.1 * nearest)  # an observer right ahead has no miss distance
    low, high = np.arcsinh(ends / scale)

    def ways_of(nodes: Floats) -> Floats:
        return np.asarray(scale * np.sinh(0.5 * (high + low) + 0.5 * (high - low) * nodes))

    degree = 8
    values = amplitudes(ways_of(np.cos(np.pi * np.arange(degree + 1) / degree)))
    while True:
        coarse = _Series(scale, (low, high), _coefficients(values))
        ways = ways_of(np.cos(np.pi * (np.arange(degree) + 0.5) / degree))
        new = amplitudes(ways)
        size, error = (np.linalg.norm(q, axis=(1, 2)) for q in (new, new - coarse(ways)))
        finer = np.empty((2 * degree + 1, *values.shape[1:]), complex)
        finer[::2], finer[1::2] = values, new
        values, degree = finer, 2 * degree
        if np.all(error <= _TOLERANCE * np.maximum(size, _FLOOR * size.max())):
            return _Series(scale, (low, high), _coefficients(values))
        if degree >= _MOST_POSITIONS:
            raise ValueError(
                f"tones change too fast along the track for {degree} positions on it; "
                "lower max_frequency_hz, or march"
            )


def _coefficients(values: Complex) -> Complex:
    """Chebyshev series through values at cos(pi j / degree)."""
    degree = len(values) - 1
    series: Complex = (dct(values.real, 1, axis=0) + 1j * dct(values.imag, 1, axis=0)) / degree
    series[[0, -1]] *= 0.5
    return series


def _record(
    series: _Series,
    track: _Track,
    times: Floats,
    step: float,
    fundamental: float,
    sound_speed: float,
    max_frequency_hz: float,
) -> Floats:
    """Pressure of all sources, (n_sources, n_times)."""
    ways = track.ways(times)
    distance = track.distance(ways)
    emission = times - distance / sound_speed
    rate = float(np.max(np.diff(emission) / np.diff(times)))
    if max_frequency_hz * rate > 0.5 / step:
        raise ValueError(
            f"a record of {1 / step:g} samples per second holds no "
            f"{max_frequency_hz * rate:.4g} Hz, as which max_frequency_hz is heard"
        )
    record = np.empty((series.coefficients.shape[1], times.size))
    for first in range(0, times.size, _CHUNK):
        part = slice(first, first + _CHUNK)
        amplitudes = series(ways[part])
        turn = np.exp(-1j * fundamental * emission[part])
        total = np.zeros((turn.size, len(record)), complex)
        for amplitude in np.moveaxis(amplitudes, 2, 0)[::-1]:  # Horner's scheme
            total = (total + amplitude) * turn[:, None]
        record[:, part] = 2 * total.real.T / distance[part]
    return record
