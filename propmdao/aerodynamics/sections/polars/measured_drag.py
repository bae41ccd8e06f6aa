"""Drag of section polars brought to the level that wind tunnels measure.

Lift and drag of a section at Re 30 to 200 thousand ask for different transition. Rotating blades of
all makers have the zero-lift angles of polars at n_crit 5: rotation and vibration keep laminar
separation bubbles short. Drag at equal lift is that of n_crit 9 in two wind tunnels, 15 to 25 %
above that of n_crit 5. So lift stays, and drag at each lift becomes that of n_crit 9, times what
the tunnels still have above it (`TUNNEL_LEVEL`). The evidence, which
`studies/validation/section_drag.py` shows, is 763 drag points of 25 sections: Selig et al., Summary
of Low-Speed Airfoil Data 1-3 (1995-1998), and Selig, Donovan, Fraser, Airfoils at Low Speeds,
SoarTech 8 (1989). None of it comes from propellers.

The correction is worked out at the angles and Reynolds numbers of a table, so what is interpolated
from it is as smooth as all tables are.
"""

from __future__ import annotations

import numpy as np

from propmdao.aerodynamics.sections.polars.high_angle import (
    ATTACHED_DEG,
    FADE_DEG,
    FloatArray,
    IntArray,
)

#: Critical amplification of the polars whose drag at equal lift is the measured one.
TUNNEL_N_CRIT = 9.0
#: Logarithm of measured drag over theirs below the first and above the second of `_LEVEL_REYNOLDS`,
#: fitted to all points with robust least squares by studies/validation/section_drag.py.
TUNNEL_LEVEL = (-0.01, 0.16)
#: Scatter of measured over corrected drag, one standard deviation without the tails, each section
#: left out of its own fit (the same study). A band of drag takes it; it is not in the polars.
DRAG_SCATTER = 0.17

_LEVEL_REYNOLDS = (4.0e4, 2.0e5)
# Measured are Re 59 to 205 thousand, and one section at 40. The correction fades on either side,
# over these ranges.
_LOW_REYNOLDS, _HIGH_REYNOLDS = (2.0e4, 6.0e4), (2.0e5, 1.0e6)
# Runs whose bubble has not burst have up to twice the drag of n_crit 5 (98 % of them). A burst
# bubble, which polars of n_crit 9 have below Re 50 thousand, costs the lift that stays here.
_LARGEST_LOGARITHM = np.log(2.0)
# The correction grows over this lift coefficient from zero lift, where there is none.
_LIFT = 0.3
# It fades over the last tenth of the lift at stall: stalled drag is no bubble's. Up to there the
# measured sections ask for it (from 0.8 on they would have 5 to 8 % more drag left than below).
_STALL = (0.9, 1.0)
# Stall is within 20 deg; on the other side it is the first below -4 deg.
_FIRST, _ZERO, _LAST = (
    int(np.flatnonzero(ATTACHED_DEG == angle)[0]) for angle in (-4.0, 0.0, 20.0)
)


def at_measured_level(
    coefficients: FloatArray,
    tunnel: FloatArray,
    reynolds: FloatArray,
    level: tuple[float, float] = TUNNEL_LEVEL,
) -> FloatArray:
    """Bring the drag of polars to the measured level at each lift.

    Parameters
    ----------
    coefficients : (..., 3, n_re, n_attached) array
        Coefficients cl, cd, cm at `high_angle.ATTACHED_DEG`, at any n_crit.
    tunnel : (..., n, n_re, n_attached) array
        Coefficients cl, cd (and others, n >= 2) of the same sections at `TUNNEL_N_CRIT`.
    reynolds : (n_re,) array
        Reynolds numbers.
    level : (float, float)
        In place of `TUNNEL_LEVEL`, to fit it.

    Returns
    -------
    (..., 3, n_re, n_attached) array
        The same lift and moment. Drag is the same at zero lift, from stall on, up to Re 2e4 and
        from 1e6; else it is at most 2.4 times as much. A section upside down is corrected alike.
    """
    cl, cd = coefficients[..., 0, :, :], coefficients[..., 1, :, :]
    tunnel_cl, tunnel_cd = tunnel[..., 0, :, :], tunnel[..., 1, :, :]
    upper = _logarithm(cl, cd, tunnel_cl, tunnel_cd, reynolds, level)
    turned = -cl[..., ::-1], cd[..., ::-1], -tunnel_cl[..., ::-1], tunnel_cd[..., ::-1]
    lower = _logarithm(*turned, reynolds, level)
    corrected = coefficients.copy()
    corrected[..., 1, :, :] = cd * np.exp(upper + lower[..., ::-1])
    return corrected


def _logarithm(
    cl: FloatArray,
    cd: FloatArray,
    tunnel_cl: FloatArray,
    tunnel_cd: FloatArray,
    re: FloatArray,
    level: tuple[float, float],
) -> FloatArray:
    """Logarithm of corrected over given drag on the side of positive lift, 0 on the other."""
    lift, tunnel_lift = _rising(cl), _rising(tunnel_cl)
    ratio = _at_lift(lift, tunnel_lift, np.log(tunnel_cd)) - np.log(cd)
    ratio = _LARGEST_LOGARITHM * np.tanh(ratio / _LARGEST_LOGARITHM)
    over_re = level[0] + (level[1] - level[0]) * _step(np.log(re), *np.log(_LEVEL_REYNOLDS))
    total = _smoothed(ratio) + over_re[:, None]
    stall = np.maximum(lift[..., -1:], 1e-9)
    # Measured sections have none at lift against their camber: it starts as far below zero lift as
    # zero angle is above.
    start = np.maximum(-cl[..., _ZERO, None], 0.0)
    weight = _step(lift, start, start + _LIFT) * (1.0 - _step(lift / stall, *_STALL))
    # Thick sections may stall on their other side before they lose all lift.
    other_stall = ATTACHED_DEG[_other_stall(cl)]
    weight = weight * _step(ATTACHED_DEG, other_stall - FADE_DEG, other_stall)
    known = _step(np.log(re), *np.log(_LOW_REYNOLDS))
    known = known * (1.0 - _step(np.log(re), *np.log(_HIGH_REYNOLDS)))
    corrected: FloatArray = known[:, None] * weight * total
    return corrected


def _rising(cl: FloatArray) -> FloatArray:
    """Lift from stall to stall, where it does not fall; that of the stalls beyond them."""
    below, position = _other_stall(cl), np.arange(cl.shape[-1])
    lift = np.where(position < below, np.take_along_axis(cl, below, axis=-1), cl)
    rising: FloatArray = np.maximum.accumulate(np.where(position <= _LAST, lift, -np.inf), axis=-1)
    return rising


def _other_stall(cl: FloatArray) -> IntArray:
    """Position of the last angle up to -4 deg before which lift is larger; (..., 1)."""
    falls = np.diff(cl[..., : _FIRST + 1], axis=-1) <= 0.0
    last = falls.shape[-1] - falls[..., ::-1].argmax(axis=-1)
    return np.where(falls.any(axis=-1), last, 0)[..., None].astype(np.intp)


def _at_lift(lift: FloatArray, known_lift: FloatArray, values: FloatArray) -> FloatArray:
    """Values of other polars at each lift, held at the ends of theirs."""
    n = lift.shape[-1]
    # Where lift stands still there are several values: a rise that is none makes it one.
    rise = 1e-9 * np.arange(n)
    rows = zip(*(array.reshape(-1, n) for array in (lift, known_lift, values)), strict=True)
    curves = [np.interp(wanted, known + rise, value) for wanted, known, value in rows]
    return np.reshape(curves, lift.shape)


def _smoothed(values: FloatArray) -> FloatArray:
    """Binomial mean over five angles: bubbles of other lift come and go between two of them."""
    for _ in range(2):
        ends = np.concatenate([values[..., :1], values, values[..., -1:]], axis=-1)
        values = 0.25 * (ends[..., :-2] + 2.0 * values + ends[..., 2:])
    return values


def _step(x: FloatArray, start: FloatArray | float, end: FloatArray | float) -> FloatArray:
    """Rise from 0 at the start to 1 at the end, C1."""
    t = np.clip((x - start) / (end - start), 0.0, 1.0)
    step: FloatArray = t**2 * (3.0 - 2.0 * t)
    return step
