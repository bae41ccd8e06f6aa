"""Polars of a section shape near attached flow, and how files have them: as small numbers."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.polars.high_angle import FloatArray, IntArray

#: Units of the whole numbers in a file, of cl, ln(cd) and cm: for the transition that is taken by
#: default, and for others, which a network of 0.01 in cl does not tell apart from finer ones.
FINE: FloatArray = np.array([2e-4, 2e-4, 2e-5])
COARSE: FloatArray = np.array([4e-4, 5e-4, 1e-4])
for _unit in (FINE, COARSE):
    _unit.setflags(write=False)


@dataclasses.dataclass(frozen=True, eq=False)
class AttachedPolars:
    """Polars of a section shape over maximum camber and thickness, near attached flow.

    Attributes
    ----------
    coefficients : (n_camber, n_thickness, 3, n_re, n_attached) array
        Coefficients cl, cd, cm for cambers from 0 up, at
        `propmdao.aerodynamics.sections.polars.high_angle.ATTACHED_DEG`.
    low, high : (n_camber, n_thickness, n_re) arrays of int
        Positions of the angles between which the coefficients hold, as
        `propmdao.aerodynamics.sections.polars.high_angle.all_angles` takes them.
    """

    coefficients: FloatArray
    low: IntArray
    high: IntArray


def packed(name: str, polars: AttachedPolars, unit: FloatArray) -> dict[str, npt.NDArray]:
    """Turn polars into arrays that a file holds in little space.

    Parameters
    ----------
    name : str
        Name of the polars in the file.
    polars : AttachedPolars
        The polars.
    unit : (3,) array
        Units to which cl, ln(cd) and cm are rounded, `FINE` or `COARSE`.

    Returns
    -------
    dict of arrays
        Members of the file, for `unpacked`.

    Raises
    ------
    ValueError
        If a coefficient is too large for the unit.
    """
    values = polars.coefficients.copy()
    values[:, :, 1] = np.log(values[:, :, 1])
    whole = np.round(values / unit[:, None, None])
    if not np.abs(whole).max() <= np.iinfo(np.int16).max:
        raise ValueError(f"coefficients of '{name}' are too large to be packed")
    return {
        name: folded(whole),
        f"{name} limits": np.stack([polars.low, polars.high]).astype(np.int8),
        f"{name} unit": unit,
    }


def unpacked(members: Mapping[str, npt.NDArray], name: str) -> AttachedPolars:
    """Turn the arrays of a file back into polars.

    Parameters
    ----------
    members : mapping of str to array
        Members of the file.
    name : str
        Name of the polars in the file.

    Returns
    -------
    AttachedPolars
        The polars, rounded to their unit.
    """
    coefficients: FloatArray = unfolded(members[name]) * members[f"{name} unit"][:, None, None]
    coefficients[:, :, 1] = np.exp(coefficients[:, :, 1])
    low, high = members[f"{name} limits"].astype(np.intp)
    return AttachedPolars(coefficients, low, high)


def folded(whole: npt.NDArray) -> npt.NDArray[np.uint8]:
    """Turn whole numbers, smooth over the last axis, into bytes that compress well.

    Parameters
    ----------
    whole : (..., n) array
        Whole numbers of 16 bits.

    Returns
    -------
    (2, ..., n) array
        Lower and upper bytes of their second differences, for `unfolded`.
    """
    # Second differences are small. Their sign goes into the last bit, so that the upper bytes are
    # mostly 0; bytes of a kind lie together. What overflows on the way comes back.
    from_zero = np.pad(whole.astype(np.int16), [(0, 0)] * (whole.ndim - 1) + [(2, 0)])
    steps = from_zero[..., 2:] - 2 * from_zero[..., 1:-1] + from_zero[..., :-2]
    signed = ((steps << 1) ^ (steps >> 15)).view(np.uint16)
    return np.stack([signed & 0xFF, signed >> 8]).astype(np.uint8)


def unfolded(halves: npt.NDArray) -> npt.NDArray[np.int16]:
    """Turn the bytes of `folded` back into whole numbers.

    Parameters
    ----------
    halves : (2, ..., n) array
        Lower and upper bytes.

    Returns
    -------
    (..., n) array
        The whole numbers.
    """
    lower, upper = halves.astype(np.uint16)
    signed = lower | (upper << 8)
    steps = ((signed >> 1) ^ -(signed & 1)).view(np.int16)
    whole: npt.NDArray[np.int16] = np.cumsum(
        np.cumsum(steps, axis=-1, dtype=np.int16), axis=-1, dtype=np.int16
    )
    return whole
