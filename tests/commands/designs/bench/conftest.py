"""A bench of a coarse blade, and somebody who notes what it says."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from shared_mesh import COARSE

import propmdao as pm
from propmdao.analysis.request import Request
from propmdao.commands.designs.bench.workbench import Workbench

AT = (1.905, -45.0)


@pytest.fixture(scope="session")
def propeller() -> pm.Propeller:
    return pm.load_propeller("apcsf_11x4.7")


@pytest.fixture(scope="session")
def asked(propeller: pm.Propeller) -> Request:
    observers = pm.arc(AT[0], np.array([AT[1]]))
    asked = Request.of(rpm=4200.0, broadband=True, fidelity=COARSE, observers=observers)
    return asked.completed(propeller)


class Notes:
    """What a bench says, and what the last of each kind was."""

    def __init__(self) -> None:
        self.all: list[dict[str, Any]] = []

    def __call__(self, message: dict[str, Any]) -> None:
        self.all.append(message)

    def last(self, kind: str) -> dict[str, Any]:
        return next(message for message in reversed(self.all) if message["kind"] == kind)

    def number(self, key: str, column: str = "bent") -> float:
        (row,) = (row for row in self.last("numbers")["rows"] if row["key"] == key)
        return float(row[column])


@pytest.fixture
def bench(propeller, asked, tmp_path):
    made = Workbench(propeller, asked, AT, tmp_path / "saved.toml")
    made.begin()
    yield made
    made.close()


@pytest.fixture
def fast_bench(propeller, asked, tmp_path):
    """A bench whose sliders reach the speed of sound."""
    point = dataclasses.replace(asked.point, rpm=10500.0)
    fast = dataclasses.replace(asked, point=point)
    made = Workbench(propeller, fast, AT, tmp_path / "saved.toml")
    made.begin()
    yield made
    made.close()


@pytest.fixture
def listener():
    """Somebody who listens to a bench from now on, until all is said."""

    def listening_to(bench: Workbench) -> Notes:
        notes = Notes()
        bench.connect(notes)
        assert bench.wait(240.0)
        return notes

    return listening_to


@pytest.fixture
def notes(bench, listener) -> Notes:
    return listener(bench)
