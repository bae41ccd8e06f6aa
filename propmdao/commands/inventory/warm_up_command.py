"""Command line: ``propmdao warm-up``."""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from propmdao.commands.observer_options import add_observers, listening_of
from propmdao.commands.options import add_command
from propmdao.commands.output.warning_lines import warning_lines
from propmdao.formats.endings import PROPELLER_READERS, described
from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from propmdao.propeller.description import Propeller
    from propmdao.records.listening import Floats

DESCRIPTION = """\
Compile what is used most, so that nobody waits for it later: analyses at a rotation speed and for a
thrust, with tones and broadband noise, and PropellerGroup with the derivatives that a search asks
for, all with default options. For images of containers, and for machines that test.

Compiled code depends on the number of blades, stations and airfoils of the propeller and on the
number of observers: name those that will be used. It is kept in the user's cache folder, elsewhere
with PROPMDAO_CACHE_DIR, and is of this version of propmdao, JAX, NumPy and Python on this kind of
processor. What is compiled already is read, which takes seconds.
"""
EXAMPLES = """\
examples:
  propmdao warm-up
  propmdao warm-up my_blade.toml --arc 1.905 -60:30:15

Exit status: 0, or 2 with one line on stderr, also where no cache can be written.
"""
_TIP_SPEED = 60.0  # m/s


def add_warm_up(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands, "warm-up", _warm_up, "compile beforehand what is used most",
        DESCRIPTION, EXAMPLES,
    )  # fmt: skip
    command.add_argument(
        "propeller",
        metavar="PROPELLER",
        nargs="?",
        default="apcsf_11x4.7",
        help=f"name from 'propmdao list', or path of a file: {described(PROPELLER_READERS)};"
        " default %(default)s",
    )
    add_observers(command)


def _warm_up(options: argparse.Namespace) -> None:
    observers = listening_of(options).observers
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.acoustics.kinematics.limits import require_outside_rotor
    from propmdao.acoustics.kinematics.observers import arc
    from propmdao.formats.propellers import load_propeller
    from propmdao.runtime.caches import FOLDER_VARIABLE, cache_folder

    folder = cache_folder("programs")
    if folder is None:
        raise ValueError(f"no cache can be written: {FOLDER_VARIABLE} names a folder that can be")
    with warning_lines("warm-up"):
        propeller = load_propeller(options.propeller)
    if not len(observers):
        observers = arc(5.0 * propeller.diameter, [-45.0])
    require_outside_rotor(observers, 0.5 * propeller.diameter)
    started = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of results that nobody has asked for
        works = _works(propeller, observers)
        warnings.simplefilter("ignore")  # OpenMDAO asks to be heard
        for words, work in works.items():
            before = time.perf_counter()
            work()
            print_line(f"{words}: {time.perf_counter() - before:.1f} s")
    print_line(f"all: {time.perf_counter() - started:.1f} s, kept in {folder.parent}")


def _works(propeller: Propeller, observers: Floats) -> dict[str, Callable[[], object]]:
    """What is compiled, by the words that tell of it, in the order in which it is done."""
    import openmdao.api as om

    from propmdao.analysis.single_point import analyze
    from propmdao.components import PropellerGroup
    from propmdao.records.units import RAD_PER_S

    rpm = _TIP_SPEED / (0.5 * propeller.diameter) / RAD_PER_S

    def analysed(**asked: Any) -> dict[str, Any]:
        return analyze(propeller, observers=observers, **asked).to_dict()

    def for_a_thrust() -> None:
        analysed(thrust=analysed(rpm=rpm)["thrust"])

    prob = om.Problem(reports=False)
    ends = [float(propeller.r_over_R[0]), 1.0]
    group = PropellerGroup(
        propeller=propeller,
        observers=observers,
        design_distributions={"beta": ends, "chord_over_R": ends},
    )
    prob.model.add_subsystem("propeller", group, promotes=["*"])

    def group_runs() -> None:
        prob.setup(mode="rev")
        prob.set_val("thrust_required", analysed(rpm=rpm)["thrust"], units="N")
        prob.run_model()

    def group_derives() -> None:
        prob.compute_totals(of=["torque", "oaspl_db"], wrt=["beta_cp", "chord_over_R_cp"])

    return {
        "analysis at a rotation speed": lambda: analysed(rpm=rpm),
        "analysis for a thrust": for_a_thrust,
        "broadband noise": lambda: analysed(rpm=rpm, broadband=True),
        "PropellerGroup": group_runs,
        "its derivatives": group_derives,
    }
