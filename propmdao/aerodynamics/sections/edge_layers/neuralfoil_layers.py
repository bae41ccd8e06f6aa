"""Boundary layers at the trailing edge from NeuralFoil, and how files have them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.polars.attached import folded, unfolded
from propmdao.aerodynamics.sections.polars.high_angle import FloatArray
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import REYNOLDS, neuralfoil_results
from propmdao.records.models import Transition

#: Angles of the tables [deg], finer where sections work; beyond 20 deg the layers are held.
ALPHA_DEG: FloatArray = np.concatenate(
    [[-20.0, -17.0, -14.0, -12.0, -10.0], np.arange(-8.0, 9.0), [10.0, 12.0, 14.0, 17.0, 20.0]]
)
ALPHA_DEG.setflags(write=False)
# Whole numbers in a file stand for so much of `tables.QUANTITIES`: 2 % of a thickness are 0.09 dB.
_UNIT = np.array([0.02, 0.02, 0.01, 0.01])
_SIDES = ("upper", "lower")
_LAST = 31  # of NeuralFoil's stations, at x/c 0.984
_LEAST_MOMENTUM = 1e-5  # over chord: the network may go below 0 where a layer is thinnest


def neuralfoil_layers(
    camber_shape: FloatArray,
    thickness_shape: FloatArray,
    max_camber: FloatArray,
    max_thickness: FloatArray,
    transition: Transition,
) -> FloatArray:
    """Compute the boundary layers of a section shape over maximum camber and thickness.

    Parameters
    ----------
    camber_shape, thickness_shape : (n_chord,) arrays
        Shape with camber and thickness scaled to a maximum of 1.
    max_camber, max_thickness : (n_camber,), (n_thickness,) arrays
        Maximum camber and thickness over chord of the sections wanted.
    transition : Transition
        Transition of the boundary layers, completed.

    Returns
    -------
    (n_camber, n_thickness, 2, 4, n_re, n_alpha) array
        `tables.QUANTITIES` of the upper and the lower side.
    """
    thickness = max_thickness[:, None] * thickness_shape
    rows = []
    for camber in max_camber[:, None] * camber_shape:
        lines = np.broadcast_to(camber, thickness.shape)
        result = neuralfoil_results(lines, thickness, ALPHA_DEG, REYNOLDS, transition)
        rows.append(
            [
                [
                    np.log(np.maximum(result[f"{side}_bl_theta_{_LAST}"], _LEAST_MOMENTUM)),
                    np.log(result[f"{side}_bl_H_{_LAST}"]),
                    result[transition_key],
                    result[f"{side}_bl_ue/vinf_{_LAST}"],
                ]
                for side, transition_key in zip(_SIDES, ("Top_Xtr", "Bot_Xtr"), strict=True)
            ]
        )
    return np.moveaxis(np.array(rows), 3, 1)


def packed_layers(name: str, values: FloatArray) -> dict[str, npt.NDArray]:
    """Turn boundary layers into arrays that a file holds in little space.

    Parameters
    ----------
    name : str
        Name in the file.
    values : (..., 4, n_re, n_alpha) array
        The boundary layers.

    Returns
    -------
    dict of arrays
        Members of the file, for `unpacked_layers`.
    """
    return {name: folded(np.round(values / _UNIT[:, None, None]))}


def unpacked_layers(members: Mapping[str, npt.NDArray], name: str) -> FloatArray:
    """Turn the arrays of a file back into boundary layers.

    Parameters
    ----------
    members : mapping of str to array
        Members of the file.
    name : str
        Name in the file.

    Returns
    -------
    (..., 4, n_re, n_alpha) array
        The boundary layers, rounded to 2 % of thicknesses and 0.01 of the others.
    """
    values: FloatArray = unfolded(members[name]) * _UNIT[:, None, None]
    return values


def of_both_cambers(upright: FloatArray, upside_down: FloatArray) -> FloatArray:
    """Mirror boundary layers to negative camber.

    Parameters
    ----------
    upright, upside_down : (n_camber, ..., 2, 4, n_re, n_alpha) arrays
        Boundary layers for cambers from 0 up, and the same with the trips of both sides exchanged.

    Returns
    -------
    (2 n_camber - 1, ..., 2, 4, n_re, n_alpha) array
        Those of negative camber are of the same section seen from below.
    """
    turned = upside_down[::-1, ..., ::-1, :, :, ::-1]
    # Without camber both are the same section, but for the rounding of the file.
    flat_section = 0.5 * (turned[-1:] + upright[:1])
    return np.concatenate([turned[:-1], flat_section, upright[1:]])
