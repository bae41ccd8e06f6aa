"""Sounds of random numbers, and every figure once."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.signals import Tones
from propmdao.formats.propellers import load_propeller

BANDS = third_octave_centers(50.0, 20e3)
ELEVATIONS = np.linspace(-90.0, 90.0, 13)
AZIMUTHS = np.linspace(0.0, 360.0, 25)
RATE = 48000  # Hz
MEASURED = {"total": ([-45.0, 0.0], [60.0, 62.0])}


def sound(seed: int, bpf_hz: float):
    from propmdao.figures.contents.sound import Sound

    rng = np.random.default_rng(seed)
    fall = 1e-3 * 10.0 ** -np.arange(4.0)  # 20 dB from one harmonic to the next
    parts = {
        source: jnp.asarray(fall * (1.0 + rng.random((13, 4))) * np.exp(6j * rng.random((13, 4))))
        for source in ("thickness", "loading")
    }
    noise = 1e-7 * (1.0 + rng.random((13, 1))) * (BANDS / 1000.0) ** 0.3
    return Sound(Tones(bpf_hz * jnp.arange(1.0, 5.0), parts), BANDS, noise)


@pytest.fixture(scope="session")
def sounds():
    """Tones and broadband noise at `ELEVATIONS`, of two propellers."""
    pytest.importorskip("matplotlib")
    return {"before": sound(1, 140.0), "after": sound(2, 155.0)}


@pytest.fixture(scope="session")
def levels(sounds):
    """Overall levels of the first sound by noise source."""
    from propmdao.figures.contents.sound import source_levels

    return source_levels(sounds["before"])


@pytest.fixture(scope="session")
def propellers():
    before = load_propeller("apcsf_11x4.7_thesis")  # its thickness is that of its airfoils
    return {
        "before": before,
        "after": dataclasses.replace(before, airfoils=[(0.15, "naca6406"), (1.0, "naca4403")]),
    }


@pytest.fixture(scope="session")
def figures(sounds, levels, propellers):
    """Every kind of figure by name."""
    from propmdao.figures.contents.pressures import blade_passage, sampled
    from propmdao.figures.contents.sound import Sound, band_levels, source_levels
    from propmdao.figures.designs.convergence import convergence
    from propmdao.figures.designs.spectra_over_each_other import spectra_over_each_other
    from propmdao.figures.directivity import directivity, hemisphere_map
    from propmdao.figures.histories import level_history
    from propmdao.figures.pressure import pressure
    from propmdao.figures.rotor.blades import blade_comparison
    from propmdao.figures.spectra import harmonic_spectrum, narrowband_spectrum, third_octaves

    tones = {name: Sound.of_tones(sound.tones) for name, sound in sounds.items()}
    time = np.arange(RATE) / RATE
    heard = {"total": 0.1 * np.sin(900.0 * time), "tones": 0.05 * np.cos(900.0 * time)}
    record = sampled(heard, RATE, 0.02)
    below = np.flatnonzero(ELEVATIONS <= 0)
    return {
        "blades": blade_comparison(propellers, (0.15, 0.5, 1.0)),
        "convergence": convergence([3.0, 2.0, np.nan], [1, 1, 0], "level, dB", {"start": 4}),
        "harmonic_spectrum": harmonic_spectrum(sounds, 3),
        "narrowband_spectrum": narrowband_spectrum(sounds, 3),
        "narrowband_spectrum_of_tones": narrowband_spectrum(tones, 3),
        "third_octaves": third_octaves(
            BANDS,
            {"total": band_levels(sounds["before"], 3), "separation": BANDS * 0 + 20},
            {"total": ([125.0, 1000.0], [50.0, 45.0])},
        ),
        "spectra_over_each_other": spectra_over_each_other(sounds, 3, "title"),
        "spectra_of_tones_over_each_other": spectra_over_each_other(tones, 3),
        "pressure": pressure({name: blade_passage(s.tones, 3) for name, s in sounds.items()}),
        "pressure_of_records": pressure({"one": record, "two": record}),
        "directivity": directivity(ELEVATIONS, levels, MEASURED),
        "directivity_of_two": directivity(
            ELEVATIONS,
            {name: source_levels(sound) for name, sound in tones.items()},
            microphone_deg=-45.0,
        ),
        "hemisphere_map": hemisphere_map(
            ELEVATIONS[below], AZIMUTHS, 60 - np.outer(below, np.cos(np.radians(AZIMUTHS)))
        ),
        "level_history": level_history(
            [0.0, 1.0, 2.0], {"total": [50.0, 60.0, 50.0]}, "level, dB", {"overhead": 1.0}
        ),
    }


@pytest.fixture(scope="session")
def line():
    """Function that finds the one line of a label in a figure."""

    def find(figure, label: str, axes: int = 0):
        (found,) = (drawn for drawn in figure.axes[axes].lines if drawn.get_label() == label)
        return found

    return find
