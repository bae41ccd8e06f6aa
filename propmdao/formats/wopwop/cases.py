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
from propmdao.formats.wopwop.namelists.bases import (
    MOST_OBSERVERS,
    Turning,
    change_of_base,
    observer_points,
    rotor_azimuth,
    uniform_motion,
)
from propmdao.formats.wopwop.namelists.broadband_groups import (
    BpmNoise,
    PeggNoise,
    bpm_noise,
    pegg_noise_of,
)
from propmdao.formats.wopwop.namelists.case_records import (
    BroadbandContainer,
    Case,
    Container,
    ObserverGrid,
    Wanted,
)
from propmdao.formats.wopwop.namelists.groups import Group, read_namelists
from propmdao.records.air import Air

# Groups of broadband noise that may follow a container, and the keys that ask for it.
_METHODS = {"bpmin": "bpmnoiseflag", "peggin": "peggnoiseflag"}
# Groups of what is not computed.
_NOT_DONE = {
    "bwiin": "noise of blades and wakes (&BWIIn) is not computed",
    "rangein": "levels of frequency ranges (&RangeIn) are not worked out",
}
_WINDOWS = {"hanning window": "hann"}
# Air of PSU-WOPWOP 3.4.3 where a case does not give it: kg/m^3, m/s. What absorbs sound is that of
# the standard atmosphere, J/(kg K), and as humid as ours.
_USUAL_AIR = {"rho": 1.225, "c": 342.0}
_GAS_CONSTANT, _HEAT_RATIO, _HUMIDITY = 287.05287, 1.4, 100.0 * float(Air().relative_humidity)
# Containers within each other, times of a record, pressures of a case (0.4 GiB for each source) and
# source times in a record, beyond which a file is damaged rather than a case.
_DEEPEST, _MOST_TIMES, _MOST_PRESSURES, _MOST_STEPS = 50, 1 << 20, 1 << 24, 1 << 20


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
    shaft: _Shaft | None = None
    step: float | None = None
    depth: int = 1


class _Shaft(NamedTuple):
    """The innermost base that turns with the rotor: its rate [rad/s], axis and what is around."""

    rate: float
    axis: NDArray[np.float64]
    motion: Motion


@dataclass
class _Parser:
    """Takes the groups of a case file one after another: their order says what belongs together."""

    groups: list[Group]
    position: int = 0
    n_observers: int = 0
    n_pressures: int = 0
    longest: float = 0.0
    is_broadband: bool = False
    containers: list[Container] = field(default_factory=list)
    broadband: list[BroadbandContainer] = field(default_factory=list)
    chains: dict[str, Motion] = field(default_factory=dict)

    def case(self, name: str) -> Case:
        environment = self.take("environmentin")
        thickness, loading = _sources(environment)
        self.is_broadband = environment.flag("broadbandflag")
        air = self.air()
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
            air,
            thickness,
            loading,
            _wanted(environment),
            tuple(self.containers),
            tuple(self.broadband),
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

    def air(self) -> Air:
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
        gas, ratio = (
            air.number(key, usual)
            for key, usual in (("gasconstant", _GAS_CONSTANT), ("gamma", _HEAT_RATIO))
        )
        viscosity = air.number("mu", float(Air().dynamic_viscosity))
        if "nu" in air.values:
            viscosity = air.number("nu") * density
        humidity = air.number("relhumidity", _HUMIDITY)
        if not (gas > 0 and ratio > 0 and viscosity > 0 and 0.0 <= humidity <= 100.0):
            raise air.error(
                "gasConstant, gamma and viscosity must be positive, RelHumidity within 0 ... 100;"
                f" they are {gas:g}, {ratio:g}, {viscosity:g}, {humidity:g}"
            )
        temperature = sound_speed**2 / (ratio * gas)
        return Air(
            density, sound_speed, viscosity, temperature, density * gas * temperature,
            0.01 * humidity,
        )  # fmt: skip

    def chain(self, owner: Group, key: str) -> Motion:
        """Return the changes of base that follow a group of observers."""
        motion: list[Frame] = []
        for _ in range(owner.count(key, 0)):
            motion += change_of_base(self.take("cb"), None)
        self.refuse_not_done(owner)
        return tuple(motion)

    def chain_of_sources(
        self, owner: Group, around: _Surrounding
    ) -> tuple[_Surrounding, dict[str, Group]]:
        """Return what a container hands on, without its step, and its groups of broadband noise."""
        motion, rotor, shaft = around.motion, around.rotor, around.shaft
        methods: dict[str, Group] = {}
        left = owner.count("nbbase", 0)
        while left or self.next_name() in (*_METHODS, *_NOT_DONE):
            self.refuse_not_done(owner)
            group = self.take("cb", *_METHODS)
            if group.name == "cb":
                frames = change_of_base(group, rotor)
                if (turning := rotor_azimuth(group)) is not None:
                    rotor = turning
                    outside = (*motion, *frames[:-1])
                    shaft = _Shaft(turning.rate, np.array(group.vector("axisvalue")), outside)
                motion = (*motion, *frames)
                left -= 1
            else:
                methods[group.name] = group
        return around._replace(motion=motion, rotor=rotor, shaft=shaft), methods

    def refuse_not_done(self, owner: Group) -> None:
        """Refuse a group of what is not computed."""
        if (name := self.next_name()) in _NOT_DONE:
            raise owner.error(_NOT_DONE[name])

    def next_name(self) -> str:
        return self.groups[self.position].name if self.position < len(self.groups) else ""

    def container(self, around: _Surrounding) -> None:
        group = self.take("containerin")
        if around.depth > _DEEPEST:
            raise group.error(f"containers must be at most {_DEEPEST} deep within each other")
        within, methods = self.chain_of_sources(group, around)
        motion = within.motion
        step = _step(group, self.longest)
        if step is None:
            step = around.step
        title = group.text("title") or ""
        self.chains[title.lower()] = motion
        first = len(self.containers)
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
            self.container(within._replace(step=step, depth=around.depth + 1))
        noises = _broadband(group, methods)
        if noises and not self.is_broadband:
            warnings.warn(f"{group}: its noise is not heard: broadbandFlag is off", stacklevel=4)
        for noise in noises if self.is_broadband else ():
            shaft = within.shaft
            self.broadband.append(
                BroadbandContainer(
                    str(group),
                    motion,
                    None if shaft is None else shaft.rate,
                    None if shaft is None else shaft.axis,
                    motion if shaft is None else shaft.motion,
                    noise,
                    tuple(self.containers[first:]),
                )
            )

    def observers(self) -> Callable[[], ObserverGrid]:
        group = self.take("observerin")
        own, around, local = (
            self.chain(group, f"nbbase{kind}") for kind in ("", "obscontframe", "localframe")
        )
        n = group.count("nt", least=2, most=_MOST_TIMES)
        t_min, t_max = group.number("tmin"), group.number("tmax")
        if not t_max > t_min:
            raise group.error(f"tMax must be above tMin; they are {t_max:g} and {t_min:g}")
        band = (
            group.number("highpassfrequency", 0.0),
            group.number("lowpassfrequency", np.inf),
        )
        points, shape = observer_points(group)
        listening = _listening(group, t_max - t_min)
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
            title = group.text("title") or ""
            return ObserverGrid(title, position, velocity, times, band, shape, *listening)

        return place_observers


def _sources(environment: Group) -> tuple[bool, bool]:
    """Return whether thickness and loading noise are wanted: the total takes both."""
    thickness, loading, total = (
        environment.flag(f"{name}noiseflag") for name in ("thickness", "loading", "total")
    )
    total = total or not (thickness or loading)
    return thickness or total, loading or total


def _wanted(environment: Group) -> Wanted:
    """Return which results are asked for; files are binary unless text is asked for."""
    return Wanted(
        *(
            environment.flag(f"{name}flag")
            for name in (
                "spectrum", "spldba", "oaspldb", "oaspldba", "sel", "pnlt", "epnl", "asciioutput",
            )
        )
    )  # fmt: skip


def _broadband(container: Group, methods: dict[str, Group]) -> list[BpmNoise | PeggNoise]:
    """Return the broadband noise that a container asks for."""
    noises: list[BpmNoise | PeggNoise] = []
    for name, flag in _METHODS.items():
        if not container.flag(flag):
            if name in methods:
                warnings.warn(f"{container}: &{name} has no effect: {flag} is off", stacklevel=5)
            continue
        if name not in methods:
            raise container.error(f"{flag} needs a &{name} group behind the container")
        group = methods[name]
        noises.append(bpm_noise(group) if name == "bpmin" else pegg_noise_of(group))
    return noises


def _listening(group: Group, length: float) -> tuple[float, float, str, bool, bool]:
    """Return segment, step, window, whether third octaves are wanted and whether air absorbs."""
    segment = group.number("segmentsize", length)
    step = group.number("segmentstepsize", segment)
    if not (0.0 < segment <= length * (1.0 + 1e-9) and step > 0.0):
        raise group.error(
            f"segmentSize must be within the record of {length:g} s and segmentStepSize above 0;"
            f" they are {segment:g} and {step:g}"
        )
    name = group.text("windowfunction")
    window = "boxcar" if not name else _WINDOWS.get(name.lower())
    if window is None:
        raise group.error(f"windowFunction {name!r} is not done, only 'Hanning Window'")
    octaves = group.flag("octaveflag")
    if octaves and group.number("octavenumber", 3) != 3:
        raise group.error("octaveNumber must be 3: levels are of third octaves")
    return min(segment, length), step, window, octaves, group.flag("atmatten")


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
