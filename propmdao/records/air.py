"""The air that a propeller flies in and that its sound crosses, and its turbulence."""

from __future__ import annotations

import math

from propmdao.records.pytrees import Scalar, record
from propmdao.records.quantities import require_asked

# The International Standard Atmosphere (ISO 2533): the troposphere and Sutherland's law.
_GAS_CONSTANT, _HEAT_RATIO, _GRAVITY = 287.05287, 1.4, 9.80665  # J/(kg K), 1, m/s2
_SEA_LEVEL_TEMPERATURE, _SEA_LEVEL_PRESSURE, _LAPSE_RATE = 288.15, 101325.0, 0.0065  # K, Pa, K/m
_SUTHERLAND_FACTOR, _SUTHERLAND_TEMPERATURE = 1.458e-6, 110.4  # kg/(m s K^0.5), K
_TROPOPAUSE = 11000.0  # m


@record
class Air:
    """State of the air; by default that of the standard atmosphere at sea level, humid.

    Attributes
    ----------
    density : scalar
        Density of the air [kg/m^3].
    sound_speed : scalar
        Speed of sound [m/s].
    dynamic_viscosity : scalar
        Dynamic viscosity of the air [Pa s].
    temperature : scalar
        Temperature of the air that absorbs sound [K]; it does not change the speed of sound, see
        `standard`.
    pressure : scalar
        Pressure of the air that absorbs sound [Pa].
    relative_humidity : scalar
        Share of the vapour pressure over water, 0 ... 1; absorption depends on it.
    """

    density: Scalar = 1.225
    sound_speed: Scalar = 340.294
    dynamic_viscosity: Scalar = 1.789e-5
    temperature: Scalar = 288.15
    pressure: Scalar = 101325.0
    relative_humidity: Scalar = 0.7

    @property
    def kinematic_viscosity(self) -> Scalar:
        """Dynamic viscosity over density [m^2/s]."""
        return self.dynamic_viscosity / self.density

    @classmethod
    def standard(
        cls,
        altitude: float = 0.0,
        temperature_offset: float = 0.0,
        relative_humidity: float = 0.7,
    ) -> Air:
        """Air of the International Standard Atmosphere.

        Parameters
        ----------
        altitude : float
            Geopotential altitude, 0 to 11,000 m [m].
        temperature_offset : float
            Temperature above the standard's, at the standard's pressure [K].
        relative_humidity : float
            Relative humidity, 0 ... 1; the density is that of dry air.

        Returns
        -------
        Air
            Density, speed of sound, viscosity, temperature and pressure that belong together.

        Raises
        ------
        ValueError
            If the altitude is not in the troposphere, or nothing is left of the temperature.

        References
        ----------
        ISO 2533:1975; the dynamic viscosity is by Sutherland's formula in the standard.
        """
        if not 0.0 <= altitude <= _TROPOPAUSE:
            raise ValueError(f"altitude must be within 0 ... {_TROPOPAUSE:g} m; it is {altitude:g}")
        standard = _SEA_LEVEL_TEMPERATURE - _LAPSE_RATE * altitude
        temperature = standard + temperature_offset
        if not 0.0 < temperature < math.inf:
            raise ValueError(f"temperature must be positive; it is {temperature:g} K")
        exponent = _GRAVITY / (_LAPSE_RATE * _GAS_CONSTANT)
        pressure = _SEA_LEVEL_PRESSURE * (standard / _SEA_LEVEL_TEMPERATURE) ** exponent
        viscosity = _SUTHERLAND_FACTOR * temperature**1.5 / (temperature + _SUTHERLAND_TEMPERATURE)
        return cls(
            density=pressure / (_GAS_CONSTANT * temperature),
            sound_speed=math.sqrt(_HEAT_RATIO * _GAS_CONSTANT * temperature),
            dynamic_viscosity=viscosity,
            temperature=temperature,
            pressure=pressure,
            relative_humidity=relative_humidity,
        )


def require_known_air(air: Air) -> None:
    """Refuse air whose absorption ISO 9613-1 does not state; not traceable by JAX.

    Parameters
    ----------
    air : Air
        State of the air.

    Raises
    ------
    ValueError
        If the air is outside -20 to 50 degrees Celsius, 0 to 100 % humidity or 1 to 200 kPa.
    """
    for name, value, low, high, unit in (
        ("temperature", air.temperature - 273.15, -20.0, 50.0, "degrees Celsius"),
        ("relative humidity", 100 * air.relative_humidity, 0.0, 100.0, "%"),
        ("pressure", air.pressure, 1e3, 200e3, "Pa"),
    ):
        if not low - 1e-9 <= float(value) <= high + 1e-9:
            raise ValueError(
                f"absorption: {name} must be within {low:g} ... {high:g} {unit}; it is {value:g}"
            )


@record
class Turbulence:
    """Isotropic turbulence with von Karman's spectrum; by default there is none.

    Attributes
    ----------
    turbulence_intensity : scalar
        Root mean square of each component of the velocity [m/s].
    turbulence_length_scale : scalar
        Longitudinal integral length scale [m].
    """

    turbulence_intensity: Scalar = 0.0
    turbulence_length_scale: Scalar = 0.0


def require_turbulence(turbulence: Turbulence) -> None:
    """Refuse turbulence that there is not; not traceable by JAX.

    Parameters
    ----------
    turbulence : Turbulence
        Intensity and length scale.

    Raises
    ------
    ValueError
        If one of them is out of range, or there is an intensity and no length scale.
    """
    intensity, length = turbulence.turbulence_intensity, turbulence.turbulence_length_scale
    require_asked("turbulence_intensity", intensity)
    require_asked("turbulence_length_scale", length)
    if intensity > 0.0 and not length > 0.0:
        raise ValueError(
            f"turbulence_length_scale must be above 0 m where there is a turbulence_intensity, here"
            f" {float(intensity):g} m/s; it is 0"
        )
