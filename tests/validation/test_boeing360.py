"""A hovering four-bladed rotor against PSU-WOPWOP v3.4: its own files in, its own pressure out.

The case is the one that comes with VSP2WOPWOP: a closed-section blade surface for the thickness and
a line of forces for the loading noise, three observers 14 m away.
"""

from pathlib import Path

import numpy as np
import pytest

from propmdao.analysis.wopwop.foreign_case import run_case
from propmdao.formats.wopwop.geometry_file import read_geometry, write_geometry
from propmdao.formats.wopwop.loading_file import read_loading, write_loading
from propmdao.formats.wopwop.outputs.pressure_file import read_pressure


@pytest.fixture(scope="module")
def folder(reference_data: Path) -> Path:
    return reference_data / "wopwop" / "boeing360"


def test_files_are_written_byte_for_byte(folder: Path, tmp_path: Path):
    geometry, loading = tmp_path / "Geom.dat", tmp_path / "Load.dat"
    write_geometry(geometry, read_geometry(folder / geometry.name))
    write_loading(loading, read_loading(folder / loading.name))
    for copy in (geometry, loading):
        assert copy.read_bytes() == (folder / copy.name).read_bytes()


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*(broadband noise|octaveflag)")
def test_histories_at_three_observers(folder: Path, drawn):
    (result,) = run_case(folder)
    expected = read_pressure(folder / "pressure")
    # text with six digits
    np.testing.assert_allclose(result.pressure.position, expected.position, atol=1e-4)
    np.testing.assert_allclose(result.pressure.time, expected.time, atol=1e-7)
    for k, time in enumerate(expected.time):
        drawn(
            f"observer {k + 1}", ("time, ms", "pressure, Pa"), 1e3 * (time - time[0]),
            {"propmdao": result.pressure.total[k]}, {"PSU-WOPWOP": expected.total[k]},
        )  # fmt: skip
    # measured: loading 0.11 %, thickness 0.28 % of peak to peak
    for source, limit in (("loading", 0.002), ("thickness", 0.004), ("total", 0.004)):
        reference = getattr(expected, source)
        error = np.abs(getattr(result.pressure, source) - reference).max(axis=1)
        assert (error < limit * np.ptp(reference, axis=1)).all(), source
