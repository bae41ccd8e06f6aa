"""Equilibrium of a blade under centrifugal and air loads: the minimum of its potential."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.records.pytrees import Scalar, record
from propmdao.runtime import linear_algebra
from propmdao.runtime.compilation import compiled
from propmdao.structures.beam import Beam, SectionForces, potential, work
from propmdao.structures.shapes import N_SHAPES, Shapes

_MAX_STEPS = 60
_TOLERANCE = 1.0e-9  # of the last step over the largest amplitude
# Fractions of a Newton step that are tried, and what rounding may add to the potential.
_FRACTIONS = 0.5 ** np.arange(12)
_ROUNDING = 1.0e-12
_NOTHING = 1.0e-30  # largest amplitude of a blade without loads


@record
class Equilibrium:
    """A deflection at which all forces on a blade balance.

    Attributes
    ----------
    amplitudes : (4, N_SHAPES) array
        Amplitudes of the stretch [m], psi_y, psi_z and phi [rad], as `beam.motion` takes them.
    stable : bool
        Whether Newton's method came to rest, in a minimum of the potential.
    """

    amplitudes: Array
    stable: Array


class _Newton(NamedTuple):
    n_steps: Array | int
    q: Array
    last: Array  # size of the last step over the largest amplitude
    stiffness: Array  # second derivatives of the potential, before the last step


@compiled
def equilibrium(
    beam: Beam, rotation_speed: Scalar, basis: Shapes, loads: SectionForces
) -> Equilibrium:
    """Find the deflection of a blade that turns under given loads.

    Derivatives are those of the implicit function: nothing is differentiated through the
    iterations.

    Parameters
    ----------
    beam : Beam
        The blade.
    rotation_speed : scalar
        Rotation speed [rad/s].
    basis : Shapes
        Polynomials at the m sections that are loaded.
    loads : SectionForces
        Loads of these sections.

    Returns
    -------
    Equilibrium
        The deflection, 0 where nothing loads the blade.
    """
    params = beam, jnp.asarray(rotation_speed, float), loads

    def total(params: tuple[Beam, Array, SectionForces], q: Array) -> Array:
        beam, rotation_speed, loads = params
        amplitudes = q.reshape(4, N_SHAPES)
        return potential(beam, rotation_speed, amplitudes) - work(beam, basis, loads, amplitudes)

    slope, stiffness = jax.grad(total, argnums=1), jax.hessian(total, argnums=1)
    fixed = jax.lax.stop_gradient(params)
    # Tension comes first: without it, a blade that turns fast is not stiff enough to stand.
    outward = jnp.arange(4 * N_SHAPES) < N_SHAPES
    others = jnp.diag(jnp.where(outward, 0.0, 1.0))

    def unfinished(state: _Newton) -> Array:
        return (state.n_steps < _MAX_STEPS) & (state.last > _TOLERANCE)

    def step(state: _Newton) -> _Newton:
        q, first = state.q, state.n_steps == 0
        by_q, force = stiffness(fixed, q), -slope(fixed, q)
        by_u = jnp.where(outward[:, None] & outward, by_q, others)
        dq = linear_algebra.solve(
            jnp.where(first, by_u, by_q), jnp.where(first & ~outward, 0.0, force)
        )
        energies = jax.lax.map(lambda f: total(fixed, q + f * dq), jnp.append(_FRACTIONS, 0.0))
        falls = energies[:-1] <= energies[-1] + _ROUNDING * jnp.abs(energies[-1])
        fraction = jnp.where(
            falls.any(), jnp.asarray(_FRACTIONS)[jnp.argmax(falls)], _FRACTIONS[-1]
        )
        following = q + fraction * dq
        size = jnp.abs(dq).max() / jnp.maximum(jnp.abs(following).max(), _NOTHING)
        last = jnp.where(first, 1.0, size)
        return _Newton(state.n_steps + 1, following, last, by_q)

    n = 4 * N_SHAPES
    end = jax.lax.while_loop(
        unfinished, step, _Newton(0, jnp.zeros(n), jnp.ones(()), jnp.zeros((n, n)))
    )
    # One more step, in which only the forces are differentiated, has the implicit derivative.
    q, by_q = jax.lax.stop_gradient((end.q, end.stiffness))
    q = q - linear_algebra.solve(by_q, slope(params, q))
    stable = (end.last <= _TOLERANCE) & (linear_algebra.eigenvalues(by_q)[0] > 0.0)
    return Equilibrium(q.reshape(4, N_SHAPES), stable)
