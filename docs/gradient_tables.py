"""Tables of docs/verification.md about optimisation by gradients; `update_tables.py` writes them.

They are what the studies `gradient_design.py` and `smooth_objectives.py` print. The searches run
once for all tables and leave figures, blades and what the drivers recorded in
``results/gradient_design``. Seconds of compiling are those of a first run only where nothing is
kept from an earlier one: with ``XDG_CACHE_HOME`` at an empty folder.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from propmdao.analysis.comparisons import Rows, side_by_side

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "studies" / "design"))
import gradient_design  # noqa: E402
import smooth_objectives  # noqa: E402

EVALUATIONS = 1200  # of differential evolution
# Searches of the thesis' problem, by their names in the study and here.
OF_THE_THESIS = {
    "thesis' problem": "SLSQP",
    "evolution": "differential evolution",
    "and SLSQP": "and SLSQP from its best",
}
FREE_FORM = ("quiet tones", "quiet total")


@functools.cache
def results() -> gradient_design.Results:
    """Blades, searches and contributions of the study, its figures written."""
    output = ROOT / "results" / "gradient_design"
    output.mkdir(parents=True, exist_ok=True)
    designs = gradient_design.design(output, EVALUATIONS)
    gradient_design.draw(designs, output)
    return designs


def targets() -> Rows:
    """Targets of searches by gradients, and what is measured."""
    searches = results().searches
    slsqp, evolved = (searches[name] for name in ("thesis' problem", "evolution"))
    louder = slsqp.history.objective[-1] - evolved.history.objective[-1]
    rows: list[tuple[str, float, float, str, str]] = [
        ("thesis' problem: designs analysed", 80, slsqp.history.objective.size, ".0f", ""),
        ("thesis' problem: time", 60, slsqp.compiling + slsqp.seconds, ".0f", " s"),
        ("thesis' problem: time, compiling apart", 60, slsqp.seconds, ".0f", " s"),
        (f"thesis' problem: above the best of {EVALUATIONS} designs", 0, louder, ".3f", " dB"),
    ]
    for name in FREE_FORM:
        steps = [searches[f"{name}, coarse"], searches[name]]
        seconds = sum(step.compiling + step.seconds for step in steps)
        rows += [
            (f"29 variables, {name}: time", 300, seconds, ".0f", " s"),
            (f"29 variables, {name}: largest violation", 1e-4, steps[-1].history.violation[-1],
             ".1e", ""),
        ]  # fmt: skip
    return [
        ("search by gradients", "target", "measured", ""),
        *(
            (label, f"{target:g}{unit}", f"{value:{form}}{unit}",
             "met" if value <= target else "missed")
            for label, target, value, form, unit in rows
        ),
    ]  # fmt: skip


def thesis_problem() -> Rows:
    """Cost of solving the thesis' problem by SLSQP, differential evolution and both."""
    return gradient_design.cost(
        {label: results().searches[name] for name, label in OF_THE_THESIS.items()}
    )


def free_form() -> Rows:
    """The blades beside the one they start from."""
    return side_by_side(gradient_design.ROWS, results().columns())


def free_form_cost() -> Rows:
    """Cost of the searches for the free-form blades."""
    searches = results().searches.items()
    return gradient_design.cost({k: search for k, search in searches if k not in OF_THE_THESIS})


def contributions(name: str) -> Rows:
    """Contribution of each kind of variable to a free-form blade."""
    return results().contributions[name]


def smoothness() -> Rows:
    """Second differences along random lines, kinks, derivatives against differences."""
    return smooth_objectives.rows(*smooth_objectives.survey())


#: Tables by the names that stand in docs/verification.md.
TABLES: dict[str, Callable[[], Rows]] = {
    "gradient targets": targets,
    "gradient thesis": thesis_problem,
    "gradient free form": free_form,
    "gradient cost": free_form_cost,
    "gradient contributions tones": partial(contributions, "quiet tones"),
    "gradient contributions total": partial(contributions, "quiet total"),
    "smoothness": smoothness,
}
