"""The bench itself, without a web: sliders, undo, evaluation, sounds and files of one blade."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from propmdao.acoustics.sounds.recordings import common_full_scale
from propmdao.analysis.request import Request
from propmdao.analysis.results import Analysis
from propmdao.analysis.sounds import pressure_record
from propmdao.commands.designs.bench.design import Board, Design, History
from propmdao.commands.designs.bench.evaluation import BENT, DESCRIBED, Evaluator, Stage
from propmdao.commands.designs.bench.latest import LatestOnly
from propmdao.figures.pages import rotor_figures, sound_figures
from propmdao.figures.pages.parts import Panel
from propmdao.formats.toml_files import toml_text, write_toml
from propmdao.formats.wav import FULL_SCALE, flac
from propmdao.propeller.description import Propeller

Message = dict[str, Any]
_SECONDS = 2.0  # of a sound, which is repeated


class Workbench:
    """A described blade, its sliders, and the latest design of it.

    Messages are dictionaries of plain words and numbers with a "kind"; those that come of a design
    have the "number" with which it was asked for.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    asked : Request
        Operating point in axial flight, and model with broadband noise, completed.
    microphone : (float, float)
        Distance [m] and elevation [deg] of the microphone.
    file : Path or None
        Propeller file that designs are saved in.

    Raises
    ------
    ValueError
        If the described blade cannot be analysed.
    """

    def __init__(
        self,
        propeller: Propeller,
        asked: Request,
        microphone: tuple[float, float],
        file: Path | None,
    ) -> None:
        self._file = file
        self._evaluator = Evaluator(propeller, asked.model)
        self._board = Board(propeller, asked, microphone, self._evaluator.operation(asked))
        self._history = History(self._board.start)
        self._tell: Callable[[Message], None] = lambda message: None
        self._shown: dict[str, Message] = {}
        self._telling = threading.Lock()
        self._stage: Stage | None = None
        self._compiled: set[object] = set()
        self._number = 0
        self._latest = LatestOnly[tuple[int, Design]](self._steps, self._refuse)

    def begin(self) -> None:
        """Evaluate the described blade, in the thread of the work."""
        self._latest.ask((self._number, self._history.now))

    def connect(self, tell: Callable[[Message], None]) -> None:
        """Tell somebody from now on, and nobody else, and begin with all there is to know.

        Parameters
        ----------
        tell : callable
            Function of a message, called from any thread.
        """
        sliders = [vars(each) for each in self._board.sliders.values()]
        with self._telling:
            self._tell = tell
            tell(
                {
                    "kind": "start",
                    "number": self._number,
                    "name": self._board.propeller.name,
                    "sliders": sliders,
                    "file": None if self._file is None else str(self._file),
                    **self._history.to_dict(),
                }
            )
            for message in self._shown.values():
                tell(message)

    def receive(self, message: Mapping[str, Any]) -> None:
        """Do what somebody asks for.

        Parameters
        ----------
        message : mapping
            What is asked for, by its "kind": "drag" (a design on the way), "set" (a design to come
            back to), "undo", "redo", "reset", "hold" (the other one of rotation speed and thrust),
            "save".
        """
        number, kind = message.get("number"), message.get("kind")
        number = number if type(number) is int else self._number
        try:
            if kind == "save":
                self._save()
                return
            design = self._asked_for(kind, message)
        except ValueError as error:
            self._say({"kind": "trouble", "number": number, "text": str(error)})
            return
        if kind != "drag":
            self._say({"kind": "design", **self._history.to_dict()})
        self._number = number
        self._latest.ask((number, design))

    def _asked_for(self, kind: Any, message: Mapping[str, Any]) -> Design:
        """Design that a message asks for."""
        history, board = self._history, self._board
        if kind == "drag":
            return board.design(message)
        if kind == "set":
            history.add(board.design(message))
        elif kind == "undo":
            history.undo()
        elif kind == "redo":
            history.redo()
        elif kind == "reset":
            history.add(board.start)
        elif kind == "hold":
            history.add(self._held(message.get("held")))
        else:
            raise ValueError(f"there is no {kind!r} on a bench")
        return history.now

    def _held(self, held: Any) -> Design:
        """Design of now with the rotation speed or the thrust held that it has."""
        now = self._history.now
        if self._stage is None or held not in self._board.sliders:
            return now
        return self._board.holding(now, held, self._stage.bent.result[held])

    def sound(self, name: str) -> tuple[bytes, float]:
        """Sound of the last blade whose broadband noise is known.

        Parameters
        ----------
        name : str
            `DESCRIBED` or `BENT`.

        Returns
        -------
        content : bytes
            FLAC, to be repeated.
        full_scale : float
            Pressure of its largest number [Pa].

        Raises
        ------
        ValueError
            If there is no such blade, nothing to be heard yet, or the rotor stands still.
        """
        if name not in (DESCRIBED, BENT):
            raise ValueError(f"there are sounds of {DESCRIBED} and {BENT}, not of {name!r}")
        if self._stage is None or not self._stage.with_broadband:
            raise ValueError("the broadband noise is not known yet")
        record = pressure_record(getattr(self._stage, name).analysis, _SECONDS)[0]
        full_scale = max(common_full_scale(record), FULL_SCALE.lowest)
        return flac(record, full_scale), full_scale

    def text(self) -> str:
        """Propeller file of the design."""
        return toml_text(self._board.blade(self._history.now))

    def wait(self, seconds: float) -> bool:
        """Whether all that was asked for is done, within so many seconds."""
        return self._latest.wait(seconds)

    def close(self) -> None:
        """End the work."""
        self._latest.close()

    def _save(self) -> None:
        if self._file is None:
            raise ValueError("no file to save in was named: start with --save FILE.toml")
        write_toml(self._file, self._board.blade(self._history.now))
        self._say({"kind": "saved", "text": f"Saved in {self._file}"})

    def _say(self, message: Message) -> None:
        with self._telling:
            if message["kind"] in ("numbers", "blade", "spectra", "trouble"):
                self._shown[message["kind"]] = message
            if message["kind"] == "numbers":
                self._shown.pop("trouble", None)
            self._tell(message)

    def _refuse(self, job: tuple[int, Design], reason: str) -> None:
        line = " ".join(reason.split())
        self._say({"kind": "trouble", "number": job[0], "text": line})

    def _steps(self, job: tuple[int, Design]) -> Iterator[None]:
        """Evaluate a design, and tell what is found as soon as it is."""
        number, design = job
        n_blades = round(self._board.value(design, "n_blades"))
        if (n_blades, design.held) not in self._compiled:
            text = f"Compiling for {n_blades} blades: a minute where that was never done before"
            self._say({"kind": "working", "number": number, "text": text})
        for stage in self._evaluator.stages(self._board, design):
            self._say(
                {
                    "kind": "numbers",
                    "number": number,
                    "rows": stage.table(),
                    "doubts": stage.bent.doubts,
                    "is_complete": stage.with_broadband and stage.described is not None,
                }
            )
            yield
            if stage.described is None:
                continue
            self._stage = stage
            draw = _spectra if stage.with_broadband else _blade
            with warnings.catch_warnings():  # they stand below the numbers
                warnings.simplefilter("ignore", UserWarning)
                figures = draw(stage.bent.analysis, stage.described.analysis)
            self._say({"number": number, **figures})
            yield
        self._compiled.add((n_blades, design.held))


def _blade(bent: Analysis, described: Analysis) -> Message:
    """Figures of the shapes of both blades."""
    blades = {name: each.propeller for name, each in _named(bent, described).items()}
    space = rotor_figures.in_space({bent.propeller.name: bent.propeller}).panels["all"]
    shapes = rotor_figures.shapes(blades).panels["all"]
    return {"kind": "blade", "panels": [_plain(panel) for panel in (*space, *shapes)]}


def _spectra(bent: Analysis, described: Analysis) -> Message:
    """Spectra of both blades."""
    (panels,) = sound_figures.beside(_named(bent, described), [0]).panels.values()
    return {"kind": "spectra", "panels": [_plain(panel) for panel in panels]}


def _named(bent: Analysis, described: Analysis) -> dict[str, Analysis]:
    """Both blades by the names of their lines."""
    return {"A, described": described, "B, bent": bent}


def _plain(panel: Panel) -> Message:
    return {"label": panel.label, "data": panel.data, "layout": panel.layout}
