"""Formulation 1A by advanced-time marching: closed forms, the Fourier form, and who hears what."""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.motion import blade_motions, rotation, translation
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.kinematics.reception import Observers, source_times
from propmdao.acoustics.sources.advanced_time import source_history
from propmdao.acoustics.sources.moving_sources import UnsteadySources, sample, unsteady_loads
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.runtime.compilation import compiled

RHO, C = 1.2, 340.0
AIR = Air(density=RHO, sound_speed=C)
REST = np.zeros(3)


def observers_at(*positions, velocity=REST):
    return Observers(jnp.atleast_2d(jnp.asarray(positions, float)), jnp.asarray(velocity, float))


@pytest.mark.parametrize(("elevation_deg", "speed"), [(-45.0, 0.0), (20.0, 30.0)])
def test_tones_of_a_flying_rotor_within_a_hundredth_of_a_decibel(slow_flyer, elevation_deg, speed):
    """The Fourier form at a tip Mach number of 0.6, observers flying along."""
    rotor = slow_flyer.with_(rotation_speed=1500.0, speed=speed, sound_speed=C, density=RHO)
    position = arc(1.905, elevation_deg)
    n, n_harmonics = 512, 6
    turn = 2 * np.pi / 1500.0
    t = np.arange(n) * turn / n
    observers = observers_at(*position, velocity=(0, 0, speed))
    thickness, loading = np.zeros(n), np.zeros(n)
    for motion in blade_motions([0, np.pi], 1500.0, (translation(velocity=(0, 0, speed)),)):
        tau = source_times(motion, rotor.panels.center, observers, t, C)
        thickness += source_history("thickness", rotor.panels, motion, tau, observers, t, AIR)[0]
        loading += source_history("loading", rotor.loads, motion, tau, observers, t, AIR)[0]
    tones = rotor.tones(position, n_harmonics)
    for history, reference in (
        (thickness, tones.parts["thickness"][0]),
        (loading, tones.parts["loading"][0]),
    ):
        spectrum = np.conj(np.fft.rfft(history)) / n
        amplitude = spectrum[2 * np.arange(1, n_harmonics + 1)]
        assert np.abs(20 * np.log10(np.abs(amplitude / np.asarray(reference)))).max() < 0.01
        assert np.abs(np.angle(amplitude / np.asarray(reference))).max() < 1e-3


OMEGA = 2 * np.pi * 200.0
VELOCITY = np.array([80.0, 0.0, -30.0])
START = np.array([1.0, 2.0, -1.5])
T = np.linspace(0.0, 0.02, 401)  # 100 steps per period
OBSERVER_VELOCITIES = [REST, VELOCITY, np.array([0.0, 40.0, 20.0])]


def spread(strength, x, t):
    """strength(tau) / (4 pi d (1 - M_r)) around a source at VELOCITY tau, at the fixed point x."""

    def earlier(_, tau):  # a fixed point that contracts by the Mach number, 0.25
        return t - jnp.linalg.norm(x - VELOCITY * tau) / C

    tau = jax.lax.fori_loop(0, 60, earlier, t)
    apart = x - VELOCITY * tau
    return strength(tau) / (4 * np.pi * (jnp.linalg.norm(apart) - apart @ (VELOCITY / C)))


def swell(tau):
    return 1 + 0.1 * jnp.cos(OMEGA * tau)


def side(tau):
    """Of a cube that grows and shrinks, over its mean."""
    return swell(tau) ** (1 / 3)


def area(tau):
    return swell(tau) ** (2 / 3)


@partial(compiled, optimisation=0)
@partial(jax.vmap, in_axes=(0, None))
def of_pulsating_body(t, observer_velocity):
    """Pressure of a unit volume and density."""
    x = START + observer_velocity * t

    def rate(s):
        return jax.jvp(lambda q: spread(swell, x, q), (s,), (1.0,))[1]

    return jax.jvp(rate, (t,), (1.0,))[1]


@partial(compiled, optimisation=0)
@partial(jax.vmap, in_axes=(0, None, None))
def of_oscillating_force(t, observer_velocity, force):
    gradient = jax.grad(lambda x: spread(swell, x, t))(START + observer_velocity * t)
    return -gradient @ force


@pytest.mark.parametrize("observer_velocity", OBSERVER_VELOCITIES)
def test_pulsating_body_in_uniform_motion(observer_velocity):
    """A volume v: p solves the wave equation with rho d2/dt2 (v delta) on its right-hand side."""
    volume = 1e-9
    observers, motion = (
        observers_at(START, velocity=observer_velocity),
        (translation(velocity=VELOCITY),),
    )
    sides = np.vstack([np.eye(3), -np.eye(3)])
    tau = source_times(motion, 1e-3 * sides, observers, T, C)
    # a cube of 1 mm that grows and shrinks
    lengths = [1e-3 * q for q in derivatives(side, tau)]
    areas = [1e-6 * q for q in derivatives(area, tau)]
    body = UnsteadySources(
        *(q[:, None, None] * sides / 2 for q in lengths),
        *(q[:, None, None] * sides for q in areas[:2]),
    )
    product = source_history("thickness", body, motion, tau, observers, T, AIR)[0]
    reference = RHO * volume * of_pulsating_body(T, observer_velocity)
    # interpolation: (2 pi / 100)^4 / 43 = 4e-7; size of the cube: 1e-7
    np.testing.assert_allclose(product, reference, atol=2e-6 * np.ptp(reference))


@partial(compiled, static_argnums=(0,), optimisation=0)
def derivatives(f, times):
    def first(t):
        return jax.jvp(f, (t,), (1.0,))[1]

    def second(t):
        return jax.jvp(first, (t,), (1.0,))[1]

    return [jax.vmap(q)(times) for q in (f, first, second)]


@pytest.mark.parametrize("observer_velocity", OBSERVER_VELOCITIES)
def test_oscillating_force_in_uniform_motion(observer_velocity):
    """p solves the wave equation with -div(F delta) on its right-hand side."""
    force = np.array([0.3, -2.0, 1.0])

    observers, motion = (
        observers_at(START, velocity=observer_velocity),
        (translation(velocity=VELOCITY),),
    )
    tau = source_times(motion, REST, observers, T, C)
    value, rate, _ = derivatives(swell, tau)
    loads = unsteady_loads(REST[None], value[:, None, None] * force, rate[:, None, None] * force)
    product = source_history("loading", loads, motion, tau, observers, T, AIR)[0]
    reference = of_oscillating_force(T, observer_velocity, force)
    np.testing.assert_allclose(product, reference, atol=2e-6 * np.ptp(reference))


def test_doppler_shift_of_a_flyover():
    """f / (1 - M) ahead and f / (1 + M) behind, from 1 km to 1 km past, within 0.1 %."""
    frequency, mach = 100.0, 0.3
    motion = (translation(offset=(-1000, 0, 0), velocity=(mach * C, 0, 0)),)
    observers = observers_at((0.0, 1.0, 0.0))
    for begin, expected in ((5.0, frequency / (1 - mach)), (15.0, frequency / (1 + mach))):
        t = begin + np.arange(4000) / 8000
        tau = source_times(motion, REST, observers, t, C)
        phase = 2 * np.pi * frequency * tau[:, None, None]
        force = np.array([1.0, 0.0, 0.0])
        rate = -2 * np.pi * frequency * np.sin(phase) * force
        p = source_history(
            "loading",
            unsteady_loads([REST], np.cos(phase) * force, rate),
            motion,
            tau,
            observers,
            t,
            AIR,
        )[0]
        up = np.flatnonzero((p[:-1] < 0) & (p[1:] >= 0))
        crossing = t[up] - p[up] * (t[1] - t[0]) / (p[up + 1] - p[up])
        heard = (crossing.size - 1) / (crossing[-1] - crossing[0])
        assert heard == pytest.approx(expected, rel=1e-3)


def test_many_panels_in_chunks_are_the_sum_of_their_parts(slow_flyer, monkeypatch):
    """More panels times source times than are worked on at once, and a last chunk that is short."""
    t = np.arange(600) * 1e-5
    (motion,), observers = blade_motions([0.0], 900.0), observers_at((1.0, 0.5, -1.0))
    panels = slow_flyer.panels
    tau = source_times(motion, panels.center, observers, t, C)
    half = panels.center.shape[0] // 2
    parts = [
        Panels(panels.center[part], panels.vector_area[part])
        for part in (slice(None, half), slice(half, None))
    ]
    assert half * tau.size > 32768
    whole, *halves = (
        source_history("thickness", q, motion, tau, observers, t, AIR)[0] for q in (panels, *parts)
    )
    np.testing.assert_allclose(whole, halves[0] + halves[1], atol=1e-12 * np.ptp(whole))


def test_source_steps_of_any_length_meet_the_observers_clock():
    motion, observers = (rotation((0, 0, 1), rate=300.0),), observers_at((2.0, 0.0, -1.0))
    loads = PointLoads(jnp.array([[0.5, 0, 0]]), jnp.array([[0.0, 1.0, -2.0]]))
    t = np.linspace(0, 0.02, 257)
    fine, finer, coarse = (
        source_history(
            "loading",
            loads,
            motion,
            source_times(motion, loads.position, observers, t, C, step),
            observers,
            t,
            AIR,
        )
        for step in (1e-4, 1e-5, 3e-4)
    )
    np.testing.assert_allclose(fine, finer, atol=1e-4 * np.ptp(finer))
    np.testing.assert_allclose(coarse, finer, atol=1e-2 * np.ptp(finer))
    assert np.isfinite(coarse).all()


def test_source_steps_are_not_longer_than_the_record():
    t = np.linspace(0, 0.1, 65)
    tau = source_times((), REST, observers_at((34.0, 0, 0)), t, C, step=1e30)
    assert np.diff(tau).max() <= 0.1
    assert tau[0] <= -0.1 - 0.1 and tau[-1] >= 0.1


def test_what_no_source_time_reaches_is_not_a_number():
    loads = PointLoads(jnp.zeros((1, 3)), jnp.ones((1, 3)))
    t = np.linspace(0.0, 1.0, 101)
    p = source_history(
        "loading", loads, (), np.linspace(0.0, 0.5, 51), observers_at((34.0, 0, 0)), t, AIR
    )[0]
    heard = np.isfinite(p)  # from 0.1 + one step to 0.6 - one step
    np.testing.assert_array_equal(heard, (t > 0.109) & (t < 0.589))


def test_derivatives_pass_through(slow_flyer):
    t = np.arange(64) * 1e-4
    (motion,), observers = blade_motions([0.0], 400.0), observers_at((1.0, 0.5, -1.0))
    loads = slow_flyer.loads
    tau = source_times(motion, loads.position, observers, t, C)

    def energy(scale):
        moved = PointLoads(scale * loads.position, loads.force)
        return jnp.sum(source_history("loading", moved, motion, tau, observers, t, AIR) ** 2)

    with_slope = compiled(jax.value_and_grad(energy), optimisation=0)
    difference = (with_slope(1 + 1e-5)[0] - with_slope(1 - 1e-5)[0]) / 2e-5
    assert float(with_slope(1.0)[1]) == pytest.approx(float(difference), rel=1e-6)


class TestTables:
    def test_periodic_with_and_without_the_repeated_end(self):
        phase = np.linspace(0, 2 * np.pi, 73)
        times = np.linspace(-3.0, 5.0, 50)
        expected = [np.sin(np.pi * times), np.pi * np.cos(np.pi * times)]
        for keep in (73, 72):
            got = sample(np.sin(phase[:keep]), phase[:keep] / np.pi, times, period=2.0)
            np.testing.assert_allclose(got[0], expected[0], atol=1e-6)
            np.testing.assert_allclose(got[1], expected[1], atol=1e-4)

    def test_a_table_that_ends_too_early_is_refused(self):
        with pytest.raises(
            ValueError, match=r"table over 0 \.\.\. 1 s is asked for 0.5 \.\.\. 2 s"
        ):
            sample(np.zeros(5), np.linspace(0, 1, 5), [0.5, 2.0])
        with pytest.raises(ValueError, match="longer than its period"):
            sample(np.zeros(5), np.linspace(0, 1, 5), [0.5], period=0.5)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"t": np.array([0.0, 1.0, 3.0])}, "evenly spaced"),
        ({"tau": np.zeros(9)}, "source times must be 4 or more"),
        ({"velocity": (0, 0, 400.0)}, "observers must be slower than sound; .* 1.176"),
    ],
)
def test_bad_input_is_one_clear_line(change, message):
    case = {"t": np.linspace(0, 1, 9), "tau": np.linspace(0, 1, 9), "velocity": REST} | change
    loads = PointLoads(jnp.zeros((1, 3)), jnp.ones((1, 3)))
    observers = observers_at((1.0, 0, 0), velocity=case["velocity"])
    with pytest.raises(ValueError, match=message):
        source_history("loading", loads, (), case["tau"], observers, case["t"], AIR)


@pytest.mark.parametrize(
    "motion", [translation(velocity=(400.0, 0, 0)), rotation((0, 0, 1), 0, 400)]
)
def test_supersonic_sources_are_refused(motion):
    points = [[-1.0, 0, 0], [1.0, 0, 0]]
    with pytest.raises(ValueError, match="must be slower than sound"):
        source_times((motion,), points, observers_at((9.0, 0, 0)), [0.0, 0.1], C)
