"""Scripts that build a propeller in OpenVSP, with its sections as they are.

A BEM file leaves OpenVSP with sections of the NACA 16-series; a script can hand it contours. The
functions called are those of OpenVSP's application interface (VSP_Geom_API.h, version 3.4x) in its
AngelScript dialect.
"""

from __future__ import annotations

import os

import numpy as np

from propmdao.formats.exchange.vsp_blade import FloatArray, contours, vsp_blade
from propmdao.propeller.description import Propeller
from propmdao.runtime.output_files import replacing

#: Intervals between two stations of the curves, which OpenVSP runs through by monotone cubics where
#: here they are splines.
_PER_STATION = 4
#: OpenVSP's curves of a blade by our names of them; it takes axial for rake here.
_CURVES = {
    "PROP_CHORD": "chord",
    "PROP_TWIST": "twist",
    "PROP_RAKE": "rake",
    "PROP_SKEW": "skew",
    "PROP_SWEEP": "sweep",
    "PROP_THICK": "thickness",
    "PROP_CLI": "design_lift",
    "PROP_AXIAL": "axial",
    "PROP_TANGENTIAL": "tangential",
}
#: A function of the script that gives a section its radius and its contour.
_SECTION = """\
void SetSection( string prop, int index, double radius, array<double> &in x, array<double> &in z )
{
    string surface = GetXSecSurf( prop, 0 );
    ChangeXSecShape( surface, index, XS_FILE_AIRFOIL );
    string section = GetXSec( surface, index );
    SetParmVal( GetXSecParm( section, "RadiusFrac" ), radius );
    int nose = ( int( x.length() ) - 1 ) / 2;
    array<vec3d> upper;
    array<vec3d> lower;
    for ( int i = 0; i <= nose; i++ )
    {
        upper.insertLast( vec3d( x[nose + i], z[nose + i], 0.0 ) );
        lower.insertLast( vec3d( x[nose - i], z[nose - i], 0.0 ) );
    }
    SetAirfoilPnts( section, upper, lower );
    Update();
}
"""


def write_vspscript(path: str | os.PathLike[str], propeller: Propeller) -> int:
    """Write a script that makes a propeller in OpenVSP.

    Parameters
    ----------
    path : path
        File to write; its unit of length is the metre.
    propeller : Propeller
        Propeller to write. OpenVSP sets sections across a raked blade where here they are across
        the radius.

    Returns
    -------
    int
        Number of sections.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    stations = propeller.r_over_R
    between = np.arange(_PER_STATION) / _PER_STATION
    inner = stations[:-1, None] + np.diff(stations)[:, None] * between
    blade = vsp_blade(propeller, np.append(inner.ravel(), stations[-1]))
    name = "".join(c if c.isascii() and c.isprintable() and c not in '"\\' else "_"
                   for c in propeller.name)  # fmt: skip
    x, z = contours(propeller, stations)
    lines = [
        f"// {name}, in metres; written by propmdao. File, Run Script in OpenVSP.",
        "void main()",
        "{",
        '    string prop = AddGeom( "PROP", "" );',
        f'    SetGeomName( prop, "{name}" );',
        f'    SetParmVal( prop, "Diameter", "Design", {propeller.diameter!r} );',
        f'    SetParmVal( prop, "NumBlade", "Design", {propeller.n_blades} );',
        '    SetParmVal( prop, "UseBeta34Flag", "Design", 0 );',
        '    SetParmVal( prop, "Feather", "Design", 0.0 );',
        '    SetParmVal( prop, "ConstructXoC", "Design", 0.5 );',
        '    SetParmVal( prop, "FeatherAxisXoC", "Design", 0.5 );',
        '    SetParmVal( prop, "CapUMaxOption", "EndCap", FLAT_END_CAP );',
        "    CutXSec( prop, 1 );",
        f"    array<double> x = {_array(x)};",
    ]
    last = stations.size - 1
    # The tip first: every other section then goes in ahead of it, at a radius that is free.
    for station in (0, last, *range(1, last)):
        index = 1 if station == last else station
        if station not in (0, last):
            lines += [f"    InsertXSec( prop, {index - 1}, XS_FILE_AIRFOIL );", "    Update();"]
        lines += [
            f"    array<double> z{station} = {_array(z[station])};",
            f"    SetSection( prop, {index}, {float(stations[station])!r}, x, z{station} );",
        ]
    lines.append(f"    array<double> r = {_array(blade.radius)};")
    for curve, quantity in _CURVES.items():
        lines += [
            f"    array<double> {quantity} = {_array(getattr(blade, quantity))};",
            f"    SetPCurve( prop, {curve}, r, {quantity}, PCHIP );",
        ]
    lines += [
        "    Update();",
        "    while ( GetNumTotalErrors() > 0 )",
        "    {",
        "        ErrorObj error = PopLastError();",
        "        Print( error.GetErrorString() );",
        "    }",
        "}",
        "",
        _SECTION,
    ]
    with replacing(path) as file:
        file.write_text("\n".join(lines), encoding="utf-8")
    return int(stations.size)


def _array(values: FloatArray) -> str:
    """Values as a list of the script."""
    return "{ " + ", ".join(f"{value + 0.0:.10g}" for value in values) + " }"
