"""What of a propeller may be designed: what is free, what is minimised, what is limited.

Options of ``propmdao optimise`` and arguments of `propmdao.components.design_problem` come from
these tables. Nothing here is slow to import.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from propmdao.records.units import Range

if TYPE_CHECKING:  # help of the command line comes from here, and does without NumPy
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Free:
    """A distribution over span that may be free, as changes of the described one.

    Attributes
    ----------
    distribution : str
        Name of the distribution in `PropellerGroup`.
    meaning : str
        What the numbers of a range are.
    unit : str
        Unit of the numbers; empty where there is none.
    default : (float, float)
        Range where the user gives none.
    allowed : Range
        Values that an end of a range may have.
    within : (float, float) or None
        Values that the distribution itself keeps, those that the polars know; the range is
        narrowed to them. None: any.
    """

    distribution: str
    meaning: str
    unit: str
    default: tuple[float, float]
    allowed: Range
    within: tuple[float, float] | None = None

    def ends(self, range_: tuple[float, float], here: Floats) -> tuple[Floats, Floats]:
        """Narrow a range of changes to what the distribution itself keeps.

        Parameters
        ----------
        range_ : (float, float)
            Lowest and highest change, with no change between them.
        here : (n,) array
            The described distribution at the control points.

        Returns
        -------
        lower, upper : (n,) arrays
            Lowest and highest change at the control points; no change is always between them, even
            where the described blade is outside of what the polars know.
        """
        import numpy as np

        lower, upper = (np.full(here.size, end) for end in range_)
        if self.within is not None:
            lowest, highest = self.within
            lower = np.minimum(np.maximum(lower, lowest - here), 0.0)
            upper = np.maximum(np.minimum(upper, highest - here), 0.0)
        return lower, upper


def control_radii(root_r_over_R: float, n_control: int) -> Floats:
    """Radii of the control points of free distributions, evenly from root to tip.

    Parameters
    ----------
    root_r_over_R : float
        First station of the blade, r/R.
    n_control : int
        Number of control points.

    Returns
    -------
    (n_control,) array
        r/R.
    """
    import numpy as np

    return np.linspace(root_r_over_R, 1.0, n_control)


#: What may be free, by the word for it.
FREE = {
    "chord": Free("chord_over_R", "times the described chord", "", (0.7, 1.5), Range(0.1, 10.0)),
    "twist": Free(
        "beta", "added to the described blade angle", "deg", (-8.0, 8.0), Range(-60.0, 60.0, "deg")
    ),
    "camber": Free(
        "camber_over_chord",
        "added to the described camber over chord",
        "",
        (-0.03, 0.03),
        Range(-0.2, 0.2),
        (0.0, 0.09),
    ),
    "thickness": Free(
        "thickness_over_chord",
        "added to the described thickness over chord",
        "",
        (-0.03, 0.03),
        Range(-0.5, 0.5),
        (0.03, 0.22),
    ),
    "sweep": Free(
        "sweep_over_R",
        "added to the described sweep over tip radius, outside the root",
        "",
        (-0.15, 0.15),
        Range(-1.0, 1.0),
    ),
}


@dataclasses.dataclass(frozen=True)
class Response:
    """A result that may be minimised or limited.

    Attributes
    ----------
    output : str
        Name of the output of `PropellerGroup`, or of what `design_problem` adds to it.
    meaning : str
        Description of the result.
    unit : str
        Unit as OpenMDAO writes it; empty where there is none.
    label : str
        Name with unit for tables and axes.
    allowed : Range
        Values that a limit may have.
    is_noise : bool
        Whether it is heard: the level of the mean square over observers and operating points.
    has_broadband : bool
        Whether broadband noise is in it.
    may_be_minimised : bool
        Whether it is an objective; all of them may be limited from above.
    """

    output: str
    meaning: str
    unit: str
    label: str
    allowed: Range
    is_noise: bool = False
    has_broadband: bool = False
    may_be_minimised: bool = True


_LEVEL = Range(-100.0, 200.0, "dB")
#: What may be minimised or limited from above, by the word for it.
RESPONSES = {
    "dba": Response(
        "oaspl_total_dba", "A-weighted level of tones and broadband noise", "", "total, dBA",
        _LEVEL, is_noise=True, has_broadband=True,
    ),
    "db": Response(
        "oaspl_total_db", "level of tones and broadband noise", "", "total, dB", _LEVEL,
        is_noise=True, has_broadband=True,
    ),
    "tones": Response(
        "oaspl_db", "level of the tones alone", "", "tones, dB", _LEVEL, is_noise=True
    ),
    "torque": Response(
        "torque", "torque of all blades", "N*m", "torque, N m", Range(1e-9, 1e9, "N m")
    ),
    "power": Response(
        "shaft_power", "shaft power of all blades", "W", "shaft power, W", Range(1e-9, 1e12, "W")
    ),
    "tip-mach": Response(
        "tip_mach", "Mach number of the tip's way through the air", "", "helical tip Mach number",
        Range(0.01, 1.0), may_be_minimised=False,
    ),
}  # fmt: skip
#: Words of objectives.
OBJECTIVES = tuple(word for word, response in RESPONSES.items() if response.may_be_minimised)
#: Word for a limit that is what the described blade has.
BASELINE = "baseline"
#: Least thickness of the sections in metres.
THICKNESS = Range(1e-6, 1.0, "m")
#: Control points of each free distribution, over span: OpenMDAO's cubic curves need five.
N_CONTROL = Range(5, 20)
