"""Propellers of the geometry tests, and derivatives checked against differences."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.geometry.blade import Blade
from propmdao.propeller.description import Propeller
from propmdao.runtime.compilation import compiled

R_OVER_R = np.array([0.2, 0.4, 0.6, 0.8, 1.0])


def _straight(airfoil: str = "naca4412", beta_deg: float = 0.0) -> Propeller:
    return Propeller(
        name="straight",
        diameter=2.0,
        n_blades=1,
        r_over_R=R_OVER_R,
        c_over_R=np.full(5, 0.2),
        beta_deg=np.full(5, beta_deg),
        airfoils=[(0.0, airfoil)],
    )


@pytest.fixture(scope="session")
def straight() -> Callable[..., Propeller]:
    """Make a rectangular untwisted blade, tip radius 1 m, chord 0.2 m, root at 0.2."""
    return _straight


@pytest.fixture(scope="session")
def twisted() -> Propeller:
    """Blade with everything: taper, twist, blended sections, sweep, rake, own thickness."""
    return Propeller(
        name="twisted",
        diameter=0.3,
        n_blades=3,
        r_over_R=R_OVER_R,
        c_over_R=np.array([0.15, 0.22, 0.21, 0.15, 0.05]),
        beta_deg=np.array([45.0, 33.0, 22.0, 15.0, 11.0]),
        airfoils=[(0.2, "e63"), (1.0, "clarky")],
        thickness_over_chord=np.array([0.15, 0.12, 0.1, 0.09, 0.08]),
        sweep_over_R=np.array([0.0, -0.01, 0.0, 0.03, 0.08]),
        rake_over_R=np.array([0.0, 0.005, 0.01, 0.02, 0.04]),
    )


def _assert_derivatives(function: Callable[[Blade], jax.Array], blade: Blade) -> None:
    step = 1e-5

    @partial(compiled, optimisation=0)
    def along(t: float, blade: Blade, direction: Blade) -> tuple[jax.Array, jax.Array]:
        def moved(t: jax.Array) -> jax.Array:
            return function(jax.tree.map(lambda x, d: x + t * d, blade, direction))

        return moved(t), jax.jacfwd(moved)(t)

    for field in dataclasses.fields(blade):
        value = getattr(blade, field.name)
        if value is None:  # an edge that is not described
            continue
        ramp = jnp.cos(1.0 + jnp.arange(value.size, dtype=float)).reshape(value.shape)
        still = jax.tree.map(jnp.zeros_like, blade)
        direction = dataclasses.replace(still, **{field.name: ramp})

        (_, exact), (ahead, _), (back, _) = (along(t, blade, direction) for t in (0.0, step, -step))
        difference = (ahead - back) / (2.0 * step)
        np.testing.assert_allclose(exact, difference, atol=1e-9, err_msg=field.name)


@pytest.fixture(scope="session")
def assert_derivatives() -> Callable[[Callable[[Blade], jax.Array], Blade], None]:
    """Compare the derivative along every field of the blade with a central difference.

    The geometry is linear in all but beta, where the difference's error is step^2 / 6 = 2e-11.
    """
    return _assert_derivatives
