"""Solutions: what they hold, and why one may not have converged."""

from __future__ import annotations

import dataclasses
from typing import TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.sections.recambering import SectionStates
from propmdao.records.loads import PeriodicLoads, PointLoads
from propmdao.records.pytrees import record

SETTLED = 1.0e-6  # difference of lift coefficients of lattice and polars that counts as none
# Lift coefficient that a section may have beyond its own polar, by the mean over the span nearby.
# Smooth blades have at most 1.1, stalled or not, and blades of random chord and twist 1.6; where
# these zigzag so much that the equations have other roots, those have 3 to 8 (residuals do not see
# it: they are 1e-14 there, too).
MOST_BORROWED_LIFT = 2.0


@record
class RotorLoads:
    """Loads of the propeller in steady axial flow.

    Attributes
    ----------
    thrust, torque : float
        Thrust and torque of all blades [N], [N m].
    induced_velocity : float
        Induced velocity at the disk, which transports the wake [m/s].
    circulation : (nc, ns) array
        Circulation of the rings of a blade [m^2/s].
    strip_thrust, strip_torque : (ns,) array
        Thrust and torque of each strip of a blade [N], [N m]; divide by the strip's width for
        loads per span.
    point_loads : PointLoads
        Forces of blade 1 on the fluid, for acoustics.
    strips, sections : Strips, SectionStates
        Sections of blade 1, and their flow, lift and drag.
    converged : bool
        Whether thrust and induced velocity agree with momentum theory, and lattice and polars on
        the lift of every section, one that the polar can have; `failure` says what does not.
    """

    thrust: Array
    torque: Array
    induced_velocity: Array
    circulation: Array
    strip_thrust: Array
    strip_torque: Array
    point_loads: PointLoads
    strips: Strips
    sections: SectionStates
    converged: Array

    @property
    def hub_force(self) -> Array:
        """Mean force of all blades on the hub, in the axes of `TiltedLoads`, (3,) [N]."""
        return self.thrust * np.array([0.0, 0.0, 1.0])

    @property
    def hub_moment(self) -> Array:
        """Mean moment of all blades on the hub about the rotor's centre, (3,) [N m]."""
        return self.torque * np.array([0.0, 0.0, -1.0])


@record
class TiltedLoads:
    """Loads of the propeller in flight at an incidence, which repeat every turn.

    Attributes
    ----------
    thrust, torque : float
        Mean thrust and shaft torque of all blades [N], [N m].
    hub_force, hub_moment : (3,) arrays
        Mean force and moment of all blades on the hub, about the rotor's centre, in the axes of the
        rotor that do not turn: +z is the shaft, flight is in the plane of +z and +x [N], [N m].
    blade_force, blade_moment : (n_azimuths, 3) arrays
        The same of blade 1 at its azimuths, from 0.
    strip_thrust, strip_torque : (ns,) array
        Mean thrust and torque of each strip of a blade [N], [N m].
    induced_velocity : float
        Induced velocity at the disk, which transports the wake [m/s].
    circulation : (n_azimuths, nc, ns) array
        Circulation of the rings of blade 1 [m^2/s].
    point_loads : PeriodicLoads
        Forces of blade 1 on the fluid over the azimuths, for acoustics.
    strips : Strips
        Sections of blade 1.
    sections : SectionStates
        Flow, lift and drag of the sections, (n_azimuths, ns) each.
    attached : (n_azimuths, ns) array
        Share of the lattice in the angle of attack: 0 where the air comes from behind.
    converged : bool
        Whether thrust and induced velocity agree with momentum theory, and lattice and polars on
        the lift of every section at every azimuth.
    """

    thrust: Array
    torque: Array
    hub_force: Array
    hub_moment: Array
    blade_force: Array
    blade_moment: Array
    strip_thrust: Array
    strip_torque: Array
    induced_velocity: Array
    circulation: Array
    point_loads: PeriodicLoads
    strips: Strips
    sections: SectionStates
    attached: Array
    converged: Array

    @property
    def unsettled(self) -> str | None:
        """Why the loads are not those of every turn, in one line; here they are, and it is None."""
        return None


_Loads = TypeVar("_Loads", RotorLoads, TiltedLoads)


def sections_agree(sections: SectionStates) -> Array:
    """Whether lattice and polars agree on the lift of every section, one that the polar can have.

    Parameters
    ----------
    sections : SectionStates
        Flow and lift of the sections, (ns,) or (n_azimuths, ns) each.

    Returns
    -------
    bool
        Whether they do.
    """
    settled = jnp.abs(sections.residual).max() < SETTLED
    return settled & (_borrowed(sections).max() < MOST_BORROWED_LIFT)


def _borrowed(sections: SectionStates) -> Array:
    """Lift borrowed, as a coefficient with the section's mean speed over a turn.

    Where a blade retreats, the air hardly moves, and coefficients are large that mean no force.
    """
    speed = jnp.atleast_2d(sections.relative_speed)
    return jnp.abs(jnp.atleast_2d(sections.borrowed_lift)) * speed / speed.mean(axis=0)


def failure(solution: RotorLoads | TiltedLoads) -> str | None:
    """Say why a solution did not converge; call it outside ``jit``.

    Parameters
    ----------
    solution : RotorLoads or TiltedLoads
        The solution.

    Returns
    -------
    str or None
        Reason in one line, or None where the solution converged.
    """
    if solution.converged:
        return None
    residual = np.abs(np.atleast_2d(solution.sections.residual))
    worst = np.nanargmax(residual) if np.isfinite(residual).any() else 0
    if not residual.flat[worst] < SETTLED:
        return (
            f"lift coefficients of lattice and polar differ by {residual.flat[worst]:.2g} at "
            + _place(solution, residual.shape, worst)
        )
    borrowed = np.asarray(_borrowed(solution.sections))
    worst = np.argmax(borrowed)
    if not borrowed.flat[worst] < MOST_BORROWED_LIFT:
        lift = np.atleast_2d(solution.sections.lift_coefficient).flat[worst]
        return (
            f"section lift coefficient {lift:.2f} at {_place(solution, borrowed.shape, worst)} is "
            "beyond its polar: chord or twist changes too much from station to station for one"
            " solution"
        )
    if isinstance(solution, TiltedLoads) and solution.unsettled is not None:
        return solution.unsettled
    return (
        f"thrust {float(solution.thrust):.4g} N and induced velocity "
        f"{float(solution.induced_velocity):.4g} m/s do not agree with momentum theory: "
        "beyond its windmilling limit"
    )


def _place(solution: RotorLoads | TiltedLoads, shape: tuple[int, ...], flat: np.intp | int) -> str:
    """Words for a section, at its azimuth where there are several."""
    azimuth, strip = np.unravel_index(flat, shape)
    words = f"r/R {float(solution.strips.r_over_R[strip]):.2f}"
    if shape[0] > 1:
        words += f", azimuth {360.0 * float(azimuth) / shape[0]:.0f} deg"
    return words


def unless_still(turning: Array, loads: _Loads) -> _Loads:
    """Zero loads where the propeller does not turn.

    Parameters
    ----------
    turning : bool
        Whether the propeller turns.
    loads : RotorLoads or TiltedLoads
        Loads of the propeller that turns.

    Returns
    -------
    RotorLoads or TiltedLoads
        Loads that were passed in or, at rest, zeros, which count as converged.
    """
    still = jax.tree.map(jnp.zeros_like, loads)
    position = loads.point_loads.position
    still = dataclasses.replace(
        still,
        point_loads=dataclasses.replace(still.point_loads, position=position),
        strips=loads.strips,
        converged=jnp.asarray(True),
    )
    return jax.tree.map(lambda moving, still: jnp.where(turning, moving, still), loads, still)
