"""Section polars that ship against XFLR5 polars of E63 (n_crit 6) and Clark-Y (n_crit 7).

The tables, with drag as computed, are NeuralFoil at n_crit 5, which was trained on XFOIL: this
checks sections, angles, interpolation and network together, and shows what the other n_crit does,
which is most of it: at their own n_crit NeuralFoil meets these polars within 0.01 in cl (Clark-Y
from Re 6e4 up, E63).
Differences are means over -4 to 8 deg of angle of attack, where both sections are attached.
"""

from __future__ import annotations

from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.family import section_tables
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import section_coefficients
from propmdao.aerodynamics.sections.polars.user_table import PolarError
from propmdao.formats.polars import read_polar
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller
from propmdao.records.models import Transition

SECTIONS = {"e63": "E63_T1_Re*", "clarky": "CLARK_Y_AIRFOIL_T1_Re*"}
#: Angles within -4..8 deg at most; one size compiles once.
MOST = 32


def differences(
    reference_data: Path,
    airfoil: str,
    transition: Transition = Transition(),  # noqa: B008
) -> np.ndarray:
    """Rows of Re, mean |dcl|, mean |dcd|, mean dcd/cd, mean |dcm| of an airfoil."""
    section, r = find_airfoil(airfoil), np.array([0.5, 1.0])
    described = Propeller("x", 1.0, 2, r, 0.1 * r, r, [(0.0, airfoil)])
    polars = polars_for(described, transition=transition, measured_drag=False)
    table = section_tables(
        polars,
        jnp.tile(polars.weights[:1], (MOST, 1)),
        jnp.full(MOST, section.max_camber),
        jnp.full(MOST, section.max_thickness),
    )
    rows = []
    for path in (reference_data / "airfoils" / "polars").glob(SECTIONS[airfoil]):
        try:
            polar = read_polar(path)
        except PolarError as error:
            assert "gap" in str(error)  # XFOIL did not converge on the negative side
            continue
        chosen = np.abs(polar.alpha - np.radians(2.0)) < np.radians(6.01)
        alpha = jnp.zeros(MOST).at[: int(chosen.sum())].set(polar.alpha[chosen])
        found = section_coefficients(table, alpha, jnp.full(MOST, polar.re))
        cl, cd, cm = (np.asarray(values)[: int(chosen.sum())] for values in found)
        given = polar.cl[chosen], polar.cd[chosen], polar.cm[chosen]
        dcl, dcd, dcm = (a - b for a, b in zip((cl, cd, cm), given, strict=True))
        rows.append(
            [polar.re, *(np.abs(d).mean() for d in (dcl, dcd)), (dcd / given[1]).mean()]
            + [np.abs(dcm).mean()]
        )
    return np.array(sorted(rows))


# Mean |dcl|, |dcd| and relative dcd by Reynolds number.
MEASURED = {
    "e63": """
        30e3 0.0223 0.00163 -0.028 | 40e3 0.0188 0.00147 -0.030 | 60e3 0.0204 0.00118 -0.032
        80e3 0.0341 0.00189 -0.052 | 130e3 0.0230 0.00121 -0.039 | 160e3 0.0205 0.00128 -0.038
        200e3 0.0181 0.00136 -0.035 | 300e3 0.0080 0.00059 -0.008 | 1e6 0.0078 0.00052 0.003""",
    "clarky": """
        30e3 0.1146 0.00959 -0.170 | 40e3 0.0786 0.00615 -0.164 | 60e3 0.0521 0.00337 -0.128
        80e3 0.0291 0.00204 -0.094 | 100e3 0.0212 0.00129 -0.069 | 130e3 0.0124 0.00063 -0.038
        160e3 0.0109 0.00039 -0.019 | 200e3 0.0095 0.00028 -0.004 | 300e3 0.0081 0.00027 0.016
        500e3 0.0072 0.00027 0.028""",
}


@pytest.mark.parametrize("airfoil", SECTIONS)
def test_differences_from_xflr5_are_those_measured(
    reference_data: Path, airfoil: str, drawn
) -> None:
    rows = MEASURED[airfoil].strip().replace("\n", "|").split("|")
    expected = np.array([row.split() for row in rows], dtype=float)
    measured = differences(reference_data, airfoil)
    for k, label in ((1, "mean difference in cl"), (2, "mean difference in cd")):
        drawn(
            f"{airfoil}, {label}", ("Reynolds number", label), measured[:, 0],
            {"n_crit 5, the tables": measured[:, k]}, {}, log=True,
        )  # fmt: skip
    np.testing.assert_allclose(measured[:, 0], expected[:, 0], rtol=1e-6)
    # Bands of a tenth, and the rounding of the numbers above.
    np.testing.assert_allclose(measured[:, 1], expected[:, 1], rtol=0.1)
    np.testing.assert_allclose(measured[:, 2], expected[:, 2], rtol=0.1)
    np.testing.assert_allclose(measured[:, 3], expected[:, 3], atol=0.003)


@pytest.mark.parametrize(("airfoil", "n_crit"), [("e63", 6.0), ("clarky", 7.0)])
def test_most_of_the_difference_is_that_of_n_crit(
    reference_data: Path, airfoil: str, n_crit: float
) -> None:
    """With the n_crit of the polars, between two tables or one of them."""
    at_five = differences(reference_data, airfoil)
    at_own = differences(reference_data, airfoil, Transition(n_crit))
    assert at_own[:, 1].max() < 0.023 and np.abs(at_own[:, 3]).max() < 0.025
    assert (at_own[:, 1:3].mean(axis=0) < 0.7 * at_five[:, 1:3].mean(axis=0)).all()
