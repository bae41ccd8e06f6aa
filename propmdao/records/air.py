"""The air that a propeller flies in and that its sound crosses."""

from __future__ import annotations

from propmdao.records.pytrees import Scalar, record


@record
class Air:
    """State of the air between the rotor and the observer; the international standard's, humid.

    Attributes
    ----------
    temperature : scalar
        [K].
    relative_humidity : scalar
        0 ... 1, of the vapour pressure over water.
    pressure : scalar
        [Pa].
    """

    temperature: Scalar = 288.15
    relative_humidity: Scalar = 0.7
    pressure: Scalar = 101325.0


def require_known_air(air: Air) -> None:
    """Refuse air of which the standard does not say how it absorbs; not traceable by JAX.

    Parameters
    ----------
    air : Air
        Its state.

    Raises
    ------
    ValueError
        If it is outside -20 to 50 degrees Celsius, 0 to 100 % and 1 to 200 kPa.
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
