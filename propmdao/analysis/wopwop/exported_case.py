"""A propeller of ours for PSU-WOPWOP: its blade, or with its loads a whole case."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from propmdao.acoustics.kinematics.motion import translation
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.analysis.results import Analysis
from propmdao.formats.wopwop.blade_files import blade_geometry
from propmdao.formats.wopwop.geometry_file import write_geometry
from propmdao.formats.wopwop.write_case import write_rotor_case
from propmdao.geometry.meshes import propeller_surface
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity


def write_blade(
    path: str | Path,
    propeller: Propeller,
    fidelity: Fidelity = Fidelity(),  # noqa: B008 - frozen
) -> None:
    """Write the surface of a blade as a PSU-WOPWOP geometry ("patch") file.

    Parameters
    ----------
    path : str or Path
        Where to.
    propeller : Propeller
        The described blade.
    fidelity : Fidelity
        Numbers of panels of the surface.

    Raises
    ------
    ValueError
        If the file cannot be written.
    """
    surface = propeller_surface(propeller, fidelity.n_contour, fidelity.n_surface_span)
    geometry = blade_geometry(surface, None)
    geometry = dataclasses.replace(geometry, comment=f"propmdao {propeller.name}")
    write_geometry(path, geometry)


def write_case(analysis: Analysis, folder: str | Path, n_times: int = 1024) -> None:
    """Write a PSU-WOPWOP case of an analysed propeller, its observers flying along.

    Parameters
    ----------
    analysis : Analysis
        Blade, loads, operating point and observers.
    folder : str or Path
        Where to: cases.nam, case.nam and the geometry and loading files.
    n_times : int
        Observer times over the one turn that is written.

    Raises
    ------
    ValueError
        If the propeller does not turn, nobody listens, or the folder cannot be written.

    Notes
    -----
    The ground's axes are those of the rotor at time 0: at an incidence the flight is along +x and
    +z, and the loads are periodic, with the azimuth as key.
    """
    state, observers = analysis.state, analysis.listening.observers
    omega, air = float(state.rotation_speed), state.air
    if not omega > 0.0:
        raise ValueError(f"rpm must be positive for a PSU-WOPWOP case; it is {analysis.rpm:g}")
    if not len(observers):
        raise ValueError("a PSU-WOPWOP case needs observers; there are none")
    propeller, fidelity = analysis.changed_propeller, analysis.model.fidelity
    velocity = np.asarray(state.velocity)
    write_rotor_case(
        folder,
        [Rotor(equally_spaced(propeller.n_blades), omega, loads=analysis.loads.point_loads)],
        [propeller_surface(propeller, fidelity.n_contour, fidelity.n_surface_span)],
        Observers(jnp.asarray(observers, float), jnp.asarray(velocity)),
        np.arange(n_times) * 2 * np.pi / (omega * n_times),
        air,
        (translation(velocity=velocity),),
    )
