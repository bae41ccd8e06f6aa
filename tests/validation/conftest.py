"""What comparisons leave for the figures of the validation book."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

Curves = Mapping[str, npt.ArrayLike]


@pytest.fixture
def drawn(record_property: Callable[[str, Any], None]) -> Callable[..., None]:
    """Keep a comparison for the figure of its case in the validation book.

    ``drawn(panel, (x label, y label), x, computed, compared_with, log=False)``; computed curves
    become lines, those that they are compared with dots, by name. Tests that name the same panel
    add their points to it.
    """

    def keep(
        panel: str,
        labels: tuple[str, str],
        x: npt.ArrayLike,
        computed: Curves,
        compared_with: Curves,
        log: bool = False,
    ) -> None:
        curves = {
            kind: {name: np.atleast_1d(values).astype(float).tolist() for name, values in given}
            for kind, given in (
                ("computed", computed.items()), ("compared with", compared_with.items())
            )
        }  # fmt: skip
        abscissa = np.atleast_1d(x).astype(float).tolist()
        record_property(
            "drawn", {"panel": panel, "labels": labels, "x": abscissa, "log": log, **curves}
        )

    return keep
