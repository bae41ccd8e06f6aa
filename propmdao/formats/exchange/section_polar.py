"""The polar of one section of a blade as XFOIL writes it, for XFLR5, QBlade and JBLADE."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from propmdao.aerodynamics.sections.polars.high_angle import ALPHA, ATTACHED
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.formats.exchange.section_fits import curves_of_sections
from propmdao.propeller.description import Propeller
from propmdao.records.models import Transition
from propmdao.records.units import Range
from propmdao.runtime.output_files import replacing
from propmdao.runtime.terminal import printable

#: Reynolds numbers of a polar's file.
REYNOLDS = Range(1e3, 1e8)


def export_polar(path: str | Path, propeller: Propeller, r_over_R: float, reynolds: float) -> int:
    """Write lift, drag and moment of a section over the angle of attack.

    Parameters
    ----------
    path : str or Path
        File to write.
    propeller : Propeller
        Propeller whose section it is.
    r_over_R : float
        Radius of the section over the tip radius.
    reynolds : float
        Reynolds number on the chord.

    Returns
    -------
    int
        Number of angles, from -26 to 26 degrees. The points of transition, which the polars do
        not know, and the share of pressure in drag are written as 0.

    Raises
    ------
    ValueError
        If the radius is outside the blade, the Reynolds number out of range, or the file cannot be
        written.
    PolarError
        If the transition of the propeller takes NeuralFoil and it is not installed.
    """
    if not REYNOLDS.lowest <= reynolds <= REYNOLDS.highest:
        raise ValueError(f"reynolds must be {REYNOLDS}; got {reynolds:g}")
    polars = polars_for(propeller)
    cl, cd, cm = curves_of_sections(propeller, polars, [r_over_R], [reynolds])[:, 0, ATTACHED]
    transition = Transition().completed(propeller.transition)
    lines = [
        "propmdao",
        "",
        printable(f" Calculated polar for: {propeller.name} at r/R {r_over_R:g}"),
        "",
        " 1 1 Reynolds number fixed          Mach number fixed",
        "",
        f" xtrf = {transition.trip_upper:7.3f} (top)      {transition.trip_lower:7.3f} (bottom)",
        f" Mach =   0.000     Re = {reynolds / 1e6:9.5f} e 6     Ncrit = {transition.n_crit:7.3f}",
        "",
        "  alpha     CL        CD       CDp       Cm    Top Xtr Bot Xtr",
        " ------- -------- --------- --------- -------- ------- -------",
    ]
    rows = np.stack([np.degrees(ALPHA[ATTACHED]), cl, cd, cm], axis=1)
    lines += [
        f"{alpha:8.3f} {lift:8.4f} {drag:9.5f} {0:9.5f} {moment:8.4f} {0:7.4f} {0:7.4f}"
        for alpha, lift, drag, moment in rows
    ]
    with replacing(path) as file:
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return len(rows)
