"""The rotor's skin as triangles, for CAD and printing: STL files."""

from __future__ import annotations

from pathlib import Path

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.geometry.surface import surface_quads
from propmdao.runtime.output_files import replacing

Triangles = npt.NDArray[np.float32]

# Of the radius: single precision resolves 6e-8 of it, printers and CAD far less than this.
_LEAST_GAP = 1e-5

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def rotor_triangles(nodes: npt.ArrayLike, n_blades: int) -> Triangles:
    """Closed surfaces of all blades, each by itself: there is no hub.

    Parameters
    ----------
    nodes : (n_contour, n_span, 3) array_like
        Points of the surface of blade 1, as `surface_nodes` makes them [m].
    n_blades : int
        Number of blades, equally spaced about the axis, z.

    Returns
    -------
    (n, 3, 3) array
        Corners of the triangles [m], counter-clockwise seen from outside, in single precision as
        STL has them. Every edge is shared by two triangles.
    """
    a, b, c, d = (np.asarray(q) for q in surface_quads(jnp.asarray(_sharpened(nodes))))
    blade = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    angle = 2.0 * np.pi * np.arange(n_blades) / n_blades
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.zeros((n_blades, 3, 3))
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1] = cos, -sin, sin, cos
    turn[:, 2, 2] = 1.0
    triangles = np.einsum("bij,nkj->bnki", turn, blade).reshape(-1, 3, 3).astype(np.float32)
    # Leading edge, sharp trailing edge: where two corners are one, the neighbours meet.
    merged = np.any(np.all(triangles == np.roll(triangles, 1, axis=1), axis=2), axis=1)
    return triangles[~merged]


def _sharpened(nodes: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Nodes with both ends of a section as one where its trailing edge has next to no thickness.

    A trailing edge that ends in rounding alone would become faces without area.
    """
    sharp = np.array(nodes, float)
    least = _LEAST_GAP * np.abs(sharp).max()
    closed = np.linalg.norm(sharp[0] - sharp[-1], axis=-1) < least
    sharp[0, closed] = sharp[-1, closed] = 0.5 * (sharp[0, closed] + sharp[-1, closed])
    return sharp


def write_stl(path: str | Path, triangles: Triangles, title: str) -> None:
    """Write triangles as a binary STL file.

    Parameters
    ----------
    path : str or Path
        File to write.
    triangles : (n, 3, 3) array
        Corners, counter-clockwise seen from outside.
    title : str
        Title of the file, of which 80 bytes are kept.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    first, second, third = np.moveaxis(np.asarray(triangles, float), 1, 0)
    normal = np.cross(second - first, third - first)
    facets = np.zeros(len(triangles), _FACET)
    facets["normal"] = normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    facets["corners"] = triangles
    header = title.encode("ascii", "replace")[:80].ljust(80)
    count = np.array(len(facets), "<u4")
    with replacing(path) as file:
        file.write_bytes(header + count.tobytes() + facets.tobytes())
