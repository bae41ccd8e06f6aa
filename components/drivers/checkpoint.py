"""Every design that a search has evaluated, in a file from which the search can be done again."""

from __future__ import annotations

import json
import os
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from propmdao.components.drivers.evaluation.candidate import Array
from propmdao.components.drivers.same_model import require_same_results
from propmdao.runtime.output_files import append, require_writable

FORMAT = "propmdao search 1"


class Checkpoint:
    """Evaluated designs in the order of their evaluation, appended to a file one by one.

    A search is a function of its seed and of what its designs evaluate to. So no state of it is
    kept: a resumed search begins anew and finds the results of its first designs here, with every
    digit, until it is where it was stopped.

    Each line of the file is a checksum and JSON. Lines are written whole, so a killed process
    leaves at most its last line incomplete, which is then dropped.

    Parameters
    ----------
    path : pathlib.Path
        The file, made where there is none; whoever uses it holds its lock.
    search : dict
        JSON values that determine the search: written to a new file, and required of an existing
        one. ``"seed"`` may be None: then the file's, or a new one, is taken.

    Attributes
    ----------
    seed : int
        Seed of the search.
    n_replayed : int
        Number of designs taken from the file so far.

    Raises
    ------
    ValueError
        When the file cannot be written, is no checkpoint, is corrupt, or belongs to another search.
    """

    def __init__(self, path: Path, search: dict[str, Any]) -> None:
        self.path = path
        self.n_replayed = 0
        search = json.loads(json.dumps(search))  # as it will be read back
        require_writable(path)
        header, self._entries = self._read() if path.exists() else (None, [])
        if header is None:
            entropy: Any = np.random.SeedSequence(search["seed"]).entropy
            self.seed: int = entropy
            path.write_bytes(_line({"format": FORMAT, **search, "seed": self.seed}))
        else:
            self.seed = header["seed"]
            if search["seed"] is None:
                search["seed"] = self.seed
            self._require_same(header, {"format": FORMAT, **search})

    def first_success(self) -> dict[str, Any] | None:
        """Return the first entry of the file without a failure, if there is one."""
        return next((entry for entry in self._entries if not entry["failure"]), None)

    def require_same_model(self, entry: dict[str, Any], outputs: dict[str, Array]) -> None:
        """Refuse a model that gives other outputs at the design of an entry than it gave then.

        Parameters
        ----------
        entry : dict
            Entry that `first_success` has returned.
        outputs : dict of str to array
            Outputs that the objective and the constraints are read from, at its design now.

        Raises
        ------
        ValueError
            When an output differs by more than another machine's rounding.
        """
        file = f"checkpoint '{self.path}'"
        require_same_results(file, "the same design", entry["outputs"], outputs)

    def replay(self, designs: Sequence[Array]) -> list[dict[str, Any]]:
        """Return the next entries, which have to be of the designs.

        Parameters
        ----------
        designs : sequence of (n_variables,) arrays
            Designs that the search evaluates next.

        Returns
        -------
        list of dict
            ``failure``, str, and ``outputs``, values by name, of the first designs: of as many as
            the file still holds.

        Raises
        ------
        ValueError
            When the file holds other designs here.
        """
        entries = self._entries[self.n_replayed : self.n_replayed + len(designs)]
        for entry, design in zip(entries, designs, strict=False):
            if entry["design"] != design.tolist():
                raise ValueError(
                    f"checkpoint '{self.path}' cannot be resumed: its design {self.n_replayed + 1}"
                    " is not the one that this search evaluates, as with another version of SciPy"
                    " or NumPy; delete it to start anew"
                )
            self.n_replayed += 1
        return entries

    def append(self, design: Array, failure: str, outputs: dict[str, Array]) -> None:
        """Add a design that has been evaluated.

        Parameters
        ----------
        design : (n_variables,) array
            The design.
        failure : str
            Why its analysis failed, empty when it did not.
        outputs : dict of str to array
            Outputs that the objective and the constraints are read from, none after a failure.
        """
        entry = {
            "design": design.tolist(),
            "failure": failure,
            "outputs": {name: value.tolist() for name, value in outputs.items()},
        }
        append(self.path, _line(entry))

    def _read(self) -> tuple[dict[str, Any] | None, list[dict[str, Any]]]:
        """Header and entries; an incomplete last line is cut off."""
        content = self.path.read_bytes()
        whole = content[: content.rfind(b"\n") + 1]
        lines = [
            self._parse(number, line) for number, line in enumerate(whole.splitlines(), start=1)
        ]
        if content and not lines and FORMAT.encode() not in content:
            raise self._no_checkpoint()
        if len(whole) < len(content):
            os.truncate(self.path, len(whole))
        return (lines[0], lines[1:]) if lines else (None, [])

    def _parse(self, number: int, line: bytes) -> dict[str, Any]:
        checksum, _, text = line.partition(b" ")
        if checksum != _checksum(text):
            if number == 1:
                raise self._no_checkpoint()
            raise ValueError(
                f"checkpoint '{self.path}' is corrupt in line {number}; cut the file off before"
                " that line to resume from there, or delete it to start anew"
            )
        value: dict[str, Any] = json.loads(text)
        return value

    def _no_checkpoint(self) -> ValueError:
        return ValueError(f"'{self.path}' is not a checkpoint of a search; name another file")

    def _require_same(self, header: dict[str, Any], search: dict[str, Any]) -> None:
        for name, value in search.items():
            if header.get(name) != value:
                raise ValueError(
                    f"checkpoint '{self.path}' is of another search: {name} is"
                    f" {header.get(name)} there and {value} here; name another file, or delete"
                    " it to start anew"
                )


def _line(value: dict[str, Any]) -> bytes:
    text = json.dumps(value).encode()
    return _checksum(text) + b" " + text + b"\n"


def _checksum(text: bytes) -> bytes:
    return b"%08x" % zlib.crc32(text)
