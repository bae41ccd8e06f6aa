"""The polars of a described propeller."""

from __future__ import annotations

import dataclasses
import functools
import warnings
from collections.abc import Mapping
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.polars.attached import (
    FINE,
    AttachedPolars,
    packed,
    unpacked,
)
from propmdao.aerodynamics.sections.polars.family import SectionPolars, shape_values
from propmdao.aerodynamics.sections.polars.high_angle import (
    ALPHA,
    ATTACHED_DEG,
    FloatArray,
)
from propmdao.aerodynamics.sections.polars.interpolation import clamped_stencil, dense
from propmdao.aerodynamics.sections.polars.measured_drag import TUNNEL_N_CRIT, at_measured_level
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import (
    REYNOLDS,
    neuralfoil_grid,
    neuralfoil_settings,
)
from propmdao.aerodynamics.sections.polars.shipped import (
    CAMBER,
    CLARKY_SHARES,
    SHAPES,
    THICKNESS,
    shape,
    shipped_polars,
    shipped_shares,
)
from propmdao.aerodynamics.sections.polars.sources import find_sources
from propmdao.aerodynamics.sections.polars.table import PolarSubstituteWarning, PolarTable
from propmdao.aerodynamics.sections.polars.user_table import ANY_REYNOLDS
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller
from propmdao.records.models import Transition
from propmdao.runtime.caches import kept_arrays
from propmdao.runtime.terminal import print_line

# Transition of the polars whose drag at equal lift is the measured one.
_TUNNEL = Transition(TUNNEL_N_CRIT).completed()
# Version of the files of polars that are kept, a part of their keys.
_FORMAT = 1


@dataclasses.dataclass(frozen=True)
class _Values:
    """Coefficients over (Mach number,) Reynolds number and angle, the last axes of `values`."""

    log_re: FloatArray
    values: FloatArray
    mach: FloatArray | None = None

    @classmethod
    def of_table(cls, table: PolarTable) -> _Values:
        mach = None if table.mach is None else np.asarray(table.mach)
        return cls(np.asarray(table.log_re), np.asarray(table.values), mach)

    def resampled(self, log_re: FloatArray, mach: FloatArray | None) -> FloatArray:
        """Values at other nodes; what has no Mach numbers is the same at all."""
        values = _resampled(self.log_re, self.values, log_re)
        if mach is None:
            return values
        if self.mach is None:
            return np.repeat(values[..., None, :, :], mach.size, axis=-3)
        over_mach = _resampled(self.mach, np.moveaxis(values, -3, -2), mach)
        return np.moveaxis(over_mach, -2, -3)


def polars_for(
    propeller: Propeller,
    own: Mapping[str, PolarTable] | None = None,
    transition: Transition = Transition(),  # noqa: B008 - frozen
    measured_drag: bool = True,
) -> SectionPolars:
    """Find the polars of a propeller's sections.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    own : dict of PolarTable, optional
        A table of one section by the airfoil's name in the propeller, or its file's name without
        folder and ending; it goes before the catalogue. It is taken at any camber and thickness,
        and at any transition: a design that changes them needs polars that know them.
    transition : Transition
        Transition of the boundary layers to turbulent flow; what it leaves open the propeller's
        description says, or the defaults. The catalogue has tables at
        `propmdao.aerodynamics.sections.polars.shipped.SHIPPED`, and interpolates between them in
        n_crit; at any other transition NeuralFoil makes the tables of all shapes.
    measured_drag : bool
        Whether drag without trips is brought to the measured level
        (`propmdao.aerodynamics.sections.polars.measured_drag`); else it is NeuralFoil's. The
        user's tables are never changed.

    Returns
    -------
    SectionPolars
        Polars of E63, Clark-Y, their blends and NACA 4-digit sections with their camber at 0.4 c
        from the catalogue, whatever their names; of other sections from NeuralFoil, where it is
        installed: about half a minute per airfoil, once on a machine, for the result is kept in
        the user's cache folder. `sources.polar_sources` tells which is which.

    Raises
    ------
    PolarError
        If a user's table is no table of one section, or polars at this transition take NeuralFoil
        and it is not installed.

    Warns
    -----
    PolarSubstituteWarning
        If an airfoil has no polars and NACA 4-digit ones stand in.
    """
    transition = transition.completed(propeller.transition)
    sources = find_sources(propeller, own, transition, measured_drag)
    for name, source in sources.items():
        if source.substitute:
            warnings.warn(_substitute_message(name), PolarSubstituteWarning, stacklevel=2)
    user = {
        source.shape: _Values.of_table(source.table)
        for source in sources.values()
        if source.table is not None
    }
    weights = shape_weights(propeller, [sources[name].shape for _, name in propeller.airfoils])
    tables = [
        user.get(name) or _Values(np.log(REYNOLDS), _family_values(name, transition, measured_drag))
        for name in weights
    ]
    # A table without Reynolds numbers is the same at those of the others.
    grids = [table.log_re for table in tables if not np.array_equal(table.log_re, ANY_REYNOLDS)]
    log_re = functools.reduce(_merged, grids or [ANY_REYNOLDS])
    machs = [table.mach for table in tables if table.mach is not None]
    mach = functools.reduce(_merged, machs) if machs else None
    resampled = [table.resampled(log_re, mach) for table in tables]
    camber, thickness = np.concatenate([-CAMBER[:0:-1], CAMBER]), THICKNESS
    if user.keys() == weights.keys():
        camber, thickness = np.array([-1.0, 1.0]), np.array([0.0, 1.0])
    over_mach = () if mach is None else mach.shape
    full = (camber.size, thickness.size, 3, *over_mach, log_re.size, ALPHA.size)
    arrays = {
        "camber": camber,
        "thickness": thickness,
        "log_re": log_re,
        "alpha": ALPHA,
        "values": np.stack([np.broadcast_to(values, full) for values in resampled]),
        "weights": np.stack(list(weights.values()), axis=1),
        "mach": mach,
    }
    return SectionPolars(**jax.device_put(arrays))  # jnp.asarray compiles for each shape


def _substitute_message(name: str) -> str:
    """Say that polars of another section stand in for an airfoil's, and what to do about it."""
    return (
        f"airfoil '{name}' has no polars in the catalogue: those of a NACA 4-digit section of its "
        "camber and thickness stand in. Give polar files of it (--polar, or polars_for(propeller, "
        f"own={{'{Path(name).stem}': read_polars(...)}})), or install NeuralFoil, which makes "
        "them: pip install 'propmdao[polars]'"
    )


def shape_weights(propeller: Propeller, shapes: list[str]) -> dict[str, FloatArray]:
    """Tell what share each shape has in each station.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    shapes : list of str
        Shape of each of its airfoils.

    Returns
    -------
    dict of (n_stations,) arrays
        Shares by shape, those in use alone; at each station they sum to 1.
    """
    positions = [position for position, _ in propeller.airfoils]
    share = np.stack(
        [np.interp(propeller.r_over_R, positions, unit) for unit in np.eye(len(positions))]
    )
    # The zero-lift angle follows the camber line, so shapes count by what they give to it.
    camber = [abs(find_airfoil(name).max_camber) for _, name in propeller.airfoils]
    amount = share * np.array(camber)[:, None]
    total = amount.sum(axis=0)
    weight = np.where(total > 0.0, amount / np.where(total > 0.0, total, 1.0), share)

    def summed(rows: FloatArray, name: str) -> FloatArray:
        rows_of_shape: FloatArray = rows[[k for k, key in enumerate(shapes) if key == name]]
        return rows_of_shape.sum(axis=0)

    weights = {name: summed(weight, name) for name in shapes}
    if {"e63", "clarky"} <= weights.keys():
        both, last = weights["e63"] + weights["clarky"], summed(share, "clarky")
        shared = last + summed(share, "e63")
        blend = np.where(shared > 0.0, last / np.where(shared > 0.0, shared, 1.0), 0.0)
        nodes = np.array(list(CLARKY_SHARES.values()))
        for name, hat in zip(CLARKY_SHARES, np.eye(nodes.size), strict=True):
            weights[name] = both * np.interp(blend, nodes, hat)
    return weights


def _family_values(name: str, transition: Transition, measured_drag: bool) -> FloatArray:
    """Tables of a shape of the catalogue, or of any airfoil by NeuralFoil."""
    if name in SHAPES and shipped_shares(transition):
        return _shipped_values(name, transition, measured_drag)
    camber, thickness = scaled_shape(name)
    return _neuralfoil_values(
        name, camber.tobytes(), thickness.tobytes(), transition, measured_drag
    )


def scaled_shape(name: str) -> tuple[FloatArray, FloatArray]:
    """Get camber line and thickness of a shape of the catalogue or of any airfoil.

    Parameters
    ----------
    name : str
        Name of the shape or of the airfoil.

    Returns
    -------
    camber, thickness : (n_chord,) arrays
        Camber line and thickness, each scaled to a maximum of 1.
    """
    if name in SHAPES:
        return shape(name)
    section = find_airfoil(name)
    peak = section.max_camber
    # Camber added to a flat section has the mean line that `Blade` gives it.
    camber = section.camber / peak if peak else shape("naca4")[0]
    return camber, section.thickness / section.max_thickness


@functools.lru_cache(maxsize=16)
def _shipped_values(name: str, transition: Transition, measured_drag: bool) -> FloatArray:
    """Tables of a shape that ship, or between those that do."""
    values = np.zeros(())
    for made, share in shipped_shares(transition).items():
        polars = shipped_polars(name, made)
        if measured_drag and made.free:
            polars = _at_measured_level(polars, shipped_polars(name, _TUNNEL))
        values = values + share * shape_values(polars, polars)
    return values


@functools.lru_cache(maxsize=8)
def _neuralfoil_values(
    name: str, camber: bytes, thickness: bytes, transition: Transition, measured_drag: bool
) -> FloatArray:
    """Tables of a shape by NeuralFoil; by its bytes, so that a changed file is a new shape."""
    upright = _kept_polars(name, camber, thickness, transition)
    if measured_drag and transition.free:
        tunnel = _kept_polars(name, camber, thickness, _TUNNEL)
        upright = _at_measured_level(upright, tunnel)
    upside_down = upright
    if transition.upside_down != transition:
        upside_down = _kept_polars(name, camber, thickness, transition.upside_down)
    return shape_values(upright, upside_down)


def _kept_polars(
    name: str, camber: bytes, thickness: bytes, transition: Transition
) -> AttachedPolars:
    """Polars of a shape that NeuralFoil makes, once on a machine."""

    def make() -> dict[str, npt.NDArray]:
        print_line(
            f"propmdao: NeuralFoil makes the polars of airfoil '{name}' at {transition}, once on"
            " this machine: half a minute or more",
            error=True,
        )
        shapes = np.frombuffer(camber), np.frombuffer(thickness)
        return packed("polars", neuralfoil_grid(*shapes, CAMBER, THICKNESS, transition), FINE)

    grids = [grid.tobytes() for grid in (CAMBER, THICKNESS, REYNOLDS, ATTACHED_DEG)]
    settings = f"{_FORMAT} {neuralfoil_settings()} {dataclasses.astuple(transition)}"
    key = b"".join([camber, thickness, *grids, settings.encode()])
    return unpacked(kept_arrays("polars", key, make), "polars")


def _at_measured_level(polars: AttachedPolars, tunnel: AttachedPolars) -> AttachedPolars:
    """Polars with the drag that is measured at their lift, for boundary layers without trips."""
    level = at_measured_level(polars.coefficients, tunnel.coefficients, REYNOLDS)
    return dataclasses.replace(polars, coefficients=level)


def _merged(grid: FloatArray, second: FloatArray) -> FloatArray:
    """Nodes of both grids, without those that nearly coincide."""
    nodes = np.sort(np.concatenate([grid, second]))
    return nodes[np.concatenate([[True], np.diff(nodes) > 0.005])]


def _resampled(nodes: FloatArray, values: FloatArray, target: FloatArray) -> FloatArray:
    """Values at other nodes, held at the ends; the axis before the last."""
    if np.array_equal(nodes, target):
        return values
    inside = jnp.clip(jnp.asarray(target), nodes[0], nodes[-1])
    operator = np.asarray(dense(*clamped_stencil(jnp.asarray(nodes), inside), nodes.size))
    resampled: FloatArray = np.einsum("wr,...ra->...wa", operator, values)
    return resampled
