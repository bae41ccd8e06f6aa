"""How finely the blade, its wake and its sound are resolved."""

from __future__ import annotations

import dataclasses

from propmdao.records.quantities import Range
from propmdao.records.wake_law import WakeGrid

#: Panels of the lattice on a blade: the unknowns, whose matrix has 128 MiB.
MOST_PANELS = 4096


@dataclasses.dataclass(frozen=True)
class Fidelity:
    """Numbers of panels, harmonics and wake nodes; hashable, fixed at compile time.

    docs/verification.md, "Panels", shows what the defaults cost in accuracy.

    Attributes
    ----------
    n_chordwise, n_spanwise : int
        Panels of the vortex lattice on one blade.
    n_contour, n_surface_span : int
        Points around the section and along the span of the surface mesh
        (the thesis' Tess_W x Tess_U, 65 x 80).
    n_harmonics : int
        Harmonics of the blade passage frequency.
    wake : WakeGrid
        Nodes of the wake's filaments in axial flight.
    n_azimuths : int
        Azimuths of the period in flight at an incidence, rounded up to a multiple of the blades.
    period_wake : WakeGrid
        Nodes of the wake there: what the blade has just shed decides how its loads change, so the
        steps begin small.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    n_chordwise: int = 8
    n_spanwise: int = 24
    n_contour: int = 65
    n_surface_span: int = 80
    n_harmonics: int = 10
    wake: WakeGrid = WakeGrid()
    n_azimuths: int = 36
    period_wake: WakeGrid = WakeGrid(4.0, 0.25, 1.25, 10.0)

    def __post_init__(self) -> None:
        """Refuse resolutions that no mesh can have, or no memory hold."""
        for field, allowed in (
            ("n_chordwise", Range(2, 100)),
            ("n_spanwise", Range(2, 400)),
            ("n_contour", Range(5, 1001)),
            ("n_surface_span", Range(2, 1001)),
            ("n_harmonics", Range(1, 1000)),
            ("n_azimuths", Range(8, 1440)),
        ):
            allowed.require(field, getattr(self, field))
        n_panels = self.n_chordwise * self.n_spanwise
        if n_panels > MOST_PANELS:
            raise ValueError(
                f"n_chordwise times n_spanwise must be at most {MOST_PANELS}; it is {n_panels}"
            )
