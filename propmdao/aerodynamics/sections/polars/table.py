"""Polars of the sections of a blade: lift, drag and moment over angle and Reynolds number."""

from __future__ import annotations

import warnings

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.polars.interpolation import (
    clamped_stencil,
    periodic_cubic,
    periodic_slopes,
)
from propmdao.aerodynamics.sections.polars.mach import (
    DRAG_RISE_LIMIT,
    MACH_LIMIT,
    attached_gain,
    attached_share,
    beyond_critical,
    drag_rise,
)
from propmdao.records.pytrees import record
from propmdao.runtime.compilation import compiled


class PolarError(ValueError):
    """A polar cannot be found, read or made; the message is one line."""


class PolarSubstituteWarning(UserWarning):
    """Polars of another section stand in for those that are missing."""


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
    values : (n_sections, 3, n_re, n_alpha) or (n_sections, 3, n_mach, n_re, n_alpha) array
        Lift coefficient, natural logarithm of the drag coefficient (drag stays positive whatever
        is blended or interpolated), moment coefficient about the quarter chord (nose up). Lift and
        moment are over the factor of `prandtl_glauert` at the Mach number where they were found,
        1 in incompressible flow: times the factor at the same number they are as found.
    mach : (n_mach,) array, optional
        Mach numbers of `values`, rising, at least two. None for polars that are the same but for
        that factor at all Mach numbers.
    thickness : (n_sections,) array, optional
        Maximum thickness over chord, from which shocks begin. None for sections without drag rise;
        polars that vary with Mach number have their own.
    """

    alpha: jax.Array
    log_re: jax.Array
    values: jax.Array
    mach: jax.Array | None = None
    thickness: jax.Array | None = None

    @property
    def cl(self) -> jax.Array:
        """Lift coefficients as in `values`, without its second axis."""
        return self.values[:, 0]

    @property
    def cd(self) -> jax.Array:
        """Drag coefficients, shaped as `values` without its second axis."""
        return jnp.exp(self.values[:, 1])

    @property
    def cm(self) -> jax.Array:
        """Moment coefficients about the quarter chord as in `values`, without its second axis."""
        return self.values[:, 2]


@record
class SectionCurves:
    """Polars of several sections, each at its own Reynolds and Mach number.

    Attributes
    ----------
    alpha : (n_alpha,) array
        Angles of attack, as `PolarTable` has them [rad].
    values : (n_sections, 3, n_alpha) array
        Lift coefficient, natural logarithm of the drag coefficient, moment coefficient, as
        `PolarTable` has them.
    slopes : (n_sections, 3, n_alpha) array
        Slopes of `values` at the nodes [1/rad].
    gain : (n_sections,) array or number
        What Mach number adds to attached lift and moment, by `attached_gain`.
    beyond : (n_sections,) array, optional
        Mach number over the critical one without lift, by `beyond_critical`; None where there is
        no drag rise to add.
    """

    alpha: jax.Array
    values: jax.Array
    slopes: jax.Array
    gain: jax.Array
    beyond: jax.Array | None = None


@compiled
def section_curves(
    table: PolarTable, re: jax.Array, mach: jax.Array | float = 0.0
) -> SectionCurves:
    """Interpolate polars to the Reynolds and Mach number of each section.

    Parameters
    ----------
    table : PolarTable
        Polars of n sections.
    re : (n,) array
        Reynolds number on the chord, positive; held at the ends of the table (`warn_outside`
        tells the user).
    mach : (n,) array or number
        Mach number; held at the ends of a table that has Mach numbers.

    Returns
    -------
    SectionCurves
        Polars over the angle of attack alone, cheap to evaluate with `curve_coefficients`.
    """
    index, weight = clamped_stencil(table.log_re, jnp.log(re))
    row = jnp.arange(table.values.shape[0])[:, None]
    if table.mach is None:
        near, thickness = table.values[row, :, index], table.thickness
        curves = jnp.einsum("nrca,nr->nca", near, weight)
    else:
        values = jnp.einsum("nrcma,nr->ncma", table.values[row, :, :, index], weight)
        machs = jnp.broadcast_to(jnp.asarray(mach, float), re.shape)
        index, weight = clamped_stencil(table.mach, machs)
        curves, thickness = jnp.einsum("nmca,nm->nca", values[row, :, index], weight), None
    return SectionCurves(
        table.alpha,
        curves,
        periodic_slopes(table.alpha, curves),
        attached_gain(mach),
        None if thickness is None else beyond_critical(mach, thickness),
    )


@compiled
def curve_coefficients(
    curves: SectionCurves, alpha: jax.Array
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Interpolate lift, drag and moment of each section to its own angle.

    Parameters
    ----------
    curves : SectionCurves
        Polars of n sections.
    alpha : (n,) array
        Angle of attack of each section, any angle [rad].

    Returns
    -------
    cl, cd, cm : (n,) arrays
        Coefficients, C1 in the angle; cm about the quarter chord, nose up. Drag is with that of
        shocks, by `drag_rise`, where the curves have a thickness.
    """
    index, (by_value, by_slope) = periodic_cubic(curves.alpha, alpha)
    row = jnp.arange(curves.values.shape[0])[:, None]
    read = jnp.einsum("nac,na->cn", curves.values[row, :, index], by_value)
    read += jnp.einsum("nac,na->cn", curves.slopes[row, :, index], by_slope)
    attached = attached_share(alpha)
    factor = 1.0 + attached * curves.gain
    cl, cd = factor * read[0], jnp.exp(read[1])
    if curves.beyond is not None:
        cd = cd + attached * drag_rise(curves.beyond, cl)
    return cl, cd, factor * read[2]


@compiled
def section_coefficients(
    table: PolarTable, alpha: jax.Array, re: jax.Array, mach: jax.Array | float = 0.0
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Interpolate lift, drag and moment to each section's own angle, Reynolds and Mach number.

    Parameters
    ----------
    table : PolarTable
        Polars of n sections.
    alpha : (n,) array
        Angle of attack of each section, any angle [rad].
    re : (n,) array
        Reynolds number of each section on its chord; held at the ends of the table.
    mach : (n,) array or number
        Mach number of each section; it raises lift and moment by `prandtl_glauert`, from a table
        without Mach numbers by that alone, and its drag by `drag_rise`.

    Returns
    -------
    cl, cd, cm : (n,) arrays
        Coefficients, C1 in every argument; cm about the quarter chord, nose up.
    """
    return curve_coefficients(section_curves(table, re, mach), alpha)


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
        If Reynolds or Mach numbers lie outside, a warning for either; the message names the section
        furthest outside.
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
    limit = np.full(radii.shape, MACH_LIMIT)
    if table.mach is not None:
        # Sections whose polars do not vary with Mach number share the table of others.
        vary = np.ptp(np.asarray(table.values), axis=2).max(axis=(1, 2, 3)) > 1e-9
        limit = np.where(vary, float(table.mach[-1]), MACH_LIMIT)
    over = machs - limit
    if (over > 1e-9).any():
        worst = int(over.argmax())
        what = (
            "the polars are held at the end of their range there"
            if table.mach is not None and limit[worst] == float(table.mach[-1])
            else "the polars know no shocks: their lift correction is held there, and so is the "
            f"drag rise from Mach {DRAG_RISE_LIMIT:g} on"
        )
        warnings.warn(
            f"Mach number {machs[worst]:.3g} at r/R {radii[worst]:.3g} is above "
            f"{limit[worst]:.3g}; {what}",
            PolarRangeWarning,
            stacklevel=2,
        )
