"""Point sources on a circle against the exact Green's function and the far-field closed forms.

With n = m B, k = n Omega / c and amplitudes of exp(-1j n Omega t), a force F that turns with the
blade and a volume v that it displaces radiate, at an observer x that flies along,

    P_m = B/2pi  oint  exp(1j n psi) F . grad_y G(x - y(psi)) dpsi
    P_m = B/2pi  oint  exp(1j n psi) rho v (-1j n Omega - V d/dz)^2 G(x - y(psi)) dpsi

because p solves the wave equation with -div(F delta) and rho d^2/dt^2 (v delta) on its right-hand
side. G = exp(1j k sigma) / (4 pi S) is the Green's function in the moving frame (Garrick and
Watkins, NACA Report 1198, 1954): S^2 = z^2 + (1 - M^2)(x^2 + y^2), sigma = (M z + S) / (1 - M^2),
with z along the flight, which may be at an angle to the shaft.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.special import jv, jvp

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.sources.periodic import rotor_tones
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.records.air import Air
from propmdao.records.loads import PeriodicLoads
from propmdao.runtime.compilation import compiled

RADIUS, RAKE = 0.9, 0.05
HARMONICS = np.arange(1, 11)


def level_error(product, reference):
    return np.abs(20 * np.log10(np.abs(np.asarray(product) / reference))).max()


def exact(rotor, observer, source, n_azimuths=256, incidence=0.0):
    """Average `source(n Omega, G(n), D)` over one turn for every harmonic."""
    mach = rotor.speed / rotor.sound_speed

    def green(k, x, y, z):
        ahead = x * jnp.sin(incidence) + z * jnp.cos(incidence)
        s = jnp.sqrt(mach**2 * ahead**2 + (1 - mach**2) * (x**2 + y**2 + z**2))
        return jnp.exp(1j * k * (mach * ahead + s) / (1 - mach**2)) / (4 * jnp.pi * s)

    def one(n, psi):
        distance = (
            observer[0] - RADIUS * jnp.cos(psi),
            observer[1] - RADIUS * jnp.sin(psi),
            observer[2] - RAKE,
        )
        omega = n * rotor.rotation_speed
        g = source(omega, lambda *d: green(omega / rotor.sound_speed, *d), distance, psi)
        return rotor.n_blades * jnp.exp(1j * n * psi) * g

    psi = jnp.linspace(0, 2 * jnp.pi, n_azimuths, endpoint=False)
    grid = jax.vmap(jax.vmap(one, (None, 0)), (0, None))
    orders = jnp.asarray(rotor.n_blades * HARMONICS, float)
    return np.asarray(compiled(grid, optimisation=0)(orders, psi)).mean(axis=1)


@pytest.mark.parametrize("speed", [0.0, 120.0])
@pytest.mark.parametrize("observer", [(2.0, 0.3, -1.5), (0.4, -1.9, 0.8)])
class TestNearField:
    def test_turning_force(self, point_force, speed, observer):
        force = (0.3, 1.7, -4.0)  # outward, along the motion, along the axis
        rotor = point_force((RADIUS, 0, RAKE), force, rotation_speed=200.0, speed=speed)

        def dipole(omega, green, distance, psi):
            cos, sin = jnp.cos(psi), jnp.sin(psi)
            fx, fy = force[0] * cos - force[1] * sin, force[0] * sin + force[1] * cos
            # -F . grad_x = F . grad_y
            return -jax.jvp(green, distance, (fx, fy, jnp.full_like(fx, force[2])))[1]

        loading = rotor.tones(np.array(observer)).parts["loading"][0]
        np.testing.assert_allclose(loading, exact(rotor, observer, dipole), rtol=1e-9)

    def test_force_that_changes_around_the_turn_at_an_incidence(self, point_force, speed, observer):
        """All harmonics of the loads, of which each radiates at all of the blade passage."""
        incidence, at = 1.2, np.array([RADIUS, 0.0, RAKE])
        steady, factors = (0.3, 1.7, -4.0), (0.8, -0.5, 0.3)

        def force(psi):
            change = 1 + sum(a * jnp.cos(k * psi + k) for k, a in enumerate(factors, start=1))
            return jnp.stack([q * change for q in steady])

        def dipole(omega, green, distance, psi):
            (radial, along, axial), cos, sin = force(psi), jnp.cos(psi), jnp.sin(psi)
            f = radial * cos - along * sin, radial * sin + along * cos, axial
            return -jax.jvp(green, distance, f)[1]

        rotor = point_force(at, steady, rotation_speed=200.0, speed=speed)
        psi = 2 * np.pi * np.arange(144) / 144
        loads = PeriodicLoads(jnp.asarray(at[None]), jax.vmap(force)(psi)[:, None])
        air = Air(density=rotor.density, sound_speed=rotor.sound_speed)
        product = rotor_tones(
            Rotor(equally_spaced(rotor.n_blades), 200.0, loads=loads),
            speed * np.array([np.sin(incidence), 0.0, np.cos(incidence)]),
            air,
            np.array(observer),
            HARMONICS.size,
        ).parts["loading"][0]
        reference = exact(rotor, observer, dipole, incidence=incidence)
        # A table of 144 azimuths, splines in between.
        np.testing.assert_allclose(product, reference, atol=1e-5 * np.abs(reference).max())

    def test_turning_volume(self, point_volume, speed, observer):
        volume = 2e-3
        rotor = point_volume((RADIUS, 0, RAKE), volume, rotation_speed=200.0, speed=speed)

        def displacement(omega, green, distance, psi):
            def convected(g):
                def derivative(*d):
                    value, d_dz = jax.jvp(g, d, (0.0 * psi, 0.0 * psi, 1.0 + 0.0 * psi))
                    return -1j * omega * value - speed * d_dz

                return derivative

            return rotor.density * volume * convected(convected(green))(*distance)

        thickness = rotor.tones(np.array(observer)).parts["thickness"][0]
        # the cube is 0.1 mm wide, 1e-4 of everything else, and its sides cancel to 1e-4
        np.testing.assert_allclose(thickness, exact(rotor, observer, displacement), rtol=1e-6)


@pytest.mark.parametrize("elevation_deg", [-60.0, -10.0, 45.0])
class TestFarField:
    """500 diameters away, in hover: G = exp(1j k (|x| - x.y/|x|)) / (4 pi |x|).

    With q = k r cos(el), averaging exp(1j n psi - 1j q cos psi) gives (-1j)^n J_n(q), times sin psi
    -n/q of that and times cos psi 1j J_n'/J_n of that.
    """

    def far(self, rotor, elevation_deg):
        distance = 1000 * RADIUS
        n = rotor.n_blades * HARMONICS
        omega = n * rotor.rotation_speed
        q = omega / rotor.sound_speed * RADIUS * np.cos(np.radians(elevation_deg))
        return n, omega, q, rotor.n_blades / (4 * np.pi * distance), arc(distance, elevation_deg)[0]

    def test_gutin_steady_thrust_and_torque(self, point_force, elevation_deg):
        """Gutin 1936 (NACA TM 1195), here with a radial force as well."""
        radial, tangential, axial = 0.3, 0.6, -4.0
        rotor = point_force((RADIUS, 0, 0), (radial, tangential, axial), rotation_speed=250.0)
        n, omega, q, spread, observer = self.far(rotor, elevation_deg)
        el = np.radians(elevation_deg)
        direction = (axial * np.sin(el) + tangential * n / q * np.cos(el)) * jv(n, q)
        direction = direction + 1j * radial * np.cos(el) * jvp(n, q)
        reference = spread * omega / rotor.sound_speed * direction
        assert level_error(rotor.tones(observer).parts["loading"][0], reference) < 0.01

    def test_deming_thickness_of_a_compact_section(self, point_volume, elevation_deg):
        """Deming 1938 (NACA TN 679) for one section of volume v per blade."""
        rotor = point_volume((RADIUS, 0, 0), 2e-3, rotation_speed=250.0)
        n, omega, q, spread, observer = self.far(rotor, elevation_deg)
        reference = spread * rotor.density * 2e-3 * omega**2 * jv(n, q)
        assert level_error(rotor.tones(observer).parts["thickness"][0], reference) < 0.01

    def test_blade_volume_alone_decides_the_thickness_of_a_slow_rotor(
        self, slow_flyer, elevation_deg
    ):
        """The first tone of a real surface at low Mach number: v r^2 over the blade counts."""
        rotor = slow_flyer.with_(rotation_speed=20.0)
        center, area = np.asarray(rotor.panels.center), np.asarray(rotor.panels.vector_area)
        # J_2(q) = q^2/8, so the source is the integral of (x + iy)^2 over the blade's volume,
        # by the divergence theorem that of (x + iy)^2 z over its surface.
        moment = np.sum((center[:, 0] + 1j * center[:, 1]) ** 2 * center[:, 2] * area[:, 2])
        k = 2 * 20.0 / rotor.sound_speed
        distance = 1e4 / k
        observer = arc(distance, elevation_deg)[0]
        reference = 2 * rotor.density * (40.0 * k * np.cos(np.radians(elevation_deg))) ** 2
        reference = reference * np.abs(moment) / 8 / (4 * np.pi * distance)
        first = rotor.tones(observer, 1).parts["thickness"][0, 0]
        assert np.abs(first) == pytest.approx(reference, rel=0.02)  # of the coarse panels
