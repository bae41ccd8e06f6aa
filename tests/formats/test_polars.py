"""Polars from files: what is read, and one clear line for what is wrong."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable, section_coefficients
from propmdao.aerodynamics.sections.polars.user_table import Polar, table_from_polars
from propmdao.formats.c81 import read_c81
from propmdao.formats.polars import load_polars, read_polar, read_polars

XFLR5 = """xflr5 v6.61

 Calculated polar for: FLAT 6

 1 1 Reynolds number fixed          Mach number fixed

 xtrf =   1.000 (top)        1.000 (bottom)
 Mach =   0.000     Re =     0.060 e 6     Ncrit =   7.000

  alpha     CL        CD       CDp       Cm    Top Xtr Bot Xtr   Cpmin    Chinge    XCp
 ------- -------- --------- --------- -------- ------- ------- -------- --------- ---------
"""
ANGLES = np.arange(-6.0, 10.5, 1.0)


def lift(degrees: np.ndarray) -> np.ndarray:
    return 0.3 + 0.1 * degrees


def drag(degrees: np.ndarray) -> np.ndarray:
    return 0.02 + 1e-4 * degrees**2


def rows(degrees: np.ndarray = ANGLES) -> list[str]:
    return [
        f"{a:8.3f} {lift(a):8.4f} {drag(a):9.5f} 0.01 -0.0500 1.0 1.0 -1.0 0.0 0.0 0.0 0.3\n"
        for a in degrees
    ]


def written(folder: Path, text: str, name: str = "flat.txt") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def coefficients_at(table: PolarTable, degrees: np.ndarray, re: float = 6e4) -> np.ndarray:
    strips = dataclasses.replace(table, values=jnp.repeat(table.values, degrees.size, axis=0))
    coefficients = section_coefficients(strips, jnp.radians(degrees), jnp.full(degrees.size, re))
    return np.stack([np.asarray(values) for values in coefficients])


def test_xflr5_polar(tmp_path: Path) -> None:
    # Rows are written from 0 up and then from 0 down.
    order = [*rows(ANGLES[6:]), *rows(ANGLES[5::-1])]
    polar = read_polar(written(tmp_path, XFLR5 + "".join(order)))
    assert (polar.name, polar.re, polar.mach, polar.n_crit) == ("FLAT 6", 6e4, 0.0, 7.0)
    np.testing.assert_allclose(np.degrees(polar.alpha), ANGLES, atol=1e-12)
    np.testing.assert_allclose(polar.cl, lift(ANGLES), atol=1e-12)
    np.testing.assert_allclose(polar.cd, drag(ANGLES), atol=1e-12)
    np.testing.assert_array_equal(polar.cm, -0.05)


def test_xfoil_polar(tmp_path: Path) -> None:
    header = XFLR5.replace("xflr5 v6.61", "       XFOIL         Version 6.99")
    header = header.replace("Cm    Top Xtr Bot Xtr", " CM     Top_Xtr  Bot_Xtr")
    assert read_polar(written(tmp_path, header + "".join(rows()))).cm[0] == -0.05


def test_a_polar_is_kept_where_it_has_values_and_continued_outside(tmp_path: Path) -> None:
    table = read_polars(written(tmp_path, XFLR5 + "".join(rows())))
    cl, cd, cm = coefficients_at(table, ANGLES)
    np.testing.assert_allclose(cl, lift(ANGLES), atol=1e-9)
    np.testing.assert_allclose(cd, drag(ANGLES), rtol=1e-9)
    np.testing.assert_allclose(cm, -0.05, atol=1e-9)
    around = coefficients_at(table, np.linspace(-180.0, 180.0, 721))
    assert np.isfinite(around).all()
    assert around[1].max() == pytest.approx(2.01, abs=1e-3)


def test_one_reynolds_number_holds_for_all(tmp_path: Path) -> None:
    table = read_polars(written(tmp_path, XFLR5 + "".join(rows())))
    np.testing.assert_allclose(
        coefficients_at(table, ANGLES, 1e3), coefficients_at(table, ANGLES, 1e7), rtol=1e-12
    )


def test_polars_are_sorted_by_reynolds_number_and_kept_there(tmp_path: Path) -> None:
    text = XFLR5 + "".join(rows())
    high = text.replace("0.060 e 6", "0.240 e 6").replace(" 0.02", " 0.01")
    table = read_polars(written(tmp_path, high, "a.txt"), written(tmp_path, text, "b.txt"))
    np.testing.assert_allclose(np.exp(table.log_re), [6e4, 2.4e5])
    assert coefficients_at(table, np.zeros(1), 6e4)[1, 0] == pytest.approx(0.02)
    assert coefficients_at(table, np.zeros(1), 2.4e5)[1, 0] == pytest.approx(0.01)
    assert coefficients_at(table, np.zeros(1), 1.2e5)[1, 0] == pytest.approx(
        0.01 * 2**0.5
    )  # logarithmic
    with pytest.raises(PolarError, match="'FLAT 6' and 'FLAT 6' are equal: 60000"):
        read_polars(tmp_path / "b.txt", tmp_path / "b.txt")


NAMES = "alpha CL CD CDp Cm Top_Xtr Bot_Xtr Cpmin Chinge XCp a b".split()
HEADER = XFLR5[: XFLR5.index("  alpha")]
TOOLS = """Xfoil polar. Reynolds number fixed. Mach  number fixed
Polar key,xf-flat-il-60000
Airfoil,FLAT 6
Reynolds number,60000
Ncrit,7
Mach,0
Max Cl/Cd alpha,5.25
Url,http://example.org

"""


@pytest.mark.parametrize(
    "text",
    [
        TOOLS + "".join(",".join(line.split()) + "\n" for line in [" ".join(NAMES), *rows()]),
        HEADER + "".join(",".join(line.split()) + ",\n" for line in [" ".join(NAMES), *rows()]),
        HEADER
        + "".join(
            ";".join(line.split()).replace(".", ",") + "\n" for line in [" ".join(NAMES), *rows()]
        ),
        "\ufeff" + XFLR5 + "".join(rows()),
        HEADER + " ".join(NAMES) + "  " + "".join(rows()),  # the first row behind the names
        XFLR5.removesuffix("\n") + "".join(rows()),  # or behind the line under them
    ],
)
def test_dialects_are_the_same_polar(text: str, tmp_path: Path) -> None:
    plain = read_polar(written(tmp_path, XFLR5 + "".join(rows()), "plain.txt"))
    path = tmp_path / "other.txt"
    path.write_text(text, encoding="utf-8")
    polar = read_polar(path)
    assert (polar.name, polar.re, polar.mach, polar.n_crit) == ("FLAT 6", 6e4, 0.0, 7.0)
    for name in ("alpha", "cl", "cd", "cm"):
        np.testing.assert_array_equal(getattr(polar, name), getattr(plain, name))


def test_a_symmetric_section_goes_on_below(tmp_path: Path) -> None:
    half = "".join(f"{a:g} {0.1 * a:g} {drag(a):g} 0 {-0.002 * a:g}\n" for a in range(11))
    polar = read_polar(written(tmp_path, XFLR5 + half))
    np.testing.assert_allclose(np.degrees(polar.alpha), np.arange(-10, 11), atol=1e-12)
    np.testing.assert_allclose(polar.cl, 0.1 * np.arange(-10, 11), atol=1e-12)
    np.testing.assert_allclose(polar.cd, drag(np.arange(-10, 11)), atol=1e-12)
    np.testing.assert_allclose(polar.cm, -0.002 * np.arange(-10, 11), atol=1e-12)


def test_a_polar_at_a_mach_number_is_found_again_there(tmp_path: Path) -> None:
    text = XFLR5.replace("Mach =   0.000", "Mach =   0.500") + "".join(rows())
    table = read_polars(written(tmp_path, text))
    degrees = np.array([-4.0, 0.0, 6.0])
    strips = dataclasses.replace(table, values=jnp.repeat(table.values, 3, axis=0))
    cl, cd, _ = section_coefficients(strips, jnp.radians(degrees), jnp.full(3, 6e4), 0.5)
    np.testing.assert_allclose(cl, lift(degrees), atol=1e-9)
    np.testing.assert_allclose(cd, drag(degrees), rtol=1e-9)


BODY = "".join(rows())
FIXED = "1 1 Reynolds number fixed          Mach number fixed"
WRONG = {
    "no columns": (XFLR5.replace("alpha", "angle") + BODY, "no line names the columns alpha, CL"),
    "no drag": (XFLR5.replace(" CD ", " XX ") + BODY, "line 10: missing column 'cd'; found: alpha"),
    "no Re": (XFLR5.replace("Re =", "Rn =") + BODY, "the header has no 'Re = ...'"),
    "no number": (XFLR5 + BODY.replace("0.4000", "0.4x00"), "line 19, column 'cl': '0.4x00' is no"),
    "not finite": (XFLR5 + BODY.replace("0.4000", "nan"), "line 19, column 'cl': 'nan' is not fin"),
    "short row": (XFLR5 + BODY + " 11.0 1.4\n", "line 29: 2 values, too few for its columns"),
    "few rows": (XFLR5 + "".join(rows(ANGLES[6:9])), "needs at least 5 angles; it has 3"),
    "gap": (
        XFLR5 + "".join(rows(np.array([-6.0, -5.0, 0.5, 1.0, 2.0, 3.0, 4.0]))),
        "alpha has a gap from -5 to 0.5 deg; steps must not exceed 5 deg",
    ),
    "narrow": (XFLR5 + "".join(rows(ANGLES[6:])), "must span at least -1..4 deg; it spans 0..10"),
    "twice": (XFLR5 + BODY + rows()[3], "alpha -3 deg is given twice"),
    "drag counts": (
        XFLR5 + "".join(f" {a:g} {lift(a):g} {1e4 * drag(a):g} 0 0\n" for a in ANGLES),
        r"cd must be below 3; it is 300 at 10 deg \(in drag counts\?\)",
    ),
    "radians": (
        XFLR5
        + "".join(f" {np.radians(a):.6f} {lift(a):g} 0.02 0 0\n" for a in np.arange(-60, 300, 5.0)),
        "cl changes by 5.73 per degree: alpha seems to be in radians",
    ),
    "no drag at all": (
        XFLR5 + BODY.replace(" 0.02000", " 0.00000"),
        "cd must be positive; it is 0",
    ),
    "Re in millions": (XFLR5.replace("0.060 e 6", "0.060") + BODY, "at least 1000; it is 0.06"),
    "type 2": (
        XFLR5.replace(FIXED, "2 2 Reynolds number ~ 1/sqrt(CL)   Mach number ~ 1/sqrt(CL)") + BODY,
        r"line 5: 'Reynolds number ~ 1/sqrt\(CL\)': Reynolds or Mach number varies with lift",
    ),
    "type 3": (
        XFLR5.replace(FIXED, "3 1 Reynolds number ~ 1/CL   Mach number fixed") + BODY,
        "line 5: 'Reynolds number ~ 1/CL': Reynolds or Mach number varies with lift",
    ),
    "type 4": (
        XFLR5.replace(FIXED, "4 1 Reynolds number range") + BODY,
        "line 5: a polar of type 4",
    ),
    "two rows in a line": (
        XFLR5 + BODY.replace("\n", "", 1),
        "line 12: 24 values, too many for its columns",
    ),
    "column twice": (XFLR5.replace("CDp", " CD") + BODY, "line 10: more than one column 'cd'"),
    "Re of 999 digits": (
        XFLR5.replace("0.060 e 6", "0.060 e 999") + BODY,
        "line 8: Re: '0.060e999' is not finite",
    ),
    "Re no number": (XFLR5.replace("0.060 e 6", "lots") + BODY, "line 8: Re: 'lots' is no number"),
    "Re too large": (
        XFLR5.replace("0.060 e 6", "0.060 e 20") + BODY,
        "must be at most 1e.11; it is",
    ),
    "1e308": (XFLR5 + BODY.replace("0.4000", "1e308"), "line 19, column 'cl': '1e308' is out of"),
    "first row of inf": (
        XFLR5 + "inf " * 12 + "\n" + BODY,
        "line 12, column 'alpha': 'inf' is not",
    ),
    "far angle": (XFLR5 + BODY + "1e6 0 0.1 0 0\n", "alpha must be within -180..180 deg; .* 1e.06"),
    "Mach": (XFLR5.replace("Mach =   0.000", "Mach =   0.800") + BODY, "within 0..0.7.*it is 0.8"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_file_is_described_in_one_line(tmp_path: Path, case: str) -> None:
    text, message = WRONG[case]
    with pytest.raises(PolarError, match=message) as caught:
        read_polar(written(tmp_path, text))
    assert str(caught.value).startswith(f"{tmp_path / 'flat.txt'}: ")
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(PolarError, match="none.txt: cannot be read: No such file"):
        read_polar(tmp_path / "none.txt")
    with pytest.raises(PolarError, match="at least one polar"):
        table_from_polars([])


def test_arrays_of_a_polar_belong_together() -> None:
    with pytest.raises(PolarError, match="cl must be 6 finite numbers, one per angle"):
        Polar("x", 1e5, 0.0, np.radians(np.arange(-2, 10, 2.0)), *(np.ones(5),) * 3)


def test_the_ending_says_which_format_a_polar_has(tmp_path: Path) -> None:
    columns = f"{'FLAT PLATE':30}" + "0109" * 3 + "\n"
    angles = "".join(f"{a:7.1f}{0.0:7.3f}\n" for a in range(-8, 10, 2))
    drag_rows = angles.replace("  0.000\n", "  0.020\n")
    numbers = [" " * 7 + "  0.000\n" + rows for rows in (angles, drag_rows, angles)]
    table = written(tmp_path, columns + "".join(numbers), "flat.C81")
    np.testing.assert_array_equal(load_polars(table).values, read_c81(table).values)
    polar = written(tmp_path, XFLR5 + "".join(rows()), "flat.pol")
    np.testing.assert_array_equal(load_polars(polar).values, read_polars(polar).values)
    with pytest.raises(PolarError) as caught:
        load_polars(polar, table)
    assert str(caught.value) == f"{table}: a C81 file stands alone; there is also {polar}"
    with pytest.raises(PolarError, match="at least one polar"):
        load_polars()
