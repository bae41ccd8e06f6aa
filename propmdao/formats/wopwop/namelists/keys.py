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
    "totalnoiseflag broadbandflag spectrumflag spldbaflag oaspldbflag oaspldbaflag selflag "
    "pnltflag epnlflag asciioutputflag | acousticpressureflag spldbflag splflag oasplflag "
    "narrowbandflag debuglevel loadingsigmaflag "
    "pressuresigmaflag normalsigmaflag observersigmaflag observercontainersigmaflag "
    "loadingnoisesigmaflag thicknessnoisesigmaflag totalnoisesigmaflag accelerationsigmaflag "
    "mdotrsigmaflag velocitysigmaflag machsigmaflag areasigmaflag iblanksigmaflag iblankflag "
    "densitysigmaflag momentumsigmaflag geomsigmaflag sigmastructuredformat "
    "sigmaunstructuredformat pressurefoldername pressurefilename splfoldername splfilename "
    "spectrumfilename oasplfilename phasefilename complexpressurefilename sigmafoldername "
    "sigmafilename audiofoldername audiofilename parth36flag forcesel resultsfoldername",
    "environmentconstants": "rho c gamma mu nu relhumidity gasconstant | epsilon",
    "observerin": "nt tmin tmax nbbase attachedto nbbaseobscontframe nbbaselocalframe xloc yloc "
    "zloc nbx xmin xmax nby ymin ymax nbz zmin zmax radius nbtheta thetamin thetamax nbpsi psimin "
    "psimax highpassfrequency lowpassfrequency title filename segmentsize segmentstepsize "
    "windowfunction octaveflag octavenumber atmatten | octaveapproxflag",
    "containerin": "title nbcontainer nbbase dtau ntau taumin taumax patchgeometryfile "
    "patchloadingfile periodickeyoffset bpmnoiseflag peggnoiseflag | prefix ispermeable",
    "bpmin": "bpmnoisefile nsect uniformblade bltrip sectchordflag sectchord sectlengthflag "
    "sectlength tethicknessflag tethickness teflowangleflag teflowangle tiplcsflag tiplcs "
    "sectaoaflag sectaoa uflag u lblvsnoise tbltenoise bluntnoise bladetipnoise roundbladetip "
    "directivityflag |",
    "peggin": "totalbladeareaflag totalbladearea bladeradiusflag bladeradius rotspeedflag rotspeed "
    "clbarflag clbar totalthrustflag totalthrust hubaxisflag hubaxis | spreadbands "
    "keepenergyconst",
    "cb": "translationtype translationvalue ah vh y0 angletype anglevalue omega psi0 axistype "
    "axisvalue title rotation windframe a0 " + " ".join(f"a{k} b{k}" for k in HARMONICS) + " |",
}

# What keys ask for if they are set that is not done: such a case is refused.
_NOT_DONE = {
    "environmentin": {
        "audioflag": "no sound file is written",
        "sigmaflag": "no data on the surfaces are written",
        "pressuregradientflag": "pressure gradients are not computed",
        "pressuregradient1aflag": "pressure gradients are not computed",
        "phaseflag": "phases are not written",
        "complexpressureflag": "complex pressures are not written",
        "pnlflag": "PNL without the correction for tones is not written, PNLT is",
        "faacertflag": "corrections to the conditions of certification are not worked out",
        "forceepnl": "EPNL takes a record that begins and ends 10 dB below its maximum",
        "readinpressureflag": "pressures are computed, not read",
        "isomsthicknessnoiseflag": "thickness noise is by Formulation 1A",
    },
    "environmentconstants": {"integrationtype": "noise is computed in the time domain"},
    "observerin": {
        "segmentincrement": "segments follow segmentSize and segmentStepSize",
        "nbharmonics": "all harmonics are kept",
        "nbfreqranges": "levels are of the whole band",
        "indexswap": "theta stays the first index",
        "fscoutputflag": "no such file is written",
    },
    "containerin": {"bwinoiseflag": "noise of blades and wakes is not computed"},
}
_REFERENCE_PRESSURE = 20e-6


def not_done(name: str, values: Mapping[str, Any]) -> Iterator[str]:
    """What a group asks for that is not done here.

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
    for key, reason in _NOT_DONE.get(name, {}).items():
        if values.get(key):
            yield f"{key} asks for what is not done: {reason}"


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
        Text for each such key: its name, and why.
    """
    if name not in _KEYS:
        return
    known = {*_KEYS[name].split(), *_NOT_DONE.get(name, {})}
    for key, value in values.items():
        if key == "p_ref" and name == "environmentconstants":
            if value != _REFERENCE_PRESSURE:
                yield f"{key} has no effect: levels are in dB re 20 uPa"
        elif key not in known:
            yield f"{key} is not known and has no effect"
