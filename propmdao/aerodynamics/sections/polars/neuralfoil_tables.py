"""Polars of any section from NeuralFoil, an optional dependency (the extra `polars`)."""

from __future__ import annotations

import importlib
import importlib.util
from importlib.metadata import version

import numpy as np

from propmdao.aerodynamics.sections.polars.attached import AttachedPolars
from propmdao.aerodynamics.sections.polars.high_angle import (
    ATTACHED_DEG,
    FloatArray,
    trusted_range,
)
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION
from propmdao.records.models import Transition

#: Largest of NeuralFoil's networks.
MODEL_SIZE = "xxxlarge"
#: Reynolds numbers of the tables, four per decade.
REYNOLDS: FloatArray = np.geomspace(10**3.5, 10**6.75, 14)
REYNOLDS.setflags(write=False)


def neuralfoil_installed() -> bool:
    """Tell whether NeuralFoil can be imported.

    Returns
    -------
    bool
        True if it is installed.
    """
    return importlib.util.find_spec("neuralfoil") is not None


def neuralfoil_settings() -> str:
    """Describe how polars are made, for the record inside a table file.

    Returns
    -------
    str
        One line with version and settings.
    """
    return f"NeuralFoil {version('neuralfoil')}, model {MODEL_SIZE}, incompressible"


def neuralfoil_results(
    camber: FloatArray,
    thickness: FloatArray,
    alpha_deg: FloatArray,
    re: FloatArray,
    transition: Transition,
) -> dict[str, FloatArray]:
    """Compute sections over angles and Reynolds numbers.

    Parameters
    ----------
    camber, thickness : (n, n_chord) arrays
        Camber line and full thickness over chord of each section on
        `airfoils.airfoil.CHORD_FRACTION`.
    alpha_deg : (n_alpha,) array
        Angles from the chord line [deg].
    re : (n_re,) array
        Reynolds numbers.
    transition : Transition
        Transition of the boundary layers, completed.

    Returns
    -------
    dict of (n, n_re, n_alpha) arrays
        NeuralFoil's results by its own names: coefficients, the moment about the quarter chord, its
        confidence, 0..1, transition and boundary layers.

    Notes
    -----
    Sharpe, NeuralFoil: an airfoil aerodynamics analysis tool using physics-informed machine
    learning, arXiv:2503.16323 (2025).
    """
    # By name: neither has types, and neither need be installed.
    asb, neuralfoil = (importlib.import_module(name) for name in ("aerosandbox", "neuralfoil"))

    shapes = []
    for line, full in zip(camber, thickness, strict=True):
        upper, lower = (
            np.stack([CHORD_FRACTION, line + side * full], axis=1) for side in (0.5, -0.5)
        )
        section = asb.Airfoil("section", coordinates=np.vstack([upper[::-1], lower[1:]]))
        fitted = section.to_kulfan_airfoil(n_weights_per_side=8, normalize_coordinates=False)
        shapes.append(fitted.kulfan_parameters)
    angles, numbers = np.meshgrid(alpha_deg, re)
    result = neuralfoil.get_aero_from_kulfan_parameters(
        {
            key: np.repeat(np.transpose([shape[key] for shape in shapes]), angles.size, axis=-1)
            for key in shapes[0]
        },
        alpha=np.tile(angles.ravel(), len(shapes)),
        Re=np.tile(numbers.ravel(), len(shapes)),
        n_crit=transition.n_crit,
        xtr_upper=transition.trip_upper,
        xtr_lower=transition.trip_lower,
        model_size=MODEL_SIZE,
    )
    return {
        key: np.asarray(values, dtype=float).reshape(len(shapes), *angles.shape)
        for key, values in result.items()
    }


def neuralfoil_polars(
    camber: FloatArray,
    thickness: FloatArray,
    alpha_deg: FloatArray,
    re: FloatArray,
    transition: Transition,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Compute the coefficients of sections over angles and Reynolds numbers.

    Parameters
    ----------
    camber, thickness : (n, n_chord) arrays
        Camber line and full thickness over chord of each section on
        `airfoils.airfoil.CHORD_FRACTION`.
    alpha_deg : (n_alpha,) array
        Angles from the chord line [deg].
    re : (n_re,) array
        Reynolds numbers.
    transition : Transition
        Transition of the boundary layers, completed.

    Returns
    -------
    cl, cd, cm, confidence : (n, n_re, n_alpha) arrays
        Coefficients, the moment about the quarter chord, and NeuralFoil's confidence, 0..1.
    """
    result = neuralfoil_results(camber, thickness, alpha_deg, re, transition)
    return result["CL"], result["CD"], result["CM"], result["analysis_confidence"]


def neuralfoil_grid(
    camber_shape: FloatArray,
    thickness_shape: FloatArray,
    max_camber: FloatArray,
    max_thickness: FloatArray,
    transition: Transition,
) -> AttachedPolars:
    """Compute the polars of a section shape over maximum camber and maximum thickness.

    Nine tenths of the time are the network's products of matrices. All thicknesses at once take
    three quarters of the time that they take one by one; more at once take no less.

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
    AttachedPolars
        The polars at `REYNOLDS`, each up to where it holds by
        `propmdao.aerodynamics.sections.polars.high_angle.trusted_range`.
    """
    thickness = max_thickness[:, None] * thickness_shape
    by_camber = [
        neuralfoil_polars(
            np.broadcast_to(camber, thickness.shape), thickness, ATTACHED_DEG, REYNOLDS, transition
        )
        for camber in max_camber[:, None] * camber_shape
    ]
    cl, cd, cm, confidence = map(np.stack, zip(*by_camber, strict=True))
    rows = (-1, ATTACHED_DEG.size)
    limits = trusted_range(cl.reshape(rows), confidence.reshape(rows))
    low, high = (limit.reshape(cl.shape[:-1]) for limit in limits)
    coefficients = np.stack([cl, cd, cm], axis=2)
    return AttachedPolars(coefficients, low, high)
