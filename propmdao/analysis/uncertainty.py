"""Band of a result: what is not known for sure of its inputs does to it.

Every input is set to both ends of what it may be, one at a time, and the operating point is solved
anew. The changes of thrust or rotation speed, shaft power and the level at blade passage are
combined as the root of the sum of their squares, those that raise a number apart from those that
lower it: inputs are taken as independent of each other.
"""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from propmdao.aerodynamics.sections.polars.family import SectionPolars, with_drag
from propmdao.aerodynamics.sections.polars.measured_drag import DRAG_SCATTER
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import PolarError
from propmdao.analysis.request import Request
from propmdao.analysis.results import Analysis
from propmdao.analysis.single_point import analyze
from propmdao.records.models import NoiseModel, Transition
from propmdao.records.units import RAD_PER_S, Range

#: Result by its key, thrust and rpm only where they are not asked for; levels by observer.
Values = dict[str, float | list[float]]

RULE = (
    "root of the sum of squares of the changes, those that raise a number apart from those that"
    " lower it; one input at a time"
)
_SIZES = {
    "twist_deg": Range(0.0, 30.0, "deg"),
    "chord": Range(0.0, 0.9),
    "drag": Range(0.0, 0.9),
}


@dataclasses.dataclass(frozen=True)
class Uncertainties:
    """How far inputs of an analysis may be off, to either side.

    The defaults are of model propellers whose geometry was measured or published, none of them of
    one blade: photographed blade angles differ from the maker's own tables by 0.7 to 2.1 deg on
    slow flyers and 0.2 to 1.4 deg on thin blades, chords by 2 to 4 % (UIUC Propeller Data Site,
    volumes 1-3, against APC's PE0 files); what measured drag of sections scatters about the polars'
    is `propmdao.aerodynamics.sections.polars.measured_drag.DRAG_SCATTER`. Transition is early on a
    rough blade in its own wake, n_crit 3, and late in still air on a smooth one, 9.

    Attributes
    ----------
    twist_deg : float
        Blade angle all over the span [deg].
    chord : float
        Chord all over the span, as a fraction of it.
    n_crit : (float, float)
        Least and largest critical amplification exponent of the sections' polars.
    drag : float
        Drag of the sections at every angle of attack, as a fraction of it.

    Raises
    ------
    ValueError
        If a size is out of range, or n_crit falls.
    """

    twist_deg: float = 1.0
    chord: float = 0.03
    n_crit: tuple[float, float] = (3.0, 9.0)
    drag: float = DRAG_SCATTER

    def __post_init__(self) -> None:
        """Refuse sizes that mean nothing."""
        for name, allowed in _SIZES.items():
            allowed.require(name, getattr(self, name))
        low, high = self.n_crit
        for n_crit in self.n_crit:
            Transition(n_crit)  # refuses what no boundary layer has
        if not low <= high:
            raise ValueError(f"n_crit must rise from least to largest; it is {low:g} and {high:g}")


@dataclasses.dataclass(frozen=True)
class Effect:
    """What one input does to the results at both ends of what it may be.

    Attributes
    ----------
    name : str
        Name of the input: "blade angle", "chord", "n_crit", "section drag".
    unit : str
        Unit of its ends; empty where there is none.
    ends : (float, float)
        Lower and upper end: offsets [deg], factors, or values of n_crit.
    changes : (dict or None, dict or None)
        Changes of the results at either end; None where there are none.
    left_out : str or None
        Why results are missing at one end or both, None where they are complete.
    """

    name: str
    unit: str
    ends: tuple[float, float]
    changes: tuple[Values | None, Values | None]
    left_out: str | None = None


@dataclasses.dataclass(frozen=True)
class Band:
    """How far the results of an analysis may be off.

    Attributes
    ----------
    values : dict
        Results of the analysis itself: thrust [N] at a given rotation speed or rpm at a given
        thrust, shaft_power [W], spl_bpf_db of every observer [dB].
    effects : tuple of Effect
        What each input does.
    below, above : dict
        How far each result may be lower (0 or less) and higher (0 or more), by `RULE`; of the
        effects that are complete and those ends that could be solved.
    """

    values: Values
    effects: tuple[Effect, ...]
    below: Values
    above: Values

    @property
    def left_out(self) -> list[str]:
        """What the band is too narrow for, a line for each."""
        return [f"{e.name}: {e.left_out}" for e in self.effects if e.left_out is not None]

    def to_dict(self) -> dict[str, Any]:
        """Band as plain numbers, ``band`` of ``propmdao analyze --band --json``.

        Returns
        -------
        dict
            below, above, each with the keys of `values`; rule; effects, a list of name, unit, ends,
            changes (two, null where there are none), left_out.
        """
        return {
            "below": self.below,
            "above": self.above,
            "rule": RULE,
            "effects": [
                dataclasses.asdict(effect)
                | {"ends": list(effect.ends), "changes": list(effect.changes)}
                for effect in self.effects
            ],
        }


_Trial = Callable[[], Analysis]


def band(
    analysis: Analysis,
    uncertainties: Uncertainties = Uncertainties(),
    polars: SectionPolars | None = None,
) -> Band:
    """Find how far the results of an analysis may be off.

    Nothing is compiled that the analysis has not compiled; eight solutions at most.

    Parameters
    ----------
    analysis : Analysis
        Result of `propmdao.analyze`.
    uncertainties : Uncertainties
        How far its inputs are known.
    polars : SectionPolars, optional
        Polars that the analysis was given; None where it took the catalogue's.

    Returns
    -------
    Band
        Effects of blade angle, chord, n_crit and section drag, and the band of all.

    Raises
    ------
    ValueError
        If the analysis has not converged, or was given polars and they are not given here.
    """
    if not analysis.loads.converged:
        raise ValueError(
            f"no band at {analysis.rpm:.1f} rpm: the analysis itself has not converged"
        )
    if polars is None and "given" in analysis.polars.values():
        raise ValueError("the analysis was given polars of its own: give them to band, too")
    values = results(analysis)
    effects = tuple(
        _effect(values, name, unit, ends, trials)
        for name, unit, ends, trials in _inputs(analysis, uncertainties, polars)
    )
    below, above = (_combined(values, effects, sign) for sign in (-1.0, 1.0))
    return Band(values, effects, below, above)


def results(analysis: Analysis) -> Values:
    """Results of an analysis that a band is of.

    Parameters
    ----------
    analysis : Analysis
        The analysis.

    Returns
    -------
    dict
        Numbers with the keys of `Band.values`.
    """
    loads = analysis.loads
    values: Values = (
        {"thrust": float(loads.thrust)} if analysis.point.thrust is None else {"rpm": analysis.rpm}
    )
    values["shaft_power"] = float(loads.torque) * analysis.rpm * RAD_PER_S
    values["spl_bpf_db"] = analysis.spl_bpf_db().tolist()
    return values


def _inputs(
    analysis: Analysis, size: Uncertainties, own: SectionPolars | None
) -> Iterator[tuple[str, str, tuple[float, float], tuple[_Trial, _Trial] | str]]:
    """Name, unit and ends of every input, and its two analyses or why there are none."""
    request, propeller = analysis.request, analysis.propeller
    # Broadband noise is no part of the band, and takes longer than the loads.
    model = dataclasses.replace(request.model, noise=NoiseModel())
    request = dataclasses.replace(request, model=model)
    change, loads = request.change, model.loads
    polars = own
    if loads.viscous and own is None:
        with _silent():  # the analysis has said it
            polars = polars_for(propeller, transition=loads.transition)

    def trial(request: Request, polars: SectionPolars | None = polars) -> Analysis:
        records = {f.name: getattr(request, f.name) for f in dataclasses.fields(request)}
        return analyze(propeller, polars=polars, **records)

    def turned(offset_deg: float) -> Analysis:
        twist = change.twist_offset_deg + offset_deg
        changed = dataclasses.replace(change, twist_offset_deg=twist)
        return trial(dataclasses.replace(request, change=changed))

    def widened(factor: float) -> Analysis:
        changed = dataclasses.replace(change, chord_factor=factor * change.chord_factor)
        return trial(dataclasses.replace(request, change=changed))

    def with_transition(n_crit: float) -> Analysis:
        transition = dataclasses.replace(loads.transition, n_crit=n_crit)
        return trial(request, polars_for(propeller, transition=transition))

    def dragged(factor: float) -> Analysis:
        assert polars is not None
        return trial(request, with_drag(polars, factor))

    def both(
        analysed: Callable[[float], Analysis], ends: tuple[float, float]
    ) -> tuple[_Trial, _Trial]:
        return (lambda: analysed(ends[0])), (lambda: analysed(ends[1]))

    ends = (-size.twist_deg, size.twist_deg)
    yield "blade angle", "deg", ends, both(turned, ends)
    ends = (1.0 - size.chord, 1.0 + size.chord)
    yield "chord", "", ends, both(widened, ends)
    inviscid = "inviscid flow has no polars"
    no_n_crit = "the polars given are at the transition they were made at"
    why = inviscid if not loads.viscous else no_n_crit if own is not None else None
    yield "n_crit", "", size.n_crit, why or both(with_transition, size.n_crit)
    ends = (1.0 - size.drag, 1.0 + size.drag)
    drag = both(dragged, ends) if loads.viscous else inviscid
    yield "section drag", "", ends, drag


def _effect(
    values: Values,
    name: str,
    unit: str,
    ends: tuple[float, float],
    trials: tuple[_Trial, _Trial] | str,
) -> Effect:
    """Analyse at both ends; what fails is said."""
    if isinstance(trials, str):
        return Effect(name, unit, ends, (None, None), trials)
    changes: list[Values | None] = []
    failures = []
    for end, trial in zip(ends, trials, strict=True):
        try:
            with _silent():
                changed = trial()
            if not changed.loads.converged:
                raise ValueError("it has not converged")
            changes.append(_difference(results(changed), values))
        except PolarError as error:
            return Effect(name, unit, ends, (None, None), str(error))
        except ValueError as error:
            failures.append(f"no solution at {end:g}, {error}")
            changes.append(None)
    return Effect(name, unit, ends, (changes[0], changes[1]), "; ".join(failures) or None)


def _silent() -> warnings.catch_warnings[None]:
    """Keep warnings back: those of the analysis itself were given with it."""
    return warnings.catch_warnings(action="ignore")


def _difference(changed: Values, values: Values) -> Values:
    return {key: (np.array(changed[key]) - np.array(values[key])).tolist() for key in values}


def _combined(values: Values, effects: tuple[Effect, ...], sign: float) -> Values:
    """Root of the sum of squares of the changes of one sign, the larger one of each input's two."""
    squares: dict[str, Any] = {key: np.zeros_like(np.array(value)) for key, value in values.items()}
    for effect in effects:
        for key in values:
            sizes = [np.array(change[key]) for change in effect.changes if change is not None]
            if sizes:
                largest = np.max([np.maximum(sign * size, 0.0) for size in sizes], axis=0)
                squares[key] = squares[key] + largest**2
    return {key: (sign * np.sqrt(square)).tolist() for key, square in squares.items()}
