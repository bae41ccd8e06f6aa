"""How finely the blade, its wake and its sound are resolved, and loads that are marched in time."""

from __future__ import annotations

import dataclasses
from typing import Literal, get_args

from propmdao.records.quantities import require_asked
from propmdao.records.units import Range
from propmdao.records.wake_law import WakeGrid

#: Panels of the lattice on a blade: the unknowns, whose matrix has 128 MiB.
MOST_PANELS = 4096
#: What there is when the march begins: a rotor set going in still air, or its steady solution.
Start = Literal["steady", "impulsive"]
#: How the wake moves: by the law of the steady solution, or with the local velocity.
WakeMotion = Literal["prescribed", "free"]
#: How a gust comes: it comes and goes, as 1-cos, or comes and stays.
GustShape = Literal["cosine", "step"]


@dataclasses.dataclass(frozen=True)
class Fidelity:
    """Numbers of panels, harmonics and wake nodes; hashable, fixed at compile time.

    docs/verification.md, "Panels", shows what the defaults cost in accuracy.

    Attributes
    ----------
    n_chordwise, n_spanwise : int
        Panels of the vortex lattice on one blade.
    n_contour, n_surface_span : int
        Points around the section and along the span of the surface mesh
        (the thesis' Tess_W x Tess_U, 65 x 80).
    n_harmonics : int
        Harmonics of the blade passage frequency.
    wake : WakeGrid
        Nodes of the wake's filaments in axial flight.
    n_azimuths : int
        Azimuths of the period in flight at an incidence, rounded up to a multiple of the blades.
    period_wake : WakeGrid
        Nodes of the wake there: what the blade has just shed decides how its loads change, so the
        steps begin small.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    n_chordwise: int = 8
    n_spanwise: int = 24
    n_contour: int = 65
    n_surface_span: int = 80
    n_harmonics: int = 10
    wake: WakeGrid = WakeGrid()
    n_azimuths: int = 36
    period_wake: WakeGrid = WakeGrid(4.0, 0.25, 1.25, 10.0)

    def __post_init__(self) -> None:
        """Refuse resolutions that no mesh can have, or no memory hold."""
        for field, allowed in (
            ("n_chordwise", Range(2, 100)),
            ("n_spanwise", Range(2, 400)),
            ("n_contour", Range(5, 1001)),
            ("n_surface_span", Range(2, 1001)),
            ("n_harmonics", Range(1, 1000)),
            ("n_azimuths", Range(8, 1440)),
        ):
            allowed.require(field, getattr(self, field))
        n_panels = self.n_chordwise * self.n_spanwise
        if n_panels > MOST_PANELS:
            raise ValueError(
                f"n_chordwise times n_spanwise must be at most {MOST_PANELS}; it is {n_panels}"
            )


@dataclasses.dataclass(frozen=True)
class FreeWake:
    """Wake whose nodes move with the local velocity; hashable, fixed at compile time.

    Attributes
    ----------
    turns : float
        Revolutions for which a node moves freely. Over the next one the law of the prescribed wake
        takes over, which carries the rest of the wake.
    core : float
        Core radius with which the wake acts on itself when it is shed, over the tip radius; it
        grows with age. What acts on the blades keeps the core of the prescribed wake.
    n_filaments : int
        Filaments of a blade that move, at most those of the lattice; the others are carried along.
    step_deg : float
        Spacing of the nodes that move [deg]; at least the time step.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    turns: float = 3.0
    core: float = 0.03
    n_filaments: int = 13
    step_deg: float = 10.0

    def __post_init__(self) -> None:
        """Refuse numbers of which no wake is made."""
        Range(0.25, 50.0).require("turns of a free wake", self.turns)
        Range(0.001, 0.5).require("core of a free wake", self.core)
        Range(3, 101).require("n_filaments of a free wake", self.n_filaments)
        Range(1.0, 45.0, "deg").require("step_deg of a free wake", self.step_deg)


@dataclasses.dataclass(frozen=True)
class Marching:
    """Schedule of a march in time; hashable.

    Attributes
    ----------
    revolutions : int
        Revolutions that are marched.
    average : int
        Last revolutions of which the loads are the mean.
    timestep_deg : float
        Angle by which the rotor turns in a step [deg]; a revolution is a whole number of steps.
    start : {"steady", "impulsive"}
        The march begins with circulation and wake of the steady solution in axial flight, or with
        no wake at all.
    wake_motion : {"prescribed", "free"}
        The wake moves by the law of the steady solution, or with the local velocity.
    free_wake : FreeWake
        Resolution of a free wake.
    tolerance : float
        Change of the thrust from one revolution to the next, over the thrust, that counts as none.
    stop_when_settled : bool
        Whether the march ends as soon as the revolutions of the mean, and the one before them,
        change no more.
    gust_speed : float
        Largest speed of a gust along the shaft, positive as the air of faster axial flight, which
        on an upright shaft comes from above; 0 is no gust [m/s].
    gust_shape : {"cosine", "step"}
        The gust comes and goes as (1 - cos)/2, or comes likewise and stays.
    gust_start, gust_length : float
        Revolutions before the gust, and over which it comes and goes, or comes.

    Raises
    ------
    ValueError
        If a number is out of range, the step does not divide a revolution, more revolutions are
        averaged than marched, or a gust is asked for that the steps do not show.
    """

    revolutions: int = 4
    average: int = 3
    timestep_deg: float = 3.0
    start: Start = "steady"
    wake_motion: WakeMotion = "prescribed"
    free_wake: FreeWake = FreeWake()
    tolerance: float = 0.01
    stop_when_settled: bool = False
    gust_speed: float = 0.0
    gust_shape: GustShape = "cosine"
    gust_start: float = 1.0
    gust_length: float = 1.0

    def __post_init__(self) -> None:
        """Refuse schedules that cannot be kept."""
        for name in ("revolutions", "average"):
            require_asked(name, value := getattr(self, name))
            if value != int(value):
                raise ValueError(f"{name} must be a whole number; it is {value:g}")
            # The attribute of a frozen dataclass can only be set this way.
            object.__setattr__(self, name, int(value))
        if self.average > self.revolutions:
            raise ValueError(
                f"average must be at most the revolutions, {self.revolutions:g}; it is"
                f" {self.average:g}"
            )
        require_asked("timestep_deg", self.timestep_deg)
        if abs(360.0 / self.timestep_deg - self.steps_per_turn) > 1e-9 * self.steps_per_turn:
            raise ValueError(
                f"timestep_deg must divide a revolution of 360 deg; it is {self.timestep_deg:.10g}"
            )
        known_words = ("start", Start), ("wake_motion", WakeMotion), ("gust_shape", GustShape)
        for name, words in known_words:
            if getattr(self, name) not in get_args(words):
                known = ", ".join(get_args(words))
                raise ValueError(f"{name} must be one of {known}; it is {getattr(self, name)!r}")
        Range(0.0, 1.0).require("tolerance", self.tolerance)
        self._check_gust()

    def _check_gust(self) -> None:
        """Refuse a gust that comes after the march or between its steps."""
        for name in ("gust_speed", "gust_start", "gust_length"):
            require_asked(name, getattr(self, name))
        if self.gust_speed == 0.0:
            for name in ("gust_shape", "gust_start", "gust_length"):
                if getattr(self, name) != getattr(Marching, name):
                    raise ValueError(f"{name} is about a gust: give gust_speed, too")
            return
        if not self.gust_start < self.revolutions:
            raise ValueError(
                f"gust_start must be below the revolutions of the march, {self.revolutions:g}; it"
                f" is {self.gust_start:g}"
            )
        least = 4.0 / self.steps_per_turn
        if self.gust_length < least:
            raise ValueError(
                f"gust_length must be at least four time steps, {least:.3g} revolutions; it is"
                f" {self.gust_length:g}"
            )

    @property
    def steps_per_turn(self) -> int:
        """Time steps of a revolution."""
        return round(360.0 / self.timestep_deg)

    @property
    def n_steps(self) -> int:
        """Time steps of the whole march."""
        return self.revolutions * self.steps_per_turn
