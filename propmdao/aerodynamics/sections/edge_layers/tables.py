"""Boundary layers at the trailing edge over angle and Reynolds number, camber and thickness."""

from __future__ import annotations

import jax
import jax.numpy as jnp

from propmdao.aerodynamics.sections.polars.interpolation import clamped_stencil, dense
from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.records.loads import EdgeSide
from propmdao.records.pytrees import record
from propmdao.runtime.compilation import compiled

#: Quantities of a side, in the order of the tables: logarithms of momentum thickness over chord and
#: of the shape factor, x/c of transition, edge velocity over that of the stream.
QUANTITIES = ("momentum", "shape_factor", "transition", "edge_speed")
_STANDSTILL = 1.0  # Reynolds number that a logarithm can take


@record
class EdgeLayerTable:
    """Boundary layers of several sections on shared angles and Reynolds numbers.

    Attributes
    ----------
    alpha : (n_alpha,) array
        Angles of attack [rad]; held at the ends.
    log_re : (n_re,) array
        Natural logarithms of the Reynolds numbers; held at the ends.
    values : (n_sections, 2, 4, n_re, n_alpha) array
        `QUANTITIES` of the upper and the lower side.
    """

    alpha: jax.Array
    log_re: jax.Array
    values: jax.Array


@record
class SectionLayers:
    """Boundary layers of a blade's sections for any camber and thickness they may be given.

    Attributes
    ----------
    camber, thickness : (n_camber,), (n_thickness,) arrays
        Maximum camber, on both sides of 0, and maximum thickness over chord, rising.
    log_re, alpha : (n_re,), (n_alpha,) arrays
        Natural logarithms of the Reynolds numbers and angles of attack [rad], both held at their
        ends.
    values : (n_shapes, n_camber, n_thickness, 2, 4, n_re, n_alpha) array
        `QUANTITIES` of the upper and the lower side.
    weights : (n_stations, n_shapes) array
        Share of each shape in each station of the propeller; rows sum to 1.
    """

    camber: jax.Array
    thickness: jax.Array
    log_re: jax.Array
    alpha: jax.Array
    values: jax.Array
    weights: jax.Array


@compiled
def blade_layers(layers: SectionLayers, blade: Blade, span: SpanInterpolation) -> EdgeLayerTable:
    """Interpolate the boundary layers of a blade's sections to the radii of a span interpolation.

    Parameters
    ----------
    layers : SectionLayers
        Boundary layers of the propeller's sections.
    blade : Blade
        The propeller's blade, modified or not.
    span : SpanInterpolation
        Interpolation from the blade's stations to n radii.

    Returns
    -------
    EdgeLayerTable
        Tables with a row per radius, C1 in camber and thickness.
    """
    camber = span.linear @ blade.camber_over_chord
    thickness = span.linear @ blade.thickness_over_chord
    by_camber = dense(*clamped_stencil(layers.camber, camber), layers.camber.size)
    by_thickness = dense(*clamped_stencil(layers.thickness, thickness), layers.thickness.size)
    mix = jnp.einsum("ns,nc,nt->nsct", span.linear @ layers.weights, by_camber, by_thickness)
    shape = layers.values.shape
    flat = mix.reshape(mix.shape[0], -1) @ layers.values.reshape(mix[0].size, -1)
    return EdgeLayerTable(layers.alpha, layers.log_re, flat.reshape(-1, *shape[3:]))


def edge_sides(
    table: EdgeLayerTable, angle_of_attack: jax.Array, reynolds: jax.Array
) -> tuple[EdgeSide, EdgeSide]:
    """Interpolate the boundary layers of sections to their angles and Reynolds numbers.

    Parameters
    ----------
    table : EdgeLayerTable
        Boundary layers of n sections.
    angle_of_attack, reynolds : (n,) or (n_azimuths, n) arrays
        Angle of attack from the chord line [rad], Reynolds number on the chord.

    Returns
    -------
    upper, lower : EdgeSide
        Both sides, of the shape of the arguments, C1 in both.
    """
    n = table.values.shape[0]
    row = jnp.arange(n)[:, None, None]

    def at(angle: jax.Array, re: jax.Array) -> jax.Array:
        k, by_re = clamped_stencil(table.log_re, jnp.log(jnp.hypot(re, _STANDSTILL)))
        i, by_alpha = clamped_stencil(table.alpha, angle)
        near = table.values[row, :, :, k[:, :, None], i[:, None, :]]
        return jnp.einsum("nkisq,nk,ni->nsq", near, by_re, by_alpha)

    angle, re = jnp.broadcast_arrays(jnp.asarray(angle_of_attack), jnp.asarray(reynolds))
    values = jax.vmap(at)(angle.reshape(-1, n), re.reshape(-1, n)).reshape(*angle.shape, 2, 4)
    upper, lower = (
        EdgeSide(jnp.exp(side[..., 0]), jnp.exp(side[..., 1]), side[..., 2], side[..., 3])
        for side in (values[..., 0, :], values[..., 1, :])
    )
    return upper, lower
