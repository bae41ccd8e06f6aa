"""Positions of a section's points in space: chord coordinates to the blade frame."""

from __future__ import annotations

import jax
import jax.numpy as jnp

from propmdao.geometry.blade import Blade, SpanInterpolation


def place_sections(
    blade: Blade, span: SpanInterpolation, chordwise: jax.Array, normal: jax.Array
) -> jax.Array:
    """Put section points on the blade.

    Parameters
    ----------
    blade : Blade
        The blade.
    span : SpanInterpolation
        Interpolation to the n_span radii wanted.
    chordwise : (n_points,) array
        Chord fraction of each point, 0 leading edge to 1 trailing edge.
    normal : (n_points, n_span) array
        Height above the chord, toward the suction side, over chord.

    Returns
    -------
    (n_points, n_span, 3) array
        Positions in the blade frame at azimuth 0 [m]. Each section is flat, in the plane
        x = r, with its quarter chord at (r, -sweep, rake) and its chord turned by beta:
        leading to trailing edge along (0, -cos beta, -sin beta), suction side toward
        (0, -sin beta, cos beta).
    """
    chord = span.smooth @ blade.chord_over_R
    beta = span.smooth @ blade.beta
    aft = (chordwise[:, None] - 0.25) * chord
    up = normal * chord
    cos, sin = jnp.cos(beta), jnp.sin(beta)
    x = jnp.broadcast_to(span.r_over_R, up.shape)
    y = -(span.smooth @ blade.sweep_over_R) - aft * cos - up * sin
    z = span.smooth @ blade.rake_over_R - aft * sin + up * cos
    return blade.radius * jnp.stack([x, y, z], axis=-1)


def section_shape(
    blade: Blade, span: SpanInterpolation, chord_operator: jax.Array
) -> tuple[jax.Array, jax.Array]:
    """Interpolate camber and full thickness over chord to chord fractions of each radius.

    Parameters
    ----------
    blade : Blade
        The blade.
    span : SpanInterpolation
        Interpolation to the n_span radii wanted.
    chord_operator : (n_points, n_chord) array
        Interpolation from the shared chord grid to the chord fractions wanted.

    Returns
    -------
    camber, thickness : (n_points, n_span) arrays
        Camber line and full thickness over chord.
    """
    camber_shape = chord_operator @ (span.linear @ blade.camber_shape).T
    thickness_shape = chord_operator @ (span.linear @ blade.thickness_shape).T
    camber = camber_shape * (span.linear @ blade.camber_over_chord)
    return camber, thickness_shape * (span.linear @ blade.thickness_over_chord)
