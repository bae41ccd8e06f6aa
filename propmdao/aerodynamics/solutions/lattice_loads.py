"""Circulation and forces of the lattice for a wake that is already known.

Neumann condition at the collocation points, Kutta-Joukowski force on every bound and chordwise
segment with the total local velocity (Katz and Plotkin 2001, sections 12.3 and 3.11), profile drag
of the sections along the air that meets them.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.chord_lines import ChordLines, chord_lines
from propmdao.aerodynamics.lattice.rings import (
    BOUND_CORE,
    Rings,
    blade_normalwash,
    ring_segments,
    segment_circulation,
    turned,
    vortex_rings,
)
from propmdao.aerodynamics.lattice.steady_wake import WakeInfluence
from propmdao.aerodynamics.lattice.strips import Strips, blade_strips
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import ViscousSections, section_laws
from propmdao.aerodynamics.sections.recambering import (
    SectionStates,
    StripFlow,
    solve_recambering,
    unheld_states,
)
from propmdao.aerodynamics.vortices.biot_savart import SegmentKernels, segment_kernels
from propmdao.geometry.lattice import strip_middle
from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar, record
from propmdao.records.states import RotorState
from propmdao.runtime import linear_algebra


@record
class LatticeGeometry:
    """Part of the lattice that does not change with the operating point.

    Attributes
    ----------
    rings : Rings
        Lattice of blade 1.
    strips : Strips
        Sections of blade 1 in the strips of the lattice.
    points : (n_panels + n_segments, 3) array
        Collocation points, then points of the bound and chordwise segments' forces [m].
    segment : (n_segments, 3) array
        Bound, then chordwise segments, in the direction of positive circulation [m].
    lines : ChordLines
        Points at which the flow of what is far away is computed.
    """

    rings: Rings
    strips: Strips
    points: Array
    segment: Array
    lines: ChordLines

    @property
    def n_panels(self) -> int:
        """Panels of the blade, nc * ns."""
        return self.rings.normal.shape[0]


@record
class BladeInfluence:
    """What the rings of all blades induce, without wake, and their part of the solution.

    A new wake changes the last row of rings alone. With the rings' own downwash, factorised once,
    that of the wake enters by a system of ns equations (Woodbury's identity).

    Attributes
    ----------
    downwash : Factorised
        Normalwash at the collocation points by the circulation of each ring [1/m].
    recambered : (n_panels, ns) array
        Circulation of the rings per unit of normalwash on all panels of a strip [m].
    segments : SegmentKernels
        Segments of all blades as those of blade 1 see them.
    """

    downwash: linear_algebra.Factorised
    recambered: Array
    segments: SegmentKernels


@record
class LatticeLoads:
    """Loads of blade 1.

    Attributes
    ----------
    circulation : (nc, ns) array
        Circulation of the rings [m^2/s].
    position : (n_segments + ns, 3) array
        Points at which the forces act: bound segments (nc * ns) first, then chordwise
        (nc * (ns + 1)), then the quarter points of the sections [m].
    force : (n_segments + ns, 3) array
        Force on the blade; that on the sections is profile drag [N].
    sections : SectionStates
        Flow, lift and drag of the sections.
    """

    circulation: Array
    position: Array
    force: Array
    sections: SectionStates

    @property
    def thrust(self) -> Array:
        """Thrust of the blade [N]."""
        return self.force[:, 2].sum()

    @property
    def torque(self) -> Array:
        """Shaft torque the blade needs [N m]."""
        x, y = self.position[:, 0], self.position[:, 1]
        return -(x * self.force[:, 1] - y * self.force[:, 0]).sum()


@record
class Onset:
    """Air that meets the blade before its vortices act.

    Attributes
    ----------
    velocity : (3, n_points) array
        Velocity of the undisturbed air relative to the lattice's points [m/s].
    relative_speed : (ns,) array
        Resultant speed of the air at the sections, induced velocity of the disk included [m/s].
    turning_share : scalar
        Rotational speed of the tip over its resultant with the axial speed.
    """

    velocity: Array
    relative_speed: Array
    turning_share: Scalar


def axial_onset(lattice: LatticeGeometry, state: RotorState, induced_velocity: Scalar) -> Onset:
    """Air that meets the blade of a rotor in axial flight: -Omega x r - V.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    state : RotorState
        Rotation speed, flight speed and air of the rotor.
    induced_velocity : float
        Induced velocity at the disk [m/s].

    Returns
    -------
    Onset
        Velocities of the air in the turning and climbing frame of the blade.
    """
    omega, speed = state.rotation_speed, state.speed
    x, y = lattice.points[:, 0], lattice.points[:, 1]
    velocity = jnp.stack([omega * y, -omega * x, jnp.full_like(x, -speed)])
    axial_speed, radius = speed + induced_velocity, lattice.strips.radius
    tip_speed = omega * radius / lattice.strips.r_over_R
    return Onset(
        velocity,
        jnp.sqrt((omega * radius) ** 2 + axial_speed**2),
        tip_speed / jnp.sqrt(tip_speed**2 + axial_speed**2),
    )


def lattice_geometry(rotor: RotorGeometry) -> LatticeGeometry:
    """Rings, points and the part of the influence that no wake changes.

    Parameters
    ----------
    rotor : RotorGeometry
        Blade and number of blades.

    Returns
    -------
    LatticeGeometry
        The lattice.
    """
    nodes, radius = rotor.nodes, rotor.radius
    rings = vortex_rings(nodes)
    start, end = ring_segments(rings)
    nc, ns = nodes.shape[0] - 1, nodes.shape[1] - 1
    # Of a bound segment the middle of its strip, of a chordwise one its own.
    f = jnp.concatenate([jnp.tile(strip_middle(ns), nc), jnp.full(nc * (ns + 1), 0.5)])[:, None]
    points = jnp.concatenate([rings.collocation, (1.0 - f) * start + f * end])
    segment = end - start
    return LatticeGeometry(
        rings, blade_strips(nodes, rings, radius), points, segment, chord_lines(nodes)
    )


def blade_influence_of(lattice: LatticeGeometry, rotor: RotorGeometry) -> BladeInfluence:
    """What the rings of all blades induce on blade 1.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    rotor : RotorGeometry
        Blade and number of blades.

    Returns
    -------
    BladeInfluence
        The part of the Neumann condition and of the velocities that no wake changes.
    """
    core, rings = BOUND_CORE * rotor.radius, lattice.rings
    downwash = blade_normalwash(rings, rotor.azimuths, core)
    nc, ns = downwash.shape[:2]
    factors = linear_algebra.factorised(downwash.reshape(nc * ns, -1).T)
    start, end = (turned(ends, rotor.azimuths) for ends in ring_segments(rings))
    return BladeInfluence(
        factors,
        -factors.solve(jnp.tile(jnp.eye(ns), (nc, 1))),
        segment_kernels(lattice.points[lattice.n_panels :], start, end, core).without_own(),
    )


def loads_with_wake(
    lattice: LatticeGeometry,
    blades: BladeInfluence,
    wake: WakeInfluence,
    onset: Onset,
    air: Air,
    sections: ViscousSections | None,
) -> LatticeLoads:
    """Solve for the circulation in a given wake and take the forces.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    blades : BladeInfluence
        What the rings of all blades induce on it.
    wake : WakeInfluence
        What the wake induces per unit circulation of the last rings.
    onset : Onset
        Air that meets the blade before its vortices act.
    air : Air
        The undisturbed air.
    sections : ViscousSections or None
        Polars that the lattice is held to; None for inviscid flow.

    Returns
    -------
    LatticeLoads
        Loads of blade 1.
    """
    normal, strips, n_panels = lattice.rings.normal, lattice.strips, lattice.n_panels
    ns = strips.chord.size
    normalwash = (onset.velocity[:, :n_panels] * normal.T).sum(axis=0)
    by_wake = wake.normalwash(normal, lattice.lines)
    solved = blades.downwash.solve(jnp.column_stack([-normalwash, by_wake.T]))
    relative_speed = onset.relative_speed
    # Without the wake, by each unknown: none, and the recambering of each strip.
    alone = jnp.column_stack([solved[:, 0], blades.recambered * relative_speed])
    carried = solved[:, 1:]
    # The last rings carry the circulation of their whole strip, and the wake's.
    last = linear_algebra.solve(jnp.eye(ns) + carried[-ns:], alone[-ns:])
    strip_flow = StripFlow(strips, relative_speed, last[:, 0], last[:, 1:])
    if sections is None:
        recambering, states = jnp.zeros(ns), unheld_states(strip_flow)
    else:
        laws = section_laws(strips, relative_speed, onset.turning_share, air, sections)
        recambering, states = solve_recambering(strip_flow, laws)
    known = jnp.concatenate([jnp.ones(1), recambering])
    of_strips = last @ known
    circulation = (alone @ known - carried @ of_strips).reshape(-1, ns)

    strength = segment_circulation(circulation)
    induced = blades.segments.velocities(strength) + wake.velocities(of_strips, n_panels)
    velocity = (onset.velocity[:, n_panels:] + induced).T
    lift = air.density * strength[:, None] * jnp.cross(velocity, lattice.segment)
    return LatticeLoads(
        circulation,
        jnp.concatenate([lattice.points[n_panels:], strips.quarter_chord]),
        jnp.concatenate([lift, profile_drag(strips, states, air.density)]),
        states,
    )


def profile_drag(strips: Strips, states: SectionStates, density: Scalar) -> Array:
    """Drag of the sections, along the air that meets them.

    Parameters
    ----------
    strips : Strips
        Sections of blade 1.
    states : SectionStates
        Flow and drag coefficients of the sections.
    density : float
        Density of the air [kg/m^3].

    Returns
    -------
    (ns, 3) array
        Forces on the blade [N].
    """
    alpha = states.angle_of_attack[:, None]
    wind = jnp.cos(alpha) * strips.backward + jnp.sin(alpha) * strips.upward
    area = strips.chord * strips.width
    return (0.5 * density * states.relative_speed**2 * area * states.drag_coefficient)[
        :, None
    ] * wind
