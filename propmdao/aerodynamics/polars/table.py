"""Polars of the sections of a blade: lift, drag and moment over angle and Reynolds number."""

from __future__ import annotations

import warnings

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.polars.interpolation import clamped_stencil, periodic_stencil
from propmdao.aerodynamics.polars.mach import MACH_LIMIT, prandtl_glauert
from propmdao.records import record


class PolarError(ValueError):
    """A polar cannot be found, read or made; the message is one line."""


class PolarRangeWarning(UserWarning):
    """A section works outside its polars, which are held at their ends there."""


@record
class PolarTable:
    """Polars of several sections on shared angles and Reynolds numbers.

    Attributes
    ----------
    alpha : (n_alpha,) array
        Angles of attack from -pi to pi, both included and equal in value [rad].
    log_re : (n_re,) array
        Natural logarithms of the Reynolds numbers, rising, at least two.
    values : (n_sections, 3, n_re, n_alpha) array
        Lift coefficient, natural logarithm of the drag coefficient (drag stays positive whatever
        is blended or interpolated), moment coefficient about the quarter chord (nose up).
    """

    alpha: jax.Array
    log_re: jax.Array
    values: jax.Array

    @property
    def cl(self) -> jax.Array:
        """Lift coefficients, (n_sections, n_re, n_alpha)."""
        return self.values[:, 0]

    @property
    def cd(self) -> jax.Array:
        """Drag coefficients, (n_sections, n_re, n_alpha)."""
        return jnp.exp(self.values[:, 1])

    @property
    def cm(self) -> jax.Array:
        """Moment coefficients about the quarter chord, (n_sections, n_re, n_alpha)."""
        return self.values[:, 2]


@jax.jit
def section_coefficients(
    table: PolarTable, alpha: jax.Array, re: jax.Array, mach: jax.Array | float = 0.0
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Lift, drag and moment of each section at its own angle, Reynolds and Mach number.

    Parameters
    ----------
    table : PolarTable
        Polars of n sections.
    alpha : (n,) array
        Angle of attack of each section, any angle [rad].
    re : (n,) array
        Reynolds number on the chord, positive; held at the ends of the table (`warn_outside`
        tells the user).
    mach : (n,) array or number
        Mach number; raises lift and moment by `prandtl_glauert`, leaves drag.

    Returns
    -------
    cl, cd, cm : (n,) arrays
        Coefficients, C1 in every argument; cm about the quarter chord, nose up.
    """
    at_re, re_weight = clamped_stencil(table.log_re, jnp.log(re))
    at_alpha, alpha_weight = periodic_stencil(table.alpha, alpha)
    row = jnp.arange(table.values.shape[0])[:, None, None]
    near = table.values[row, :, at_re[:, :, None], at_alpha[:, None, :]]
    cl, log_cd, cm = jnp.einsum("nrac,nr,na->cn", near, re_weight, alpha_weight)
    factor = prandtl_glauert(mach, alpha)
    return factor * cl, jnp.exp(log_cd), factor * cm


def warn_outside(
    table: PolarTable,
    re: npt.ArrayLike,
    r_over_R: npt.ArrayLike,
    mach: npt.ArrayLike = 0.0,
) -> None:
    """Warn once if sections work outside their polars; call it outside ``jit``.

    Parameters
    ----------
    table : PolarTable
        Polars of n sections.
    re, r_over_R : (n,) arrays
        Reynolds number and radius of each section.
    mach : (n,) array or number
        Mach number of each section.

    Warns
    -----
    PolarRangeWarning
        One line for Reynolds and one for Mach numbers, naming the section furthest outside.
    """
    re, radii = np.asarray(re, dtype=float), np.asarray(r_over_R, dtype=float)
    low, high = np.exp(np.asarray(table.log_re)[[0, -1]])
    excess = np.maximum(np.log(low / re), np.log(re / high))
    if (excess > 1e-9).any():
        worst = int(excess.argmax())
        warnings.warn(
            f"Reynolds number {re[worst]:.3g} at r/R {radii[worst]:.3g} is outside the polars' "
            f"{low:.3g}..{high:.3g} ({int((excess > 1e-9).sum())} of {re.size} sections are); "
            "the polars are held at the end of their range there",
            PolarRangeWarning,
            stacklevel=2,
        )
    machs = np.broadcast_to(np.asarray(mach, dtype=float), radii.shape)
    if (machs > MACH_LIMIT).any():
        worst = int(machs.argmax())
        warnings.warn(
            f"Mach number {machs[worst]:.3g} at r/R {radii[worst]:.3g} is above {MACH_LIMIT:g}; "
            "the polars know no shocks: their lift correction is held there, drag has none",
            PolarRangeWarning,
            stacklevel=2,
        )
