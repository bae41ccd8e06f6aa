"""The polars of a described propeller."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Mapping
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from propmdao.aerodynamics.sections.polars.family import SectionPolars, shape_values
from propmdao.aerodynamics.sections.polars.high_angle import ALPHA, FloatArray
from propmdao.aerodynamics.sections.polars.interpolation import clamped_stencil, dense
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import (
    REYNOLDS,
    neuralfoil_grid,
    neuralfoil_installed,
)
from propmdao.aerodynamics.sections.polars.shipped import (
    CAMBER,
    CLARKY_SHARES,
    THICKNESS,
    limits,
    shape,
    shipped_tables,
)
from propmdao.aerodynamics.sections.polars.table import (
    PolarError,
    PolarSubstituteWarning,
    PolarTable,
)
from propmdao.propeller.airfoils.airfoil import Airfoil
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller

# What coordinates with four to six digits leave of a shape scaled to a maximum of 1.
_SAME, _FLAT = 0.02, 1.0e-4
_PLAIN = ("naca4", "e63", "clarky")  # shapes of the catalogue that are no blends


def polars_for(propeller: Propeller, own: Mapping[str, PolarTable] | None = None) -> SectionPolars:
    """Find the polars of a propeller's sections.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    own : dict of PolarTable, optional
        A table of one section by the airfoil's name in the propeller, or its file's name without
        folder and ending; it goes before the catalogue. It is taken at any camber and thickness:
        a design that changes them needs polars that know them.

    Returns
    -------
    SectionPolars
        Polars of E63, Clark-Y, their blends and NACA 4-digit sections with their camber at 0.4 c
        from the catalogue, whatever their names; of other sections from NeuralFoil, where it is
        installed (about 15 s per airfoil).

    Raises
    ------
    PolarError
        If a table of one's own is no table of one section.

    Warns
    -----
    PolarSubstituteWarning
        If an airfoil has no polars and NACA 4-digit ones stand in.
    """
    names = [name for _, name in propeller.airfoils]
    sources: list[str] = []
    given: dict[str, tuple[FloatArray, FloatArray]] = {}
    for name in names:
        user = _own_table(name, own or {})
        sources.append(_catalogue_shape(name) if user is None else f"{name} of the user")
        if user is not None:
            given[sources[-1]] = np.asarray(user.log_re), np.asarray(user.values)
    weights = _shape_weights(propeller, sources)
    found = [given.get(key) or (np.log(REYNOLDS), _family_values(key)) for key in weights]
    log_re = functools.reduce(_merged, [grid for grid, _ in found])
    resampled = [_resampled(grid, table, log_re) for grid, table in found]
    camber, thickness = np.concatenate([-CAMBER[:0:-1], CAMBER]), THICKNESS
    if given.keys() == weights.keys():
        camber, thickness = np.array([-1.0, 1.0]), np.array([0.0, 1.0])
    full = (camber.size, thickness.size, 3, log_re.size, ALPHA.size)
    return SectionPolars(
        camber=jnp.asarray(camber),
        thickness=jnp.asarray(thickness),
        log_re=jnp.asarray(log_re),
        alpha=jnp.asarray(ALPHA),
        values=jnp.asarray(np.stack([np.broadcast_to(one, full) for one in resampled])),
        weights=jnp.asarray(np.stack(list(weights.values()), axis=1)),
    )


def _own_table(name: str, own: Mapping[str, PolarTable]) -> PolarTable | None:
    """The user's table of an airfoil."""
    table = own.get(name, own.get(Path(name).stem))
    if table is not None and (table.values.shape[0] != 1 or table.alpha.shape != ALPHA.shape):
        raise PolarError(
            f"the table of airfoil '{name}' must hold one section as read_polars and read_c81 make "
            f"it; its values are {table.values.shape}"
        )
    return table


def _catalogue_shape(name: str) -> str:
    """Shape of the catalogue that an airfoil has, or its own name if NeuralFoil can make it."""
    section = find_airfoil(name)
    for known in _PLAIN:
        if _alike(section, *shape(known)):
            return known
    if neuralfoil_installed():
        return name
    warnings.warn(
        f"airfoil '{name}' has no polars in the catalogue: those of a NACA 4-digit section of its "
        "camber and thickness stand in. Give polar files of it (--polar, or polars_for(propeller, "
        f"own={{'{Path(name).stem}': read_polars(...)}})), or install NeuralFoil, which makes "
        "them: pip install 'propmdao[polars]'",
        PolarSubstituteWarning,
        stacklevel=3,
    )
    return "naca4"


def _alike(section: Airfoil, camber: FloatArray, thickness: FloatArray) -> bool:
    """Whether a section is a shape of the catalogue, whatever its camber and thickness."""
    peak = np.abs(section.camber).max()
    same_camber = peak < _FLAT or np.allclose(section.camber / peak, camber, atol=_SAME)
    # A flat section has no camber line to compare: only the symmetric NACA shape may claim it.
    same_thickness = np.allclose(section.thickness / section.thickness.max(), thickness, atol=_SAME)
    return bool(same_camber and same_thickness)


def _shape_weights(propeller: Propeller, sources: list[str]) -> dict[str, FloatArray]:
    """Share of each shape in each station, (n_stations,) by shape, those in use alone."""
    position = [at for at, _ in propeller.airfoils]
    unit = np.eye(len(position))
    share = np.stack([np.interp(propeller.r_over_R, position, one) for one in unit])
    # The zero-lift angle follows the camber line, so shapes count by what they give to it.
    camber = [abs(find_airfoil(name).max_camber) for _, name in propeller.airfoils]
    amount = share * np.array(camber)[:, None]
    total = amount.sum(axis=0)
    weight = np.where(total > 0.0, amount / np.where(total > 0.0, total, 1.0), share)

    def of(rows: FloatArray, source: str) -> FloatArray:
        picked: FloatArray = rows[[k for k, name in enumerate(sources) if name == source]].sum(0)
        return picked

    shapes = {source: of(weight, source) for source in sources}
    if {"e63", "clarky"} <= shapes.keys():
        both, last = shapes["e63"] + shapes["clarky"], of(share, "clarky")
        shared = last + of(share, "e63")
        blend = np.where(shared > 0.0, last / np.where(shared > 0.0, shared, 1.0), 0.0)
        nodes = np.array(list(CLARKY_SHARES.values()))
        for name, hat in zip(CLARKY_SHARES, np.eye(nodes.size), strict=True):
            shapes[name] = both * np.interp(blend, nodes, hat)
    return shapes


def _family_values(source: str) -> FloatArray:
    """Tables of a shape of the catalogue, or of any airfoil by NeuralFoil."""
    shipped = shipped_tables().values
    if source in shipped:
        return shipped[source]
    section = find_airfoil(source)
    peak = section.max_camber
    # Camber added to a flat section has the mean line that `Blade` gives it.
    camber = section.camber / peak if peak else shape("naca4")[0]
    thickness = section.thickness / section.max_thickness
    return _neuralfoil_values(camber.tobytes(), thickness.tobytes())


@functools.lru_cache(maxsize=8)
def _neuralfoil_values(camber: bytes, thickness: bytes) -> FloatArray:
    """Tables of a shape by NeuralFoil; by its bytes, so that a changed file is a new shape."""
    shapes = np.frombuffer(camber), np.frombuffer(thickness)
    coefficients, confidence = neuralfoil_grid(*shapes, CAMBER, THICKNESS)
    return shape_values(coefficients, *limits(coefficients, confidence))


def _merged(one: FloatArray, other: FloatArray) -> FloatArray:
    """Nodes of both grids, without those that nearly coincide."""
    nodes = np.sort(np.concatenate([one, other]))
    return nodes[np.concatenate([[True], np.diff(nodes) > 0.005])]


def _resampled(log_re: FloatArray, values: FloatArray, wanted: FloatArray) -> FloatArray:
    """Values at other Reynolds numbers, held at the ends; the axis before the last."""
    if np.array_equal(log_re, wanted):
        return values
    inside = jnp.clip(jnp.asarray(wanted), log_re[0], log_re[-1])
    operator = np.asarray(dense(*clamped_stencil(jnp.asarray(log_re), inside), log_re.size))
    resampled: FloatArray = np.einsum("wr,...ra->...wa", operator, values)
    return resampled
