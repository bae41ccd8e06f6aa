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

    ``drawn(panel, (x label, y label), x, computed, compared_with, log=False, joined=True)``;
    computed curves become lines, or dots where `joined` is False as neighbours have not all else in
    common; those that they are compared with become rings, by name. Tests that name the same panel
    add their points to it.
    """

    def keep(
        panel: str,
        labels: tuple[str, str],
        x: npt.ArrayLike,
        computed: Curves,
        compared_with: Curves,
        log: bool = False,
        joined: bool = True,
    ) -> None:
        curves = {
            kind: {name: np.atleast_1d(values).astype(float).tolist() for name, values in given}
            for kind, given in (
                ("computed", computed.items()), ("compared with", compared_with.items())
            )
        }  # fmt: skip
        abscissa = np.atleast_1d(x).astype(float).tolist()
        form = {"panel": panel, "labels": labels, "log": log, "joined": joined}
        record_property("drawn", {**form, "x": abscissa, **curves})

    return keep
