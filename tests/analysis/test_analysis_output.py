"""Sound and figures of an analysis."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import arc, sphere
from propmdao.acoustics.sounds.recordings import SAMPLE_RATE
from propmdao.analysis.single_point import analyze
from propmdao.analysis.sounds import pressure_record, write_sound
from propmdao.formats.propellers import load_propeller

PROPELLER = load_propeller("apcsf_11x4.7_uiuc")
ARC = arc(1.905, [-45.0, 0.0, 45.0])


def run(rpm=4200.0, observers=ARC, **options):
    return analyze(PROPELLER, rpm=rpm, observers=observers, fidelity=COARSE, **options)


@pytest.fixture(scope="module")
def hover():
    return run(broadband=True)


def oaspl(pressure):
    return 10 * np.log10(np.mean(pressure**2, axis=-1) / 4e-10)


def test_a_sound_of_tones_alone_is_as_loud_as_they_are():
    tones = run()
    said = [observer["oaspl_db"] for observer in tones.to_dict()["observers"]]
    np.testing.assert_allclose(oaspl(pressure_record(tones, 1.0)), said, atol=1e-3)


def test_the_sound_is_as_loud_as_the_analysis_says(hover):
    record = pressure_record(hover, 1.0)
    said = [observer["oaspl_total_db"] for observer in hover.to_dict()["observers"]]
    # The file leaves out the halves of the lowest and the highest bins: measured 0.01 dB.
    np.testing.assert_allclose(oaspl(record), said, atol=0.05)


def test_a_sound_file_has_a_channel_for_each_observer_and_its_calibration(hover, tmp_path):
    written = write_sound(tmp_path / "hover.wav", hover, 0.5)
    data, rate = soundfile.read(written.path)
    assert rate == SAMPLE_RATE and data.shape[1] == len(ARC)
    pressure = written.full_scale * data.T
    np.testing.assert_allclose(pressure, pressure_record(hover, 0.5), atol=1e-6 * written.peak)
    louder = write_sound(tmp_path / "hover.wav", hover, 0.5, full_scale=2.0)
    assert louder.full_scale == 2.0


def test_what_cannot_be_heard(hover, tmp_path):
    for full_scale in (0.0, 1e-6):
        with pytest.raises(ValueError, match=r"full scale must be|would be clipped"):
            write_sound(tmp_path / "a.wav", hover, 0.5, full_scale)
    many = run(observers=sphere(2.0, [-45.0, 0.0], np.linspace(0.0, 320.0, 33)))
    with pytest.raises(ValueError, match="at most 64 observers; there are 66"):
        write_sound(tmp_path / "a.wav", many, 0.5)
    with pytest.raises(ValueError, match="blade passage frequency must be positive"):
        write_sound(tmp_path / "a.wav", run(rpm=0.0), 0.5)


def test_figures_of_what_there_is(hover):
    figures = pytest.importorskip("propmdao.figures.of_analysis").analysis_figures
    assert set(figures(hover)) == {
        "spectrum", "pressure", "third_octaves", "directivity"
    }  # fmt: skip
    tones = run(observers=ARC[:2])
    assert set(figures(tones)) == {"spectrum", "pressure"}
    with pytest.raises(ValueError, match="figures need observers"):
        figures(run(observers=arc(1.0, [])))
