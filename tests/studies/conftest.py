"""Fixtures of the studies' tests: scripts imported as when they are run, coarse meshes."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from propmdao.records.fidelity import Fidelity
from propmdao.records.wake_law import WakeGrid


@pytest.fixture(scope="module")
def import_study(checkout: Path) -> Iterator[Callable[[str], ModuleType]]:
    """Import a script anew; those it builds on lie beside it, once for a file of tests."""
    scripts = list((checkout / "studies").glob("*/*.py"))
    with pytest.MonkeyPatch.context() as patch:
        for folder in {script.parent for script in scripts}:
            patch.syspath_prepend(folder)

        def anew(name: str) -> ModuleType:
            sys.modules.pop(name, None)
            return importlib.import_module(name)

        yield anew
        for script in scripts:
            sys.modules.pop(script.stem, None)


@pytest.fixture(scope="session")
def coarse() -> Fidelity:
    """Meshes on which a blade can be told from another."""
    return Fidelity(n_chordwise=4, n_spanwise=8, n_contour=15, n_surface_span=12, n_harmonics=3)


@pytest.fixture(scope="session")
def coarsest() -> Fidelity:
    """Meshes for what does not depend on them."""
    return Fidelity(n_chordwise=2, n_spanwise=4, n_contour=5, n_surface_span=4, n_harmonics=2)


@pytest.fixture(scope="session")
def around(coarsest: Fidelity) -> Fidelity:
    """The coarsest with few azimuths and a short wake, for flight at an incidence."""
    return replace(coarsest, n_azimuths=8, period_wake=WakeGrid(2.0, 2.0, 1.5, 40.0))


@pytest.fixture(scope="session")
def assert_phase_totals():
    """``assert_phase_totals(prob, chosen_freely)``: totals of a phase of Dymos that has run.

    Along a random direction for each design variable, at the best of several steps; among the
    variables are those named.
    """

    def check(prob, chosen_freely):
        driver, rng = prob.driver, np.random.default_rng(2)
        totals = prob.compute_totals(driver_scaling=False)
        free = {name.split(":")[-1] for _, name in totals}
        assert chosen_freely <= free
        for name, meta in prob.model.get_design_vars(recurse=True).items():
            start, errors = prob.get_val(name).copy(), {}
            along = np.zeros(start.size)
            chosen = slice(None) if meta["indices"] is None else meta["indices"].flat()
            along[chosen] = 1e-2 * np.abs(start).max() * rng.standard_normal(along[chosen].size)
            for step in (1.0, 0.1, 1e-2, 1e-3):
                at = {}
                for k in (-2, -1, 1, 2):
                    prob.set_val(name, start + k * step * along.reshape(start.shape))
                    prob.run_model()
                    at[k] = {
                        of: np.array(value)
                        for of, value in (
                            *driver.get_constraint_values(driver_scaling=False).items(),
                            *driver.get_objective_values(driver_scaling=False).items(),
                        )
                    }
                for of in at[1]:
                    exact = totals[of, name] @ along[chosen]
                    slope = 8.0 * (at[1][of] - at[-1][of]) - at[2][of] + at[-2][of]
                    largest = max(np.abs(exact).max(), 1e-4 * np.abs(at[1][of]).max(), 1e-6)
                    error = np.abs(slope / (12.0 * step) - exact).max() / largest
                    errors.setdefault(of, []).append(error)
                if all(min(found) < 1e-6 for found in errors.values()):
                    break
            prob.set_val(name, start)
            for of, found in errors.items():
                assert min(found) < 1e-6, f"{of} by {name}: {found}"

    return check
