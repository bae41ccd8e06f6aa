"""Polars of section families over maximum camber and thickness, and of the blade made of them."""

from __future__ import annotations

import dataclasses
import warnings

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.polars.attached import AttachedPolars
from propmdao.aerodynamics.sections.polars.high_angle import ALPHA, FloatArray, all_angles
from propmdao.aerodynamics.sections.polars.interpolation import clamped_stencil, dense
from propmdao.aerodynamics.sections.polars.table import PolarRangeWarning, PolarTable
from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.records.pytrees import record
from propmdao.runtime.compilation import compiled


@record
class SectionPolars:
    """Polars of a blade's sections for any camber and thickness they may be given.

    Some megabytes: hand it to compiled functions as an argument, where a constant costs compile
    time.

    A shape is a section with camber and thickness scaled to a maximum of 1. The polar of a section
    between shapes is the mean, by weight, of theirs at its own camber and thickness (of the
    logarithm, for drag).

    Attributes
    ----------
    camber : (n_camber,) array
        Maximum camber over chord, rising, on both sides of 0.
    thickness : (n_thickness,) array
        Maximum thickness over chord, rising.
    log_re, alpha : (n_re,), (n_alpha,) arrays
        Natural logarithms of the Reynolds numbers and angles of attack [rad], both as `PolarTable`
        has them.
    values : (n_shapes, n_camber, n_thickness, 3, n_re, n_alpha) array
        Coefficients cl, ln(cd), cm as `PolarTable` has them, with its axis of Mach numbers where
        there is one.
    weights : (n_stations, n_shapes) array
        Share of each shape in each station of the propeller; rows sum to 1.
    mach : (n_mach,) array, optional
        Mach numbers as `PolarTable` has them.
    """

    camber: jax.Array
    thickness: jax.Array
    log_re: jax.Array
    alpha: jax.Array
    values: jax.Array
    weights: jax.Array
    mach: jax.Array | None = None


@compiled
def section_tables(
    polars: SectionPolars, weights: jax.Array, camber: jax.Array, thickness: jax.Array
) -> PolarTable:
    """Interpolate the polars of sections of any shape, camber and thickness.

    Parameters
    ----------
    polars : SectionPolars
        Polars of the shapes.
    weights : (n, n_shapes) array
        Share of each shape in each section.
    camber, thickness : (n,) arrays
        Maximum camber and thickness over chord; held just outside the ends of the polars' ranges.

    Returns
    -------
    PolarTable
        Polars with a row per section, C1 in camber and thickness.
    """
    by_camber = dense(*clamped_stencil(polars.camber, camber), polars.camber.size)
    by_thickness = dense(*clamped_stencil(polars.thickness, thickness), polars.thickness.size)
    # One product with a matrix: 24 sections are done in a millisecond, and so is the transpose.
    mix = jnp.einsum("ns,nc,nt->nsct", weights, by_camber, by_thickness)
    shape = polars.values.shape
    flat = mix.reshape(mix.shape[0], -1) @ polars.values.reshape(mix[0].size, -1)
    values = flat.reshape(-1, *shape[3:])
    return PolarTable(polars.alpha, polars.log_re, values, polars.mach, thickness)


@compiled
def blade_tables(polars: SectionPolars, blade: Blade, span: SpanInterpolation) -> PolarTable:
    """Interpolate the polars of a blade's sections to the radii of a span interpolation.

    Parameters
    ----------
    polars : SectionPolars
        Polars of the propeller's sections.
    blade : Blade
        The propeller's blade, modified or not.
    span : SpanInterpolation
        Interpolation from the blade's stations to n radii.

    Returns
    -------
    PolarTable
        Polars with a row per radius.
    """
    return section_tables(
        polars,
        span.linear @ polars.weights,
        span.linear @ blade.camber_over_chord,
        span.linear @ blade.thickness_over_chord,
    )


def with_drag(polars: SectionPolars, factor: float) -> SectionPolars:
    """Multiply the drag of polars at every angle of attack.

    Parameters
    ----------
    polars : SectionPolars
        Polars of the shapes.
    factor : float
        Factor on the drag coefficient, above 0.

    Returns
    -------
    SectionPolars
        Polars with the same lift.
    """
    values = np.array(polars.values)
    values[:, :, :, 1] += np.log(factor)
    return dataclasses.replace(polars, values=jnp.asarray(values))


def warn_outside_sections(polars: SectionPolars, blade: Blade, r_over_R: npt.ArrayLike) -> None:
    """Warn, once each, if camber or thickness lies outside the polars; call it outside ``jit``.

    Parameters
    ----------
    polars : SectionPolars
        Polars of the propeller's sections.
    blade : Blade
        The propeller's blade.
    r_over_R : (n_stations,) array
        r/R of the blade's stations.

    Warns
    -----
    PolarRangeWarning
        If a station lies outside; the message names the station furthest outside.
    """
    radii = np.asarray(r_over_R, dtype=float)
    for name in ("camber", "thickness"):
        nodes = np.asarray(getattr(polars, name))
        value = np.asarray(getattr(blade, f"{name}_over_chord"))
        excess = np.maximum(nodes[0] - value, value - nodes[-1])
        if (excess > 1e-9).any():
            worst = int(excess.argmax())
            warnings.warn(
                f"{name}_over_chord {value[worst]:.3g} at r/R {radii[worst]:.3g} is outside the "
                f"polars' {nodes[0]:.3g}..{nodes[-1]:.3g}; the polars are held at the end of "
                "their range there",
                PolarRangeWarning,
                stacklevel=2,
            )


def shape_values(upright: AttachedPolars, upside_down: AttachedPolars) -> FloatArray:
    """Continue a shape's polars through all angles and mirror them to negative camber.

    Parameters
    ----------
    upright : AttachedPolars
        Polars of the shape.
    upside_down : AttachedPolars
        The same with the trips of the upper and the lower side exchanged: a section of negative
        camber is the same section seen from below. The same object where both trips are equal.

    Returns
    -------
    (2 n_camber - 1, n_thickness, 3, n_re, n_alpha) array
        Coefficients cl, ln(cd), cm at all angles.
    """
    above = _around(upright)
    below = above if upside_down is upright else _around(upside_down)
    turned = below[::-1, ..., ::-1] * np.array([-1.0, 1.0, -1.0])[:, None, None]
    # Without camber both are the same section, but for the rounding of the file.
    flat_section = 0.5 * (turned[-1:] + above[:1])
    return np.concatenate([turned[:-1], flat_section, above[1:]])


def _around(polars: AttachedPolars) -> FloatArray:
    """Coefficients cl, ln(cd), cm at all angles, (n_camber, n_thickness, 3, n_re, n_alpha)."""
    cl, cd, cm = np.moveaxis(polars.coefficients, 2, 0)
    rows = (-1, cl.shape[-1])
    flat = all_angles(
        cl.reshape(rows),
        cd.reshape(rows),
        cm.reshape(rows),
        polars.low.ravel(),
        polars.high.ravel(),
    )
    return np.moveaxis(flat.reshape(*polars.low.shape, 3, ALPHA.size), -2, -3)
