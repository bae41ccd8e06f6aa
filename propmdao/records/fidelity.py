"""How finely the blade, its wake and its sound are resolved."""

from __future__ import annotations

import dataclasses

from propmdao.records.wake_law import WakeGrid


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
        Nodes of the wake's filaments.
    """

    n_chordwise: int = 8
    n_spanwise: int = 24
    n_contour: int = 65
    n_surface_span: int = 80
    n_harmonics: int = 10
    wake: WakeGrid = WakeGrid()

    def __post_init__(self) -> None:
        """Refuse resolutions that no mesh can have."""
        for field, least in (
            ("n_chordwise", 2),
            ("n_spanwise", 2),
            ("n_contour", 5),
            ("n_surface_span", 2),
            ("n_harmonics", 1),
        ):
            value = getattr(self, field)
            if value < least:
                raise ValueError(f"{field} must be at least {least}; it is {value}")
