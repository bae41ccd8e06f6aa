"""Bars with closed solutions: bending, torsion, rotation, pretwist, sweep."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.runtime.compilation import compiled
from propmdao.structures.beam import SectionForces, motion
from propmdao.structures.equilibrium import equilibrium
from propmdao.structures.shapes import gauss, shapes
from propmdao.structures.vibration import natural_frequencies

from .conftest import BASIS, held, loads, tip


def test_polynomials_integrate_what_they_are():
    s = np.linspace(0.0, 1.0, 7)
    basis, nodes = shapes(s), gauss(40)[0]
    np.testing.assert_allclose(basis.integral @ shapes(nodes).slope, basis.value, atol=1e-13)
    np.testing.assert_allclose(basis.integral @ np.cos(nodes), np.sin(s), atol=1e-14)
    assert not basis.value[0].any()


def test_without_loads_nothing_moves(bar):
    assert not np.any(held(bar).amplitudes)


def test_cantilever_under_tip_and_span_load(bar):
    small = 0.01
    stiff = bar.young * bar.flap_inertia
    assert tip(bar, z=small)[1] == pytest.approx(small / (3 * stiff), rel=1e-6)
    assert tip(bar, span_z=small)[1] == pytest.approx(small / (8 * stiff), rel=1e-6)
    sideways = small / (3 * bar.young * bar.lag_inertia)
    assert tip(bar, y=small)[0] == pytest.approx(sideways, rel=1e-6)
    assert tip(bar, moment=small)[2] == pytest.approx(
        small / (bar.shear * bar.torsion_constant), rel=1e-6
    )


def test_a_force_ahead_of_the_elastic_axis_winds_the_blade_in(bar):
    ahead = SectionForces(
        jnp.full((13, 2), jnp.array([0.01, 0.0])), loads(z=0.1).force, jnp.zeros(13)
    )
    found = equilibrium(bar.beam, 0.0, BASIS, ahead)
    turn = motion(bar.beam, shapes([1.0]), found.amplitudes)[1][0]
    assert turn == pytest.approx(0.1 * 0.01 / (bar.shear * bar.torsion_constant), rel=1e-3)


@pytest.mark.parametrize("beta", [0.3, -0.7])
def test_propeller_moment_turns_a_blade_flat(bar, beta):
    """Moment per span -rho Omega^2 (I_max - I_min) sin cos of the blade angle, constant here."""
    speed, bar = 2.0, replace(bar, beta=beta)
    inertia = bar.lag_inertia - bar.flap_inertia
    moment = -bar.density * speed**2 * inertia * np.sin(beta) * np.cos(beta)
    expected = moment * bar.length**2 / (2 * bar.shear * bar.torsion_constant)
    assert tip(bar, speed)[2] == pytest.approx(expected, rel=1e-4)


def test_tension_untwists_a_twisted_bar(bar):
    """Torque T k_A^2 beta' on a twisted bar (Houbolt and Brooks), here with the tension at each r.

    The blade angle is kept near zero so that the propeller moment has no part.
    """
    speed, rate = 3.0, 1e-3
    bar = replace(bar, twist_rate=rate)
    polar = (bar.lag_inertia + bar.flap_inertia) / bar.area
    tension_integral = bar.density * bar.area * speed**2 * bar.length**3 / 3
    untwist = -tension_integral * polar * rate
    # The propeller moment, -rho Omega^2 (I_max - I_min) beta(r), twice integrated.
    inertia = bar.lag_inertia - bar.flap_inertia
    flat = -bar.density * speed**2 * inertia * rate * bar.length**3 / 3
    expected = (untwist + flat) / (bar.shear * bar.torsion_constant)
    assert tip(bar, speed)[2] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("speed", "published"),
    [
        (0.0, (3.5160, 22.0345)),
        (2.0, (4.1373, 22.6149)),
        (6.0, (7.3604, 26.8091)),
        (10.0, (11.2023, 33.6404)),
    ],
)
def test_rotation_stiffens_flapping(bar, speed, published):
    """Uniform beam clamped at the axis, over sqrt(EI / m L^4): Wright, Smith, Thresher and Wang,
    J. Applied Mechanics 49 (1982), table 1."""
    unit = np.sqrt(bar.young * bar.flap_inertia / (bar.density * bar.area * bar.length**4))
    amplitudes = held(bar, speed * unit).amplitudes
    found = natural_frequencies(bar.beam, speed * unit, amplitudes)[:2] / unit
    np.testing.assert_allclose(found, published, rtol=1e-4)


@pytest.mark.parametrize("degrees", [5.0, 20.0])
def test_a_swept_bar_is_the_same_bar_in_other_axes(bar, degrees):
    angle, force, moment = np.radians(degrees), 0.01, 0.01
    bar = replace(bar, sweep=angle)
    # The bar along its own axis: longer, and narrower across it.
    length, inertia = 1.0 / np.cos(angle), bar.flap_inertia * np.cos(angle)
    bending = bar.young * inertia
    _, lifted, turn = tip(bar, z=force)
    assert lifted == pytest.approx(force * length**3 / (3 * bending), rel=1e-5)
    # Swept aft, a blade that bends up turns nose down.
    assert turn == pytest.approx(-force * length**2 / (2 * bending) * np.sin(angle), rel=1e-5)
    torsion = bar.shear * bar.torsion_constant * np.cos(angle)
    expected = moment * length * (np.cos(angle) ** 2 / torsion + np.sin(angle) ** 2 / bending)
    assert tip(bar, moment=moment)[2] == pytest.approx(expected, rel=1e-5)


def test_derivatives_of_the_twist_are_those_of_the_equilibrium(bar):
    bar = replace(bar, beta=0.3, sweep=0.1)
    beam, tip_basis = bar.beam, shapes([1.0])
    fixed = loads(z=0.3)

    def twist(speed_and_moment):
        speed, moment = speed_and_moment
        given = SectionForces(fixed.arm, fixed.force, jnp.zeros(13).at[-1].set(moment))
        found = equilibrium(beam, speed, BASIS, given)
        return motion(beam, tip_basis, found.amplitudes)[1][0]

    x, h = np.array([20.0, 0.02]), 1e-4
    with_slopes = compiled(jax.value_and_grad(twist), optimisation=0)
    exact = with_slopes(x)[1]
    for i in range(2):
        step = h * np.eye(2)[i]
        change = float(with_slopes(x + step)[0] - with_slopes(x - step)[0]) / (2 * h)
        assert float(exact[i]) == pytest.approx(change, rel=1e-5)


def test_a_blade_that_cannot_stand_says_so(bar):
    """A bar as soft as this has no minimum near its shape under a moment of this size."""
    soft = replace(bar, young=70e3, shear=26e3, beta=0.3)
    assert not equilibrium(soft.beam, 300.0, BASIS, loads(z=50.0, moment=20.0)).stable


def test_a_raked_and_swept_blade_does_not_lock(bar):
    """A wavy axis, steeper than polynomials can follow, is as soft as one that is straight."""
    beam = bar.beam
    s, wave = gauss(40)[0], 0.1
    slope = wave * np.stack([np.sin(25.0 * s), np.cos(25.0 * s)], axis=-1)
    wavy = replace(beam, axis_slope=jnp.asarray(slope))
    found = [equilibrium(b, 0.0, BASIS, loads(z=0.01)).amplitudes for b in (beam, wavy)]
    straight, waved = (
        float(motion(b, shapes([1.0]), q)[0][0, 1])
        for b, q in zip((beam, wavy), found, strict=True)
    )
    assert waved == pytest.approx(straight, rel=3 * wave**2)
