"""How many points of a blade are solved for in one compiled call."""

from __future__ import annotations

from propmdao.runtime.side_by_side import is_accelerated

#: Points of a call by blade elements, and of any on an accelerator.
MANY = 64
#: Points of a call by the lattice on a processor: what no point changes is computed once, 0.7 of
#: the time of single calls; more points do not fit the caches.
_FEW = 4
_FEWEST = 3  # for which a call of several is worth its compilation


def points_in_a_call(n_points: int, blade_element: bool) -> int:
    """Number of points in axial flight that one call solves for; fewer are filled up.

    Parameters
    ----------
    n_points : int
        Points that there are of a blade.
    blade_element : bool
        Whether it is blade elements that are solved for, or the lattice.

    Returns
    -------
    int
        One where each point has a call of its own.
    """
    if blade_element or is_accelerated():
        return MANY
    return _FEW if n_points >= _FEWEST else 1
