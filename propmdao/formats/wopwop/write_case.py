"""Cases for PSU-WOPWOP: namelists and files of rotors, observers and their motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from propmdao.acoustics.kinematics.motion import Frame, Motion
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.sources.moving_sources import AperiodicLoads, PeriodicLoads
from propmdao.acoustics.sources.rotors import Rotor
from propmdao.formats.wopwop.blade_files import blade_geometry, blade_loading
from propmdao.formats.wopwop.geometry_file import write_geometry
from propmdao.formats.wopwop.loading_file import write_loading
from propmdao.formats.wopwop.namelists.groups import write_namelists
from propmdao.records.air import Air
from propmdao.runtime.output_files import replacing_in

Groups = list[tuple[str, Mapping[str, Any]]]


def write_rotor_case(
    folder: str | Path,
    rotors: Sequence[Rotor],
    surfaces: Sequence[ArrayLike | None],
    observers: Observers,
    times: ArrayLike,
    air: Air,
    flight: Motion = (),
) -> None:
    """Write a case that PSU-WOPWOP, and `run_case`, can run.

    Parameters
    ----------
    folder : str or Path
        Folder to write to, made if it does not exist; files of the same names are replaced.
    rotors : sequence of Rotor
        Rotors of one aircraft; their panels are not used.
    surfaces : sequence of (n_contour, n_span, 3) array_like or None
        Points of `surface_nodes` of the blade of each rotor [m]; without them there is no thickness
        noise.
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array_like
        Uniform observer times [s].
    air : Air
        The undisturbed air.
    flight : Motion
        Motion of the aircraft; at rest by default.

    Raises
    ------
    ValueError
        If a blade has neither surface nor loads, or the folder cannot be written.

    Notes
    -----
    Forces become one line through the points they act on, from root to tip, with the force per
    length that the trapezoidal rule turns into the same forces again.
    """
    clock = np.asarray(times, float)
    with replacing_in(folder) as files:
        containers: Groups = [
            ("ContainerIn", _container("aircraft", flight, len(rotors))),
            *_bases(flight),
        ]
        for number, (rotor, nodes) in enumerate(zip(rotors, surfaces, strict=True), start=1):
            containers += _rotor(files, number, rotor, nodes, float(clock[1] - clock[0]))
        groups: Groups = [
            ("EnvironmentIn", _environment(len(observers.position))),
            ("EnvironmentConstants", {"rho": float(air.density), "c": float(air.sound_speed)}),
        ]
        groups += _observers(observers, clock) + containers
        write_namelists(files / "case.nam", groups)
        names = {"globalFolderName": "./", "caseNameFile": "case.nam"}
        write_namelists(files / "cases.nam", [("casename", names)])


def _environment(n_observers: int) -> dict[str, Any]:
    flags = ("acousticPressure", "thicknessNoise", "loadingNoise", "totalNoise", "spectrum")
    return {
        "nbSourceContainers": 1,
        "nbObserverContainers": n_observers,
        "ASCIIOutputFlag": True,
        "SPLdBFlag": True,
        **{f"{name}Flag": True for name in flags},
    }


def _observers(observers: Observers, clock: np.ndarray) -> Groups:
    groups: Groups = []
    moving = bool(np.any(observers.velocity))
    for number, place in enumerate(np.asarray(observers.position, float), start=1):
        values = {
            "title": f"observer {number}",
            "nt": clock.size,
            "tMin": float(clock[0]),
            "tMax": float(clock[-1]),
            **{f"{axis}Loc": float(x) for axis, x in zip("xyz", place, strict=True)},
            "nbBase": int(moving),
        }
        groups.append(("ObserverIn", values))
        if moving:
            translation = {"TranslationType": "KnownFunction", "VH": _list(observers.velocity)}
            groups.append(("CB", {"title": "observer motion"} | translation))
    return groups


def _rotor(folder: Path, number: int, rotor: Rotor, nodes: ArrayLike | None, step: float) -> Groups:
    geometry = blade_geometry(nodes, rotor.loads)
    write_geometry(folder / f"rotor{number}_geometry.dat", geometry)
    azimuths = np.atleast_1d(np.asarray(rotor.azimuths, float))
    turn = {
        "title": "rotation",
        "rotation": True,
        "AngleType": "KnownFunction",
        "Omega": float(rotor.rotation_speed),
        "Psi0": 0.0,
        "AxisType": "TimeIndependent",
        "AxisValue": [0.0, 0.0, 1.0],
    }
    values = _container(f"rotor {number}", rotor.mount, azimuths.size) | {"dTau": step}
    values["nbBase"] += 1
    groups: Groups = [("ContainerIn", values), *_bases(rotor.mount), ("CB", turn)]
    own_loads = isinstance(rotor.loads, AperiodicLoads)
    for blade, azimuth in enumerate(azimuths):
        container: dict[str, Any] = {
            "title": f"rotor {number} blade {blade + 1}",
            "nbBase": 1,
            "patchGeometryFile": f"rotor{number}_geometry.dat",
        }
        if rotor.loads is not None:
            name = f"rotor{number}_loading{blade + 1 if own_loads else ''}.dat"
            container["patchLoadingFile"] = name
            if own_loads or blade == 0:
                loading = blade_loading(
                    rotor.loads, len(geometry.zones), rotor.rotation_speed, blade
                )
                write_loading(folder / name, loading)
        if isinstance(rotor.loads, PeriodicLoads):
            container["periodicKeyOffset"] = float(np.sign(rotor.rotation_speed) * azimuth)
        fixed = {"AngleType": "TimeIndependent", "AngleValue": float(azimuth)}
        axis = {"AxisType": "TimeIndependent", "AxisValue": [0.0, 0.0, 1.0]}
        groups += [("ContainerIn", container), ("CB", {"title": "azimuth"} | fixed | axis)]
    return groups


def _container(title: str, motion: Motion, n_parts: int) -> dict[str, Any]:
    return {"title": title, "nbContainer": n_parts, "nbBase": len(motion)}


def _bases(motion: Motion) -> Groups:
    return [("CB", _base(frame)) for frame in motion]


def _base(frame: Frame) -> dict[str, Any]:
    values: dict[str, Any] = {
        "TranslationType": "KnownFunction",
        "AH": _list(frame.acceleration),
        "VH": _list(frame.velocity),
        "Y0": _list(frame.offset),
    }
    if not (np.any(frame.angle) or np.any(frame.rate) or np.any(frame.swing)):
        return values
    values |= {"AxisType": "TimeIndependent", "AxisValue": _list(frame.axis)}
    if not np.any(frame.swing):
        turn = {"AngleType": "KnownFunction", "Psi0": float(frame.angle)}
        return values | turn | {"Omega": float(frame.rate)}
    if np.any(frame.rate):
        raise ValueError("a frame that turns and swings takes two of PSU-WOPWOP's changes of base")
    values |= {"AngleType": "Periodic", "Omega": float(frame.swing_rate), "A0": float(frame.angle)}
    for letter, factors in zip("AB", np.asarray(frame.swing), strict=True):
        values |= {f"{letter}{k}": -float(q) for k, q in enumerate(factors, start=1)}
    return values


def _list(vector: Any) -> list[float]:
    return [float(x) for x in np.asarray(vector)]
