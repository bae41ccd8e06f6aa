"""A run of ours handed to PSU-WOPWOP: read back, its case has our own levels."""

from __future__ import annotations

from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.acoustics.levels.weighting import oaspl_dba
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.analysis.foreign_case import run_case
from propmdao.analysis.wopwop_export import write_blade, write_propeller_case
from propmdao.commands.wopwop_command import levels
from propmdao.formats.propellers import load_propeller
from propmdao.formats.wopwop.geometry_file import read_geometry
from propmdao.formats.wopwop.sources import thickness_sources
from propmdao.geometry.blade import Blade
from propmdao.geometry.surface import (
    surface_interpolation,
    surface_nodes,
    surface_panels,
)
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels

COARSE = Fidelity(n_chordwise=4, n_spanwise=8, n_contour=15, n_surface_span=12, n_harmonics=4)
AIR = {"density": 1.225, "sound_speed": 340.294}


@pytest.fixture(scope="module")
def loads() -> PointLoads:
    """Of a plausible size at 8000 rpm: about 5 N of thrust."""
    r = 0.1397 * np.linspace(0.2, 0.98, 12)
    position = np.stack([r, 0 * r, 0.02 * r], axis=-1)
    force = np.stack([0 * r, 0.6 * r, -60.0 * r * (0.15 - r)], axis=-1)
    return PointLoads(jnp.asarray(position), jnp.asarray(force))


def test_levels_of_the_case_are_those_of_the_tones(tmp_path: Path, loads: PointLoads) -> None:
    places = arc([1.905, 3.0], [-45.0, 10.0])
    propeller = load_propeller("apcsf_11x4.7")
    write_propeller_case(
        tmp_path / "case",
        propeller,
        loads,
        rpm=8000.0,
        speed=8.0,
        observers=places,
        fidelity=COARSE,
        n_times=256,
        **AIR,
    )
    expected = tones(
        panels(propeller), loads, 2, 8000.0 * np.pi / 30, 8.0, *AIR.values(), places, 4
    )
    read = [group["observers"][0] for group in levels(run_case(tmp_path / "case"))]
    for i, theirs in enumerate(read):
        # measured: 1e-6 dB
        assert theirs["oaspl_db"] == pytest.approx(float(oaspl_db(expected.total[i])), abs=0.05)
        for name in ("thickness", "loading"):
            ours = float(oaspl_db(getattr(expected, name)[i]))
            assert theirs[f"oaspl_{name}_db"] == pytest.approx(ours, abs=0.05)
        weighted = float(oaspl_dba(expected.frequency_hz, expected.total[i]))
        assert theirs["oaspl_dba"] == pytest.approx(weighted, abs=0.05)
        assert len(theirs["peaks"]) >= 2
        for m, peak in enumerate(theirs["peaks"][:3]):
            assert peak["frequency_hz"] == pytest.approx(float(expected.frequency_hz[m]))
            assert peak["spl_db"] == pytest.approx(float(spl_db(expected.total[i])[m]), abs=0.05)


def panels(propeller: Propeller) -> Panels:
    stations = propeller.r_over_R
    span = surface_interpolation(stations, COARSE.n_surface_span)
    return surface_panels(surface_nodes(Blade.from_propeller(propeller), span, COARSE.n_contour))


def test_a_blade_alone_encloses_its_volume(tmp_path: Path) -> None:
    propeller = load_propeller("apcsf_11x4.7")
    write_blade(tmp_path / "blade.dat", propeller, COARSE)
    zones = read_geometry(tmp_path / "blade.dat").zones
    parts = [thickness_sources(zone, np.zeros(1)) for zone in zones]
    flux = sum(np.sum(part.position[0] * part.vector[0], axis=0) for part in parts)
    own = panels(propeller)
    volume = np.sum(np.asarray(own.center * own.vector_area), axis=0)
    # along each axis the same volume, but for warped quadrangles
    np.testing.assert_allclose(flux, volume, rtol=1e-5)
    with pytest.raises(ValueError, match="No such file or directory"):
        write_blade(tmp_path / "nowhere" / "blade.dat", propeller, COARSE)


@pytest.mark.parametrize(
    ("rpm", "message"), [(0.0, "rpm must be positive"), (30000.0, "tip Mach number")]
)
def test_what_has_no_case(tmp_path: Path, loads: PointLoads, rpm: float, message: str) -> None:
    propeller = load_propeller("apcsf_11x4.7")
    with pytest.raises(ValueError, match=message):
        write_propeller_case(
            tmp_path, propeller, loads, rpm=rpm, speed=0.0, observers=arc(2.0, 0.0), **AIR
        )
