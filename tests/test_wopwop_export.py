"""A run of ours handed to PSU-WOPWOP: read back, its case has our own levels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from propmdao.acoustics.observers import arc
from propmdao.analysis import SOUND_SPEED, analyze
from propmdao.fidelity import Fidelity
from propmdao.propeller import load_propeller
from propmdao.wopwop import run_case
from propmdao.wopwop_command import levels
from propmdao.wopwop_export import write_propeller_case

COARSE = Fidelity(n_chordwise=4, n_spanwise=8, n_contour=15, n_surface_span=12, n_harmonics=4)
AIR = {"density": 1.225, "sound_speed": SOUND_SPEED}


def test_levels_of_the_case_are_those_of_the_analysis(tmp_path: Path) -> None:
    propeller = load_propeller("apcsf_11x4.7")
    places = [(1.905, -45.0), (3.0, 10.0)]
    analysis = analyze(propeller, rpm=8000.0, speed=8.0, observers=places, fidelity=COARSE)
    write_propeller_case(
        tmp_path / "case",
        propeller,
        analysis.steady.point_loads,
        rpm=8000.0,
        speed=8.0,
        observers=arc(*np.transpose(places)),
        fidelity=COARSE,
        n_times=256,
        **AIR,
    )
    read = [group["observers"][0] for group in levels(run_case(tmp_path / "case"))]
    for ours, theirs in zip(analysis.to_dict()["observers"], read, strict=True):
        for key in ("oaspl_db", "oaspl_thickness_db", "oaspl_loading_db", "oaspl_dba"):
            assert theirs[key] == pytest.approx(ours[key], abs=0.05)
        # of the tones that are within 60 dB
        for ours_m, theirs_m in zip(ours["harmonics"][:3], theirs["peaks"], strict=False):
            assert theirs_m["frequency_hz"] == pytest.approx(ours_m["frequency_hz"])
            for key in ("spl_db", "spl_thickness_db", "spl_loading_db"):
                assert theirs_m[key] == pytest.approx(ours_m[key], abs=0.05)


@pytest.mark.parametrize(
    ("rpm", "message"), [(0.0, "rpm must be positive"), (30000.0, "tip Mach number")]
)
def test_what_has_no_case(tmp_path: Path, rpm: float, message: str) -> None:
    propeller = load_propeller("apcsf_11x4.7")
    loads = analyze(propeller, rpm=4000.0, fidelity=COARSE).steady.point_loads
    with pytest.raises(ValueError, match=message):
        write_propeller_case(
            tmp_path, propeller, loads, rpm=rpm, speed=0.0, observers=arc(2.0, 0.0), **AIR
        )
