"""Cases of PSU-WOPWOP: observers and sources, their motion, and the files of the sources."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.motion import Frame, Motion
from propmdao.formats.wopwop.bases import change_of_base, observer_points, uniform_motion
from propmdao.formats.wopwop.namelists import Group, read_namelists

# Groups that may follow a container or observer, and what they are about, which is not computed.
_ELSEWHERE = {
    "bpmin": "broadband noise of this container",
    "peggin": "broadband noise of this container",
    "bwiin": "broadband noise of this container",
    "rangein": "the frequency range of the spectra",
}


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


@dataclass
class _Parser:
    """Takes the groups of a case file one after another: their order says what belongs together."""

    groups: list[Group]
    position: int = 0
    containers: list[Container] = field(default_factory=list)
    chains: dict[str, Motion] = field(default_factory=dict)

    def case(self, name: str) -> Case:
        environment = self.take("environmentin")
        if environment.values.get("broadbandflag"):
            warnings.warn(f"{environment}: broadband noise is not computed", stacklevel=4)
        air = self.take("environmentconstants")
        density, sound_speed = air.number("rho"), air.number("c")
        if not (density > 0 and sound_speed > 0):
            raise air.error(f"rho and c must be positive; they are {density:g}, {sound_speed:g}")
        later: list[Callable[[], ObserverGrid]] = []
        for _ in range(environment.count("nbobservercontainers", 1)):
            later.append(self.observers())
        for _ in range(environment.count("nbsourcecontainers", 1)):
            self.container((), None)
        if self.position < len(self.groups):
            raise self.groups[self.position].error("one group more than the containers ask for")
        return Case(
            name,
            density,
            sound_speed,
            bool(environment.values.get("thicknessnoiseflag", True)),
            bool(environment.values.get("loadingnoiseflag", True)),
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

    def chain(self, owner: Group) -> Motion:
        motion: list[Frame] = []
        left = owner.count("nbbase", 0)
        while left or self.next_is_elsewhere():
            group = self.take("cb", *_ELSEWHERE)
            if group.name == "cb":
                motion += change_of_base(group)
                left -= 1
            else:
                warnings.warn(
                    f"{owner}: &{group.name} has no effect: {_ELSEWHERE[group.name]} "
                    "is not computed",
                    stacklevel=5,
                )
        return tuple(motion)

    def next_is_elsewhere(self) -> bool:
        return self.position < len(self.groups) and self.groups[self.position].name in _ELSEWHERE

    def container(self, outer: Motion, step: float | None) -> None:
        group = self.take("containerin")
        motion = (*outer, *self.chain(group))
        if "dtau" in group.values:
            step = group.number("dtau")
        elif "ntau" in group.values:
            steps = max(group.count("ntau") - 1, 1)
            step = (group.number("taumax") - group.number("taumin")) / steps
        if step is not None and not step > 0:
            raise group.error(f"dTau must be positive; it is {step:g}")
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
            self.container(motion, step)

    def observers(self) -> Callable[[], ObserverGrid]:
        group = self.take("observerin")
        own = self.chain(group)
        n, t_min, t_max = group.count("nt"), group.number("tmin"), group.number("tmax")
        if n < 2 or not t_max > t_min:
            raise group.error(f"nt must be 2 or more, tMax above tMin; got {n}, {t_min}, {t_max}")
        band = (
            group.number("highpassfrequency", 0.0),
            group.number("lowpassfrequency", np.inf),
        )
        points = observer_points(group)

        def place_observers() -> ObserverGrid:
            attached = group.text("attachedto")
            if attached and attached.lower() not in self.chains:
                raise group.error(f"attachedTo {attached!r}: there is no such container")
            chain = (*self.chains[attached.lower()], *own) if attached else own
            position, velocity = uniform_motion(group, chain, points)
            times = np.linspace(t_min, t_max, n)
            return ObserverGrid(group.text("title") or "", position, velocity, times, band)

        return place_observers
