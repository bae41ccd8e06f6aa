"""The boundary layers of a described propeller's sections, those that ship or by NeuralFoil."""

from __future__ import annotations

import dataclasses
import functools
import warnings
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.edge_layers.neuralfoil_layers import (
    ALPHA_DEG,
    neuralfoil_layers,
    of_both_cambers,
    packed_layers,
    unpacked_layers,
)
from propmdao.aerodynamics.sections.edge_layers.tables import SectionLayers
from propmdao.aerodynamics.sections.polars.high_angle import FloatArray
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import REYNOLDS, neuralfoil_settings
from propmdao.aerodynamics.sections.polars.propeller_polars import scaled_shape, shape_weights
from propmdao.aerodynamics.sections.polars.shipped import (
    CAMBER,
    SHAPES,
    SHIPPED,
    THICKNESS,
    shape,
    shipped_shares,
)
from propmdao.aerodynamics.sections.polars.sources import find_sources
from propmdao.aerodynamics.sections.polars.table import PolarSubstituteWarning
from propmdao.propeller.description import Propeller
from propmdao.records.models import Transition
from propmdao.runtime.caches import kept_arrays
from propmdao.runtime.output_files import replacing
from propmdao.runtime.terminal import print_line

# Version of the files of boundary layers that are kept, a part of their keys.
_FORMAT = 1


def layers_for(
    propeller: Propeller,
    transition: Transition = Transition(),  # noqa: B008 - frozen
) -> SectionLayers:
    """Find the boundary layers at the trailing edge of a propeller's sections.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    transition : Transition
        Transition to turbulent flow; what it leaves open the propeller's description says, or the
        defaults.

    Returns
    -------
    SectionLayers
        Those of the sections that `polars_for` knows: from the catalogue, or from NeuralFoil where
        it is installed, once on a machine.

    Raises
    ------
    PolarError
        If layers at this transition take NeuralFoil and it is not installed.

    Warns
    -----
    PolarSubstituteWarning
        If an airfoil is not known and NACA 4-digit sections stand in.
    """
    transition = transition.completed(propeller.transition)
    sources = find_sources(propeller, None, transition, measured_drag=False)
    for name, source in sources.items():
        if source.substitute:
            warnings.warn(
                f"airfoil '{name}' has no boundary layers in the catalogue: broadband noise takes"
                " those of a NACA 4-digit section of its camber and thickness. NeuralFoil makes"
                " its own: pip install 'propmdao[polars]'",
                PolarSubstituteWarning,
                stacklevel=2,
            )
    weights = shape_weights(propeller, [sources[name].shape for _, name in propeller.airfoils])
    values = np.stack([_values(name, transition) for name in weights])
    return SectionLayers(
        camber=jnp.asarray(np.concatenate([-CAMBER[:0:-1], CAMBER])),
        thickness=jnp.asarray(THICKNESS),
        log_re=jnp.asarray(np.log(REYNOLDS)),
        alpha=jnp.asarray(np.radians(ALPHA_DEG)),
        values=jnp.asarray(values),
        weights=jnp.asarray(np.stack(list(weights.values()), axis=1)),
    )


@functools.lru_cache(maxsize=16)
def _values(name: str, transition: Transition) -> FloatArray:
    """Boundary layers of a shape over both cambers."""
    shares = shipped_shares(transition) if name in SHAPES else {}
    if shares:
        upright = np.sum([share * _shipped(name, made) for made, share in shares.items()], axis=0)
        return of_both_cambers(upright, upright)
    camber, thickness = scaled_shape(name)
    upright, upside_down = (
        _kept(name, camber.tobytes(), thickness.tobytes(), t)
        for t in (transition, transition.upside_down)
    )
    return of_both_cambers(upright, upside_down)


def _shipped(name: str, transition: Transition) -> FloatArray:
    """Boundary layers of a shape that ship."""
    with _file().open("rb") as file, np.load(file) as members:
        return unpacked_layers(members, _member(name, transition))


def _kept(name: str, camber: bytes, thickness: bytes, transition: Transition) -> FloatArray:
    """Boundary layers of a shape that NeuralFoil makes, once on a machine."""

    def make() -> dict[str, npt.NDArray]:
        print_line(
            f"propmdao: NeuralFoil makes the boundary layers of airfoil '{name}' at {transition},"
            " once on this machine: half a minute or more",
            error=True,
        )
        shapes = np.frombuffer(camber), np.frombuffer(thickness)
        return packed_layers("layers", neuralfoil_layers(*shapes, CAMBER, THICKNESS, transition))

    grids = [grid.tobytes() for grid in (CAMBER, THICKNESS, REYNOLDS, ALPHA_DEG)]
    settings = f"{_FORMAT} {neuralfoil_settings()} {dataclasses.astuple(transition)}"
    key = b"".join([camber, thickness, *grids, settings.encode()])
    return unpacked_layers(kept_arrays("layers", key, make), "layers")


def generate(path: Path) -> None:
    """Make the file of tables; needs NeuralFoil and takes three minutes of a core.

    Parameters
    ----------
    path : Path
        File to write.
    """
    members: dict[str, npt.NDArray] = {"settings": np.array(neuralfoil_settings())}
    for transition in SHIPPED:
        for name in SHAPES:
            values = neuralfoil_layers(*shape(name), CAMBER, THICKNESS, transition)
            members |= packed_layers(_member(name, transition), values)
    with replacing(path) as file:
        np.savez_compressed(file, allow_pickle=False, **members)


def shipped_settings() -> str:
    """Tell how the tables that ship were made.

    Returns
    -------
    str
        Program, version and settings, one line.
    """
    with _file().open("rb") as file, np.load(file) as members:
        return str(members["settings"])


def _member(name: str, transition: Transition) -> str:
    """Name of a table in the file."""
    return f"{name} {SHIPPED.index(transition)}"


def _file() -> Traversable:
    """File of the tables."""
    return files("propmdao.propeller.catalog") / "polars" / "layers.npz"
