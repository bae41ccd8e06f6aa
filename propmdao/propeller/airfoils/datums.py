"""Lines that a section's angle is measured to, other than its chord: parting line, flat bottom.

Blades are specified and gauged by what can be touched. A moulded blade is split along its foremost
and rearmost points, and a pitch gauge rests under its lower side; how far either line is from the
chord line follows from the shape of the section.
"""

from __future__ import annotations

import functools

import numpy as np

from propmdao.propeller.airfoils.airfoil import FloatArray, chord_interpolation

#: Points of a side; the foremost one is then found to 0.01 deg of the line.
_POINTS = 1001
#: Steps of the fixed point; the foremost point moves little with the angle, a step is worth 1/50.
_STEPS = 6


@functools.cache
def _fine_grid() -> tuple[FloatArray, FloatArray]:
    """Chord fractions from nose to tail, and the operator to them from the shared grid."""
    angle = np.linspace(0.0, np.pi, _POINTS)
    return 0.5 * (1.0 - np.cos(angle)), chord_interpolation(angle)


def _sides(camber: FloatArray, thickness: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Chord fractions, upper and lower side of a section."""
    x, operator = _fine_grid()
    line, half = operator @ camber, 0.5 * (operator @ thickness)
    return x, line + half, line - half


def chord_from_parting_line(camber: FloatArray, thickness: FloatArray, beta: float) -> float:
    """Find how much steeper the chord line is than the line between a section's ends.

    The ends are the foremost and the rearmost point in the plane of the rotor, where the halves of
    a mould that opens along the shaft meet. A round nose that is turned up by the blade angle has
    its foremost point below the end of the chord line.

    Parameters
    ----------
    camber, thickness : (n_chord,) arrays
        Camber line and full thickness over chord at
        `propmdao.propeller.airfoils.airfoil.CHORD_FRACTION`.
    beta : float
        Angle of the line between the ends from the rotor plane [rad].

    Returns
    -------
    float
        Blade angle of the chord line less that of the line between the ends [rad].
    """
    x, upper, lower = _sides(camber, thickness)
    x, z = np.concatenate([x, x]), np.concatenate([upper, lower])
    steeper = 0.0
    for _ in range(_STEPS):
        forward = -x * np.cos(beta + steeper) - z * np.sin(beta + steeper)
        front, rear = np.argmax(forward), np.argmin(forward)
        steeper = -float(np.arctan2(z[front] - z[rear], x[rear] - x[front]))
    return steeper


def chord_from_flat_bottom(camber: FloatArray, thickness: FloatArray) -> float:
    """Find how much steeper the chord line is than a gauge that rests under the section.

    The gauge touches the lower side before and behind mid-chord, or, where that is round there,
    at mid-chord.

    Parameters
    ----------
    camber, thickness : (n_chord,) arrays
        Camber line and full thickness over chord at
        `propmdao.propeller.airfoils.airfoil.CHORD_FRACTION`.

    Returns
    -------
    float
        Blade angle of the chord line less that of the gauge [rad].
    """
    x, _, lower = _sides(camber, thickness)
    hull: list[int] = []  # convex from below, nose to tail
    for i in range(x.size):
        while len(hull) > 1 and _is_above(hull[-2], hull[-1], i, x, lower):
            hull.pop()
        hull.append(i)
    behind = next(k for k in range(1, len(hull)) if x[hull[k]] >= 0.5)
    first, last = hull[behind - 1], hull[behind]
    return float(np.arctan2(lower[last] - lower[first], x[last] - x[first]))


def _is_above(first: int, middle: int, last: int, x: FloatArray, z: FloatArray) -> bool:
    """Tell whether the middle one of three points is on or above the line between the others."""
    slope = (z[last] - z[first]) * (x[middle] - x[first])
    return bool((z[middle] - z[first]) * (x[last] - x[first]) >= slope)
