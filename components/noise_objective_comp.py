"""Levels at several microphones to one number that an optimiser can bring down."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import openmdao.api as om
from scipy.special import logsumexp, softmax

from propmdao.components.bases.refusals import require_numbers

_PER_DB = np.log(10.0) / 10.0


def soft_maximum_db(level_db: npt.ArrayLike, exponent: float) -> float:
    """Power mean of levels.

    Parameters
    ----------
    level_db : array
        Levels [dB].
    exponent : float
        Exponent p of `NoiseObjectiveComp`.

    Returns
    -------
    float
        Power mean of the levels [dB].
    """
    levels, slope = np.asarray(level_db), exponent * _PER_DB
    mean: float = (logsumexp(slope * levels) - np.log(levels.size)) / slope
    return mean


class NoiseObjectiveComp(om.ExplicitComponent):
    """Power mean of levels: their maximum, but smooth.

    The largest of several levels has a kink wherever another microphone becomes the loudest, and
    a minimum of the largest level lies on such a kink. The power mean of the mean-square pressures,

        L = 10 / p log10( 1/n sum_i 10^(p L_i / 10) ),

    has none. It is never above the largest level and at most 10 log10(n) / p dB below it; equal
    levels give that level.

    Inputs
    ------
    level_db : array
        Levels, dB or dBA, such as `oaspl_total_dba` of a `PropellerGroup`.

    Outputs
    -------
    soft_maximum_db : float
        Power mean of the levels, in their unit.

    Options
    -------
    shape : int or tuple
        Shape of `level_db`: microphones, or operating points by microphones.
    exponent : float
        Exponent p, at least 1, which gives the level of the mean of the mean squares. The larger it
        is, the nearer to the maximum and the sharper its corners.

    Raises
    ------
    om.AnalysisError
        If a level is not finite.
    ValueError
        If the exponent is below 1.
    """

    def initialize(self) -> None:
        self.options.declare("shape", types=(int, tuple), desc="Shape of level_db.")
        self.options.declare(
            "exponent",
            8.0,
            types=(int, float),
            desc="Exponent of the power mean; 1: the mean square.",
        )

    def setup(self) -> None:
        exponent = self.options["exponent"]
        if not 1.0 <= exponent < np.inf:
            raise ValueError(f"exponent must be at least 1 and finite; it is {exponent:g}")
        self.add_input("level_db", shape=self.options["shape"], desc="Levels in dB or dBA.")
        self.add_output("soft_maximum_db", desc="Power mean of the levels.")
        self.declare_partials("soft_maximum_db", "level_db")

    def compute(self, inputs: Any, outputs: Any) -> None:
        require_numbers("input ", inputs)
        outputs["soft_maximum_db"] = soft_maximum_db(inputs["level_db"], self.options["exponent"])

    def compute_partials(self, inputs: Any, partials: Any) -> None:
        weights = softmax(self.options["exponent"] * _PER_DB * inputs["level_db"])
        partials["soft_maximum_db", "level_db"] = weights.reshape(1, -1)
