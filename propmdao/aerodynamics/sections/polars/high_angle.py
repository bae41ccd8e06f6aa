"""Polars continued from stall through all angles."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]

#: Angles of attack near attached flow, where airfoil codes speak [deg].
ATTACHED_DEG: FloatArray = np.arange(-26.0, 27.0)
_FAR_DEG = np.concatenate(
    [[28.0, 30.0, 34.0, 38.0, 42.0, 46.0], np.arange(50.0, 160.0, 10.0), np.arange(160.0, 181.0, 5)]
)
#: All angles of a table, -180 to 180 deg [rad].
ALPHA: FloatArray = np.radians(np.concatenate([-_FAR_DEG[::-1], ATTACHED_DEG, _FAR_DEG]))
#: Positions of `ATTACHED_DEG` in `ALPHA`.
ATTACHED = slice(_FAR_DEG.size, _FAR_DEG.size + ATTACHED_DEG.size)
for _grid in (ATTACHED_DEG, ALPHA):
    _grid.setflags(write=False)

#: Drag coefficient broadside to the flow: 1.11 + 0.018 AR of Viterna and Corrigan at AR = 50, the
#: end of their formula. That is the section in two dimensions; the finite blade is the lattice's.
BROADSIDE_DRAG = 1.11 + 0.018 * 50.0
#: Over this many degrees past stall the given polar fades into the continuation.
FADE_DEG = 6
#: Lift of a section that flies backwards, relative to forwards (sharp edge first).
BACKWARD_LIFT = 0.7
#: Over this angle the moment at stall fades into that of a flat plate [rad].
_MOMENT_FADE = np.radians(20.0)


def viterna(
    alpha: FloatArray, stall: FloatArray, cl: FloatArray, cd: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Compute lift and drag from stall to 180 deg.

    Parameters
    ----------
    alpha : (n_alpha,) array
        Angles of attack, 0 < alpha <= pi [rad].
    stall : (n, 1) array
        Angles of stall, from which the formula starts, above 0 [rad].
    cl, cd : (n, 1) arrays
        Coefficients at stall.

    Returns
    -------
    cl, cd : (n, n_alpha) arrays
        Coefficients, equal to those at stall there. Past 90 deg lift is `BACKWARD_LIFT` of its
        mirror image and goes to zero along a sine within `stall` of 180 deg.

    Notes
    -----
    Viterna and Corrigan, Fixed pitch rotor performance of large horizontal axis wind turbines,
    NASA CP-2230 (1982); drag broadside: `BROADSIDE_DRAG`.
    """
    sine, cosine = np.sin(stall), np.cos(stall)
    b2 = (cd - BROADSIDE_DRAG * sine**2) / cosine
    a2 = (cl - BROADSIDE_DRAG * sine * cosine) * sine / cosine**2
    # Mirrored to the front: the formula's A2 cos^2/sin must not come near its pole at 0 and pi.
    front = np.maximum(np.minimum(alpha, np.pi - alpha), stall)
    lift = 0.5 * BROADSIDE_DRAG * np.sin(2.0 * front) + a2 * np.cos(front) ** 2 / np.sin(front)
    angle = np.minimum(alpha, np.pi - alpha)
    lift = lift * np.where(angle < stall, np.sin(angle) / np.sin(front), 1.0)
    lift = np.where(alpha > 0.5 * np.pi, -BACKWARD_LIFT, 1.0) * lift
    drag = BROADSIDE_DRAG * np.sin(alpha) ** 2 + b2 * np.abs(np.cos(alpha))
    return lift, np.maximum(drag, 0.5 * cd)


def flat_plate_moment(alpha: FloatArray, cl: FloatArray, cd: FloatArray) -> FloatArray:
    """Compute the moment about the quarter chord of a stalled section.

    Parameters
    ----------
    alpha : array
        Angles of attack, 0..pi [rad].
    cl, cd : arrays
        Coefficients at these angles.

    Returns
    -------
    array
        Moment coefficient, nose up: the normal force acts at 0.5 - 0.175 (1 - 2 alpha/pi) chords.

    Notes
    -----
    Lindenburg, Investigation into rotor blade aerodynamics, ECN-C--03-025 (2003).
    """
    normal = cl * np.cos(alpha) + cd * np.sin(alpha)
    return -normal * (0.25 - 0.175 * (1.0 - 2.0 * alpha / np.pi))


def all_angles(
    cl: FloatArray, cd: FloatArray, cm: FloatArray, low: IntArray, high: IntArray
) -> FloatArray:
    """Continue polars given near attached flow through all angles.

    Parameters
    ----------
    cl, cd, cm : (n, n_attached) arrays
        Coefficients at `ATTACHED_DEG`.
    low, high : (n,) arrays of int
        Positions in `ATTACHED_DEG` of the angles between which each polar holds: the stalls.

    Returns
    -------
    (n, 3, n_alpha) array
        Coefficients cl, ln(cd), cm at `ALPHA`: unchanged between the stalls, fading over
        `FADE_DEG` degrees into the continuation from the values at the stall.
    """
    upper = _continued(cl, cd, cm, high)
    flipped = _continued(-cl[:, ::-1], cd[:, ::-1], -cm[:, ::-1], ATTACHED_DEG.size - 1 - low)
    lower = flipped[:, :, ::-1] * np.array([-1.0, 1.0, -1.0])[:, None]
    values: FloatArray = np.where(ALPHA >= 0.0, upper, lower)
    # -180 and 180 deg are the same angle: the section has one drag and moment there, and no lift.
    values[:, :, [0, -1]] = 0.5 * (values[:, :, :1] + values[:, :, -1:])
    return values


def _continued(cl: FloatArray, cd: FloatArray, cm: FloatArray, high: IntArray) -> FloatArray:
    """Continue cl, ln(cd), cm past the position `high` to all of `ALPHA`; right for alpha >= 0."""
    row = np.arange(high.size)
    stall = np.radians(ATTACHED_DEG[high])[:, None]
    stalled = [coefficient[row, high][:, None] for coefficient in (cl, cd, cm)]
    alpha = np.maximum(ALPHA, 1e-3)
    lift, drag = viterna(alpha, stall, stalled[0], stalled[1])
    at_stall = flat_plate_moment(stall, stalled[0], stalled[1])
    decay = np.clip(1.0 - (alpha - stall) / _MOMENT_FADE, 0.0, 1.0)
    moment = flat_plate_moment(alpha, lift, drag) + decay * (stalled[2] - at_stall)
    step = np.clip((np.degrees(ALPHA) - np.degrees(stall)) / FADE_DEG, 0.0, 1.0)
    weight = 1.0 - step**2 * (3.0 - 2.0 * step)
    attached = np.zeros((high.size, 3, ALPHA.size))
    attached[:, :, ATTACHED] = np.stack([cl, np.log(cd), cm], axis=1)
    far = np.stack([lift, np.log(drag), moment], axis=1)
    weight = weight[:, None, :]
    return weight * attached + (1.0 - weight) * far


def trusted_range(cl: FloatArray, confidence: FloatArray) -> tuple[IntArray, IntArray]:
    """Find where polars of NeuralFoil hold: to stall, and past it while it is sure of itself.

    Parameters
    ----------
    cl, confidence : (n, n_attached) arrays
        Lift coefficient and analysis confidence at `ATTACHED_DEG`.

    Returns
    -------
    low, high : (n,) arrays of int
        Positions in `ATTACHED_DEG` of the last angles that hold: from the largest lift within
        4..20 deg outward, the first angle whose confidence is below 0.5, at most 20 deg; and
        likewise on the negative side. Between the stalls the confidence does not count: it tells
        where XFOIL converges, and low-Reynolds polars agree with XFOIL there although it is low.
    """
    inner, outer = (int(np.flatnonzero(ATTACHED_DEG == angle)[0]) for angle in (4.0, 20.0))

    def upper(lift: FloatArray, sure: FloatArray) -> IntArray:
        peak = inner + lift[:, inner : outer + 1].argmax(axis=1)
        position = np.arange(ATTACHED_DEG.size)
        unsure = (position >= peak[:, None]) & ((sure < 0.5) | (position >= outer))
        return unsure.argmax(axis=1)

    low = ATTACHED_DEG.size - 1 - upper(-cl[:, ::-1], confidence[:, ::-1])
    return low, upper(cl, confidence)
