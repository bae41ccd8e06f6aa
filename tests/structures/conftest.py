"""Bars of rectangular section, whose deflections are known in closed form."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.structures.beam import Beam, Material, SectionForces, motion
from propmdao.structures.equilibrium import Equilibrium, equilibrium
from propmdao.structures.shapes import N_RADII, gauss, shapes


@dataclasses.dataclass(frozen=True)
class Bar:
    """A bar of aluminium from the axis of rotation along x; its wide side at `beta`."""

    length: float = 1.0
    width: float = 0.05
    thickness: float = 0.004
    beta: float = 0.0
    twist_rate: float = 0.0
    sweep: float = 0.0  # angle, aft
    young: float = 70e9
    shear: float = 26e9
    density: float = 2700.0

    @property
    def area(self) -> float:
        return self.width * self.thickness

    @property
    def flap_inertia(self) -> float:
        return self.width * self.thickness**3 / 12

    @property
    def lag_inertia(self) -> float:
        return self.thickness * self.width**3 / 12

    @property
    def torsion_constant(self) -> float:
        return self.width * self.thickness**3 / 3

    @property
    def beam(self) -> Beam:
        s, _ = gauss(N_RADII)
        x, share = gauss(12)
        aft = (x - 0.5) * self.width
        up = np.full(x.size, self.thickness / np.sqrt(12))
        chordwise, normal = np.concatenate([aft, aft]), np.concatenate([up, -up])
        beta = (self.beta + self.twist_rate * self.length * s)[:, None]
        fibres = np.stack(
            [
                -chordwise * np.cos(beta) - normal * np.sin(beta),
                -chordwise * np.sin(beta) + normal * np.cos(beta),
            ],
            axis=-1,
        )
        area = np.tile(share * self.area / 2, 2)
        one, aside = np.ones(N_RADII), -np.tan(self.sweep)
        return Beam(
            root=jnp.asarray(0.0),
            length=jnp.asarray(self.length),
            axis=jnp.stack([jnp.asarray(aside * self.length * s), jnp.zeros(N_RADII)], axis=-1),
            axis_slope=jnp.asarray(np.stack([aside * one, 0 * one], axis=-1)),
            twist_rate=jnp.asarray(self.twist_rate * one),
            fibres=jnp.asarray(fibres),
            areas=jnp.asarray(area * one[:, None]),
            torsion_constant=jnp.asarray(self.torsion_constant * one),
            material=Material(self.young, self.shear, self.density),
        )


#: Where the bars are loaded: 12 places of Gauss over the span, and the tip.
PLACES, SHARE = gauss(12)
BASIS = shapes([*PLACES, 1.0])


def loads(y=0.0, z=0.0, moment=0.0, span_z=0.0) -> SectionForces:
    """Force and moment at the tip, and a force spread evenly over the span."""
    force = np.zeros((13, 2))
    force[:-1, 1], force[-1] = span_z * SHARE, (y, z)
    moments = np.zeros(13)
    moments[-1] = moment
    return SectionForces(jnp.zeros((13, 2)), jnp.asarray(force), jnp.asarray(moments))


def held(bar: Bar, rotation_speed: float = 0.0, **load: float) -> Equilibrium:
    found = equilibrium(bar.beam, rotation_speed, BASIS, loads(**load))
    assert found.stable
    return found


def tip(bar: Bar, rotation_speed: float = 0.0, **load: float) -> tuple[float, float, float]:
    """Displacement along y and z and turn of the tip."""
    d, phi = motion(bar.beam, shapes([1.0]), held(bar, rotation_speed, **load).amplitudes)
    return float(d[0, 0]), float(d[0, 1]), float(phi[0])


@pytest.fixture
def bar() -> Bar:
    return Bar()
