"""Polars of any section from NeuralFoil, an optional dependency (the extra `polars`)."""

from __future__ import annotations

import importlib
import importlib.util
from importlib.metadata import version

import numpy as np

from propmdao.aerodynamics.sections.polars.high_angle import ATTACHED_DEG, FloatArray
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION

#: Largest of NeuralFoil's networks.
MODEL_SIZE = "xxxlarge"
#: Reynolds numbers of the tables, four per decade.
REYNOLDS: FloatArray = np.geomspace(10**3.5, 1e6, 11)
REYNOLDS.setflags(write=False)


def neuralfoil_installed() -> bool:
    """Tell whether NeuralFoil can be imported.

    Returns
    -------
    bool
        True if it is installed.
    """
    return importlib.util.find_spec("neuralfoil") is not None


def neuralfoil_settings(n_crit: float) -> str:
    """Describe how polars are made, for the record inside a table file.

    Parameters
    ----------
    n_crit : float
        Critical amplification exponent of transition.

    Returns
    -------
    str
        One line with version and settings.
    """
    return (
        f"NeuralFoil {version('neuralfoil')}, model {MODEL_SIZE}, n_crit {n_crit:g}, free "
        "transition, incompressible"
    )


def neuralfoil_polar(
    camber: FloatArray,
    thickness: FloatArray,
    alpha_deg: FloatArray,
    re: FloatArray,
    n_crit: float,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Compute the coefficients of a section over angles and Reynolds numbers.

    Parameters
    ----------
    camber, thickness : (n_chord,) arrays
        Camber line and full thickness over chord on
        `airfoils.airfoil.CHORD_FRACTION`.
    alpha_deg : (n_alpha,) array
        Angles from the chord line [deg].
    re : (n_re,) array
        Reynolds numbers.
    n_crit : float
        Critical amplification exponent of transition.

    Returns
    -------
    cl, cd, cm, confidence : (n_re, n_alpha) arrays
        Coefficients, the moment about the quarter chord, and NeuralFoil's confidence, 0..1.

    Notes
    -----
    Sharpe, NeuralFoil: an airfoil aerodynamics analysis tool using physics-informed machine
    learning, arXiv:2503.16323 (2025).
    """
    # By name: neither has types, and neither need be installed.
    asb, neuralfoil = (importlib.import_module(name) for name in ("aerosandbox", "neuralfoil"))

    upper, lower = (
        np.stack([CHORD_FRACTION, camber + side * thickness], axis=1) for side in (0.5, -0.5)
    )
    section = asb.Airfoil("section", coordinates=np.vstack([upper[::-1], lower[1:]]))
    shape = section.to_kulfan_airfoil(n_weights_per_side=8, normalize_coordinates=False)
    angles, numbers = np.meshgrid(alpha_deg, re)
    result = neuralfoil.get_aero_from_kulfan_parameters(
        shape.kulfan_parameters,
        alpha=angles.ravel(),
        Re=numbers.ravel(),
        n_crit=n_crit,
        model_size=MODEL_SIZE,
    )
    cl, cd, cm, confidence = (
        np.asarray(result[key], dtype=float).reshape(angles.shape)
        for key in ("CL", "CD", "CM", "analysis_confidence")
    )
    return cl, cd, cm, confidence


def neuralfoil_grid(
    camber_shape: FloatArray,
    thickness_shape: FloatArray,
    max_camber: FloatArray,
    max_thickness: FloatArray,
    n_crit: float,
) -> tuple[FloatArray, FloatArray]:
    """Compute the polars of a section shape over maximum camber and maximum thickness.

    Parameters
    ----------
    camber_shape, thickness_shape : (n_chord,) arrays
        Shape with camber and thickness scaled to a maximum of 1.
    max_camber, max_thickness : (n_camber,), (n_thickness,) arrays
        Maximum camber and thickness over chord of the sections wanted.
    n_crit : float
        Critical amplification exponent of transition.

    Returns
    -------
    coefficients : (n_camber, n_thickness, 3, n_re, n_alpha) array
        Coefficients cl, cd, cm at `REYNOLDS` and `high_angle.ATTACHED_DEG`.
    confidence : (n_camber, n_thickness, n_re, n_alpha) array
        NeuralFoil's confidence, 0..1.
    """
    polars = np.stack(
        [
            np.stack(neuralfoil_polar(camber, thickness, ATTACHED_DEG, REYNOLDS, n_crit))
            for camber in max_camber[:, None] * camber_shape
            for thickness in max_thickness[:, None] * thickness_shape
        ]
    ).reshape(max_camber.size, max_thickness.size, 4, REYNOLDS.size, ATTACHED_DEG.size)
    return polars[:, :, :3], polars[:, :, 3]
