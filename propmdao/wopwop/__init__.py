"""Files of PSU-WOPWOP: reading, writing, and running its cases."""

from propmdao.wopwop.binary import WopwopFileError
from propmdao.wopwop.cases import read_cases
from propmdao.wopwop.geometry_file import GeometryFile, read_geometry, write_geometry
from propmdao.wopwop.loading_file import LoadingFile, read_loading, write_loading
from propmdao.wopwop.namelists import read_namelists, write_namelists
from propmdao.wopwop.pressure_file import PressureHistories, read_pressure
from propmdao.wopwop.run import CaseResult, run_case
from propmdao.wopwop.write_case import write_case
from propmdao.wopwop.zones import Zone

__all__ = [
    "CaseResult",
    "GeometryFile",
    "LoadingFile",
    "PressureHistories",
    "WopwopFileError",
    "Zone",
    "read_cases",
    "read_geometry",
    "read_loading",
    "read_namelists",
    "read_pressure",
    "run_case",
    "write_case",
    "write_geometry",
    "write_loading",
    "write_namelists",
]
