"""A blade that gives under its loads: loads and deflection that belong together.

The air loads bend and twist the blade, and the blade changes the air loads. Both are computed in
turn until the blade rests, which takes four or five rounds: a degree of twist changes the loads by
some per cent, and these the twist by as little.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array

from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.sections.polars.table import curve_coefficients, section_curves
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.analysis.elastic.materials import ElasticError
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation, strip_radii
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller
from propmdao.records.panels import Panels
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled
from propmdao.structures.beam import Beam, Material, SectionForces, motion, turned
from propmdao.structures.equilibrium import equilibrium
from propmdao.structures.sections import (
    BeamRadii,
    beam_of,
    beam_radii,
    elastic_axis,
    filled,
)
from propmdao.structures.shapes import Shapes, shapes

FloatArray = npt.NDArray[np.float64]

_TOLERANCE = 1.0e-4  # of the twist between two rounds [deg]
_MOST_ROUNDS = 40
_MOST_TWIST = 45.0  # beyond which the sections' flow and the beam mean nothing any more [deg]


@dataclasses.dataclass(frozen=True)
class Deflection:
    """How far a blade has given, at the stations of its propeller.

    Attributes
    ----------
    r_over_R : (n_stations,) array
        Stations.
    twist_deg : (n_stations,) array
        Turn of the sections, nose up [deg].
    sweep_over_R, rake_over_R : (n_stations,) arrays
        Displacement of the quarter chord aft and toward thrust, over the tip radius.
    """

    r_over_R: FloatArray
    twist_deg: FloatArray
    sweep_over_R: FloatArray
    rake_over_R: FloatArray

    def applied_to(self, propeller: Propeller) -> Propeller:
        """Deflect a propeller of these stations."""
        return dataclasses.replace(
            propeller,
            beta_deg=propeller.beta_deg + self.twist_deg,
            sweep_over_R=propeller.sweep_over_R + self.sweep_over_R,
            rake_over_R=propeller.rake_over_R + self.rake_over_R,
        )


class Solved(NamedTuple):
    """Loads of a propeller that is held in a shape.

    Attributes
    ----------
    blade : Blade
        Blade of the propeller.
    panels : Panels
        Closed surface of the blade.
    case : RotorCase
        Case that was solved.
    loads : RotorLoads or TiltedLoads
        Loads of the case; elastic blades are of axial flow, the former.
    state : RotorState
        How the rotor turns and flies, which a thrust required decides.
    """

    blade: Blade
    panels: Panels
    case: RotorCase
    loads: RotorLoads | TiltedLoads
    state: RotorState


def deflected(
    propeller: Propeller, material: Material, solve: Callable[[Propeller], Solved]
) -> tuple[Deflection, Solved]:
    """Let a blade give until its loads and its shape belong together.

    Parameters
    ----------
    propeller : Propeller
        Blade without loads.
    material : Material
        What it is made of.
    solve : callable
        Function that returns the loads of a propeller that is held in its shape.

    Returns
    -------
    deflection, solved : Deflection, Solved
        How far the blade gives, and the loads of the blade that has given so far.

    Raises
    ------
    ElasticError
        If the blade does not come to rest.
    """
    n_stations = propeller.r_over_R.size
    deflection = Deflection(propeller.r_over_R, *np.zeros((3, n_stations)))
    solved = solve(propeller)
    hold = _Hold(propeller, material, solved.loads.strip_thrust.size)
    change = np.inf
    for _ in range(_MOST_ROUNDS):
        following = hold.deflection(solved)
        change = np.abs(following.twist_deg - deflection.twist_deg).max()
        if change < _TOLERANCE:
            return deflection, solved
        deflection = following
        try:
            bent = deflection.applied_to(propeller)
        except PropellerError as error:
            raise ElasticError(f"the blade does not stand its loads: {error}") from error
        solved = solve(bent)
    raise ElasticError(
        f"the blade does not come to rest under its loads: after {_MOST_ROUNDS} rounds its twist"
        f" still changes by {change:.2g} deg"
    )


def beam_of_propeller(propeller: Propeller, material: Material) -> tuple[Blade, BeamRadii, Beam]:
    """Turn a described propeller into a beam.

    Parameters
    ----------
    propeller : Propeller
        The described blade; its cross-sections are those it names, or those of its airfoils.
    material : Material
        Material of the blade.

    Returns
    -------
    blade, radii, beam : Blade, BeamRadii, Beam
        Blade as it is stiff, interpolation from its stations, and the beam.
    """
    blade = Blade.from_propeller(propeller)
    if propeller.area_over_c2 is not None:
        blade = filled(blade, propeller.area_over_c2)
    radii = beam_radii(propeller.r_over_R)
    return blade, radii, beam_of(blade, radii, material)


class _Hold:
    """Beam of a blade, and where it is loaded and looked at."""

    def __init__(self, propeller: Propeller, material: Material, n_strips: int) -> None:
        stations = propeller.r_over_R
        root = stations[0]
        blade, radii, beam = beam_of_propeller(propeller, material)
        self.r_over_R, self.radius, self.beam = stations, float(blade.radius), beam
        strips = strip_interpolation(stations, n_strips)
        # From the elastic axis to the quarter chord.
        self.arms = [-blade.radius * elastic_axis(blade, span) for span in (strips, radii.stations)]
        self.places = [
            shapes((r - root) / (1.0 - root)) for r in (strip_radii(root, n_strips), stations)
        ]

    def deflection(self, solved: Solved) -> Deflection:
        """How far the blade gives under loads."""
        sections = solved.case.sections
        assert sections is not None  # `LoadModel` has refused inviscid flow
        assert isinstance(solved.loads, RotorLoads)  # an incidence has been refused before
        loads = _air_loads(solved.loads, sections, solved.state, self.arms[0])
        moved, turn, stable = _given(
            self.beam,
            jnp.asarray(solved.state.rotation_speed, float),
            loads,
            self.places,
            self.arms[1],
        )
        twist_deg = np.degrees(np.asarray(turn))
        worst = int(np.argmax(np.abs(twist_deg)))
        if not stable or not abs(twist_deg[worst]) <= _MOST_TWIST:
            rest = "finds no rest" if not stable else f"twists by {twist_deg[worst]:.3g} deg"
            raise ElasticError(
                f"the blade does not stand its loads: it {rest} at"
                f" r/R {self.r_over_R[worst]:.2f}; is it stiff enough?"
            )
        y, z = np.asarray(moved).T / self.radius
        return Deflection(self.r_over_R, twist_deg, -y, z)


@compiled
def _air_loads(
    loads: RotorLoads, sections: ViscousSections, state: RotorState, arm: Array
) -> SectionForces:
    """Forces of the air on the strips, at their quarter chord, and moments of the sections."""
    strips, flow, air = loads.strips, loads.sections, state.air
    reynolds = air.density * flow.relative_speed * strips.chord / air.dynamic_viscosity
    mach = flow.relative_speed / air.sound_speed
    curves = section_curves(sections.polars, reynolds, mach)
    cm = curve_coefficients(curves, flow.angle_of_attack)[2]
    pressure = 0.5 * air.density * flow.relative_speed**2
    force = jnp.stack([-loads.strip_torque / strips.radius, loads.strip_thrust], axis=-1)
    return SectionForces(arm, force, pressure * strips.chord**2 * strips.width * cm)


@compiled
def _given(
    beam: Beam, rotation_speed: Array, loads: SectionForces, places: list[Shapes], arm: Array
) -> tuple[Array, Array, Array]:
    """Displacement of the quarter chord and turn at the stations, and whether the blade rests."""
    rest = equilibrium(beam, rotation_speed, places[0], loads)
    axis, turn = motion(beam, places[1], rest.amplitudes)
    return axis + turned(arm, turn) - arm, turn, rest.stable
