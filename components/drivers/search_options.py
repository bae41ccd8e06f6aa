"""Options of a search: how it searches, when it ends, what it writes."""

from __future__ import annotations

import math
import os
from typing import Any

from openmdao.utils.options_dictionary import OptionsDictionary
from scipy.stats import qmc

STRATEGIES = tuple(
    mutation + crossover
    for mutation in ("best1", "best2", "rand1", "rand2", "randtobest1", "currenttobest1")
    for crossover in ("bin", "exp")
)
SAMPLERS = {"latinhypercube": qmc.LatinHypercube, "sobol": qmc.Sobol, "halton": qmc.Halton}


def declare_search_options(options: OptionsDictionary) -> None:
    """Declare the options that determine the search and its end."""
    declare = options.declare
    declare("max_gen", 100, types=int, lower=0, desc="Number of generations after the initial one.")
    declare(
        "pop_size",
        0,
        types=int,
        lower=0,
        desc="Number of designs per generation; 0: 15 a variable.",
    )
    declare(
        "tol",
        1e-3,
        lower=0.0,
        check_valid=_require_number,
        desc="Converged when the standard deviation of the population's scaled objectives is "
        "below tol times the magnitude of their mean.",
    )
    declare(
        "polish",
        False,
        types=bool,
        desc="Go on from the best design by SLSQP with the model's derivatives.",
    )
    declare(
        "time_budget",
        None,
        types=(int, float),
        allow_none=True,
        lower=0.0,
        check_valid=_require_number,
        desc="Seconds after which no further design is evaluated; None: no limit.",
    )
    declare(
        "seed",
        None,
        types=int,
        allow_none=True,
        desc="Seed of random numbers: same seed, same search.",
    )
    declare(
        "strategy",
        "best1bin",
        values=STRATEGIES,
        desc="Strategy of mutation and crossover, as SciPy names it.",
    )
    declare(
        "init", "latinhypercube", values=tuple(SAMPLERS), desc="Sampler of the initial population."
    )
    declare(
        "mutation",
        (0.5, 1.0),
        types=(float, tuple),
        check_valid=_require_mutation,
        desc="Differential weight in [0, 2); from a pair each generation draws one in between.",
    )
    declare(
        "recombination",
        0.7,
        lower=0.0,
        upper=1.0,
        check_valid=_require_number,
        desc="Crossover probability.",
    )
    declare(
        "equality_tolerance",
        1e-4,
        lower=0.0,
        check_valid=_require_number,
        desc="Largest deviation from `equals` that counts as met in the end, in driver scaling.",
    )


def _require_number(name: str, value: Any) -> None:
    # OpenMDAO's limits let a nan through.
    if value is not None and math.isnan(value):
        raise ValueError(f"{name} is nan; it is a number of at least 0")


def _require_mutation(name: str, value: Any) -> None:
    # Scipy sorts a pair without a word.
    low_high = value if isinstance(value, tuple) else (value, value)
    try:
        valid = len(low_high) == 2 and 0.0 <= low_high[0] <= low_high[1] < 2.0
    except TypeError:
        valid = False
    if not valid:
        raise ValueError(
            f"{name} is {value}; it is a number in [0, 2), or a pair (low, high) of such"
        )


def declare_file_options(options: OptionsDictionary) -> None:
    """Declare the options of the files that are written and of what is printed."""
    declare = options.declare
    path = {"types": (str, os.PathLike), "allow_none": True}
    declare(
        "best_file",
        "best_design.json",
        **path,
        desc="JSON file that holds the best feasible design so far at any time; a relative "
        "path lies in the Problem's outputs directory; None: no file.",
    )
    declare(
        "checkpoint",
        None,
        **path,
        desc="File to which every evaluated design is added, and from which the search goes on "
        "where there is one; a relative path as of best_file; None: no file.",
    )
    declare("disp", True, types=bool, desc="Print a summary at the end.")
