"""C81 files: their columns are used at their Mach numbers, wrong ones are one clear line."""

from __future__ import annotations

import dataclasses
import warnings
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.high_angle import ALPHA
from propmdao.aerodynamics.sections.polars.mach import prandtl_glauert
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import (
    PolarError,
    PolarRangeWarning,
    PolarTable,
    section_coefficients,
    warn_outside,
)
from propmdao.formats.c81 import read_c81
from propmdao.formats.propellers import load_propeller

CIRCLE = np.array([-180.0, -90.0, -30.0, *range(-10, 12, 2), 30.0, 90.0, 180.0])
STEP = 0.05  # between the Mach numbers of the file


def c81(n_mach: int = 2, rise: float = 1.0) -> str:
    """C81 file of lift sin(2 a), drag 0.01 + 2 sin^2, no moment.

    Each column adds 1 to lift and moment and `rise` times the first to drag.
    """
    lines = ["FLAT PLATE".ljust(30) + f"{n_mach:2d}{CIRCLE.size:2d}" * 3]
    radians = np.radians(CIRCLE)
    tables = np.sin(2 * radians), 0.01 + 2 * np.sin(radians) ** 2, 0 * radians

    def fields(first: str, numbers: list[float]) -> None:
        for k in range(0, len(numbers), 9):
            block = "".join(f"{number:7.3f}" for number in numbers[k : k + 9])
            lines.append((first if k == 0 else " " * 7) + block)

    for number, table in enumerate(tables):
        fields(" " * 7, [STEP * k for k in range(n_mach)])
        for angle, value in zip(CIRCLE, table, strict=True):
            added = rise * value if number == 1 else 1.0
            fields(f"{angle:7.2f}", [value + k * added for k in range(n_mach)])
    return "\n".join(lines) + "\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "flat.c81"
    path.write_text(text)
    return path


def coefficients_at(table: PolarTable, degrees: np.ndarray, mach: float) -> np.ndarray:
    values = np.repeat(np.asarray(table.values), degrees.size, axis=0)
    strips = dataclasses.replace(table, values=values)
    re = np.full(degrees.size, 6e4)
    coefficients = jax.jit(section_coefficients)(strips, np.radians(degrees), re, mach)
    return np.stack([np.asarray(values) for values in coefficients])


@pytest.mark.parametrize("n_mach", [1, 2, 9, 11])
def test_columns_are_found_again_at_their_mach_numbers(tmp_path: Path, n_mach: int) -> None:
    table = read_c81(written(tmp_path, c81(n_mach)))
    radians = np.radians(CIRCLE)
    for k in {0, n_mach - 1}:
        cl, cd, cm = coefficients_at(table, CIRCLE, STEP * k)
        np.testing.assert_allclose(cl, np.sin(2 * radians) + k, atol=6e-4)  # three decimals
        np.testing.assert_allclose(cd, (1 + k) * (0.01 + 2 * np.sin(radians) ** 2), atol=6e-4)
        np.testing.assert_allclose(cm, float(k), atol=1e-9)


WIDE = c81(rise=4.0).replace("  0.050\n", "  0.600\n")  # columns at Mach 0 and 0.6


def test_between_two_columns_coefficients_are_straight_lines(tmp_path: Path) -> None:
    table = read_c81(written(tmp_path, WIDE))
    degrees = np.array([-4.0, 2.0, 8.0, 90.0])
    low, high = (coefficients_at(table, degrees, mach) for mach in (0.0, 0.6))
    for mach in (0.05, 0.3, 0.52):
        between = low + (mach / 0.6) * (high - low)
        np.testing.assert_allclose(
            coefficients_at(table, degrees, mach), between, rtol=0.01, atol=5e-4
        )


def test_a_column_that_is_alone_follows_the_rule_from_its_mach_number(tmp_path: Path) -> None:
    text = c81(1).replace(" " * 7 + "  0.000\n", " " * 7 + "  0.500\n")
    table = read_c81(written(tmp_path, text))
    assert table.mach is None
    at_own, slow = (coefficients_at(table, np.array([4.0]), mach) for mach in (0.5, 0.0))
    np.testing.assert_allclose(at_own[0], np.sin(np.radians(8.0)), atol=6e-4)
    np.testing.assert_allclose(slow[0] / at_own[0], np.sqrt(1.0 - 0.5**2))
    np.testing.assert_allclose(slow[1], at_own[1])


def test_derivatives_by_mach_number_are_those_of_the_values(tmp_path: Path) -> None:
    table = read_c81(written(tmp_path, WIDE))

    def coefficients(mach: jax.Array) -> jax.Array:
        alpha, re = jnp.radians(jnp.array([5.0])), jnp.array([1e5])
        return jnp.concatenate(section_coefficients(table, alpha, re, mach[None]))

    values, slopes = jax.jit(coefficients), jax.jit(jax.jacfwd(coefficients))
    for mach in (0.0, 0.13, 0.3, 0.6):  # nodes, and within a cell
        slope = slopes(mach)
        high, low = (np.asarray(values(mach + step)) for step in (1e-6, -1e-6))
        difference = (high - low) / 2e-6
        np.testing.assert_allclose(slope, difference, rtol=1e-5, atol=1e-6)


def test_only_mach_numbers_beyond_the_file_are_warned_of(tmp_path: Path) -> None:
    table = read_c81(written(tmp_path, WIDE))
    r = np.array([0.8])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_outside(table, np.array([2e3]), r, np.array([0.6]))
        warn_outside(table, np.array([2e8]), r, np.array([0.0]))
    with pytest.warns(
        PolarRangeWarning, match="Mach number 0.65 at r/R 0.8 is above 0.6; the polars"
    ):
        warn_outside(table, np.array([1e5]), r, np.array([0.65]))


def test_a_blade_may_mix_a_table_over_mach_number_with_the_catalogue(tmp_path: Path) -> None:
    propeller = load_propeller("apcsf_11x4.7_uiuc")
    table = read_c81(written(tmp_path, WIDE))
    plain, mixed = polars_for(propeller), polars_for(propeller, own={"e63": table})
    assert mixed.mach is not None and mixed.values.ndim == plain.values.ndim + 1
    np.testing.assert_array_equal(mixed.log_re, plain.log_re)
    # The shape that is not the user's is the same at all Mach numbers.
    last = np.asarray(mixed.values[-1])
    assert np.ptp(last, axis=3).max() == 0.0
    for k, mach in enumerate(np.asarray(mixed.mach)):
        own = np.asarray(mixed.values[0, 0, 0, :, k, 0])
        found = coefficients_at(table, np.degrees(ALPHA), float(mach))
        lift = own[0] * np.asarray(prandtl_glauert(mach, jnp.asarray(ALPHA)))
        np.testing.assert_allclose(lift, found[0], atol=1e-9)
        np.testing.assert_allclose(np.exp(own[1]), found[1], rtol=1e-9)


def test_lines_before_the_title_are_read_over(tmp_path: Path) -> None:
    plain = read_c81(written(tmp_path, c81()))
    behind = read_c81(written(tmp_path, "1 0 0\n0\n0\nwind tunnel data\n\n" + c81()))
    np.testing.assert_array_equal(behind.values, plain.values)


def changed(number: int, text: str) -> str:
    lines = c81().splitlines()
    lines[number - 1] = text
    return "\n".join(lines) + "\n"


TEXT = c81()
WRONG = (
    ("", "line 1: columns 31-42 must hold six counts"),
    (TEXT.replace(" 217", " 0 0", 1), "line 1: columns 31-42 must hold six counts"),
    ("\n".join(TEXT.splitlines()[:40]), "the moment table needs 17 angles up to line 55"),
    (TEXT.replace("  0.000  1.000", "  0.0x0  1.000", 1), "columns 8-14: '0.0x0' is no number"),
    (TEXT.replace("  0.010", " -0.010"), "cd must be positive"),
    (changed(9, " -16.00  0.000  1.000"), "line 9: angles of lift must rise; -16 follows -6"),
    (changed(9, "  -8.00  0.000  1.000"), "line 9: angles of lift must rise; -8 follows -6"),
    (
        changed(20, "         0.600  0.000"),
        "line 20: Mach numbers of drag must rise; 0 follows 0.6",
    ),
    (changed(2, "         0.000  9.000"), "Mach numbers must be within 0..3; there is 9"),
    (changed(9, "  -8.00  1e308  1.000"), "line 9, columns 8-14: '1e308' is out of range"),
    (changed(2, "           inf    inf"), "line 2, columns 8-14: 'inf' is not finite"),
)


@pytest.mark.parametrize(("text", "message"), WRONG)
def test_a_wrong_file_is_described_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(PolarError, match=message) as caught:
        read_c81(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)
