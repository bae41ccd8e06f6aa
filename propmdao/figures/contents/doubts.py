"""What keeps numbers from being used, or is not in them: it stands below them, where it is read."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

INVISCID = "Inviscid flow: no profile drag, so torque and power are low and eta is high."
BLADE_ELEMENTS = (
    "Blade elements, no lattice: thrust and torque are up to a fifth higher, on wide blades."
)
TONES_ONLY = "Tones only: with broadband noise (--broadband) it is louder, above all in dBA."


def doubts(results: Sequence[dict[str, Any]]) -> list[str]:
    """Sentences on what keeps the numbers of results from being used.

    Parameters
    ----------
    results : sequence of dict
        Results of one propeller with the keys of ``propmdao analyze --json``.

    Returns
    -------
    list of str
        Sentences: which points have not converged, and what the model leaves out.
    """
    sentences = [
        f"NOT CONVERGED at {result['rpm']:.1f} rpm, do not use these numbers: {result['failure']}."
        for result in results
        if not result["converged"]
    ]
    loads = results[0]["model"]["loads"]
    if not loads["viscous"]:
        sentences.append(INVISCID)
    if loads["blade_element"]:
        sentences.append(BLADE_ELEMENTS)
    return sentences
