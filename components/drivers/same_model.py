"""Results in a file are gone on with only where the model still gives them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

SAME_MODEL = 1e-6  # relative difference of results, far above another machine's rounding


def require_same_results(
    file: str,
    point: str,
    file_results: Mapping[str, npt.ArrayLike],
    model_results: Mapping[str, npt.ArrayLike],
) -> None:
    """Refuse a file whose results the model does not give any more.

    Parameters
    ----------
    file : str
        Kind and path of the file, for the message.
    point : str
        Design or sample that the results belong to, for the message.
    file_results : mapping of str to array
        Results by name that the file has; those that the model does not give are ignored.
    model_results : mapping of str to array
        Results by name that the model gives now.

    Raises
    ------
    ValueError
        When a result differs by more than another machine's rounding.
    """
    for name, value in model_results.items():
        expected = file_results[name]
        if not np.allclose(value, expected, rtol=SAME_MODEL, atol=0.0):
            raise ValueError(
                f"{file} is of another model: at {point} {name} was {_text(expected)} and is"
                f" {_text(value)}; name another file, or delete it to start anew"
            )


def _text(value: npt.ArrayLike) -> str:
    return str(np.asarray(value).tolist())
