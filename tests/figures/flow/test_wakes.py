"""Pictures of a wake show its nodes, from the side and from above."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from propmdao.figures.flow.wakes import wake_picture, write_wake_animation

RADIUS = 0.5
TURN = np.linspace(0.0, 4.0 * np.pi, 40)


def helix(phase: float) -> np.ndarray:
    """Wakes of two blades, twelve filaments each, that go down and to the left."""
    blades = []
    for start in (phase, phase + np.pi):
        angle, radius = start - TURN, np.linspace(0.2, 1.0, 12)[:, None]
        x = radius * np.cos(angle) - 0.1 * TURN
        y, z = radius * np.sin(angle), np.broadcast_to(-0.05 * TURN, (12, 40))
        blades.append(np.stack([x, y, z], axis=-1))
    return RADIUS * np.stack(blades)


def thick(axes):
    """Filaments of the tip on axes, blade by blade, then the blades themselves."""
    tips = [line for line in axes.lines if line.get_linewidth() == 1.8]
    return tips, [line for line in axes.lines if line.get_linewidth() == 3.0]


def test_tips_and_blades_are_drawn_from_the_side_and_from_above():
    nodes = helix(0.3)
    figure = wake_picture(nodes, RADIUS, "a wake of $1")
    for axes, up in zip(figure.axes, (2, 1), strict=True):
        tips, blades = thick(axes)
        assert len(tips) == len(blades) == 2
        for blade in range(2):
            np.testing.assert_allclose(tips[blade].get_xdata(), nodes[blade, -1, :, 0] / RADIUS)
            np.testing.assert_allclose(tips[blade].get_ydata(), nodes[blade, -1, :, up] / RADIUS)
            np.testing.assert_allclose(blades[blade].get_ydata(), nodes[blade, :, 0, up] / RADIUS)
        assert tips[0].get_color() != tips[1].get_color()
        assert axes.get_aspect() == 1.0
        # All of it is on the page.
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        assert left < (nodes[..., 0] / RADIUS).min() and (nodes[..., 0] / RADIUS).max() < right
        assert low < (nodes[..., up] / RADIUS).min() and (nodes[..., up] / RADIUS).max() < high
    assert figure._suptitle.get_text() == r"a wake of \$1"


def test_an_animation_has_a_frame_for_each_moment(tmp_path):
    image = pytest.importorskip("PIL.Image")
    azimuths = np.array([0.0, 2.0, 4.0])
    moments = np.stack([helix(azimuth) for azimuth in azimuths])
    write_wake_animation(tmp_path / "wake.gif", moments, azimuths, RADIUS, "a wake")
    with image.open(tmp_path / "wake.gif") as gif:
        assert gif.n_frames == 3
        frames = []
        for number in range(3):
            gif.seek(number)
            frames.append(np.asarray(gif.convert("L"), float))
    # The wake moves, and the page does not: its left edge, with the numbers, stays, but for the
    # shades of a GIF.
    change = np.abs(frames[2] - frames[0])
    assert change.max() > 150.0 and change[:, 40:].mean() > 5.0 * change[:, :40].mean()


def test_moments_that_are_none_are_refused(tmp_path):
    for moments, azimuths in ((np.stack([helix(0.0)]), [0.0]), (np.stack([helix(0.0)] * 3), [0.0])):
        with pytest.raises(ValueError, match="an animation needs two snapshots or more"):
            write_wake_animation(tmp_path / "wake.gif", moments, azimuths, RADIUS)
    assert not list(tmp_path.iterdir())
