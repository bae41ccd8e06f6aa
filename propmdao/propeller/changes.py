"""Simple changes of a described propeller."""

from __future__ import annotations

import dataclasses

from propmdao.propeller.description import Propeller


@dataclasses.dataclass(frozen=True)
class Change:
    """What is changed of a described propeller before it is analysed; by default nothing.

    Attributes
    ----------
    twist_offset_deg : float
        Added to the blade angle everywhere [deg].
    chord_factor : float
        The chord is multiplied by it everywhere.
    diameter : float or None
        Diameter to which the whole blade is stretched [m]; None: as described.
    n_blades : int or None
        Number of blades; None: as described.
    """

    twist_offset_deg: float = 0.0
    chord_factor: float = 1.0
    diameter: float | None = None
    n_blades: int | None = None

    def applied_to(self, propeller: Propeller) -> Propeller:
        """Change a propeller.

        Parameters
        ----------
        propeller : Propeller
            As it is described.

        Returns
        -------
        Propeller
            The changed one; its source says what was changed.

        Raises
        ------
        PropellerError
            If a value is then out of range.
        """
        said = str(self)
        if not said:
            return propeller
        return dataclasses.replace(
            propeller,
            beta_deg=propeller.beta_deg + self.twist_offset_deg,
            c_over_R=propeller.c_over_R * self.chord_factor,
            diameter=propeller.diameter if self.diameter is None else self.diameter,
            n_blades=propeller.n_blades if self.n_blades is None else self.n_blades,
            source=f"{propeller.source} Changed: {said}.".strip(),
        )

    def __str__(self) -> str:
        """Say it in one line; nothing where nothing is changed."""
        parts = []
        if self.twist_offset_deg:
            parts.append(f"blade angle {self.twist_offset_deg:+g} deg everywhere")
        if self.chord_factor != 1.0:
            parts.append(f"chord times {self.chord_factor:g}")
        if self.diameter is not None:
            parts.append(f"diameter {self.diameter:g} m")
        if self.n_blades is not None:
            parts.append(f"{self.n_blades} blades")
        return ", ".join(parts)
