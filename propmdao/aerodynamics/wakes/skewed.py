"""Prescribed wake of a rotor whose shaft stands at an angle to the flight.

Seen from the turning blade, the wake is the helix of axial flight, carried sideways: a node of age
a has drifted for the time t = a / Omega with the part of the stream that lies in the plane of the
rotor, whose direction turns backward as the blade turns on,

    x(psi, a) = helix(a) - V sin(i) t (cos psi, -sin psi, 0).

The helix has the law of `wakes.helical` with V cos(i) along the shaft; it contracts as the
resultant of flight and induced velocity grows, so less the faster the rotor flies edgewise. Without
incidence nothing drifts sideways, and the wake is the helix.
Limits: the wake is rigid. It does not roll up into the two trailing vortices of a rotor in edgewise
flight, and its law of transport is that of axial flight.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.states import RotorState


def sideways_drift(ages: Array, azimuths: Array, state: RotorState) -> Array:
    """Drift of the wake in the plane of the rotor, seen from blade 1.

    Parameters
    ----------
    ages : (n_nodes,) array
        Azimuths of the wake nodes behind the blade [rad].
    azimuths : (n_azimuths,) array
        Azimuths of blade 1 [rad].
    state : RotorState
        Rotation speed, flight speed and incidence of the rotor.

    Returns
    -------
    (n_azimuths, n_nodes, 3) array
        Displacement of the nodes from the helix, in the frame of the blade [m].
    """
    distance = state.edgewise_speed * ages / state.rotation_speed
    backward = jnp.stack([-jnp.cos(azimuths), jnp.sin(azimuths), jnp.zeros_like(azimuths)], axis=-1)
    return distance[None, :, None] * backward[:, None, :]
