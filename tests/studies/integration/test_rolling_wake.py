"""The study of a wake that rolls up: its loads, its picture, its animation."""

from __future__ import annotations

import re
import sys

import pytest

pytest.importorskip("matplotlib")


@pytest.mark.slow
def test_both_wakes_are_marched_and_the_free_one_drawn(import_study, monkeypatch, capsys, tmp_path):
    image = pytest.importorskip("PIL.Image")
    study = import_study("rolling_wake")
    monkeypatch.setattr(study, "FRAMES_PER_TURN", 3)
    monkeypatch.setattr(sys, "argv", ["rolling_wake.py", "--quick", "--output", str(tmp_path)])
    study.main()
    printed = capsys.readouterr().out
    rigid, free = (float(text) for text in re.findall(r" per revolution ([\d.]+) %", printed))
    assert 0.0 < free < rigid < 15.0  # of a blade's mean thrust
    assert (tmp_path / "wake.png").stat().st_size > 10_000
    with image.open(tmp_path / "wake.gif") as gif:
        assert gif.n_frames == 6
