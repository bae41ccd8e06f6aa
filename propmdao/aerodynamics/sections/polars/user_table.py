"""Tables from polars that a user has: sampled on all angles, over Reynolds or Mach number."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np
from scipy.interpolate import PchipInterpolator

from propmdao.aerodynamics.sections.polars.high_angle import (
    ALPHA,
    ATTACHED_DEG,
    FloatArray,
    all_angles,
)
from propmdao.aerodynamics.sections.polars.mach import MACH_LIMIT, prandtl_glauert
from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable

#: Widest step between angles that a polar may have where it holds [deg].
LARGEST_STEP_DEG = 5.0
#: So far from no angle of attack that rule holds: C81 tables are coarse beyond [deg].
CLOSE_DEG = 12.0
#: A polar that reaches this far both ways is taken unchanged at all angles [deg].
FULL_CIRCLE_DEG = 170.0
#: Angles that every polar must reach [deg].
NEEDED_DEG = (-1.0, 4.0)
#: Logarithms of Reynolds numbers of a table that has none: beyond any, so that none is outside.
ANY_REYNOLDS: FloatArray = np.log([1.0, 1e12])
ANY_REYNOLDS.setflags(write=False)
_LARGEST_REYNOLDS = 1e11
#: Largest Mach number of polars over Mach number.
LARGEST_MACH = 3.0
#: Largest drag coefficient, at one Mach number in the tunnel and of tables beyond the sound.
_LARGEST_DRAG, _LARGEST_DRAG_OVER_MACH = 3.0, 30.0
#: Furthest angles at which a polar is continued [deg].
_LIMIT_DEG = 20.0


@dataclasses.dataclass(frozen=True, eq=False)
class Polar:
    """Coefficients of one section at one Reynolds number, or of a set over Mach number.

    Attributes
    ----------
    name : str
        Name of the section.
    re : float or None
        Reynolds number; None in a set of polars over Mach number, which have none.
    mach : float
        Mach number at which the coefficients were found.
    alpha : (n,) array
        Angles of attack, rising [rad].
    cl, cd, cm : (n,) arrays
        Coefficients; cm about the quarter chord, nose up.
    n_crit : float, optional
        Critical amplification exponent of transition, where the file tells it.

    Raises
    ------
    PolarError
        If values are missing, not finite or out of range; if angles come twice, leave gaps of
        more than 5 deg within 12 deg of 0 or do not span -1..4 deg; or if units look wrong.
    """

    name: str
    re: float | None
    mach: float
    alpha: FloatArray
    cl: FloatArray
    cd: FloatArray
    cm: FloatArray
    n_crit: float | None = None

    def __post_init__(self) -> None:
        over_mach = self.re is None
        if self.re is not None and not self.re >= 1e3:
            raise PolarError(f"Reynolds number must be at least 1000; it is {self.re:g} (in 1e6?)")
        if self.re is not None and self.re > _LARGEST_REYNOLDS:
            raise PolarError(
                f"Reynolds number must be at most {_LARGEST_REYNOLDS:g}; it is {self.re:g}"
            )
        largest = LARGEST_MACH if over_mach else MACH_LIMIT
        if not 0.0 <= self.mach <= largest:
            reason = "" if over_mach else ", up to which lift is corrected to other Mach numbers"
            raise PolarError(
                f"Mach number must be within 0..{largest:g}{reason}; it is {self.mach:g}"
            )
        degrees = np.degrees(self.alpha)
        for name in ("alpha", "cl", "cd", "cm"):
            values = getattr(self, name)
            if values.shape != degrees.shape or not np.isfinite(values).all():
                raise PolarError(f"{name} must be {degrees.size} finite numbers, one per angle")
        if np.abs(degrees).max(initial=0.0) > 180.0 + 1e-6:
            raise PolarError(
                f"alpha must be within -180..180 deg; there is "
                f"{degrees[np.abs(degrees).argmax()]:g}"
            )
        if degrees.size < 5:
            raise PolarError(f"a polar needs at least 5 angles; it has {degrees.size}")
        steps = np.diff(degrees)
        if not (steps > 0.0).all():
            raise PolarError(f"alpha {degrees[steps.argmin()]:g} deg is given twice")
        if not (self.cd > 0.0).all():
            raise PolarError(
                f"cd must be positive; it is {self.cd.min():g} at {degrees[self.cd.argmin()]:g} deg"
            )
        largest = _LARGEST_DRAG_OVER_MACH if over_mach else _LARGEST_DRAG
        if self.cd.max() > largest:
            raise PolarError(
                f"cd must be below {largest:g}; it is {self.cd.max():g} at "
                f"{degrees[self.cd.argmax()]:g} deg (in drag counts?)"
            )
        slope = np.abs(np.diff(self.cl) / steps).max()
        if slope > 1.0:
            raise PolarError(f"cl changes by {slope:.3g} per degree: alpha seems to be in radians")
        if degrees[0] > NEEDED_DEG[0] or degrees[-1] < NEEDED_DEG[1]:
            raise PolarError(
                f"alpha must span at least {NEEDED_DEG[0]:g}..{NEEDED_DEG[1]:g} deg; it spans "
                f"{degrees[0]:g}..{degrees[-1]:g}"
            )
        wide = (steps > LARGEST_STEP_DEG + 1e-6) & (np.abs(degrees[:-1] + 0.5 * steps) < CLOSE_DEG)
        if wide.any():
            gap = int(wide.argmax())
            raise PolarError(
                f"alpha has a gap from {degrees[gap]:g} to {degrees[gap + 1]:g} deg; steps must "
                f"not exceed {LARGEST_STEP_DEG:g} deg (the rows beyond it may be left out)"
            )


def table_from_polars(polars: Sequence[Polar]) -> PolarTable:
    """Make the table of one section from its polars.

    Parameters
    ----------
    polars : sequence of Polar
        The same section at different Reynolds numbers, in any order, at least one.

    Returns
    -------
    PolarTable
        Table of one section. A polar that goes round is taken at all angles; any other is continued
        past its last angle, at most 20 deg, by `propmdao.aerodynamics.sections.polars.high_angle`.

    Raises
    ------
    PolarError
        If there is no polar or a Reynolds number comes twice.
    """
    if not polars:
        raise PolarError("a table needs at least one polar")
    numbered = [(polar.re, polar) for polar in polars if polar.re is not None]
    if len(numbered) < len(polars):
        raise PolarError("each polar of a table over Reynolds number needs one")
    numbered.sort(key=lambda pair: pair[0])
    for (lower_re, lower), (upper_re, upper) in zip(numbered, numbered[1:], strict=False):
        if upper_re < 1.01 * lower_re:
            raise PolarError(
                f"Reynolds numbers of '{lower.name}' and '{upper.name}' are equal: {lower_re:g}"
            )
    rows = np.stack([_at_all_angles(polar) for _, polar in numbered], axis=1)
    log_re = np.log([re for re, _ in numbered])
    if log_re.size == 1:
        # A table interpolates between two: the one polar holds at all Reynolds numbers.
        log_re, rows = log_re + [-0.01, 0.01], np.repeat(rows, 2, axis=1)
    return PolarTable(jnp.asarray(ALPHA), jnp.asarray(log_re), jnp.asarray(rows[None]))


def table_over_mach(polars: Sequence[Polar]) -> PolarTable:
    """Make the table of one section from its polars at several Mach numbers.

    Parameters
    ----------
    polars : sequence of Polar
        The same section at rising Mach numbers, without Reynolds numbers, at least one.

    Returns
    -------
    PolarTable
        Table of one section, the same at all Reynolds numbers. With one polar it has no Mach
        numbers: lift and moment follow `propmdao.aerodynamics.sections.polars.mach` from there.

    Raises
    ------
    PolarError
        If there is no polar, or Mach numbers do not rise.
    """
    if not polars:
        raise PolarError("a table needs at least one polar")
    mach = np.array([polar.mach for polar in polars])
    if (np.diff(mach) <= 0.0).any():
        place = int(np.argmax(np.diff(mach) <= 0.0))
        raise PolarError(f"Mach numbers must rise; {mach[place + 1]:g} follows {mach[place]:g}")
    rows = np.stack([_at_all_angles(polar) for polar in polars], axis=1)
    # (3, n_mach, n_re, n_alpha)
    rows = np.repeat(rows[:, :, None], ANY_REYNOLDS.size, axis=2)
    alpha, log_re = jnp.asarray(ALPHA), jnp.asarray(ANY_REYNOLDS)
    if mach.size == 1:
        return PolarTable(alpha, log_re, jnp.asarray(rows[None, :, 0]))
    return PolarTable(alpha, log_re, jnp.asarray(rows[None]), jnp.asarray(mach))


def _at_all_angles(polar: Polar) -> FloatArray:
    """Sample a polar at `ALPHA`: cl and cm over the factor of its Mach number, ln(cd) between."""
    values = _as_found(polar)
    values[[0, 2]] /= np.asarray(prandtl_glauert(polar.mach, jnp.asarray(ALPHA)))
    return values


def _as_found(polar: Polar) -> FloatArray:
    """Sample a polar at `ALPHA`: cl, ln(cd), cm, (3, n_alpha)."""
    degrees = np.degrees(polar.alpha)
    coefficients = np.stack([polar.cl, np.log(polar.cd), polar.cm])
    if degrees[0] <= -FULL_CIRCLE_DEG and degrees[-1] >= FULL_CIRCLE_DEG:
        turn = np.concatenate([degrees - 360.0, degrees, degrees + 360.0])
        angle, first = np.unique(np.round(turn, 6), return_index=True)
        periodic = PchipInterpolator(angle, np.tile(coefficients, 3)[:, first], axis=1)
        around: FloatArray = periodic(np.degrees(ALPHA))
        around[:, [0, -1]] = around[:, [-1, -1]]
        return around
    inside = np.clip(ATTACHED_DEG, degrees[0], degrees[-1])
    cl, log_cd, cm = PchipInterpolator(degrees, coefficients, axis=1)(inside)[:, None]
    holds = np.flatnonzero((inside == ATTACHED_DEG) & (np.abs(ATTACHED_DEG) <= _LIMIT_DEG))
    values: FloatArray = all_angles(cl, np.exp(log_cd), cm, holds[:1], holds[-1:])[0]
    return values
