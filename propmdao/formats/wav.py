"""Calibrated sound files (WAV), and sounds for pages (FLAC)."""

from __future__ import annotations

import io
from pathlib import Path
from typing import NamedTuple

import numpy as np
import soundfile  # type: ignore[import-untyped]
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.sounds.recordings import SAMPLE_RATE
from propmdao.records.units import Range
from propmdao.runtime.output_files import replacing

#: Pressure of the largest number in a file.
FULL_SCALE = Range(1e-9, 1e9, "Pa")


class Recording(NamedTuple):
    """A sound file that has been written.

    Attributes
    ----------
    path : Path
        Sound file.
    full_scale : float
        Pressure that the file's largest number, 1.0, stands for [Pa]; also in the file's comment.
    peak : float
        Largest pressure in the record [Pa].
    duration : float
        Length of the record [s].
    """

    path: Path
    full_scale: float
    peak: float
    duration: float


def write_wav(
    path: str | Path,
    pressure: ArrayLike,
    full_scale: float,
    sample_rate: int = SAMPLE_RATE,
    bits: int = 24,
) -> Recording:
    """Write a calibrated sound file.

    Parameters
    ----------
    path : str or Path
        File to write, ending in .wav.
    pressure : (n_times,) or (n_channels, n_times) array_like
        Record of the pressure, one or a channel for each observer [Pa].
    full_scale : float
        Pressure of the largest number in the file [Pa]. Files written with the same full scale keep
        their loudness relative to each other; see `common_full_scale`.
    sample_rate : int
        Samples per second [Hz].
    bits : {24, 32}
        Number of bits of each sample.

    Returns
    -------
    Recording
        The file and its calibration, which its comment states, too.

    Raises
    ------
    ValueError
        If the pressure is not finite or would be clipped, the full scale is out of range, or the
        number of bits is another one, or the file cannot be written.
    """
    if bits not in _CODING:
        raise ValueError(f"bits of a sound file must be 24 or 32; got {bits}")
    p = _checked(pressure, full_scale)
    content = _encoded(p, full_scale, sample_rate, ("WAV", _CODING[bits]))
    with replacing(path) as file:
        file.write_bytes(content)
    peak = float(np.abs(p).max())
    return Recording(Path(path), full_scale, peak, p.shape[-1] / sample_rate)


def flac(pressure: ArrayLike, full_scale: float, sample_rate: int = SAMPLE_RATE) -> bytes:
    """Sound in the format that browsers play and that loses nothing but what 16 bits do not hold.

    Parameters
    ----------
    pressure : (n_times,) array_like
        Record of the pressure [Pa].
    full_scale : float
        Pressure of the largest number [Pa]; also in the comment.
    sample_rate : int
        Samples per second [Hz].

    Returns
    -------
    bytes
        Content of a FLAC file.

    Raises
    ------
    ValueError
        If the pressure is not finite or would be clipped, or the full scale is out of range.
    """
    return _encoded(_checked(pressure, full_scale), full_scale, sample_rate, ("FLAC", "PCM_16"))


def _checked(pressure: ArrayLike, full_scale: float) -> NDArray[np.float64]:
    """Pressure that a file can hold."""
    p = np.asarray(pressure, float)
    FULL_SCALE.require("full scale", full_scale)
    if p.ndim not in (1, 2) or p.size == 0:
        raise ValueError(f"a sound file holds (n_channels, n_times) pressures; got {p.shape}")
    if not np.all(np.isfinite(p)):
        raise ValueError(f"pressure must be finite; {np.sum(~np.isfinite(p))} samples are not")
    peak = float(np.abs(p).max())
    if peak > full_scale:
        raise ValueError(
            f"pressure would be clipped: its peak is {peak:.4g} Pa, full scale {full_scale:.4g} Pa"
        )
    return p


def _encoded(
    p: NDArray[np.float64], full_scale: float, sample_rate: int, coding: tuple[str, str]
) -> bytes:
    """Content of a file: in memory, as the library does not say why one could not be written."""
    content = io.BytesIO()
    container, subtype = coding
    with soundfile.SoundFile(
        content, "w", sample_rate, np.atleast_2d(p).shape[0], subtype, format=container
    ) as sound:
        sound.comment = f"full scale = {full_scale:.9g} Pa"
        sound.write(p.T / full_scale)
    return content.getvalue()


_CODING = {24: "PCM_24", 32: "PCM_32"}
