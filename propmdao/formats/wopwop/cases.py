"""Cases of PSU-WOPWOP: observers and sources, their motion, and the files of the sources."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.motion import Frame, Motion
from propmdao.formats.wopwop.bases import (
    MOST_OBSERVERS,
    Turning,
    change_of_base,
    observer_points,
    rotor_azimuth,
    uniform_motion,
)
from propmdao.formats.wopwop.namelists.groups import Group, read_namelists

# Groups that may follow a container or observer, and what they are about, which is not computed.
_ELSEWHERE = {
    "bpmin": "broadband noise of this container",
    "peggin": "broadband noise of this container",
    "bwiin": "broadband noise of this container",
    "rangein": "the frequency range of the spectra",
}
# Air of PSU-WOPWOP 3.4.3 where a case does not give it: kg/m^3, m/s.
_USUAL_AIR = {"rho": 1.225, "c": 342.0}
# Containers within each other, times of a record, pressures of a case (0.4 GiB for each source) and
# source times in a record, beyond which a file is damaged rather than a case.
_DEEPEST, _MOST_TIMES, _MOST_PRESSURES, _MOST_STEPS = 50, 1 << 20, 1 << 24, 1 << 20


@dataclass(frozen=True)
class Container:
    """A container with its own files, at the end of its chain of frames.

    Attributes
    ----------
    title : str
        Title of the container itself.
    motion : Motion
        Changes of base from the ground to the container.
    geometry : Path
        Geometry file.
    loading : Path or None
        Loading file; a container without one has thickness noise only.
    key_offset : float
        Offset of the periodic keys of the files, ``periodicKeyOffset``.
    step : float or None
        Step of the source times [s], the container's own or that of the container around it.
    """

    title: str
    motion: Motion
    geometry: Path
    loading: Path | None
    key_offset: float
    step: float | None


@dataclass(frozen=True)
class ObserverGrid:
    """Observers that listen together.

    Attributes
    ----------
    title : str
        Title of the observers.
    position : (n, 3) array
        Positions on the ground at time 0, the first index of the grid fastest [m].
    velocity : (3,) array
        Velocity on the ground [m/s].
    times : (n_times,) array
        Observer times [s].
    band_hz : tuple of float
        High-pass and low-pass frequency [Hz], 0 and infinity if not filtered.
    """

    title: str
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    times: NDArray[np.float64]
    band_hz: tuple[float, float]


@dataclass(frozen=True)
class Case:
    """A case of PSU-WOPWOP: its air, sources and observers.

    Attributes
    ----------
    name : str
        Name of the case's namelist file.
    density, sound_speed : float
        Density [kg/m^3] and speed of sound [m/s] of the air.
    thickness, loading : bool
        True for the kinds of noise that are wanted.
    containers : tuple of Container
        Containers that have files.
    observers : tuple of ObserverGrid
        All observers.
    """

    name: str
    density: float
    sound_speed: float
    thickness: bool
    loading: bool
    containers: tuple[Container, ...]
    observers: tuple[ObserverGrid, ...]


def read_cases(folder: str | Path) -> list[Case]:
    """Read ``cases.nam`` of a folder and the cases that it names.

    Parameters
    ----------
    folder : str or Path
        Folder with ``cases.nam``. A case whose ``globalFolderName`` does not exist is looked for
        beside ``cases.nam``.

    Returns
    -------
    list of Case
        The cases in order. A `UserWarning` names every key and group without effect.

    Raises
    ------
    WopwopFileError
        If a file is missing or describes an impossible case.
    """
    folder = Path(folder)
    groups = read_namelists(folder / "cases.nam")
    cases = []
    for group in groups:
        name = group.text("casenamefile") if group.name == "casename" else None
        if name is None:
            raise group.error("cases.nam takes &casename groups with a caseNameFile")
        home = folder / (group.text("globalfoldername") or ".")
        if not (home / name).is_file():
            home = folder
        cases.append(_Parser(read_namelists(home / name)).case(name))
    return cases


class _Surrounding(NamedTuple):
    """What a container hands on to those within it."""

    motion: Motion = ()
    rotor: Turning | None = None
    step: float | None = None
    depth: int = 1


@dataclass
class _Parser:
    """Takes the groups of a case file one after another: their order says what belongs together."""

    groups: list[Group]
    position: int = 0
    n_observers: int = 0
    n_pressures: int = 0
    longest: float = 0.0
    containers: list[Container] = field(default_factory=list)
    chains: dict[str, Motion] = field(default_factory=dict)

    def case(self, name: str) -> Case:
        environment = self.take("environmentin")
        thickness, loading = _sources(environment)
        density, sound_speed = self.air()
        later = [self.observers() for _ in range(environment.count("nbobservercontainers", 1, 1))]
        for _ in range(environment.count("nbsourcecontainers", 1, 1)):
            self.container(_Surrounding())
        if left := len(self.groups) - self.position:
            also = f" and the {left - 1} behind it" if left > 1 else ""
            warnings.warn(
                f"{self.groups[self.position]}: it{also} has no effect: the case is complete "
                "before it",
                stacklevel=4,
            )
        return Case(
            name,
            density,
            sound_speed,
            thickness,
            loading,
            tuple(self.containers),
            tuple(make() for make in later),  # only now are the containers known to attach to
        )

    def take(self, *names: str) -> Group:
        if self.position == len(self.groups):
            raise self.groups[-1].error(f"the file ends behind it; &{names[0]} is missing")
        group = self.groups[self.position]
        if group.name not in names:
            raise group.error(f"&{names[0]} expected here")
        self.position += 1
        return group

    def air(self) -> tuple[float, float]:
        air = self.take("environmentconstants")
        for key, usual in _USUAL_AIR.items():
            if key not in air.values:
                warnings.warn(
                    f"{air}: {key} is not given; it is {usual:g}, as PSU-WOPWOP has it",
                    stacklevel=5,
                )
        density, sound_speed = (air.number(key, usual) for key, usual in _USUAL_AIR.items())
        if not (density > 0 and sound_speed > 0):
            raise air.error(f"rho and c must be positive; they are {density:g}, {sound_speed:g}")
        return density, sound_speed

    def chain(
        self, owner: Group, key: str, rotor: Turning | None = None
    ) -> tuple[Motion, Turning | None]:
        """Return the changes of base that follow a group, and the rotor that they are within."""
        motion: list[Frame] = []
        left = owner.count(key, 0)
        while left or self.next_is_elsewhere():
            group = self.take("cb", *_ELSEWHERE)
            if group.name == "cb":
                motion += change_of_base(group, rotor)
                rotor = rotor_azimuth(group) or rotor
                left -= 1
            else:
                warnings.warn(
                    f"{owner}: &{group.name} has no effect: {_ELSEWHERE[group.name]} "
                    "is not computed",
                    stacklevel=5,
                )
        return tuple(motion), rotor

    def next_is_elsewhere(self) -> bool:
        return self.position < len(self.groups) and self.groups[self.position].name in _ELSEWHERE

    def container(self, around: _Surrounding) -> None:
        group = self.take("containerin")
        if around.depth > _DEEPEST:
            raise group.error(f"containers must be at most {_DEEPEST} deep within each other")
        own, rotor = self.chain(group, "nbbase", around.rotor)
        motion = (*around.motion, *own)
        step = _step(group, self.longest)
        if step is None:
            step = around.step
        title = group.text("title") or ""
        self.chains[title.lower()] = motion
        geometry, loading = (group.text(f"patch{kind}file") for kind in ("geometry", "loading"))
        if geometry is not None or loading is not None:
            if geometry is None:
                raise group.error("a patchLoadingFile needs a patchGeometryFile")
            home = group.path.parent
            self.containers.append(
                Container(
                    title,
                    motion,
                    home / geometry,
                    None if loading is None else home / loading,
                    group.number("periodickeyoffset", 0.0),
                    step,
                )
            )
        for _ in range(group.count("nbcontainer", 0)):
            self.container(_Surrounding(motion, rotor, step, around.depth + 1))

    def observers(self) -> Callable[[], ObserverGrid]:
        group = self.take("observerin")
        own, _ = self.chain(group, "nbbase")
        around, _ = self.chain(group, "nbbaseobscontframe")
        local, _ = self.chain(group, "nbbaselocalframe")
        n = group.count("nt", least=2, most=_MOST_TIMES)
        t_min, t_max = group.number("tmin"), group.number("tmax")
        if not t_max > t_min:
            raise group.error(f"tMax must be above tMin; they are {t_max:g} and {t_min:g}")
        band = (
            group.number("highpassfrequency", 0.0),
            group.number("lowpassfrequency", np.inf),
        )
        points = observer_points(group)
        self.n_observers += len(points)
        self.n_pressures += n * len(points)
        self.longest = max(self.longest, t_max - t_min)
        if self.n_observers > MOST_OBSERVERS or self.n_pressures > _MOST_PRESSURES:
            raise group.error(
                f"a case must have at most {MOST_OBSERVERS} observers and {_MOST_PRESSURES} "
                f"pressures, nt of each observer; with this group it has {self.n_observers} and "
                f"{self.n_pressures}"
            )

        def place_observers() -> ObserverGrid:
            attached = group.text("attachedto")
            if attached and attached.lower() not in self.chains:
                raise group.error(f"attachedTo {attached!r}: there is no such container")
            chain = (*around, *(self.chains[attached.lower()] if attached else ()), *local, *own)
            position, velocity = uniform_motion(group, chain, points)
            times = np.linspace(t_min, t_max, n)
            return ObserverGrid(group.text("title") or "", position, velocity, times, band)

        return place_observers


def _sources(environment: Group) -> tuple[bool, bool]:
    """Return whether thickness and loading noise are wanted: the total takes both."""
    thickness, loading, total = (
        environment.flag(f"{name}noiseflag") for name in ("thickness", "loading", "total")
    )
    total = total or not (thickness or loading)
    return thickness or total, loading or total


def _step(group: Group, longest: float) -> float | None:
    """Step of the source times that a container gives; 0 is PSU-WOPWOP's for none."""
    step = group.number("dtau", 0.0)
    if step == 0.0 and group.count("ntau", 0):
        step = (group.number("taumax") - group.number("taumin")) / group.count("ntau")
    least = longest / _MOST_STEPS
    if step and not step >= least:
        raise group.error(
            f"dTau must be {least:.3g} s or more, for a record of {longest:.3g} s, "
            f"or 0 for the observers' step; it is {step:g}"
        )
    return step or None
