"""Keys of PSU-WOPWOP's namelists: which are read, and which ask for what is not done here.

Names are those of PSU-WOPWOP 3.4.3's own namelists.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

#: Numbers of the harmonics of angles that change periodically, A1 ... and B1 ...
HARMONICS = range(1, 10)

# Keys that are read, and after the bar those that only label or choose among what is always given.
_KEYS = {
    "casename": "globalfoldername casenamefile |",
    "environmentin": "nbsourcecontainers nbobservercontainers thicknessnoiseflag loadingnoiseflag "
    "totalnoiseflag | acousticpressureflag spectrumflag spldbflag oaspldbflag oaspldbaflag splflag "
    "oasplflag narrowbandflag asciioutputflag debuglevel loadingsigmaflag "
    "pressuresigmaflag normalsigmaflag observersigmaflag observercontainersigmaflag "
    "loadingnoisesigmaflag thicknessnoisesigmaflag totalnoisesigmaflag accelerationsigmaflag "
    "mdotrsigmaflag velocitysigmaflag machsigmaflag areasigmaflag iblanksigmaflag iblankflag "
    "densitysigmaflag momentumsigmaflag geomsigmaflag sigmastructuredformat "
    "sigmaunstructuredformat pressurefoldername pressurefilename splfoldername splfilename "
    "spectrumfilename oasplfilename phasefilename complexpressurefilename sigmafoldername "
    "sigmafilename audiofoldername audiofilename parth36flag forceepnl forcesel",
    "environmentconstants": "rho c | gamma mu nu relhumidity gasconstant epsilon",
    "observerin": "nt tmin tmax nbbase attachedto nbbaseobscontframe nbbaselocalframe xloc yloc "
    "zloc nbx xmin xmax nby ymin ymax nbz zmin zmax radius nbtheta thetamin thetamax nbpsi psimin "
    "psimax highpassfrequency lowpassfrequency title filename | octavenumber octaveapproxflag",
    "containerin": "title nbcontainer nbbase dtau ntau taumin taumax patchgeometryfile "
    "patchloadingfile periodickeyoffset | prefix ispermeable",
    "cb": "translationtype translationvalue ah vh y0 angletype anglevalue omega psi0 axistype "
    "axisvalue title rotation windframe a0 " + " ".join(f"a{k} b{k}" for k in HARMONICS) + " |",
}

_BROADBAND = "broadband noise is not computed"
_CERTIFICATION = "levels of certification are not worked out"
_SEGMENTS = "the record is taken as a whole"
# What keys ask for if they are set, and that it is not done.
_NOT_DONE = {
    "environmentin": {
        "broadbandflag": _BROADBAND,
        "spldbaflag": "the spectrum is not A-weighted, only the overall level is",
        "audioflag": "no sound file is written",
        "sigmaflag": "no data on the surfaces are written",
        "pressuregradientflag": "pressure gradients are not computed",
        "pressuregradient1aflag": "pressure gradients are not computed",
        "phaseflag": "phases are not written",
        "complexpressureflag": "complex pressures are not written",
        "pnlflag": _CERTIFICATION,
        "pnltflag": _CERTIFICATION,
        "epnlflag": _CERTIFICATION,
        "selflag": _CERTIFICATION,
        "faacertflag": _CERTIFICATION,
        "readinpressureflag": "pressures are computed, not read",
        "isomsthicknessnoiseflag": "thickness noise is by Formulation 1A",
    },
    "environmentconstants": {"integrationtype": "noise is computed in the time domain"},
    "observerin": {
        "octaveflag": "levels in octave bands are not worked out",
        "atmatten": "absorption by the air is left out",
        "windowfunction": "spectra are without a window",
        "segmentsize": _SEGMENTS,
        "segmentstepsize": _SEGMENTS,
        "segmentincrement": _SEGMENTS,
        "nbharmonics": "all harmonics are kept",
        "nbfreqranges": "levels are of the whole band",
        "indexswap": "theta stays the first index",
        "fscoutputflag": "no such file is written",
    },
    "containerin": {
        "peggnoiseflag": _BROADBAND,
        "bpmnoiseflag": _BROADBAND,
        "bwinoiseflag": _BROADBAND,
    },
}
_REFERENCE_PRESSURE = 20e-6


def without_effect(name: str, values: Mapping[str, Any]) -> Iterator[str]:
    """Keys of a group that change nothing here, though they are set.

    Parameters
    ----------
    name : str
        Name of the group in lower case.
    values : mapping
        Values of the group by their keys in lower case.

    Yields
    ------
    str
        Text for each such key: its name, and what is not done.
    """
    if name not in _KEYS:
        return
    known, not_done = {*_KEYS[name].split()}, _NOT_DONE.get(name, {})
    for key, value in values.items():
        if key in not_done:
            if value:
                yield f"{key} has no effect: {not_done[key]}"
        elif key == "p_ref" and name == "environmentconstants":
            if value != _REFERENCE_PRESSURE:
                yield f"{key} has no effect: levels are in dB re 20 uPa"
        elif key not in known:
            yield f"{key} is not known and has no effect"
