"""Drag of sections against two wind tunnels: the study's parts, and what the catalogue reaches."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.family import section_tables
from propmdao.aerodynamics.sections.polars.high_angle import ATTACHED, ATTACHED_DEG
from propmdao.aerodynamics.sections.polars.measured_drag import DRAG_SCATTER, at_measured_level
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import section_curves
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller

#: Measured models whose shapes the catalogue has, and their names there.
SHIPPED = {"CLARKY-B": "clarky", "CLARK-Y": "clarky", "NACA2414": "naca2414",
           "NACA6409": "naca6409"}  # fmt: skip


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("section_drag")


def parabola(shift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Lift of a flat plate that stalls at 12 deg, and drag that is a parabola of lift."""
    lift = 2.0 * np.pi * np.radians(np.clip(ATTACHED_DEG, -12.0, 12.0)) + shift
    cl = np.where(np.abs(ATTACHED_DEG) > 12.0, 0.6 * lift, lift)
    return cl, 0.02 + 0.01 * cl**2


def test_drag_is_found_at_lift_between_the_stalls_alone(study: ModuleType) -> None:
    cl, cd = parabola(0.2)
    wanted = np.array([-1.0, 0.0, 0.5, 1.2])
    found = study.drag_at_lift(cl, cd, wanted)
    np.testing.assert_allclose(found, 0.02 + 0.01 * wanted**2, rtol=2e-3)
    assert np.isnan(study.drag_at_lift(cl, cd, np.array([-1.2, 1.6]))).all()


def test_the_level_is_found_that_points_were_made_with(study: ModuleType) -> None:
    re, level, lift = np.array([6e4, 2e5]), (0.1, 0.3), np.array([0.4, 0.7, 0.9])
    rows = np.stack([np.stack([*parabola(0.3), 0.0 * ATTACHED_DEG])] * 2, axis=1)
    tunnel = rows * np.array([1.0, 1.2, 1.0])[:, None, None]
    made = at_measured_level(rows, tunnel, re, level)
    drag = [study.drag_at_lift(made[0, k], made[1, k], lift) for k in range(2)]
    names = ("a", "b", "c")
    computed = study.Computed(*(dict.fromkeys(names, value) for value in (0.1, re, rows, tunnel)))
    points = study.Measured(
        section=np.repeat(names, 6),
        re=np.tile(np.repeat(re, 3), 3),
        cl=np.tile(lift, 6),
        cd=np.tile(np.concatenate(drag), 3),
    )
    found, remaining = study.left_out(computed, points)
    np.testing.assert_allclose(found, level, atol=1e-4)
    np.testing.assert_allclose(remaining, 0.0, atol=1e-4)
    table = study.rows_of({"x": remaining}, points, np.full(points.re.size, 0.1))
    assert table[0] == ["all", "18", "1.00 (0.00)"]
    assert study.statistics(np.log([1.0, 2.0, 0.5, np.nan])) == ["3", "1.00", "0.57", "1.03"]


def logarithms(study: ModuleType, points: Any, section: str, measured_drag: bool) -> np.ndarray:
    """Measured over computed drag of a model by the tables of the catalogue."""
    airfoil, r = find_airfoil(SHIPPED[section]), np.array([0.5, 1.0])
    propeller = Propeller("x", 1.0, 2, r, 0.1 * r, r, [(0.0, SHIPPED[section])])
    polars, found = polars_for(propeller, measured_drag=measured_drag), []
    size = (jnp.array([value]) for value in (airfoil.max_camber, airfoil.max_thickness))
    table = section_tables(polars, polars.weights[:1], *size)
    own = points.section == section
    for re in np.unique(points.re[own]):
        chosen = own & (points.re == re)
        values = np.asarray(section_curves(table, jnp.array([re])).values)[0, :, ATTACHED]
        drag = study.drag_at_lift(values[0], np.exp(values[1]), points.cl[chosen])
        found.append(np.log(points.cd[chosen] / drag))
    return np.concatenate(found)


@pytest.mark.validation
def test_drag_of_the_catalogue_is_that_of_two_tunnels(
    study: ModuleType, reference_data: Path
) -> None:
    points = study.measured_points(reference_data)
    raw, level = (
        np.concatenate([logarithms(study, points, section, drag) for section in SHIPPED])
        for drag in (False, True)
    )
    raw, level = raw[np.isfinite(raw)], level[np.isfinite(level)]
    assert raw.size == level.size == 150
    # Measured over computed: the median, and the spread of the logarithm without tails.
    assert np.exp(np.median(raw)) == pytest.approx(1.22, abs=0.02)
    assert np.exp(np.median(level)) == pytest.approx(1.00, abs=0.02)
    assert float(study.statistics(level)[3]) == pytest.approx(0.12, abs=0.02)
    # The scatter of all sections holds 68 % of their points; of these five models more.
    assert np.mean(np.abs(level) < DRAG_SCATTER) == pytest.approx(0.79, abs=0.03)


def test_without_measured_points_one_line_says_so(
    study: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("PROPMDAO_REFERENCE_DATA", raising=False)
    monkeypatch.setattr("sys.argv", ["section_drag.py"])
    with pytest.raises(SystemExit, match="^PROPMDAO_REFERENCE_DATA is not set"):
        study.main()
