"""One guard for all results: they are finite, or a failure that says which is not, and where."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

#: An axis of results: a word for messages, as "observer", or a label for each of its entries.
Axis = str | Sequence[str]


class NotFiniteError(ValueError):
    """A number is none, or infinite; the message is one line."""


def require_finite(name: str, values: ArrayLike, *axes: Axis, where: str = "") -> None:
    """Refuse values that are not numbers, or infinite; call it outside ``jit``.

    Parameters
    ----------
    name : str
        Name of the quantity.
    values : array
        Values of the quantity, real or complex.
    *axes : str or sequence of str
        Words or labels of the leading axes; entries of axes without them are counted.
    where : str
        End of the message, such as ", at 4200 rpm and 8 m/s".

    Raises
    ------
    NotFiniteError
        ``spl_db of observer 2, 400 Hz is nan, at 4200 rpm and 8 m/s``; counts are from 1.
    """
    array = np.asarray(values)
    finite = np.isfinite(array)
    if finite.all():
        return
    place = tuple(int(i) for i in np.argwhere(~finite)[0])
    named = [
        f"{axis} {i + 1}" if isinstance(axis, str) else axis[i]
        for axis, i in zip(axes, place, strict=False)
    ]
    if array.size > 1 and len(place) > len(axes):
        named.append("entry " + ", ".join(str(i + 1) for i in place[len(axes) :]))
    entry = f" of {', '.join(named)}" if named else ""
    raise NotFiniteError(f"{name}{entry} is {array[place]}{where}")
