"""Files for other programs: the rotor's skin, its distributions, its sections."""

from __future__ import annotations

import csv
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from propmdao.formats.endings import STL_UNITS
from propmdao.formats.meshes.stl import rotor_triangles, write_stl
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.meshes import propeller_surface
from propmdao.geometry.section import section_shape
from propmdao.propeller.airfoils.airfoil import chord_interpolation
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity
from propmdao.runtime.output_files import replacing
from propmdao.runtime.terminal import printable

_SECTION_POINTS = 161


def export_stl(
    path: str | Path,
    propeller: Propeller,
    unit: str = "m",
    fidelity: Fidelity = Fidelity(),  # noqa: B008 - frozen
) -> int:
    """Write the skin of all blades as a binary STL file.

    Parameters
    ----------
    path : str or Path
        File to write.
    propeller : Propeller
        Propeller to write.
    unit : {"m", "mm"}
        Unit of the coordinates: STL does not hold it, so the title of the file says it.
    fidelity : Fidelity
        Resolution, of which `n_contour` and `n_surface_span` count here.

    Returns
    -------
    int
        Number of triangles.

    Raises
    ------
    ValueError
        If the unit is another one.
    """
    if unit not in STL_UNITS:
        raise ValueError(f"unit of an STL file must be one of {', '.join(STL_UNITS)}; got {unit!r}")
    name, scale = STL_UNITS[unit]
    nodes = propeller_surface(propeller, fidelity.n_contour, fidelity.n_surface_span)
    triangles = rotor_triangles(scale * nodes, propeller.n_blades)
    write_stl(path, triangles, f"{name}: propmdao {propeller.name}")
    return len(triangles)


def export_csv(path: str | Path, propeller: Propeller) -> int:
    """Write the distributions of a blade at its stations.

    Parameters
    ----------
    path : str or Path
        File to write.
    propeller : Propeller
        Propeller to write.

    Returns
    -------
    int
        Number of stations.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    blade, radius = Blade.from_propeller(propeller), 0.5 * propeller.diameter
    columns = {
        "r_over_R": propeller.r_over_R,
        "radius_m": radius * propeller.r_over_R,
        "c_over_R": propeller.c_over_R,
        "chord_m": radius * propeller.c_over_R,
        "beta_deg": propeller.beta_deg,
        "thickness_over_chord": np.asarray(blade.thickness_over_chord),
        "camber_over_chord": np.asarray(blade.camber_over_chord),
        "sweep_over_R": propeller.sweep_over_R,
        "rake_over_R": propeller.rake_over_R,
        "n_blades": np.full(propeller.r_over_R.size, propeller.n_blades),
    }
    with replacing(path) as file, file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(columns)
        # Ten digits: more than were measured, fewer than rounding shows.
        rows = zip(*columns.values(), strict=True)
        writer.writerows([f"{value:.10g}" for value in row] for row in rows)
    return propeller.r_over_R.size


def export_section(path: str | Path, propeller: Propeller, r_over_R: float) -> int:
    """Write a section of unit chord as coordinates in Selig's order, as XFOIL reads them.

    Parameters
    ----------
    path : str or Path
        File to write.
    propeller : Propeller
        Propeller to write.
    r_over_R : float
        Radius of the section over the tip radius.

    Returns
    -------
    int
        Number of points.

    Raises
    ------
    ValueError
        If the radius is outside the blade, or the file cannot be written.
    """
    span = span_interpolation(propeller.r_over_R, [r_over_R])
    angle = np.linspace(np.pi, -np.pi, _SECTION_POINTS)
    operator = jnp.asarray(chord_interpolation(np.abs(angle)))
    camber, thickness = section_shape(Blade.from_propeller(propeller), span, operator)
    z = np.asarray(camber[:, 0]) + 0.5 * np.sign(np.round(angle, 12)) * np.asarray(thickness[:, 0])
    x = 0.5 * (1.0 - np.cos(angle))
    lines = [printable(f"{propeller.name} at r/R {r_over_R:g}")]
    lines += [f"{a:.7f} {b:.7f}" for a, b in zip(x, z + 0.0, strict=True)]
    with replacing(path) as file:
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return _SECTION_POINTS
