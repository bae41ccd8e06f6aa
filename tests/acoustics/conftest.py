"""A real blade, a body without extent, and Formulation 1A again as time histories."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.signals import Tones
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.surface import surface_nodes, surface_panels, surface_span
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.records.states import RotorState


@dataclasses.dataclass(frozen=True)
class Rotor:
    """Arguments of `tones`, with a default for each."""

    panels: Panels
    loads: PointLoads
    n_blades: int = 2
    rotation_speed: float = 440.0
    speed: float = 0.0
    density: float = 1.2
    sound_speed: float = 340.0

    def tones(self, observers: np.ndarray, n_harmonics: int = 10) -> Tones:
        places = np.atleast_2d(observers)
        return tones(self.panels, self.loads, self.n_blades, self.state, places, n_harmonics)

    @property
    def state(self) -> RotorState:
        air = Air(density=self.density, sound_speed=self.sound_speed)
        return RotorState(self.rotation_speed, self.speed, air)

    def with_(self, **changes: object) -> Rotor:
        return dataclasses.replace(self, **changes)


NO_LOADS = PointLoads(position=jnp.ones((1, 3)), force=jnp.zeros((1, 3)))


@pytest.fixture(scope="session")
def slow_flyer() -> Rotor:
    """APC-SF 11x4.7, coarsely panelled, with loads of a plausible size at 4200 rpm."""
    propeller = load_propeller("apcsf_11x4.7_uiuc")
    blade = Blade.from_propeller(propeller)
    span = surface_span(propeller.r_over_R[0], 10)
    nodes = surface_nodes(blade, span_interpolation(propeller.r_over_R, span), n_contour=13)
    r = 0.1397 * np.linspace(0.2, 0.98, 8)
    position = np.stack([r, -0.01 + 0.05 * r, 0.002 + 0.03 * r], axis=-1)
    force = np.stack([0.01 * r, 2.0 * r, -30.0 * r * (0.14 - r) - 1.5 * r], axis=-1)
    return Rotor(surface_panels(nodes), PointLoads(jnp.asarray(position), jnp.asarray(force)))


@pytest.fixture(scope="session")
def point_force() -> Callable[..., Rotor]:
    """Make a rotor whose blade is one point force and displaces nothing."""

    def make(position: tuple, force: tuple, **changes: object) -> Rotor:
        nothing = Panels(jnp.ones((1, 3)), jnp.zeros((1, 3)))
        loads = PointLoads(jnp.asarray([position], float), jnp.asarray([force], float))
        return Rotor(nothing, loads, **changes)

    return make


@pytest.fixture(scope="session")
def point_volume() -> Callable[..., Rotor]:
    """Make a rotor whose blade is a body without extent: a cube of 0.1 mm, areas scaled up."""

    def make(position: tuple, volume: float, **changes: object) -> Rotor:
        size = 1e-4
        sides = np.vstack([np.eye(3), -np.eye(3)])
        cube = Panels(
            jnp.asarray(np.asarray(position) + size / 2 * sides), jnp.asarray(volume / size * sides)
        )
        return Rotor(cube, NO_LOADS, **changes)

    return make


@pytest.fixture(scope="session")
def heard_over_time() -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    return _heard_over_time


def _heard_over_time(
    rotor: Rotor, observer: np.ndarray, n_times: int
) -> tuple[np.ndarray, np.ndarray]:
    """Thickness and loading pressure over one TURN, by retarded time, every blade on its own.

    Formulation 1A as Farassat prints it (NASA TM-2007-214853), in a frame at rest, with vectors and
    every term: nothing in common with the product but the formula.
    """
    omega, c, ez = rotor.rotation_speed, rotor.sound_speed, np.array([0.0, 0.0, 1.0])
    t = np.arange(n_times)[:, None] * 2 * np.pi / omega / n_times
    histories = []
    for points, vectors in (
        (rotor.panels.center, rotor.panels.vector_area),
        (rotor.loads.position, rotor.loads.force),
    ):
        pressure = np.zeros(n_times)
        for blade in range(rotor.n_blades):

            def turned(q, tau, phase=2 * np.pi * blade / rotor.n_blades):
                cos, sin = np.cos(omega * tau + phase), np.sin(omega * tau + phase)
                x, y, z = np.asarray(q).T
                return np.stack([cos * x - sin * y, sin * x + cos * y, z + 0 * tau], axis=-1)

            x = observer + rotor.speed * t[..., None] * ez
            tau = t - np.linalg.norm(x - np.asarray(points), axis=-1) / c
            for _ in range(60):  # fixed point; contracts by the Mach number
                y = turned(points, tau) + rotor.speed * tau[..., None] * ez
                tau = t - np.linalg.norm(x - y, axis=-1) / c
            y = turned(points, tau) + rotor.speed * tau[..., None] * ez
            d = np.linalg.norm(x - y, axis=-1)
            r = (x - y) / d[..., None]
            spin = omega * ez
            v = np.cross(spin, turned(points, tau)) + rotor.speed * ez
            vdot = np.cross(spin, np.cross(spin, turned(points, tau)))
            q = turned(vectors, tau)
            qdot = np.cross(spin, q)

            def dot(a, b):
                return np.sum(a * b, axis=-1)

            m_r, mdot_r, m2 = dot(v, r) / c, dot(vdot, r) / c, dot(v, v) / c**2
            near = d * mdot_r + c * (m_r - m2)
            if points is rotor.panels.center:
                first = rotor.density * (dot(vdot, q) + dot(v, qdot)) / (d * (1 - m_r) ** 2)
                p = first + rotor.density * dot(v, q) * near / (d**2 * (1 - m_r) ** 3)
            else:
                p = dot(qdot, r) / (c * d * (1 - m_r) ** 2)
                p += (dot(q, r) - dot(q, v) / c) / (d**2 * (1 - m_r) ** 2)
                p += dot(q, r) * near / (c * d**2 * (1 - m_r) ** 3)
            pressure += p.sum(axis=-1) / (4 * np.pi)
        histories.append(pressure)
    return histories[0], histories[1]
