"""A slender blade that turns: its potential as a beam that twists, bends and stretches.

The section at the radius r moves by u outward and by d = (v, w) with the elastic axis c(r), turns
by phi about the radial line, nose up, and tilts by psi out of its plane. With J the quarter turn
in the plane, a primed symbol a derivative along the radius, and a fibre at a = (y, z) from the
elastic axis, turned to A,

    d' = psi + phi J c'                                 sections stay normal to the elastic axis
    (u - A . psi, d + A - a)                            displacement of the fibre
    eps (1 + |c' + a'|^2) = u' - (A . psi)' + (|c' + d' + A'|^2 - |c' + a'|^2) / 2      its strain
    kappa (1 + |c'|^2) = phi' - psi' . J c'             twist per length of the elastic axis

where a' and A' follow the pretwist. For a straight axis and to second order this is the strain of
Houbolt and Brooks (NACA Report 1346, 1958): pretwist couples torsion with tension and bending. The
potential without that of the air loads is

    Pi = 1/2 int (int E eps^2 dA + G J_t kappa^2) dr - 1/2 Omega^2 int int rho (x^2 + y^2) dA dr.

The centrifugal force is in it through the distance of each fibre from the axis of rotation.
Tension that stiffens, the propeller moment that turns a blade flat, the trapeze effect and the
moments of sweep and rake all follow; none is modelled by itself.

Ritz's method: the mean of eps over the section, psi and phi are `shapes` or their derivatives; u
and d follow by integration.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar, record
from propmdao.structures.shapes import N_RADII, Shapes, gauss, shapes

_NODES, _WEIGHTS = gauss(N_RADII)
_BASIS = shapes(_NODES)


@record
class Material:
    """An elastic material, the same in all directions.

    Attributes
    ----------
    youngs_modulus, shear_modulus : scalar
        Stiffness in tension and in shear [Pa].
    density : scalar
        Mass per volume [kg/m^3].
    """

    youngs_modulus: Scalar
    shear_modulus: Scalar
    density: Scalar


@record
class Beam:
    """A blade as fibres, at the `N_RADII` radii of Gauss between its root and its tip.

    Attributes
    ----------
    root, length : scalars
        Radius at which it is clamped, and span from there to the tip [m].
    axis, axis_slope : (N_RADII, 2) arrays
        Elastic axis in the plane of each section, (y, z) [m], and its derivative along the radius.
    twist_rate : (N_RADII,) array
        Derivative of the blade angle along the radius [rad/m].
    fibres : (N_RADII, n_fibres, 2) array
        Fibres from the elastic axis, (y, z) [m].
    areas : (N_RADII, n_fibres) array
        Areas of the fibres in the plane of the section [m^2].
    torsion_constant : (N_RADII,) array
        Saint-Venant's J_t: torque over shear modulus and twist per length [m^4].
    material : Material
        Material of the blade.
    """

    root: Array
    length: Array
    axis: Array
    axis_slope: Array
    twist_rate: Array
    fibres: Array
    areas: Array
    torsion_constant: Array
    material: Material


@record
class SectionForces:
    """Forces on the sections of a blade, which keep their directions.

    Attributes
    ----------
    arm : (m, 2) array
        Points of attack from the elastic axis of the undeformed section, (y, z) [m].
    force : (m, 2) array
        Forces in the plane of the section, (y, z) [N].
    moment : (m,) array
        Moments about the point of attack, nose up [N m].
    """

    arm: Array
    force: Array
    moment: Array


def quarter_turn(a: Array) -> Array:
    """Turn vectors (y, z) by a right angle about the radial line, nose up: (..., 2)."""
    return jnp.stack([-a[..., 1], a[..., 0]], axis=-1)


def turned(a: Array, angle: Array) -> Array:
    """Turn vectors (y, z) by angles about the radial line, nose up: (..., 2)."""
    return jnp.cos(angle)[..., None] * a + jnp.sin(angle)[..., None] * quarter_turn(a)


def motion(beam: Beam, basis: Shapes, q: Array) -> tuple[Array, Array]:
    """Compute the displacement and the turn of sections.

    Parameters
    ----------
    beam : Beam
        The blade.
    basis : Shapes
        Polynomials at the n sections.
    q : (4, N_SHAPES) array
        Amplitudes of the stretch [m], psi_y, psi_z and phi [rad].

    Returns
    -------
    d : (n, 2) array
        Displacement of the elastic axis in the section's plane, (y, z) [m].
    phi : (n,) array
        Turn of the section, nose up [rad].
    """
    psi, phi = _BASIS.value @ q[1:3].T, jnp.asarray(_BASIS.value) @ q[3]
    slope = psi + phi[:, None] * quarter_turn(beam.axis_slope)
    return beam.length * (basis.integral @ slope), jnp.asarray(basis.value) @ q[3]


class Deformed(NamedTuple):
    """A blade at the radii of Gauss, deformed.

    Attributes
    ----------
    strain : (N_RADII, n_fibres) array
        Strain of the fibres.
    twist : (N_RADII,) array
        Twist per length of the elastic axis [rad/m].
    displacement : (N_RADII, n_fibres, 3) array
        Displacement of the fibres, (x, y, z) [m].
    """

    strain: Array
    twist: Array
    displacement: Array


def deformed(beam: Beam, q: Array) -> Deformed:
    """Deform a blade.

    Parameters
    ----------
    beam : Beam
        The blade.
    q : (4, N_SHAPES) array
        Amplitudes of the stretch [m], psi_y, psi_z and phi [rad].

    Returns
    -------
    Deformed
        Strains and displacements of its fibres.
    """
    slope, a = beam.axis_slope, beam.fibres
    mean_strain, dphi = _BASIS.slope @ q[0] / beam.length, _BASIS.slope @ q[3] / beam.length
    phi = jnp.asarray(_BASIS.value) @ q[3]
    psi, dpsi = _BASIS.value @ q[1:3].T, _BASIS.slope @ q[1:3].T / beam.length
    dd = psi + phi[:, None] * quarter_turn(slope)
    d = beam.length * (_BASIS.integral @ dd)

    fibre = turned(a, phi[:, None])
    pretwist = beam.twist_rate[:, None, None]
    before = slope[:, None] + pretwist * quarter_turn(a)
    d_fibre = (pretwist + dphi[:, None, None]) * quarter_turn(fibre)
    along = (slope + dd)[:, None] + d_fibre
    d_tilt = (d_fibre * psi[:, None]).sum(-1) + (fibre * dpsi[:, None]).sum(-1)
    own = (before**2).sum(-1)
    # The mean over the section of all that stretches it but u is taken out by u: the polynomials
    # are not rich enough to make up for products of slopes, and the blade would lock.
    stretch, share = 0.5 * ((along**2).sum(-1) - own) - d_tilt, beam.areas / (1.0 + own)
    mean = (share * stretch).sum(-1) / share.sum(-1)
    strain = (jnp.asarray(mean_strain)[:, None] + stretch - mean[:, None]) / (1.0 + own)
    twist = (jnp.asarray(dphi) - (dpsi * quarter_turn(slope)).sum(-1)) / (1.0 + (slope**2).sum(-1))
    u = _BASIS.value @ q[0] - beam.length * (_BASIS.integral @ mean)
    outward = u[:, None] - (fibre * psi[:, None]).sum(-1)
    moved = d[:, None] + fibre - a
    return Deformed(strain, twist, jnp.concatenate([outward[..., None], moved], axis=-1))


def potential(beam: Beam, rotation_speed: Scalar, q: Array) -> Array:
    """Compute the potential of a blade that turns, without that of the loads.

    Parameters
    ----------
    beam : Beam
        The blade.
    rotation_speed : scalar
        Rotation speed [rad/s].
    q : (4, N_SHAPES) array
        Amplitudes of the stretch [m], psi_y, psi_z and phi [rad].

    Returns
    -------
    scalar
        Energy of the strain less the work of the centrifugal force, 0 undeformed [J].
    """
    material = beam.material
    strain, twist, displacement = deformed(beam, q)
    stretched = 0.5 * material.youngs_modulus * (beam.areas * strain**2).sum(-1)
    twisted = 0.5 * material.shear_modulus * beam.torsion_constant * twist**2
    x = beam.root + beam.length * jnp.asarray(_NODES)[:, None]
    y = beam.axis[:, None, 0] + beam.fibres[..., 0]
    dx, dy = displacement[..., 0], displacement[..., 1]
    outward = (beam.areas * (dx * (2.0 * x + dx) + dy * (2.0 * y + dy))).sum(-1)
    centrifugal = 0.5 * material.density * rotation_speed**2 * outward
    return beam.length * (jnp.asarray(_WEIGHTS) @ (stretched + twisted - centrifugal))


def work(beam: Beam, basis: Shapes, loads: SectionForces, q: Array) -> Array:
    """Compute the work that loads of fixed directions have done at a deflection.

    Parameters
    ----------
    beam : Beam
        The blade.
    basis : Shapes
        Polynomials at the m sections that are loaded.
    loads : SectionForces
        Loads of these sections.
    q : (4, N_SHAPES) array
        Amplitudes of the stretch [m], psi_y, psi_z and phi [rad].

    Returns
    -------
    scalar
        Work [J].
    """
    d, phi = motion(beam, basis, q)
    moved = d + turned(loads.arm, phi) - loads.arm
    return (loads.force * moved).sum() + loads.moment @ phi
