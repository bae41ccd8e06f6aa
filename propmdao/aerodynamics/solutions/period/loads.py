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

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.sections.recambering import SectionStates
from propmdao.aerodynamics.solutions.period.coupling import (
    blade_forces,
    held_lattice,
    onset_laws,
    velocity_by_air_and_blades,
)
from propmdao.aerodynamics.solutions.period.lattice import (
    PeriodLattice,
    bound_inverse,
)
from propmdao.aerodynamics.solutions.period.onset import PeriodOnset
from propmdao.aerodynamics.solutions.period.wake import (
    PeriodWake,
    wake_normalwash,
    wake_velocities,
)
from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar, record


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
    normal = geometry.rings.normal
    n_panels = normal.shape[0]
    n, ns = onset.relative_speed.shape

    normalwash = jnp.einsum("kcp,pc->kp", onset.velocity[:, :, :n_panels], normal)
    by_wake = wake_normalwash(lattice, wake)
    laws = None
    if sections is not None:
        laws = onset_laws(geometry, onset, air, sections)
    held = held_lattice(lattice, bound_inverse(lattice), onset, normalwash, by_wake, laws, start)
    velocity = velocity_by_air_and_blades(lattice, onset, held.circulation)
    velocity += wake_velocities(lattice, wake, held.strips)
    rate = rotation_speed * jnp.asarray(turn_derivative(n)) @ held.circulation
    by_lattice, by_motion = held.by_lattice, held.by_motion
    behind = onset.attached < 0.5
    return PeriodBladeLoads(
        held.circulation.reshape(n, -1, ns),
        lattice.load_positions,
        blade_forces(lattice, onset, velocity, held, rate, air.density),
        dataclasses.replace(
            by_lattice,
            angle_of_attack=jnp.where(
                behind, by_motion.angle_of_attack, by_lattice.angle_of_attack
            ),
            drag_coefficient=jnp.where(
                behind, by_motion.drag_coefficient, by_lattice.drag_coefficient
            ),
        ),
        held.recambering,
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
