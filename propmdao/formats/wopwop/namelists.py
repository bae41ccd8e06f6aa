"""Fortran namelists of PSU-WOPWOP: the groups of a file in order, with every key accounted for."""

from __future__ import annotations

import contextlib
import io
import math
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import f90nml  # type: ignore[import-untyped]

from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.runtime.input_files import read_text
from propmdao.runtime.output_files import replacing

#: Numbers of the harmonics of angles that change periodically, A1 ... and B1 ...
HARMONICS = range(1, 10)

# Keys that are read by `cases`, and after the bar those that only choose what PSU-WOPWOP writes,
# or label it.
_KEYS = {
    "casename": "globalfoldername casenamefile |",
    "environmentin": "nbsourcecontainers nbobservercontainers thicknessnoiseflag loadingnoiseflag "
    "totalnoiseflag broadbandflag | acousticpressureflag spectrumflag spldbflag spldbaflag "
    "oaspldbflag oaspldbaflag sigmaflag audioflag asciioutputflag debuglevel loadingsigmaflag "
    "pressuresigmaflag normalsigmaflag observersigmaflag loadingnoisesigmaflag "
    "thicknessnoisesigmaflag totalnoisesigmaflag accelerationsigmaflag mdotrsigmaflag "
    "velocitysigmaflag machsigmaflag areasigmaflag iblanksigmaflag densitysigmaflag "
    "momentumsigmaflag geomsigmaflag pressurefoldername pressurefilename splfoldername "
    "spectrumfilename oasplfilename sigmafoldername audiofoldername",
    "environmentconstants": "rho c | p_ref gamma mu nu relhumidity gasconstant",
    "observerin": "nt tmin tmax nbbase attachedto xloc yloc zloc nbx xmin xmax nby ymin ymax nbz "
    "zmin zmax radius nbtheta thetamin thetamax nbpsi psimin psimax highpassfrequency "
    "lowpassfrequency title filename | octaveflag octavenumber octaveapproxflag",
    "containerin": "title nbcontainer nbbase dtau ntau taumin taumax patchgeometryfile "
    "patchloadingfile periodickeyoffset peggnoiseflag bpmnoiseflag bwinoiseflag | prefix",
    "cb": "translationtype translationvalue ah vh y0 angletype anglevalue omega psi0 axistype "
    "axisvalue title a0 " + " ".join(f"a{k} b{k}" for k in HARMONICS) + " | rotation",
}


@dataclass(frozen=True)
class Group:
    """One namelist group.

    Attributes
    ----------
    name : str
        Name in lower case, without the ampersand.
    values : mapping
        Lower-case keys to numbers, texts, logicals or lists of them.
    path : Path
        Namelist file that the group is in.
    """

    name: str
    values: Mapping[str, Any]
    path: Path

    def __str__(self) -> str:
        title = self.values.get("title")
        return f"{self.path}: &{self.name}" + (f" {title!r}" if title else "")

    def error(self, message: str) -> WopwopFileError:
        """Return the error to raise about this group."""
        return WopwopFileError(f"{self}: {message}")

    def number(self, key: str, default: float | None = None) -> float:
        """Return a number, or the default; refuse the file if there is neither."""
        value = self.values.get(key, default)
        if value is None or (key in self.values and not _is_number(value)):
            raise self.error(f"{key} must be a number; " + _it_is(value))
        return float(value)

    def count(self, key: str, default: int | None = None) -> int:
        """Return a whole number of at least 0, or the default."""
        value = self.values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or value < 0:
            raise self.error(f"{key} must be a whole number, 0 or more; " + _it_is(value))
        return value

    def vector(self, key: str) -> tuple[float, float, float]:
        """Return three numbers, zeros if they are not given."""
        value = self.values.get(key, [0.0, 0.0, 0.0])
        if not isinstance(value, list) or not all(map(_is_number, value)) or len(value) != 3:
            raise self.error(f"{key} must be three numbers; " + _it_is(value))
        return float(value[0]), float(value[1]), float(value[2])

    def text(self, key: str) -> str | None:
        """Return a text or None."""
        value = self.values.get(key)
        if value is not None and not isinstance(value, str):
            raise self.error(f"{key} must be a text in quotes; " + _it_is(value))
        return value


def read_namelists(path: str | Path) -> list[Group]:
    """Read the groups of a namelist file.

    Parameters
    ----------
    path : str or Path
        Namelist file.

    Returns
    -------
    list of Group
        The groups in order. A `UserWarning` names every key that is not known.

    Raises
    ------
    WopwopFileError
        If the file is missing or holds no namelist.
    """
    path = Path(path)
    text = read_text(path, WopwopFileError, complaint=str(path), encoding="latin-1")
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # it prints its tables on broken quotes
            parsed = f90nml.reads(text)
    except Exception as error:  # the parser fails on foreign text in any way it likes
        reason = " ".join(str(error).split()) or type(error).__name__
        raise WopwopFileError(f"{path}: not a Fortran namelist file ({reason})") from None
    groups = [Group(str(name).lower(), dict(values), path) for name, values in parsed.items()]
    if not groups:
        raise WopwopFileError(f"{path}: not a Fortran namelist file (no &group in it)")
    for group in groups:
        if group.name in _KEYS:
            known = {*_KEYS[group.name].split()}
            for key in group.values:
                if key not in known:
                    warnings.warn(f"{group}: {key} is not known and has no effect", stacklevel=2)
    return groups


def write_namelists(path: str | Path, groups: Iterable[tuple[str, Mapping[str, Any]]]) -> None:
    """Write a namelist file.

    Parameters
    ----------
    path : str or Path
        File to write.
    groups : iterable of (str, mapping)
        Names and values of the groups, in the order of the file; names may repeat.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    out = io.StringIO()
    for name, values in groups:
        f90nml.Namelist({name: dict(values)}).write(out)
    with replacing(path) as file:
        file.write_text(out.getvalue(), encoding="latin-1")


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _it_is(value: Any) -> str:
    return "it is missing" if value is None else f"it is {value!r}"
