"""Circulation and forces of the lattice over a period, for a wake that is already known.

At every azimuth: Neumann condition at the collocation points, with the wake that the blades have
shed until then; unsteady Kutta condition, for the first ring behind the trailing edge has the
circulation of a moment ago; Kutta-Joukowski force on every bound and chordwise segment with the
total local velocity, and the force of Bernoulli's unsteady term on every ring (Katz and Plotkin
2001, section 13.12),

    dF = rho dGamma/dt S,

with the vector area S toward the suction side and Gamma, the jump of the potential, differentiated
by its Fourier series over the azimuths; profile drag of the sections along the air that meets them.
"""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import segment_circulation
from propmdao.aerodynamics.sections.laws import SectionLaws, ViscousSections, section_laws
from propmdao.aerodynamics.sections.period_recambering import (
    PeriodFlow,
    attached_share,
    period_states,
    solve_period_recambering,
)
from propmdao.aerodynamics.sections.recambering import SectionStates
from propmdao.aerodynamics.solutions.lattice_loads import LatticeGeometry, profile_drag
from propmdao.aerodynamics.solutions.period.lattice import (
    PeriodLattice,
    PeriodWake,
    at_the_blades,
    bound_inverse,
    wake_normalwash,
    wake_velocities,
)
from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar, record
from propmdao.records.states import RotorState

_LEAST_SPEED = 1.0e-3  # of the sections' mean speed, below which no speed of theirs is


@record
class PeriodOnset:
    """Air that meets blade 1 over the azimuths before its vortices act.

    Attributes
    ----------
    velocity : (n_azimuths, 3, n_points) array
        Velocity of the undisturbed air relative to the lattice's points, in the frame of the
        blade [m/s].
    relative_speed : (n_azimuths, ns) array
        Speed of the air at the sections in the plane of their profile, induced velocity of the disk
        included [m/s].
    attached : (n_azimuths, ns) array
        Share of the lattice in the angle of attack, see `attached_share`.
    motion_angle : (n_azimuths, ns) array
        Angle at which this air meets the chord [rad].
    turning_share : (ns,) array
        Rotational speed of the tip over its resultant with the axial speed.
    """

    velocity: Array
    relative_speed: Array
    attached: Array
    motion_angle: Array
    turning_share: Array

    @property
    def mean_speed(self) -> Array:
        """Mean speed of the air at the sections over the turn, (ns,) [m/s]."""
        return self.relative_speed.mean(axis=0)


@record
class PeriodBladeLoads:
    """Loads of blade 1 over the azimuths.

    Attributes
    ----------
    circulation : (n_azimuths, nc, ns) array
        Circulation of the rings [m^2/s].
    position : (n, 3) array
        Points at which the forces act: bound segments (nc * ns), chordwise ones (nc * (ns + 1)),
        middles of the rings (nc * ns), quarter points of the sections (ns) [m].
    force : (n_azimuths, n, 3) array
        Force on the blade, in its frame: Kutta-Joukowski on the segments, Bernoulli's unsteady term
        on the rings, profile drag on the sections [N].
    sections : SectionStates
        Flow, lift and drag of the sections, (n_azimuths, ns) each.
    recambering : (n_azimuths, ns) array
        Recambering of the sections, 0 in inviscid flow [rad].
    """

    circulation: Array
    position: Array
    force: Array
    sections: SectionStates
    recambering: Array

    @property
    def hub_force(self) -> Array:
        """Force of the blade on the hub in the frame of the blade, (n_azimuths, 3) [N]."""
        return self.force.sum(axis=1)

    @property
    def hub_moment(self) -> Array:
        """Moment of the blade about the rotor's centre in its own frame, (n_azimuths, 3) [N m]."""
        return jnp.cross(self.position, self.force).sum(axis=1)


def azimuths_of(n_azimuths: int) -> np.ndarray:
    """Azimuths of a period, (n_azimuths,) [rad]."""
    return 2.0 * np.pi / n_azimuths * np.arange(n_azimuths)


def tilted_onset(
    lattice: LatticeGeometry, state: RotorState, induced_velocity: Scalar, azimuths: Array
) -> PeriodOnset:
    """Air that meets blade 1 of a rotor in flight at an incidence.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    state : RotorState
        Rotation speed, flight speed, incidence and air of the rotor.
    induced_velocity : float
        Induced velocity at the disk [m/s].
    azimuths : (n_azimuths,) array
        Azimuths of the blade [rad].

    Returns
    -------
    PeriodOnset
        Velocities of the air in the turning frame of the blade.
    """
    omega, edgewise, strips = state.rotation_speed, state.edgewise_speed, lattice.strips
    psi = azimuths[:, None]
    stream = -edgewise * jnp.cos(psi), edgewise * jnp.sin(psi)  # along x and y of the blade

    def air_at(x: Array, y: Array, axial: Scalar) -> Array:
        return jnp.stack(
            jnp.broadcast_arrays(omega * y + stream[0], -omega * x + stream[1], axial), axis=1
        )

    x, y = lattice.points[:, 0], lattice.points[:, 1]
    through = state.axial_speed + induced_velocity
    x_quarter, y_quarter = strips.quarter_chord[:, 0], strips.quarter_chord[:, 1]
    met = air_at(x_quarter, y_quarter, -through)
    # Against the rotation: what the blade meets from ahead.
    tangential = (met[:, 0] * y_quarter - met[:, 1] * x_quarter) / strips.radius
    speed = jnp.hypot(tangential, through)
    mean = jnp.hypot(omega * strips.radius, through)
    least = _LEAST_SPEED * mean
    share = tangential / jnp.maximum(speed, least) * mean / (omega * strips.radius)
    along, normal = (
        jnp.einsum("kcs,sc->ks", met, axis) for axis in (strips.backward, strips.upward)
    )
    tip_speed = omega * strips.radius / strips.r_over_R
    return PeriodOnset(
        velocity=air_at(x, y, -state.axial_speed),
        relative_speed=jnp.maximum(speed, least),
        attached=attached_share(share),
        motion_angle=jnp.arctan2(normal, jnp.where(speed > 0.0, along, 1.0)),
        turning_share=tip_speed / jnp.hypot(tip_speed, through),
    )


def period_loads(
    lattice: PeriodLattice,
    wake: PeriodWake,
    onset: PeriodOnset,
    rotation_speed: Scalar,
    air: Air,
    sections: ViscousSections | None,
    start: Array | None = None,
) -> PeriodBladeLoads:
    """Solve for the circulation over a period in a given wake and take the forces.

    Parameters
    ----------
    lattice : PeriodLattice
        Lattice of blade 1.
    wake : PeriodWake
        Wake of all blades.
    onset : PeriodOnset
        Air that meets the blade before its vortices act.
    rotation_speed : float
        Rotation speed, by which azimuths follow each other [rad/s].
    air : Air
        The undisturbed air.
    sections : ViscousSections or None
        Polars that the lattice is held to; None for inviscid flow.
    start : (n_azimuths, ns) array, optional
        Recambering from which the search for it starts [rad]; by default none.

    Returns
    -------
    PeriodBladeLoads
        Loads of blade 1.
    """
    geometry = lattice.lattice
    strips, normal, points = geometry.strips, geometry.rings.normal, geometry.points
    n_blades, n_panels = lattice.influence.shape[0], normal.shape[0]
    n, ns = onset.relative_speed.shape
    nc = n_panels // ns

    normalwash = jnp.einsum("kcp,pc->kp", onset.velocity[:, :, :n_panels], normal)
    by_rings = jnp.einsum("bcrp,pc->bpr", lattice.influence[..., :n_panels], normal)
    by_wake = wake_normalwash(geometry, wake)
    inverse = bound_inverse(by_rings)

    # The last rings carry the circulation of their whole strip, and the wake that of the strips.
    flow = PeriodFlow(
        strips,
        onset.relative_speed,
        onset.attached,
        onset.motion_angle,
        *_strip_circulation(inverse[:, -ns:], normalwash, by_wake, onset.relative_speed),
    )
    recambering, laws = jnp.zeros((n, ns)), None
    if sections is not None:
        laws = _period_laws(lattice, onset, air, sections)
        recambering = solve_period_recambering(flow, laws, recambering if start is None else start)
    by_lattice, by_motion = period_states(flow, recambering, laws)

    change = (flow.response @ recambering.ravel()).reshape(n, ns)
    strip_circulation = flow.circulation + change
    normalwash += jnp.tile(onset.relative_speed * recambering, (1, nc))
    normalwash += jnp.einsum("kqsp,qs->kp", by_wake, strip_circulation)
    circulation = -jnp.einsum("bpr,bkr->kp", inverse, at_the_blades(normalwash, n_blades))

    on_segments = points[n_panels:]
    velocity = onset.velocity[:, :, n_panels:] + jnp.einsum(
        "bcrp,bkr->kcp", lattice.influence[..., n_panels:], at_the_blades(circulation, n_blades)
    )
    velocity += wake_velocities(on_segments, wake, strip_circulation)

    def strength(rings: Array) -> Array:
        return jnp.concatenate([g.ravel() for g in segment_circulation(rings.reshape(nc, ns))])

    lift = air.density * jax.vmap(strength)(circulation)[..., None]
    lift = lift * jnp.cross(velocity.swapaxes(1, 2), geometry.segment)
    rate = rotation_speed * jnp.asarray(turn_derivative(n)) @ circulation
    unsteady = air.density * rate[..., None] * lattice.ring_area

    def drag(states: SectionStates) -> Array:
        return jax.vmap(lambda at: profile_drag(strips, at, air.density))(states)

    share = onset.attached[..., None]
    profile = share * drag(by_lattice) + (1.0 - share) * drag(by_motion)
    behind = onset.attached < 0.5
    return PeriodBladeLoads(
        circulation.reshape(n, nc, ns),
        jnp.concatenate([on_segments, lattice.ring_middle, strips.quarter_chord]),
        jnp.concatenate([lift, unsteady, profile], axis=1),
        dataclasses.replace(
            by_lattice,
            angle_of_attack=jnp.where(
                behind, by_motion.angle_of_attack, by_lattice.angle_of_attack
            ),
            drag_coefficient=jnp.where(
                behind, by_motion.drag_coefficient, by_lattice.drag_coefficient
            ),
        ),
        recambering,
    )


def _strip_circulation(
    inverse: Array, normalwash: Array, by_wake: Array, relative_speed: Array
) -> tuple[Array, Array]:
    """Circulation of the strips at all azimuths, and its change per recambering.

    Parameters
    ----------
    inverse : (n_blades, ns, n_panels) array
        Rows of `bound_inverse` that belong to the last rings.
    normalwash : (n_azimuths, n_panels) array
        Normalwash by the air that meets the blade.
    by_wake : (n_azimuths, n_azimuths, ns, n_panels) array
        Normalwash by the wake, per circulation of the strips.
    relative_speed : (n_azimuths, ns) array
        Speed of the air relative to the sections.

    Returns
    -------
    circulation, response : (n_azimuths, ns), (n_azimuths * ns, n_azimuths * ns) arrays
        Circulation, and response as in `PeriodFlow`.
    """
    (n, ns), n_blades = relative_speed.shape, inverse.shape[0]
    numbers = jnp.arange(n)

    def summed(of_blade: Array) -> Array:
        """Sum over the blades of what is felt there, at the azimuths of blade 1."""
        step = n // n_blades
        felt = [jnp.roll(of_blade[b], -step * b, axis=0) for b in range(n_blades)]
        return jnp.stack(felt).sum(axis=0)

    by_onset = summed(jnp.einsum("bsp,kp->bks", inverse, normalwash))
    by_strips = summed(jnp.einsum("bsp,kqtp->bksqt", inverse, by_wake))
    # A recambering of 1 is a normalwash W on all panels of its strip.
    all_panels = inverse.reshape(n_blades, ns, -1, ns).sum(axis=2)
    same = jnp.zeros((n_blades, n, ns, n, ns))
    same = same.at[:, numbers, :, numbers].set(all_panels[None] * relative_speed[:, None, None, :])
    size = n * ns
    matrix = jnp.eye(size) + by_strips.reshape(size, size)
    right = jnp.column_stack([by_onset.ravel(), summed(same).reshape(size, size)])
    unit = jnp.linalg.solve(matrix, -right)
    return unit[:, 0].reshape(n, ns), unit[:, 1:]


def _period_laws(
    lattice: PeriodLattice, onset: PeriodOnset, air: Air, sections: ViscousSections
) -> SectionLaws:
    """Polars of the strips at all azimuths, with a leading axis."""
    strips = lattice.lattice.strips
    return jax.vmap(lambda speed: section_laws(strips, speed, onset.turning_share, air, sections))(
        onset.relative_speed
    )


def turn_derivative(n_azimuths: int) -> np.ndarray:
    """Matrix that differentiates a Fourier series by its azimuths.

    The highest harmonic of an even number of them has no derivative there.

    Parameters
    ----------
    n_azimuths : int
        Number of azimuths of a turn.

    Returns
    -------
    (n_azimuths, n_azimuths) array
        The matrix [1/rad].
    """
    order = np.fft.fftfreq(n_azimuths, 1.0 / n_azimuths)
    order[np.abs(order) == n_azimuths / 2] = 0.0
    spectrum = 1j * order[:, None] * np.fft.fft(np.eye(n_azimuths), axis=0)
    matrix: np.ndarray = np.fft.ifft(spectrum, axis=0).real
    return matrix
