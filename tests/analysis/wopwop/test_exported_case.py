"""A run of ours handed to PSU-WOPWOP: read back, its case has our own levels."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import jax
import numpy as np
import pytest
from shared_mesh import COARSE as AXIAL

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.acoustics.levels.weighting import oaspl_dba
from propmdao.analysis.request import Asked
from propmdao.analysis.results import Analysis
from propmdao.analysis.single_point import analyze
from propmdao.analysis.wopwop.exported_case import write_blade, write_case
from propmdao.analysis.wopwop.foreign_case import run_case
from propmdao.commands.exchange.wopwop_command import levels
from propmdao.formats.propellers import load_propeller
from propmdao.formats.wopwop.cases import read_cases
from propmdao.formats.wopwop.geometry_file import read_geometry
from propmdao.formats.wopwop.sources import thickness_sources
from propmdao.geometry.blade import Blade
from propmdao.geometry.surface import surface_interpolation, surface_nodes, surface_panels
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity
from propmdao.records.listening import Listening
from propmdao.records.panels import Panels
from propmdao.records.wake_law import WakeGrid

COARSE = Fidelity(
    n_chordwise=2,
    n_spanwise=5,
    n_contour=9,
    n_surface_span=6,
    n_harmonics=3,
    n_azimuths=8,
    period_wake=WakeGrid(2.0, 2.0, 1.5, 40.0),
)
PROPELLER = load_propeller("apcsf_11x4.7_uiuc")


def analysed(incidence_deg: float) -> Analysis:
    places = arc([1.905, 3.0], [-45.0, 10.0])
    return analyze(
        PROPELLER,
        rpm=8000.0,
        speed=8.0,
        incidence_deg=incidence_deg,
        viscous=False,
        observers=places,
        fidelity=COARSE,
    )


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return analysed(0.0)


@pytest.mark.parametrize("incidence_deg", [0.0, 75.0])
def test_levels_of_the_case_are_those_of_the_tones(
    tmp_path: Path, analysis: Analysis, incidence_deg: float
) -> None:
    """At an incidence the loads are periodic and the flight is not along the shaft."""
    if incidence_deg:
        analysis = analysed(incidence_deg)
    write_case(analysis, tmp_path / "case", n_times=256)
    expected = analysis.tones
    read = [group["observers"][0] for group in levels(run_case(tmp_path / "case"))]
    for i, theirs in enumerate(read):
        # measured: 1e-6 dB in axial flight, 0.01 dB at the incidence
        assert theirs["oaspl_db"] == pytest.approx(float(oaspl_db(expected.total[i])), abs=0.05)
        for name in ("thickness", "loading"):
            ours = float(oaspl_db(expected.parts[name][i]))
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
    nodes = jax.jit(surface_nodes, static_argnums=2)
    blade = Blade.from_propeller(propeller)
    return jax.jit(surface_panels)(nodes(blade, span, COARSE.n_contour))


def test_a_blade_alone_encloses_its_volume(tmp_path: Path) -> None:
    write_blade(tmp_path / "blade.dat", PROPELLER, COARSE)
    zones = read_geometry(tmp_path / "blade.dat").zones
    parts = [thickness_sources(zone, np.zeros(1)) for zone in zones]
    flux = sum(np.sum(part.position[0] * part.vector[0], axis=0) for part in parts)
    own = panels(PROPELLER)
    volume = np.sum(np.asarray(own.center * own.vector_area), axis=0)
    # along each axis the same volume, but for warped quadrangles
    np.testing.assert_allclose(flux, volume, rtol=1e-5)
    with pytest.raises(ValueError, match="No such file or directory"):
        write_blade(tmp_path / "nowhere" / "blade.dat", PROPELLER, COARSE)


def test_the_case_is_of_the_changed_blade(tmp_path: Path) -> None:
    asked: Asked = {"n_blades": 3, "diameter": 0.2, "twist_offset_deg": 3.0}
    analysis = analyze(
        PROPELLER,
        rpm=8000.0,
        observers=arc(1.905, [-45.0]),
        fidelity=AXIAL,
        **asked,
    )
    write_case(analysis, tmp_path, n_times=256)
    (case,) = read_cases(tmp_path)
    assert len(case.containers) == 3
    ((theirs,),) = (group["observers"] for group in levels(run_case(tmp_path)))
    ours = analysis.to_dict()["observers"][0]
    for name in ("oaspl_db", "oaspl_thickness_db", "oaspl_loading_db"):
        assert theirs[name] == pytest.approx(ours[name], abs=0.05)


def test_what_has_no_case(tmp_path: Path, analysis: Analysis) -> None:
    nobody = dataclasses.replace(analysis.request, listening=Listening())
    for changed, message in (
        (dataclasses.replace(analysis, rpm=0.0), "rpm must be positive"),
        (dataclasses.replace(analysis, request=nobody), "needs observers"),
    ):
        with pytest.raises(ValueError, match=message):
            write_case(changed, tmp_path)
    assert list(tmp_path.iterdir()) == []
