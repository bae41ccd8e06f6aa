"""Sliders of the bench: a value that is described, and whole steps away from it."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from propmdao.geometry.blade import Blade
from propmdao.propeller.description import Propeller
from propmdao.propeller.design_choices import FREE, control_radii
from propmdao.records.states import OperatingPoint
from propmdao.records.units import RAD_PER_S

#: Control points of each distribution, as those of ``propmdao optimise``.
N_CONTROL = 5
#: Most steps to either side of a slider that has no steps of its own.
_STEPS = 100
_MOST_BLADES = 8
#: Step of the changes of each distribution, in the unit of `FREE`.
_SHAPE_STEPS = {"chord": 0.01, "twist": 0.1, "camber": 0.0005, "thickness": 0.0005, "sweep": 0.005}


@dataclasses.dataclass(frozen=True)
class Slider:
    """A number that is changed by whole steps, so that none of them is exactly what is described.

    Attributes
    ----------
    name : str
        Name, of which there is one.
    group : str
        Heading below which it stands.
    label : str
        Label beside it.
    unit : str
        Unit; empty where there is none.
    start, step : float
        Value at no steps, and what a step adds.
    below, above : int
        Steps that there are below and above the start.
    """

    name: str
    group: str
    label: str
    unit: str
    start: float
    step: float
    below: int
    above: int

    def value(self, steps: int) -> float:
        """Value after a number of steps."""
        return self.start + steps * self.step

    def require(self, steps: Any) -> int:
        """Refuse what is no number of steps of the slider.

        Parameters
        ----------
        steps : int
            Steps from the start.

        Returns
        -------
        int
            The steps.

        Raises
        ------
        ValueError
            If it is no whole number within the slider's ends.
        """
        if type(steps) is not int or not -self.below <= steps <= self.above:
            raise ValueError(
                f"steps of {self.name} must be a whole number within -{self.below} ..."
                f" {self.above}; they are {steps!r}"
            )
        return steps

    def nearest(self, value: float) -> int:
        """Steps to the value on the slider that is nearest to another one."""
        steps = round((value - self.start) / self.step)
        return min(max(steps, -self.below), self.above)


def slider(
    name: str, group: str, label: str, unit: str, start: float, ends: tuple[float, float],
    step: float | None = None,
) -> Slider:  # fmt: skip
    """Make a slider.

    Parameters
    ----------
    name, group, label, unit, start
        The same as those of `Slider`.
    ends : (float, float)
        Values that it does not go beyond.
    step : float, optional
        What a step adds; by default 1, 2 or 5 times a power of ten, so that there are about a
        hundred steps to the further end.

    Returns
    -------
    Slider
        The slider.
    """
    low, high = ends
    if step is None:
        least = max(start - low, high - start) / _STEPS
        power = 10.0 ** math.floor(math.log10(least))
        step = next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= least * (1 - 1e-9))
    below, above = (math.floor(reach / step + 1e-9) for reach in (start - low, high - start))
    return Slider(name, group, label, unit, start, step, below, above)


def shape_sliders(propeller: Propeller) -> list[Slider]:
    """Sliders of the distributions over span.

    Parameters
    ----------
    propeller : Propeller
        The described blade.

    Returns
    -------
    list of Slider
        One for each control point of each distribution of `FREE`, by the name "chord 1" and so on,
        as changes of the described blade within the ranges of ``propmdao optimise``; there is none
        for the sweep of the root, which would only turn the blade.
    """
    radii = control_radii(propeller.r_over_R[0], N_CONTROL)
    blade = Blade.from_propeller(propeller)
    sliders = []
    for word, free in FREE.items():
        described = np.asarray(getattr(blade, free.distribution))
        here = np.interp(radii, propeller.r_over_R, described)
        lower, upper = free.ends(free.default, here)
        start = 1.0 if word == "chord" else 0.0
        for k, r in enumerate(radii):
            if word == "sweep" and k == 0:
                continue
            ends = float(lower[k]), float(upper[k])
            name, label = f"{word} {k + 1}", f"r/R {r:.2f}"
            sliders.append(slider(name, word, label, free.unit, start, ends, _SHAPE_STEPS[word]))
    return sliders


def other_sliders(
    propeller: Propeller,
    point: OperatingPoint,
    operation: tuple[float, float],
    microphone: tuple[float, float],
) -> list[Slider]:
    """Sliders of rotor, operating point and microphone.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    point : OperatingPoint
        Operating point that was asked for.
    operation : (float, float)
        Rotation speed [rpm] and thrust [N] of the described blade there.
    microphone : (float, float)
        Distance from the rotor's centre [m] and elevation from the rotor plane [deg].

    Returns
    -------
    list of Slider
        Diameter, number of blades, rotation speed, thrust where there is any, flight speed,
        elevation and distance of the microphone.
    """
    (rpm, thrust), (distance, elevation_deg) = operation, microphone
    d, n, speed = propeller.diameter, int(propeller.n_blades), float(point.speed)
    tip_speed = 0.5 * d * rpm * RAD_PER_S
    most_speed = max(2.0 * speed, 0.5 * tip_speed)
    sliders = [
        slider("diameter", "rotor", "diameter", "m", d, (0.7 * d, 1.4 * d)),
        slider("n_blades", "rotor", "blades", "", float(n), (1.0, max(_MOST_BLADES, n)), 1.0),
        slider("rpm", "operation", "rotation speed", "rpm", rpm, (0.4 * rpm, 1.8 * rpm)),
    ]
    if thrust > 0.0:
        ends = 0.3 * thrust, 2.5 * thrust
        sliders.append(slider("thrust", "operation", "thrust", "N", thrust, ends))
    nearest = 1.05 * 0.5 * d
    return [
        *sliders,
        slider("speed", "operation", "flight speed, 0 is hover", "m/s", speed, (0.0, most_speed)),
        slider("elevation", "microphone", "elevation, below the rotor is negative", "deg",
               elevation_deg, (-90.0, 90.0), 1.0),
        slider("distance", "microphone", "distance", "m", distance, (nearest, 4.0 * distance)),
    ]  # fmt: skip
