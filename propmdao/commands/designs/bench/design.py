"""Designs of the bench: what its sliders say, the blade that follows, undo."""

from __future__ import annotations

import collections
import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from propmdao.acoustics.kinematics.observers import point as placed
from propmdao.analysis.request import Request
from propmdao.commands.designs.bench.sliders import (
    N_CONTROL,
    other_sliders,
    shape_sliders,
)
from propmdao.geometry.blade import Blade
from propmdao.propeller.description import Propeller
from propmdao.propeller.design_choices import FREE, control_radii
from propmdao.records.listening import Listening, ObserverGroup
from propmdao.records.models import Model

#: What of the operating point may be held, by the name of its slider.
HELD = ("rpm", "thrust")
#: Attributes of a propeller by the distribution of `FREE`, where they are not named alike.
_ATTRIBUTES = {"chord_over_R": "c_over_R", "beta": "beta_deg"}
_MOST_UNDONE = 500


@dataclasses.dataclass(frozen=True)
class Design:
    """What the sliders say.

    Attributes
    ----------
    held : {"rpm", "thrust"}
        What the operating point is at: the other one follows.
    steps : mapping of str to int
        Steps of each slider from its start, by its name.
    """

    held: str
    steps: Mapping[str, int]

    def to_dict(self) -> dict[str, Any]:
        """The design as plain words and numbers."""
        return {"held": self.held, "steps": dict(self.steps)}


class Board:
    """The sliders of a described blade, and what follows from them.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    asked : Request
        Operating point, in axial flight, and model of the described blade, completed.
    microphone : (float, float)
        Distance [m] and elevation [deg] of the microphone.
    operation : (float, float)
        Rotation speed [rpm] and thrust [N] of the described blade at the operating point.

    Attributes
    ----------
    sliders : dict of str to Slider
        Sliders by name, those of a group beside each other.
    start : Design
        The described blade where it was asked for.
    """

    def __init__(
        self, propeller: Propeller, asked: Request, microphone: tuple[float, float],
        operation: tuple[float, float],
    ) -> None:  # fmt: skip
        self.propeller = propeller
        self._asked = asked
        every = shape_sliders(propeller) + other_sliders(
            propeller, asked.point, operation, microphone
        )
        self.sliders = {each.name: each for each in every}
        held = "rpm" if asked.point.thrust is None else "thrust"
        self.start = Design(held, dict.fromkeys(self.sliders, 0))
        radii = control_radii(propeller.r_over_R[0], N_CONTROL)
        # The curves of ``propmdao optimise``, of which OpenMDAO is slow to import.
        curves = CubicSpline(radii, np.eye(N_CONTROL), bc_type="natural")
        self._to_stations = curves(propeller.r_over_R)
        self._blade = Blade.from_propeller(propeller)

    def design(self, plain: Mapping[str, Any]) -> Design:
        """Read what somebody says the sliders say.

        Parameters
        ----------
        plain : mapping
            With the keys of `Design.to_dict`.

        Returns
        -------
        Design
            The design.

        Raises
        ------
        ValueError
            If a slider is missing or unknown, or beyond its ends.
        """
        held, steps = plain.get("held"), plain.get("steps")
        if held not in HELD or held not in self.sliders:
            there = [name for name in HELD if name in self.sliders]
            raise ValueError(f"held must be one of {', '.join(there)}; it is {held!r}")
        if not isinstance(steps, Mapping) or steps.keys() != self.sliders.keys():
            raise ValueError(f"a design has steps of all sliders: {', '.join(self.sliders)}")
        checked = {name: each.require(steps[name]) for name, each in self.sliders.items()}
        return Design(held, checked)

    def value(self, design: Design, name: str) -> float:
        """Value of a slider."""
        return self.sliders[name].value(design.steps[name])

    def holding(self, design: Design, held: str, value: float) -> Design:
        """Hold the thrust or the rotation speed that there is.

        Parameters
        ----------
        design : Design
            The design.
        held : {"rpm", "thrust"}
            What is held from now on.
        value : float
            Value that it has now.

        Returns
        -------
        Design
            The design at the value on the slider that is nearest.
        """
        nearest = self.sliders[held].nearest(value)
        return self.design({"held": held, "steps": {**design.steps, held: nearest}})

    def described(self, design: Design) -> Design:
        """The described blade, at the operating point and the microphone of a design."""
        kept = ("operation", "microphone")
        steps = {
            name: design.steps[name] if each.group in kept else 0
            for name, each in self.sliders.items()
        }
        return Design(design.held, steps)

    def keys(self, design: Design) -> tuple[object, object]:
        """What the loads of a design depend on, and what its sound depends on beside them.

        Parameters
        ----------
        design : Design
            The design.

        Returns
        -------
        loads, place
            Equal where the loads, and the places of the microphone, are the same.
        """
        place = tuple(n for n, each in self.sliders.items() if each.group == "microphone")
        left_out = {*place, *HELD} - {design.held}
        loads = {name: steps for name, steps in design.steps.items() if name not in left_out}
        return (design.held, loads), tuple(design.steps[name] for name in place)

    def blade(self, design: Design) -> Propeller:
        """Blade of a design.

        Parameters
        ----------
        design : Design
            The design.

        Returns
        -------
        Propeller
            The described propeller itself where nothing of it is changed.

        Raises
        ------
        PropellerError
            If the changed blade is none, a chord below zero, say.
        """
        propeller, changed, words = self.propeller, dict[str, Any](), []
        for word, free in FREE.items():
            values = self._changes(design, word)
            if np.all(values == values[0]) and values[0] == (1.0 if word == "chord" else 0.0):
                continue
            attribute = _ATTRIBUTES.get(free.distribution, free.distribution)
            now = self._described(attribute)
            spread = self._to_stations @ values
            changed[attribute] = now * spread if word == "chord" else now + spread
            words.append(f"{word} {' '.join(f'{value:.4g}' for value in values)}")
        for name in ("diameter", "n_blades"):
            if design.steps[name]:
                value = self.value(design, name)
                changed[name] = round(value) if name == "n_blades" else value
                words.append(f"{name} {changed[name]:.6g}")
        if not changed:
            return propeller
        source = f"Bent by hand from {propeller.name}: {', '.join(words)}. {propeller.source}"
        name = f"{propeller.name} bent"
        return dataclasses.replace(propeller, name=name, source=source.strip(), **changed)

    def _changes(self, design: Design, word: str) -> np.ndarray:
        """Changes of a distribution at its control points."""
        names = [f"{word} {k + 1}" for k in range(N_CONTROL)]
        return np.array([self.value(design, n) if n in self.sliders else 0.0 for n in names])

    def _described(self, attribute: str) -> np.ndarray:
        """The described distribution at the stations, that of the airfoils where it is theirs."""
        value = getattr(self.propeller, attribute)
        return np.asarray(getattr(self._blade, attribute) if value is None else value, float)

    def request(self, design: Design, model: Model) -> Request:
        """What is asked of the analysis of a design.

        Parameters
        ----------
        design : Design
            The design.
        model : Model
            How loads and noise are computed, completed.

        Returns
        -------
        Request
            Operating point, model and microphone.

        Raises
        ------
        ValueError
            If a value is out of range.
        """
        held = self.value(design, design.held)
        point = dataclasses.replace(
            self._asked.point,
            rpm=held if design.held == "rpm" else None,
            thrust=held if design.held == "thrust" else None,
            speed=self.value(design, "speed"),
        )
        distance, elevation = (self.value(design, name) for name in ("distance", "elevation"))
        listening = Listening(
            placed(distance, elevation), self._asked.listening.surroundings,
            (ObserverGroup("microphone", "point", 1),),
        )  # fmt: skip
        return dataclasses.replace(self._asked, point=point, model=model, listening=listening)


class History:
    """Designs one after the other, to undo and redo.

    Parameters
    ----------
    start : Design
        The first design.
    """

    def __init__(self, start: Design) -> None:
        self.now = start
        self._before: collections.deque[Design] = collections.deque(maxlen=_MOST_UNDONE)
        self._after: list[Design] = []

    def add(self, design: Design) -> None:
        """Go on from a new design; what was undone is gone. The same one again is no step."""
        if design != self.now:
            self._before.append(self.now)
            self._after.clear()
            self.now = design

    def undo(self) -> None:
        """Go back by one design, if there is any."""
        if self._before:
            self._after.append(self.now)
            self.now = self._before.pop()

    def redo(self) -> None:
        """Go forward again, if something was undone."""
        if self._after:
            self._before.append(self.now)
            self.now = self._after.pop()

    def to_dict(self) -> dict[str, Any]:
        """The design of now, and whether there is one before and after it."""
        return {
            **self.now.to_dict(),
            "can_undo": bool(self._before),
            "can_redo": bool(self._after),
        }
