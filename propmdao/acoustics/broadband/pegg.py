"""Broadband noise of a whole rotor by Pegg's method: a spectrum fitted to helicopters."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.levels.decibels import REFERENCE_PRESSURE
from propmdao.records.pytrees import Scalar, record

#: Level of a third octave over that of the whole formula, at octaves from five below the peak's
#: frequency to seven above it [dB].
SHAPE_DB = (
    -29.0, -24.5, -19.5, -15.3, -11.7, -7.5, -11.5, -12.1, -16.5, -17.0, -21.8, -26.4, -30.0,
)  # fmt: skip
_OCTAVES = range(-5, 8)
_STALL = 0.48  # mean lift coefficient above which the level rises eight times as fast


@record
class LoadedRotor:
    """A rotor as Pegg's method sees it.

    Attributes
    ----------
    thrust : scalar
        Thrust of all blades, positive [N].
    tip_speed : scalar
        Speed of the tip by rotation [m/s].
    blade_area : scalar
        Planform of all blades [m^2].
    """

    thrust: Scalar
    tip_speed: Scalar
    blade_area: Scalar

    def mean_lift_coefficient(self, density: Scalar) -> Scalar:
        """Mean lift coefficient of the blades, 6 T / (rho A_b V_t^2), in air of a density."""
        return 6.0 * self.thrust / (density * self.blade_area * self.tip_speed**2)

    @property
    def peak_frequency_hz(self) -> Array:
        """Frequency of the loudest octave, 942 + 2.448 V_t - 240 log10 T, in SI units [Hz]."""
        return 942.0 + 2.448 * self.tip_speed - 240.0 * jnp.log10(self.thrust)


def pegg_noise(
    frequency_hz: ArrayLike,
    rotor: LoadedRotor,
    lift_coefficient: Scalar,
    sight: ArrayLike,
    axis: ArrayLike,
    sound_speed: Scalar,
) -> Array:
    """Third-octave mean squares of a rotor's broadband noise.

    Parameters
    ----------
    frequency_hz : (n_bands,) array
        Mid-band frequencies [Hz].
    rotor : LoadedRotor
        Thrust, tip speed and area of the blades.
    lift_coefficient : scalar
        Mean lift coefficient of the blades, `LoadedRotor.mean_lift_coefficient`, positive.
    sight : (..., 3) array
        Vectors from the hub to the observers [m].
    axis : (3,) array
        Direction of the shaft, of either sign.
    sound_speed : scalar
        Speed of sound [m/s].

    Returns
    -------
    (..., n_bands) array
        Mean-square pressure [Pa^2]; nothing below five octaves under the peak and above seven.

    Notes
    -----
    The level of a band is 60 log10 M_t + 10 log10[A_b (cos^2 theta + 0.1) / r^2] + f(C_L) + 130 dB
    and the shape at its frequency over that of the peak, between the octaves linear in frequency,
    as PSU-WOPWOP spreads it. The fit is of helicopters: thrusts of kilonewtons, tips at Mach 0.5
    to 0.65, with the noise of turbulence that flows in among it. For small propellers it is an
    extrapolation by orders of magnitude.

    References
    ----------
    R. J. Pegg, A summary and evaluation of semi-empirical methods for the prediction of helicopter
    rotor noise, NASA TM-80200 (1979).
    """
    peak = rotor.peak_frequency_hz
    sight, axis = jnp.asarray(sight, float), jnp.asarray(axis, float)
    square = jnp.sum(sight * sight, axis=-1)
    cos2 = jnp.square(sight @ axis) / (square * jnp.sum(axis * axis))
    lift = jnp.asarray(lift_coefficient)
    of_lift = jnp.where(
        lift <= _STALL, 10.0 * jnp.log10(lift / 0.4), 0.8 + 80.0 * jnp.log10(lift / _STALL)
    )
    level = 60.0 * jnp.log10(rotor.tip_speed / sound_speed) + of_lift + 130.0
    strength = REFERENCE_PRESSURE**2 * 10.0 ** (level / 10.0) * rotor.blade_area
    ratio = jnp.asarray(frequency_hz) / peak
    octaves = 2.0 ** np.array(_OCTAVES)
    inside = (ratio >= octaves[0]) & (ratio <= octaves[-1])
    shape = jnp.where(inside, 10.0 ** (jnp.interp(ratio, octaves, np.array(SHAPE_DB)) / 10.0), 0.0)
    return (strength * (cos2 + 0.1) / square)[..., None] * shape
