"""Analyses of the bench: loads and tones first, broadband noise after, of design and described."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Iterator
from typing import Any, NamedTuple

from propmdao.analysis.comparisons import LEVEL_ROWS, Cell, Row, operation_and_levels
from propmdao.analysis.elastic.deflections import Solved
from propmdao.analysis.elastic.modelled_blade import ModelledBlade
from propmdao.analysis.request import Request
from propmdao.analysis.results import Analysis
from propmdao.analysis.single_point import analysis_of, require_analysable
from propmdao.commands.designs.bench.design import Board, Design
from propmdao.figures.contents.doubts import doubts
from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.records.models import Model, NoiseModel

#: The two blades that are compared, as the page names them.
DESCRIBED, BENT = "described", "bent"
_LEVEL = "at "  # before the key of a level at the microphone


class Evaluated(NamedTuple):
    """An analysis, and what is read of it.

    Attributes
    ----------
    analysis : Analysis
        The analysis.
    result : dict
        The same with the keys of ``propmdao analyze --json``.
    doubts : tuple of str
        What keeps its numbers from being used, and what was warned of.
    """

    analysis: Analysis
    result: dict[str, Any]
    doubts: tuple[str, ...]


class Stage(NamedTuple):
    """Both blades as far as they are analysed.

    Attributes
    ----------
    bent : Evaluated
        The design.
    described : Evaluated or None
        The described blade at the operating point of the design; None where it is not known yet.
    with_broadband : bool
        Whether broadband noise is in them.
    """

    bent: Evaluated
    described: Evaluated | None
    with_broadband: bool

    def table(self) -> list[dict[str, str]]:
        """Numbers of both blades beside each other.

        Returns
        -------
        list of dict
            Rows of text: key, label, bent, described, change, as far as they are known; a heading
            has an empty key.
        """
        rows, bent = operation_and_levels(self.bent.result)
        described: dict[str, Cell] = {}
        if self.described is not None:
            _, described = operation_and_levels(self.described.result)
        rows = [row for row in rows if row[1] and not row[1].startswith(_LEVEL)]
        rows.append(("noise at the microphone", "", ""))
        rows += [(label, _LEVEL + key, ".2f") for label, key in LEVEL_ROWS]
        return [_row(row, bent.get(row[1]), described.get(row[1])) for row in rows]


def _row(row: Row, bent: Cell, described: Cell) -> dict[str, str]:
    """Row of a table, as text."""
    label, key, form = row
    made = {"key": key, "label": label.strip()}
    if isinstance(bent, float):
        made["bent"] = format(bent, form)
        if isinstance(described, float):
            made |= {"described": format(described, form)}
            made["change"] = format(bent - described, f"+z{form}")
    return made


@dataclasses.dataclass
class _Known:
    """What is known of a blade at an operating point."""

    loads_key: object
    modelled: ModelledBlade
    place: object = None
    solved: Solved | None = None
    #: By whether broadband noise is in it, at the place of the microphone.
    results: dict[bool, Evaluated] = dataclasses.field(default_factory=dict)


class Evaluator:
    """Analyses of a described blade and of what is made of it, no more than has changed.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    model : Model
        How loads and noise are computed, with broadband noise, completed.
    """

    def __init__(self, propeller: Propeller, model: Model) -> None:
        self._models = {True: model, False: dataclasses.replace(model, noise=NoiseModel(None))}
        self._described = ModelledBlade.of(propeller, Change(), model)
        self._known: dict[str, _Known] = {}

    def operation(self, request: Request) -> tuple[float, float]:
        """Operating point of the described blade.

        Parameters
        ----------
        request : Request
            What is asked, completed.

        Returns
        -------
        rpm, thrust : float
            Rotation speed [rpm] and thrust [N].

        Raises
        ------
        ValueError
            Where `propmdao.analyze` raises it.
        """
        request = dataclasses.replace(request, model=self._models[False])
        require_analysable(self._described.changed, request)
        analysis = analysis_of(self._described, request)
        return analysis.rpm, float(analysis.loads.thrust)

    def stages(self, board: Board, design: Design) -> Iterator[Stage]:
        """Analyse a design, and the described blade at the same operating point, in stages.

        Parameters
        ----------
        board : Board
            Sliders of the described blade.
        design : Design
            The design.

        Yields
        ------
        Stage
            Loads and tones of the design, then of both blades, then the same with broadband noise;
            of the design alone only where the described blade is not known yet.

        Raises
        ------
        ValueError
            Where `propmdao.analyze` raises it; nothing that was known before is lost.
        """
        described = board.described(design)
        for with_broadband in (False, True):
            if design == described:
                both = self._evaluated(DESCRIBED, board, design, with_broadband)
                yield Stage(both, both, with_broadband)
                continue
            # The design first, for which somebody waits, and which may be none.
            bent = self._evaluated(BENT, board, design, with_broadband)
            if not self._is_known(board, described, with_broadband):
                yield Stage(bent, None, with_broadband)
            try:
                baseline = self._evaluated(DESCRIBED, board, described, with_broadband)
            except ValueError as error:
                raise ValueError(f"the described blade there: {error}") from error
            yield Stage(bent, baseline, with_broadband)

    def _is_known(self, board: Board, described: Design, with_broadband: bool) -> bool:
        """Whether the described blade is analysed at this operating point and microphone."""
        known = self._known.get(DESCRIBED)
        if known is None or (known.loads_key, known.place) != board.keys(described):
            return False
        return with_broadband in known.results

    def _evaluated(
        self, name: str, board: Board, design: Design, with_broadband: bool
    ) -> Evaluated:
        """Analysis of one of the two blades; what is known of it is not worked out again."""
        request = board.request(design, self._models[with_broadband])
        loads_key, place = board.keys(design)
        known = self._known.get(name)
        if known is None or known.loads_key != loads_key:
            blade = board.blade(design)
            require_analysable(blade, request)
            known = _Known(loads_key, self._modelled(blade), place)
        elif known.place != place:
            require_analysable(known.modelled.changed, request)
            known = dataclasses.replace(known, place=place, results={})
        if with_broadband not in known.results:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always", UserWarning)
                analysis = analysis_of(known.modelled, request, known.solved)
            if known.solved is None:
                held = known.modelled.unloaded
                case = held.case(request.point)
                known.solved = held.solved(case, analysis.loads, analysis.state)
            result = analysis.to_dict()
            said = dict.fromkeys(str(warning.message) for warning in caught)
            known.results[with_broadband] = Evaluated(analysis, result, (*doubts([result]), *said))
        self._known[name] = known
        return known.results[with_broadband]

    def _modelled(self, blade: Propeller) -> ModelledBlade:
        """A blade made ready, with the polars of the described one."""
        is_described = blade is self._described.changed
        return self._described if is_described else self._described.reshaped(blade)
