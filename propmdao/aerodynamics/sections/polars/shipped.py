"""The tables that ship: the shapes and transitions they hold, their file."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import IO

import jax.numpy as jnp
import numpy as np

from propmdao.aerodynamics.sections.polars.attached import (
    COARSE,
    FINE,
    AttachedPolars,
    packed,
    unpacked,
)
from propmdao.aerodynamics.sections.polars.high_angle import FloatArray
from propmdao.aerodynamics.sections.polars.interpolation import clamped_stencil, dense
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import (
    REYNOLDS,
    neuralfoil_grid,
    neuralfoil_settings,
)
from propmdao.propeller.airfoils.airfoil import naca4
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.records.models import FREE, Transition
from propmdao.runtime.output_files import replacing

#: Maximum camber and thickness over chord of the tables; negative camber follows by symmetry.
CAMBER: FloatArray = np.array([0.0, 0.015, 0.03, 0.045, 0.06, 0.075, 0.09])
THICKNESS: FloatArray = np.array([0.03, 0.045, 0.065, 0.09, 0.12, 0.155, 0.19, 0.22])
#: Blends of E63 and Clark-Y among the shapes, by share of Clark-Y.
CLARKY_SHARES = {"e63": 0.0, "e63-clarky": 0.5, "clarky": 1.0}
#: Shapes of the file: the NACA 4-digit series with its maximum camber at 0.4 c, and the blends.
SHAPES = ("naca4", *CLARKY_SHARES)
#: Critical amplification of e^n transition in the tables without trips. The default, 5, is the same
#: for every blade: moulded edges, and air that other blades have stirred. A clean wind tunnel has
#: 9 to 12, a dirty one 4 to 8 (Drela, XFOIL user guide);
#: studies/validation/aerodynamic_sensitivity.py shows what it changes.
SHIPPED_N_CRIT = (3.0, 5.0, 7.0, 9.0)
#: Transition of the table with trips: both sides, as wind tunnels trip sections.
SHIPPED_TRIPPED = Transition(5.0, 0.05, 0.05)
SHIPPED = (*(Transition(n_crit, FREE, FREE) for n_crit in SHIPPED_N_CRIT), SHIPPED_TRIPPED)


def shape(name: str) -> tuple[FloatArray, FloatArray]:
    """Get camber line and thickness of a shape, each scaled to a maximum of 1.

    Parameters
    ----------
    name : str
        Name of the shape, one of `SHAPES`.

    Returns
    -------
    camber, thickness : (n_chord,) arrays
        Camber line and full thickness on `propmdao.propeller.airfoils.airfoil.CHORD_FRACTION`.
    """
    if name == "naca4":
        section = naca4(1.0, 0.4, 1.0)
        camber, thickness = section.camber, section.thickness
    else:
        share = CLARKY_SHARES[name]
        first, last = find_airfoil("e63"), find_airfoil("clarky")
        camber = (1.0 - share) * first.camber + share * last.camber
        thickness = (1.0 - share) * first.thickness + share * last.thickness
    return camber / camber.max(), thickness / thickness.max()


def shipped_shares(transition: Transition) -> dict[Transition, float]:
    """Tell of which tables that ship those of a transition are made.

    Parameters
    ----------
    transition : Transition
        Transition of the boundary layers, completed.

    Returns
    -------
    dict of Transition to float
        Shares, which sum to 1, by the transition of the table: one, or for an n_crit between those
        of the tables the weights of a C1 interpolation. Empty where the tables do not reach.
    """
    if transition in SHIPPED:
        return {transition: 1.0}
    n_crit, nodes = transition.n_crit, jnp.asarray(SHIPPED_N_CRIT)
    if n_crit is None or not (
        transition.free and SHIPPED_N_CRIT[0] <= n_crit <= SHIPPED_N_CRIT[-1]
    ):
        return {}
    weights = dense(*clamped_stencil(nodes, jnp.array([n_crit])), nodes.size)[0]
    return {made: float(w) for made, w in zip(SHIPPED, weights, strict=False) if w != 0.0}


def generate(path: Path) -> None:
    """Make the file of tables; needs NeuralFoil and takes four minutes of a core.

    Parameters
    ----------
    path : Path
        File to write.
    """
    members = {
        "camber": CAMBER,
        "thickness": THICKNESS,
        "reynolds": REYNOLDS,
        "settings": np.array(neuralfoil_settings()),
    }
    for transition in SHIPPED:
        unit = FINE if transition == Transition().completed() else COARSE
        for name in SHAPES:
            polars = neuralfoil_grid(*shape(name), CAMBER, THICKNESS, transition)
            members |= packed(_member(name, transition), polars, unit)
    with replacing(path) as file:
        np.savez_compressed(file, allow_pickle=False, **members)


def _member(name: str, transition: Transition) -> str:
    """Name of a table in the file."""
    return f"{name} {SHIPPED.index(transition)}"


def shipped_polars(name: str, transition: Transition) -> AttachedPolars:
    """Read a table that ships, that one alone.

    Parameters
    ----------
    name : str
        Name of the shape, one of `SHAPES`.
    transition : Transition
        Transition of the table, one of `SHIPPED`.

    Returns
    -------
    AttachedPolars
        Polars of the shape.
    """
    with _file() as file, np.load(file) as members:
        return unpacked(members, _member(name, transition))


def shipped_settings() -> str:
    """Tell how the tables that ship were made.

    Returns
    -------
    str
        Program, version and settings, one line.
    """
    with _file() as file, np.load(file) as members:
        return str(members["settings"])


def _file() -> IO[bytes]:
    """File of the tables, opened."""
    file = files("propmdao.propeller.catalog") / "polars" / "sections.npz"
    return file.open("rb")
