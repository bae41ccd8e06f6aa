"""The tables that ship: the shapes they hold, how they are packed in their file."""

from __future__ import annotations

import dataclasses
import functools
from importlib.resources import files
from pathlib import Path
from typing import IO

import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.polars.family import shape_values
from propmdao.aerodynamics.sections.polars.high_angle import FloatArray, IntArray, trusted_range
from propmdao.aerodynamics.sections.polars.measured_drag import TUNNEL_N_CRIT, at_measured_level
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import (
    REYNOLDS,
    neuralfoil_grid,
    neuralfoil_settings,
)
from propmdao.propeller.airfoils.airfoil import naca4
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.runtime.output_files import replacing

#: Maximum camber and thickness over chord of the tables; negative camber follows by symmetry.
CAMBER: FloatArray = np.array([0.0, 0.015, 0.03, 0.045, 0.06, 0.075, 0.09])
THICKNESS: FloatArray = np.array([0.03, 0.045, 0.065, 0.09, 0.12, 0.155, 0.19, 0.22])
#: Blends of E63 and Clark-Y among the shapes, by share of Clark-Y.
CLARKY_SHARES = {"e63": 0.0, "e63-clarky": 0.5, "clarky": 1.0}
#: Shapes of the file: the NACA 4-digit series with its maximum camber at 0.4 c, and the blends.
SHAPES = ("naca4", *CLARKY_SHARES)
#: Critical amplification of e^n transition in the tables, the same for every blade: moulded edges,
#: and air that other blades have stirred. A clean wind tunnel has 9 to 12, a dirty one 4 to 8
#: (Drela, XFOIL user guide); studies/validation/aerodynamic_sensitivity.py shows what it changes.
SHIPPED_N_CRIT = 5.0

#: Units of the whole numbers in the file: of cl, ln(cd), cm.
_UNIT = np.array([2e-4, 2e-4, 2e-5])[:, None, None]


@dataclasses.dataclass(frozen=True)
class ShippedTables:
    """Tables of all shapes and how they were made.

    Attributes
    ----------
    values : dict of (n_camber, n_thickness, 3, n_re, n_alpha) arrays
        Coefficients cl, ln(cd), cm by shape; the cambers are `CAMBER` and its mirror image.
    settings : str
        Program, version and settings, one line.
    """

    values: dict[str, FloatArray]
    settings: str


def shape(name: str) -> tuple[FloatArray, FloatArray]:
    """Get camber line and thickness of a shape, each scaled to a maximum of 1.

    Parameters
    ----------
    name : str
        Name of the shape, one of `SHAPES`.

    Returns
    -------
    camber, thickness : (n_chord,) arrays
        Camber line and full thickness on `propmdao.propeller.airfoils.airfoil.CHORD_FRACTION`.
    """
    if name == "naca4":
        section = naca4(1.0, 0.4, 1.0)
        camber, thickness = section.camber, section.thickness
    else:
        share = CLARKY_SHARES[name]
        first, last = find_airfoil("e63"), find_airfoil("clarky")
        camber = (1.0 - share) * first.camber + share * last.camber
        thickness = (1.0 - share) * first.thickness + share * last.thickness
    return camber / camber.max(), thickness / thickness.max()


def generate(path: Path) -> None:
    """Make the file of tables; needs NeuralFoil and takes about three minutes.

    Parameters
    ----------
    path : Path
        File to write.
    """
    packed, tunnel, lows, highs = [], [], [], []
    for name in SHAPES:
        coefficients, confidence = neuralfoil_grid(*shape(name), CAMBER, THICKNESS, SHIPPED_N_CRIT)
        in_tunnel, _ = neuralfoil_grid(*shape(name), CAMBER, THICKNESS, TUNNEL_N_CRIT)
        low, high = limits(coefficients, confidence)
        packed.append(pack(coefficients))
        tunnel.append(pack(in_tunnel[:, :, :2]))
        lows.append(low)
        highs.append(high)
    with replacing(path) as file:
        np.savez_compressed(
            file,
            packed=np.stack(packed),
            tunnel=np.stack(tunnel),
            low=np.stack(lows).astype(np.int8),
            high=np.stack(highs).astype(np.int8),
            camber=CAMBER,
            thickness=THICKNESS,
            reynolds=REYNOLDS,
            settings=np.array(neuralfoil_settings(SHIPPED_N_CRIT)),
        )


def limits(coefficients: FloatArray, confidence: FloatArray) -> tuple[IntArray, IntArray]:
    """Find between which angles each polar of a grid holds, by `trusted_range`.

    Parameters
    ----------
    coefficients : (n_camber, n_thickness, 3, n_re, n_attached) array
        Coefficients as `neuralfoil_grid` returns them.
    confidence : (n_camber, n_thickness, n_re, n_attached) array
        NeuralFoil's confidence.

    Returns
    -------
    low, high : (n_camber, n_thickness, n_re) arrays of int
        Positions in `propmdao.aerodynamics.sections.polars.high_angle.ATTACHED_DEG`.
    """
    sure = confidence.reshape(-1, confidence.shape[-1])
    low, high = trusted_range(coefficients[:, :, 0].reshape(sure.shape), sure)
    return low.reshape(confidence.shape[:-1]), high.reshape(confidence.shape[:-1])


def pack(coefficients: FloatArray) -> npt.NDArray[np.int16]:
    """Turn coefficients into the whole numbers of the file.

    Parameters
    ----------
    coefficients : (..., n, n_re, n_attached) array
        The first n of the coefficients cl, cd, cm.

    Returns
    -------
    array of int16 of the same shape
        Second differences over angle: small whole numbers, which pack to a third.
    """
    values = coefficients.copy()
    values[..., 1, :, :] = np.log(values[..., 1, :, :])
    whole = np.round(values / _UNIT[: values.shape[-3]]).astype(np.int32)
    start = np.zeros((*whole.shape[:-1], 2), int)
    return np.diff(whole, n=2, axis=-1, prepend=start).astype(np.int16)


def unpack(packed: npt.NDArray[np.int16]) -> FloatArray:
    """Turn the whole numbers of the file into coefficients.

    Parameters
    ----------
    packed : (..., n, n_re, n_attached) array of int16
        Second differences over angle.

    Returns
    -------
    array of the same shape
        The first n of the coefficients cl, cd, cm.
    """
    whole = np.cumsum(np.cumsum(packed.astype(np.int64), axis=-1), axis=-1)
    coefficients: FloatArray = whole * _UNIT[: packed.shape[-3]]
    coefficients[..., 1, :, :] = np.exp(coefficients[..., 1, :, :])
    return coefficients


def read_tables(file: str | Path | IO[bytes], measured_drag: bool = True) -> ShippedTables:
    """Read a file of tables.

    Parameters
    ----------
    file : path or binary file
        File that `generate` has written.
    measured_drag : bool
        Whether drag is brought to the measured level
        (`propmdao.aerodynamics.sections.polars.measured_drag`); else it is NeuralFoil's.

    Returns
    -------
    ShippedTables
        The tables, continued through all angles.
    """
    with np.load(file) as data:
        coefficients = unpack(data["packed"])
        if measured_drag:
            coefficients = at_measured_level(coefficients, unpack(data["tunnel"]), REYNOLDS)
        low, high = data["low"].astype(np.intp), data["high"].astype(np.intp)
        settings = str(data["settings"])
    values = {name: shape_values(coefficients[k], low[k], high[k]) for k, name in enumerate(SHAPES)}
    return ShippedTables(values, settings)


@functools.cache
def shipped_tables(measured_drag: bool = True) -> ShippedTables:
    """Get the tables of the catalogue, read once.

    Parameters
    ----------
    measured_drag : bool
        As of `read_tables`.

    Returns
    -------
    ShippedTables
        The tables.
    """
    file = files("propmdao.propeller.catalog") / "polars" / "sections.npz"
    with file.open("rb") as opened:
        return read_tables(opened, measured_drag)
