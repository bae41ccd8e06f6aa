"""Pictures of a wake: its filaments from the side and from above, at a moment or moving."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import RUN_COLORS, Floats
from propmdao.figures.style import GRID, headline, literal, page
from propmdao.runtime.output_files import replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_INNER = 8  # filaments that are drawn beside that of the tip
_MARGIN = 0.1  # around the wake, in radii
_VIEWS = {2: "z/R, thrust upward", 1: "y/R, seen from the thrust's side"}  # vertical axis


def wake_picture(nodes: npt.ArrayLike, radius: float, title: str = "") -> Figure:
    """Draw the filaments of a wake from the side and from above.

    Parameters
    ----------
    nodes : (n_blades, n_filaments, n_nodes, 3) array
        Nodes of the filaments, from root to tip and from the trailing edge on, in the axes that do
        not turn [m].
    radius : float
        Tip radius [m].
    title : str
        Title.

    Returns
    -------
    Figure
        Side view, in which flight is to the right, and view from above; the tip's filament thick,
        some of the others thin, each blade in its colour.
    """
    over_radius = np.asarray(nodes, float) / radius
    figure, draw = _prepared(over_radius[None], title)
    draw(over_radius, title)
    return figure


def write_wake_animation(
    path: str | Path,
    snapshots: npt.ArrayLike,
    azimuths: npt.ArrayLike,
    radius: float,
    title: str = "",
) -> None:
    """Write a GIF of a wake that moves.

    Parameters
    ----------
    path : str or Path
        File to write, which ends in .gif.
    snapshots : (n_snapshots, n_blades, n_filaments, n_nodes, 3) array
        Nodes as in `wake_picture`, moment by moment [m].
    azimuths : (n_snapshots,) array
        Azimuths of blade 1 at the moments, turns counted [rad].
    radius : float
        Tip radius [m].
    title : str
        Title, to which the revolutions are added.

    Raises
    ------
    ValueError
        If there are fewer than two snapshots, or not as many azimuths.
    OutputError
        If the file cannot be written.
    """
    from matplotlib.animation import FuncAnimation, PillowWriter

    moments, turns = np.asarray(snapshots, float) / radius, np.asarray(azimuths) / (2.0 * np.pi)
    if len(moments) < 2 or turns.shape != moments.shape[:1]:
        raise ValueError(
            "an animation needs two snapshots or more, and their azimuths; there are"
            f" {len(moments)} and {turns.size}"
        )
    figure, draw = _prepared(moments, title)
    figure.set_dpi(72)  # of many frames
    draw(moments[0], title)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laid out once, not for every frame

    def frame(number: int) -> list[Any]:
        draw(moments[number], f"{title}; revolution {turns[number]:.2f}")
        return []

    moving = FuncAnimation(figure, frame, frames=len(moments), init_func=list)
    with replacing(path) as file:
        moving.save(file, writer=PillowWriter(fps=10))


def _prepared(moments: Floats, title: str) -> tuple[Figure, Callable[[Floats, str], None]]:
    """Figure with room for the wake at all moments, and the function that draws it at one."""
    low, high = (extreme(moments, axis=(0, 1, 2, 3)) for extreme in (np.min, np.max))
    low, high = np.minimum(low, -1.0) - _MARGIN, np.maximum(high, 1.0) + _MARGIN
    high[2] = max(high[2] - 1.0 + _MARGIN, 0.3)
    width, heights = high[0] - low[0], [(high - low)[axis] for axis in _VIEWS]
    figure = page(min(1.2 + 8.0 * sum(heights) / width, 14.0))
    views = figure.subplots(2, 1, sharex=True, height_ratios=heights)
    lines: list[tuple[Any, int, int, int]] = []
    n_blades, n_filaments = moments.shape[1:3]
    for axes, (up, label) in zip(views, _VIEWS.items(), strict=True):
        axes.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[up], high[up]), ylabel=label)
        axes.grid(**GRID)
        lines += _lines(axes, n_blades, n_filaments, up)
    views[1].set_xlabel("x/R, flight to the right")
    text = headline(figure, title)

    def draw(nodes: Floats, heading: str) -> None:
        text.set_text(literal(heading))
        for line, blade, filament, up in lines:
            # The blade itself is a line of the first nodes.
            shown = nodes[blade, :, 0] if filament < 0 else nodes[blade, filament]
            line.set_data(shown[:, 0], shown[:, up])

    return figure, draw


def _lines(axes: Axes, n_blades: int, n_filaments: int, up: int) -> list[tuple[Any, int, int, int]]:
    """Empty lines of one view: with their blade, filament (-1 is the blade), vertical axis."""
    lines = []
    for blade in range(n_blades):
        color = RUN_COLORS[1 + blade % (len(RUN_COLORS) - 1)]
        tip = n_filaments - 1
        inner = np.unique(np.linspace(0, tip, _INNER + 1).round().astype(int)[:-1])
        for filament in (*inner, tip):
            style: dict[str, Any] = {"linewidth": 0.5, "alpha": 0.6}
            if filament == tip:
                style = {"linewidth": 1.8, "zorder": 3}
            lines.append((axes.plot([], [], color=color, **style)[0], blade, filament, up))
        lines.append((axes.plot([], [], color="black", linewidth=3.0)[0], blade, -1, up))
    return lines
