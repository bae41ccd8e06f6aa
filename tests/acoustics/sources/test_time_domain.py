"""The Fourier integral over emission time is Formulation 1A: the time history says the same."""

import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.decibels import pressure_history

N_TIMES = 160  # per turn; the harmonics that fold back are 140 and more


def tone_amplitudes(pressure, n_blades, n_harmonics):
    """Return the P_m of `Tones` from one turn, and the largest harmonic in between them."""
    spectrum = np.conj(np.fft.rfft(pressure)) / pressure.size
    at_blade_passage = n_blades * np.arange(1, n_harmonics + 1)
    between = np.setdiff1d(np.arange(1, at_blade_passage[-1]), at_blade_passage)
    return spectrum[at_blade_passage], np.abs(spectrum[between]).max()


@pytest.mark.parametrize(("elevation_deg", "speed"), [(-45.0, 0.0), (20.0, 30.0)])
def test_ten_harmonics_at_1_9_m_within_a_hundredth_of_a_decibel(
    slow_flyer, heard_over_time, elevation_deg, speed
):
    # A tip Mach number of 0.7, since at 0.18 the tenth harmonic is 1e-16 of the first.
    rotor = slow_flyer.with_(rotation_speed=1700.0, speed=speed)
    observer = arc(1.905, elevation_deg)[0]
    tones = rotor.tones(observer)
    for product, history in zip(
        (tones.parts["thickness"][0], tones.parts["loading"][0]),
        heard_over_time(rotor, observer, N_TIMES),
        strict=True,
    ):
        reference, between = tone_amplitudes(history, rotor.n_blades, 10)
        level_error = 20 * np.log10(np.abs(product / reference))
        assert np.abs(level_error).max() < 0.01
        assert np.abs(np.angle(product / reference)).max() < 1e-3
        assert between < 1e-12 * np.abs(reference[0])  # B blades cancel all but multiples of B


def test_first_harmonics_of_a_hovering_slow_flyer(slow_flyer, heard_over_time):
    observer = arc(1.905, -45.0)[0]
    tones = slow_flyer.tones(observer, 3)
    thickness, loading = heard_over_time(slow_flyer, observer, N_TIMES)
    for name, history in (("thickness", thickness), ("loading", loading)):
        reference, _ = tone_amplitudes(history, 2, 3)
        np.testing.assert_allclose(tones.parts[name][0], reference, rtol=1e-3)


def test_observer_close_to_the_tip(slow_flyer, heard_over_time):
    """Half a radius from the tip, where the near field asks most of the number of azimuths."""
    rotor = slow_flyer.with_(rotation_speed=1700.0, speed=30.0)
    observer = arc(1.5 * 0.1397, 0.0)[0]
    tones = rotor.tones(observer)
    thickness, loading = heard_over_time(rotor, observer, N_TIMES)
    for name, history in (("thickness", thickness), ("loading", loading)):
        reference, _ = tone_amplitudes(history, 2, 10)
        assert np.abs(20 * np.log10(np.abs(tones.parts[name][0] / reference))).max() < 0.01


def test_pressure_history_is_the_history_without_its_mean(slow_flyer, heard_over_time):
    rotor = slow_flyer.with_(n_blades=3)
    observer = arc(1.905, 10.0)[0]
    tones = rotor.tones(observer)
    time, pressure = pressure_history(tones.frequency_hz, tones.total, 64)
    reference = sum(heard_over_time(rotor, observer, 3 * 64))[:64]
    assert time[1] == pytest.approx(2 * np.pi / 440.0 / 3 / 64)
    np.testing.assert_allclose(
        pressure[0], reference - reference.mean(), atol=1e-6 * np.ptp(reference)
    )
