"""Section polars: lift, drag and moment at all angles, over Reynolds number, camber and thickness.

A face calls `polars_for(propeller)` once, `blade_tables(polars, blade, span)` for each blade and
`section_coefficients(table, alpha, re, mach)` inside its loop; all three but the first are pure
functions of arrays. `read_polars` and `read_c81` make tables of a user's files.
"""

from propmdao.aerodynamics.polars.family import (
    SectionPolars,
    blade_tables,
    section_tables,
    warn_outside_sections,
)
from propmdao.aerodynamics.polars.files import read_c81, read_polar, read_polars
from propmdao.aerodynamics.polars.propeller_polars import polars_for
from propmdao.aerodynamics.polars.table import (
    PolarError,
    PolarRangeWarning,
    PolarSubstituteWarning,
    PolarTable,
    SectionCurves,
    curve_coefficients,
    section_coefficients,
    section_curves,
    warn_outside,
)
from propmdao.aerodynamics.polars.user_table import Polar, table_from_polars

__all__ = [
    "Polar",
    "PolarError",
    "PolarRangeWarning",
    "PolarSubstituteWarning",
    "PolarTable",
    "SectionCurves",
    "SectionPolars",
    "blade_tables",
    "curve_coefficients",
    "polars_for",
    "read_c81",
    "read_polar",
    "read_polars",
    "section_coefficients",
    "section_curves",
    "section_tables",
    "table_from_polars",
    "warn_outside",
    "warn_outside_sections",
]
