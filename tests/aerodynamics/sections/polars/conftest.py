"""Propellers and section tables that the polar tests share."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.family import SectionPolars, section_tables
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import PolarTable
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller

Section = Callable[..., PolarTable]


def _propeller(*airfoils: tuple[float, str]) -> Propeller:
    r = np.array([0.2, 0.5, 1.0])
    return Propeller("bench", 0.25, 2, r, np.full(3, 0.1), np.full(3, 20.0), list(airfoils))


@pytest.fixture(scope="session")
def propeller() -> Callable[..., Propeller]:
    """Make a propeller of three stations, 0.2, 0.5 and 1, with these airfoils."""
    return _propeller


@functools.cache
def _polars(airfoil: str) -> SectionPolars:
    return polars_for(_propeller((0.0, airfoil)))


def _section(airfoil: str, n: int = 1, **changed: float) -> PolarTable:
    section, polars = find_airfoil(airfoil), _polars(airfoil)
    table = section_tables(
        polars,
        polars.weights[:1],
        jnp.array([changed.get("camber", section.max_camber)]),
        jnp.array([section.max_thickness]),
    )
    return dataclasses.replace(table, values=jnp.repeat(table.values, n, axis=0))


@pytest.fixture(scope="session")
def section() -> Section:
    """Make the table of n equal sections of an airfoil of the catalogue."""
    return _section
