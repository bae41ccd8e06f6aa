"""Origin of the polars of a propeller's airfoils: the catalogue, NeuralFoil or the user."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from propmdao.aerodynamics.sections.polars.high_angle import ALPHA, FloatArray
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import neuralfoil_installed
from propmdao.aerodynamics.sections.polars.shipped import (
    SHIPPED_N_CRIT,
    SHIPPED_TRIPPED,
    shape,
    shipped_shares,
)
from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable
from propmdao.propeller.airfoils.airfoil import Airfoil
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller
from propmdao.records.models import Transition

# What coordinates with four to six digits leave of a shape scaled to a maximum of 1.
_SAME, _FLAT = 0.02, 1.0e-4
_PLAIN = ("naca4", "e63", "clarky")  # shapes of the catalogue that are no blends


@dataclasses.dataclass(frozen=True, eq=False)
class PolarSource:
    """Origin of the polars of one airfoil.

    Attributes
    ----------
    shape : str
        Name of the section shape whose polars are taken; airfoils with the same one share them.
    text : str
        Origin in words, for a record of what was computed.
    table : PolarTable, optional
        The user's table of the airfoil, where there is one.
    substitute : bool
        True where the shape is another section's, because the airfoil has no polars.
    """

    shape: str
    text: str
    table: PolarTable | None = None
    substitute: bool = False


def polar_sources(
    propeller: Propeller,
    own: Mapping[str, PolarTable] | None = None,
    transition: Transition = Transition(),  # noqa: B008 - frozen
    measured_drag: bool = True,
) -> dict[str, str]:
    """Tell where `polars_for` takes the polars of each airfoil from, without making them.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    own : dict of PolarTable, optional
        The user's tables, by airfoil.
    transition : Transition
        Transition of the boundary layers to turbulent flow, where the propeller's does not hold.
    measured_drag : bool
        Whether drag without trips is brought to the measured level.

    Returns
    -------
    dict of str to str
        Origin by airfoil, as the propeller names it: ``"catalogue, n_crit 5, drag at the measured
        level"``, without measured drag ``"NeuralFoil, n_crit 9"``, ``"user's table"``, and with
        ``", a NACA 4-digit section in its place"`` at the end for an airfoil that has no polars.

    Raises
    ------
    PolarError
        If `polars_for` refuses the same input.
    """
    sources = find_sources(propeller, own, transition, measured_drag)
    return {name: source.text for name, source in sources.items()}


def find_sources(
    propeller: Propeller,
    own: Mapping[str, PolarTable] | None,
    transition: Transition,
    measured_drag: bool,
) -> dict[str, PolarSource]:
    """Decide for each airfoil of a propeller where its polars come from.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    own : dict of PolarTable or None
        The user's tables, by the airfoil's name in the propeller, or its file's name without
        folder and ending.
    transition : Transition
        Transition of the boundary layers to turbulent flow, where the propeller's does not hold.
    measured_drag : bool
        Whether drag without trips is brought to the measured level.

    Returns
    -------
    dict of str to PolarSource
        Origin by airfoil, as the propeller names it.

    Raises
    ------
    PolarError
        If a user's table is no table of one section, or polars at this transition take NeuralFoil
        and it is not installed.
    """
    transition = transition.completed(propeller.transition)
    level = ", drag at the measured level" if measured_drag and transition.free else ""
    return {name: _source(name, own or {}, transition, level) for _, name in propeller.airfoils}


def _source(
    name: str, own: Mapping[str, PolarTable], transition: Transition, level: str
) -> PolarSource:
    """Decide for one airfoil: the user's table goes first, then the catalogue, then NeuralFoil."""
    table = _own_table(name, own)
    if table is not None:
        return PolarSource(f"{name} of the user", "user's table", table)
    installed, shipped = neuralfoil_installed(), bool(shipped_shares(transition))
    if not (installed or shipped):
        low, high = SHIPPED_N_CRIT[0], SHIPPED_N_CRIT[-1]
        raise PolarError(
            f"polars of airfoil '{name}' at {transition} are made by NeuralFoil, which is not "
            f"installed: pip install 'propmdao[polars]', or take the catalogue's n_crit {low:g} to "
            f"{high:g} without trips, or {SHIPPED_TRIPPED}"
        )
    catalogue, neuralfoil = (
        f"{origin}, {transition}{level}" for origin in ("catalogue", "NeuralFoil")
    )
    plain = _catalogue_shape(name)
    if plain is not None:
        return PolarSource(plain, catalogue if shipped else neuralfoil)
    if installed:
        return PolarSource(name, neuralfoil)
    text = f"{catalogue}, a NACA 4-digit section in its place"
    return PolarSource("naca4", text, substitute=True)


def _own_table(name: str, own: Mapping[str, PolarTable]) -> PolarTable | None:
    """Get the user's table of an airfoil, None where there is none."""
    table = own.get(name, own.get(Path(name).stem))
    if table is not None and (table.values.shape[0] != 1 or table.alpha.shape != ALPHA.shape):
        raise PolarError(
            f"the table of airfoil '{name}' must hold one section as read_polars and read_c81 make "
            f"it; its values are {table.values.shape}"
        )
    return table


def _catalogue_shape(name: str) -> str | None:
    """Find the shape of the catalogue that an airfoil has; None if it has another."""
    section = find_airfoil(name)
    return next((plain for plain in _PLAIN if _alike(section, *shape(plain))), None)


def _alike(section: Airfoil, camber: FloatArray, thickness: FloatArray) -> bool:
    """Tell whether a section is a shape of the catalogue, whatever its camber and thickness."""
    peak = np.abs(section.camber).max()
    same_camber = peak < _FLAT or np.allclose(section.camber / peak, camber, atol=_SAME)
    # A flat section has no camber line to compare: only the symmetric NACA shape may claim it.
    same_thickness = np.allclose(section.thickness / section.thickness.max(), thickness, atol=_SAME)
    return bool(same_camber and same_thickness)
