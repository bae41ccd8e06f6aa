"""Options of a search: how it searches, when it ends, what it writes."""

from __future__ import annotations

import os

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
        desc="Converged when the standard deviation of the population's scaled objectives is "
        "below tol times the magnitude of their mean.",
    )
    declare(
        "time_budget",
        None,
        types=(int, float),
        allow_none=True,
        lower=0.0,
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
        desc="Differential weight in [0, 2); from a pair each generation draws one in between.",
    )
    declare("recombination", 0.7, lower=0.0, upper=1.0, desc="Crossover probability.")
    declare(
        "equality_tolerance",
        1e-4,
        lower=0.0,
        desc="Largest deviation from `equals` that counts as met, in driver scaling.",
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
