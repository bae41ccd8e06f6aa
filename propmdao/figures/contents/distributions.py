"""What is drawn over the span of a blade: its shape and its loads."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from propmdao.analysis.results import Analysis
from propmdao.figures.contents.palette import Floats
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION
from propmdao.propeller.description import Propeller

Curve = tuple[Floats, Floats]


def blade_distributions(propeller: Propeller) -> dict[str, Curve]:
    """Chord, blade angle, thickness, camber and planform over span.

    Parameters
    ----------
    propeller : Propeller
        The propeller.

    Returns
    -------
    dict of str to (r/R, values)
        (n,) arrays each, by their name with its unit. The planform is a closed contour, seen from
        ahead: the leading edge is toward +y, a quarter of the chord from the sweep line.
    """
    r = np.linspace(propeller.r_over_R[0], 1.0, 200)
    span = span_interpolation(propeller.r_over_R, r)
    chord, beta_deg, sweep = (
        np.asarray(span.smooth) @ values
        for values in (propeller.c_over_R, propeller.beta_deg, propeller.sweep_over_R)
    )
    camber, thickness = (np.asarray(span.linear) @ shape for shape in _sections(propeller))
    largest = np.take_along_axis(camber, np.abs(camber).argmax(axis=1)[:, None], axis=1)
    projected = chord * np.cos(np.radians(beta_deg))
    edges = np.append(0.25 * projected - sweep, (-0.75 * projected - sweep)[::-1])
    return {
        "chord c/R": (r, chord),
        "blade angle, deg": (r, beta_deg),
        "thickness t/c": (r, thickness.max(axis=1)),
        "camber f/c": (r, largest[:, 0]),
        "planform y/R": (np.append(r, r[::-1]), edges),
    }


def section_contours(propeller: Propeller, r_over_R: Sequence[float]) -> list[Curve]:
    """Contours of sections of unit chord.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    r_over_R : sequence of float
        Radii r/R of the sections.

    Returns
    -------
    list of (x/c, z/c)
        (n,) arrays each, from the trailing edge over the upper side around to it.
    """
    linear = np.asarray(span_interpolation(propeller.r_over_R, r_over_R).linear)
    camber, thickness = (linear @ shape for shape in _sections(propeller))
    x = np.append(CHORD_FRACTION[::-1], CHORD_FRACTION)
    return [
        (x, np.append((f + 0.5 * t)[::-1], f - 0.5 * t))
        for f, t in zip(camber, thickness, strict=True)
    ]


def span_values(analysis: Analysis) -> dict[str, Floats]:
    """Lift, angle of attack, drag, Reynolds number, circulation and thrust of the strips.

    Parameters
    ----------
    analysis : Analysis
        Analysis of a rotor that turns.

    Returns
    -------
    dict of str to (n_azimuths, n_strips) array
        Values by their name with its unit; one azimuth stands for all where they are the same all
        around.
    """
    loads, air = analysis.loads, analysis.point.air
    strips, states = loads.strips, loads.sections
    reynolds = states.relative_speed * strips.chord / air.kinematic_viscosity
    # The last ring of a strip has the circulation of the whole section.
    values = {
        "lift coefficient": states.lift_coefficient,
        "angle of attack, deg": np.degrees(np.asarray(states.angle_of_attack)),
        "drag coefficient": states.drag_coefficient,
        "Reynolds number, thousands": np.asarray(reynolds) / 1e3,
        "circulation, m²/s": np.asarray(loads.circulation)[..., -1, :],
        "thrust over span, N/m": np.asarray(loads.strip_thrust / strips.width),
    }
    return {name: np.atleast_2d(np.asarray(value, float)) for name, value in values.items()}


def _sections(propeller: Propeller) -> tuple[Floats, Floats]:
    """Camber and thickness over chord, (n_stations, n_chord), as the blade has them."""
    blade = Blade.from_propeller(propeller)
    camber = blade.camber_over_chord[:, None] * blade.camber_shape
    thickness = blade.thickness_over_chord[:, None] * blade.thickness_shape
    return np.asarray(camber), np.asarray(thickness)
