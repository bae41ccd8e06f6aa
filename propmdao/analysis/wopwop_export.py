"""A propeller of ours for PSU-WOPWOP: its blade, or with its loads a whole case."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from numpy.typing import ArrayLike

from propmdao.acoustics.kinematics.limits import require_subsonic_tip
from propmdao.acoustics.kinematics.motion import translation
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.formats.wopwop.blade_files import blade_geometry
from propmdao.formats.wopwop.geometry_file import write_geometry
from propmdao.formats.wopwop.write_case import write_case
from propmdao.geometry.meshes import propeller_surface
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity
from propmdao.records.loads import PointLoads


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
    try:
        write_geometry(path, geometry)
    except OSError as error:
        raise ValueError(f"{path}: {error.strerror or error}") from None


def write_propeller_case(
    folder: str | Path,
    propeller: Propeller,
    loads: PointLoads,
    *,
    rpm: float,
    speed: float,
    density: float,
    sound_speed: float,
    observers: ArrayLike,
    fidelity: Fidelity = Fidelity(),  # noqa: B008 - frozen
    n_times: int = 1024,
) -> None:
    """Write a PSU-WOPWOP case of a propeller in hover or axial flight, observers flying along.

    Parameters
    ----------
    folder : str or Path
        Where to: cases.nam, case.nam and the geometry and loading files.
    propeller : Propeller
        The described blade, as it was analysed.
    loads : PointLoads
        Of the analysis, ``steady.point_loads``.
    rpm, speed, density, sound_speed : float
        Operating point [rev/min], [m/s], [kg/m^3], [m/s].
    observers : (n_observers, 3) array_like
        Positions from the rotor centre [m], see `arc`.
    fidelity : Fidelity
        Numbers of panels of the surface.
    n_times : int
        Observer times over the one turn that is written.

    Raises
    ------
    ValueError
        If the propeller does not turn, its tip is not slower than sound, or the folder cannot be
        written.
    """
    if not (np.isfinite(rpm) and rpm > 0):
        raise ValueError(f"rpm must be positive for a PSU-WOPWOP case; it is {rpm:g}")
    omega = rpm * np.pi / 30
    require_subsonic_tip(0.5 * propeller.diameter, omega, speed, sound_speed)
    velocity = np.array([0.0, 0.0, speed])
    write_case(
        folder,
        [Rotor(equally_spaced(propeller.n_blades), omega, loads=loads)],
        [propeller_surface(propeller, fidelity.n_contour, fidelity.n_surface_span)],
        Observers(jnp.asarray(observers, float).reshape(-1, 3), jnp.asarray(velocity)),
        np.arange(n_times) * 2 * np.pi / (omega * n_times),
        density,
        sound_speed,
        (translation(velocity=velocity),),
    )
