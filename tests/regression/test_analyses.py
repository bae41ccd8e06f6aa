"""Forty analyses as they were before the rooms were laid out: rearranging code changes no number.

`analyses.json` holds what was asked and what came out, to ten digits. Who changes the physics on
purpose makes the file anew, with ``python tests/regression/test_analyses.py``, and says why.
"""

from __future__ import annotations

import dataclasses
import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import point
from propmdao.analysis.results import Analysis
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.records.fidelity import Fidelity
from propmdao.records.listening import Surroundings
from propmdao.records.quantities import BROADBAND_LEVELS, LEVELS

FILE = Path(__file__).with_name("analyses.json")
KEPT = json.loads(FILE.read_text(encoding="utf-8"))
# Relative to the largest number of the array. Roots are found to 1e-9 of the induced velocity, and
# XLA adds in another order where code moves; the first is what is left of both in tones.
LARGEST_DIFFERENCE, LEVEL_DB = 1e-7, 1e-6
FLOOR_DB = -100.0  # far below what can be heard; there stands what rounding and rings leave
SILENCE = 4e-30  # mean square at -200 dB [Pa^2]
RESULTS = "rpm J thrust torque shaft_power CT CQ CP eta converged failure".split()


def analysis_of(case: dict[str, Any]) -> Analysis:
    """Analyse what a case asks."""
    asked = dict(case)
    propeller = load_propeller(asked.pop("propeller"))
    asked["fidelity"] = COARSE if asked["fidelity"] == "coarse" else Fidelity()
    asked["observers"] = point(*np.transpose(asked["observers"]))
    asked["surroundings"] = Surroundings(**asked.get("surroundings", {}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # beyond the polars' Reynolds numbers
        return analyze(propeller, **asked)


def numbers_of(analysis: Analysis) -> dict[str, Any]:
    """Results, loads by strip, and what each observer hears."""
    result = analysis.to_dict()
    loads, tones, noise = analysis.loads, analysis.tones, analysis.broadband
    observers = []
    for i, levels in enumerate(result["observers"]):
        heard: dict[str, Any] = {
            "frequency_hz": tones.frequency_hz,
            "thickness": _parts(tones.parts["thickness"][i]),
            "loading": _parts(tones.parts["loading"][i]),
            "third_octave_db": [band["spl_db"] for band in levels["third_octave"]],
        }
        heard |= {key: levels[key] for key in (*LEVELS, *BROADBAND_LEVELS) if key in levels}
        if noise is not None:
            heard["broadband"] = {
                field.name: getattr(noise, field.name)[i] for field in dataclasses.fields(noise)
            }
        observers.append(heard)
    by_strip = {
        "strip_thrust": loads.strip_thrust,
        "strip_torque": loads.strip_torque,
        "lift_coefficient": loads.sections.lift_coefficient,
        "induced_velocity": loads.induced_velocity,
    }
    return {
        "result": {key: result[key] for key in RESULTS},
        "loads": by_strip,
        "observers": observers,
    }


def _parts(amplitude: Any) -> np.ndarray:
    """Real and imaginary parts, (n_harmonics, 2)."""
    return np.stack([np.real(amplitude), np.imag(amplitude)], axis=-1)


def _plain(value: Any) -> Any:
    """Numbers of ten digits."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if value is None or isinstance(value, bool | str | int):
        return value
    if np.ndim(value):
        return _plain(np.asarray(value).tolist())
    return float(f"{float(value):.10g}")


def label(kept):
    case = kept["case"]
    return "-".join(
        f"{value}" for key, value in case.items() if key not in ("observers", "surroundings")
    )


def test_there_are_forty():
    assert len(KEPT) == 40


@pytest.mark.parametrize("kept", KEPT, ids=label)
def test_numbers_are_what_they_were(kept):
    found = numbers_of(analysis_of(kept["case"]))
    for key, value in kept["result"].items():
        number = isinstance(value, float)
        same = pytest.approx(value, rel=LARGEST_DIFFERENCE, abs=1e-12) if number else value
        assert found["result"][key] == same, key
    for key, value in kept["loads"].items():
        assert_same(found["loads"][key], value)
    for heard, known in zip(found["observers"], kept["observers"], strict=True):
        assert heard.keys() >= known.keys()
        for key, value in known.items():
            if key.endswith(("_db", "_dba")):
                levels = [np.maximum(q, FLOOR_DB) for q in (heard[key], value)]
                np.testing.assert_allclose(*levels, rtol=0.0, atol=LEVEL_DB, err_msg=key)
            elif key == "broadband":
                for mechanism, bands in value.items():
                    # Below silence is what rounding leaves of a mechanism that is not there.
                    spectra = (np.maximum(q, SILENCE) for q in (heard[key][mechanism], bands))
                    assert_same(*spectra)
            else:
                assert_same(heard[key], value)


def assert_same(found, known):
    scale = np.abs(known).max()
    np.testing.assert_allclose(found, known, rtol=0.0, atol=LARGEST_DIFFERENCE * scale)


if __name__ == "__main__":
    new = [_plain({"case": k["case"], **numbers_of(analysis_of(k["case"]))}) for k in KEPT]
    lines = [json.dumps(one, separators=(",", ":")) for one in new]
    FILE.write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8")
