"""Simple changes of a described propeller."""

from __future__ import annotations

import dataclasses

from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller
from propmdao.records.quantities import require_asked


@dataclasses.dataclass(frozen=True)
class Change:
    """Changes of a described propeller before it is analysed; by default there are none.

    Attributes
    ----------
    twist_offset_deg : float
        Angle added to the blade angle everywhere [deg].
    chord_factor : float
        Factor by which the chord is multiplied everywhere.
    diameter : float or None
        Diameter to which the whole blade is stretched [m]; None: as described.
    n_blades : int or None
        Number of blades; None: as described.

    Raises
    ------
    PropellerError
        If a value is out of range.
    """

    twist_offset_deg: float = 0.0
    chord_factor: float = 1.0
    diameter: float | None = None
    n_blades: int | None = None

    def __post_init__(self) -> None:
        """Refuse changes that are out of range whatever the propeller."""
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None:
                require_asked(field.name, value, PropellerError)

    def applied_to(self, propeller: Propeller) -> Propeller:
        """Change a propeller.

        Parameters
        ----------
        propeller : Propeller
            Propeller as it is described.

        Returns
        -------
        Propeller
            Changed propeller; its source says what was changed.

        Raises
        ------
        PropellerError
            If a value of the changed propeller is out of range.
        """
        changes = str(self)
        if not changes:
            return propeller
        return dataclasses.replace(
            propeller,
            beta_deg=propeller.beta_deg + self.twist_offset_deg,
            c_over_R=propeller.c_over_R * self.chord_factor,
            diameter=propeller.diameter if self.diameter is None else self.diameter,
            n_blades=propeller.n_blades if self.n_blades is None else self.n_blades,
            source=f"{propeller.source} Changed: {changes}.".strip(),
        )

    def __str__(self) -> str:
        """Describe the changes in one line; empty where there are none."""
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
