"""The catalogue: every entry loads, says where it comes from and follows the published numbers."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.blade_tables.pe0 import propeller_of_table
from propmdao.formats.blade_tables.pe0_table import read_pe0_table
from propmdao.formats.blade_tables.uiuc import read_uiuc_geometry
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.catalog import airfoil_file, airfoil_names, catalog_names

#: Entries from the maker's files, and the files.
OF_THE_MAKER = {
    "apce_10x5": "10x5E", "apce_10x7": "10x7E", "apce_11x5.5": "11x55E", "apce_16x8": "16x8E",
    "apcsf_9x4.7": "9x47SF", "apcsf_10x4.7": "10x47SF", "apcsf_10x7": "10x7SF",
    "apcsf_11x4.7": "11x47SF", "apcmr_8x4.5": "8x45MR",
}  # fmt: skip
PHOTOGRAPHED = ["apcsf_9x4.7", "apcsf_10x4.7", "apcsf_11x4.7", "apce_10x5", "apce_10x7",
                "apce_11x5.5"]  # fmt: skip
#: Photographed entries whose sections are the same all along.
OTHERS = {
    "gwssf_11x4.7": "e63", "gwsdd_9x5": "e63", "grcp_10x6": "naca4412", "mae_9x6": "naca4412",
    "magf_10x6": "naca4412", "kyosho_10x6": "naca4412", "da4002_9x6.75_2b": "naca2412",
    "da4022_9x6.75_3b": "naca2412", "nr640_9x5.68_2b": "naca4412",
}  # fmt: skip


def test_the_catalogue_holds_propellers_of_seven_makers_with_both_geometries() -> None:
    names = set(catalog_names())
    assert {*OF_THE_MAKER, *OTHERS, "apcff_4.2x4", "apcsf_11x4.7_thesis"} <= names
    assert {f"{name}_uiuc" for name in [*PHOTOGRAPHED, "apcsf_10x7", "apce_16x8"]} <= names
    assert {"e63", "clarky"} <= set(airfoil_names())


@pytest.mark.parametrize("name", catalog_names())
def test_every_propeller_loads_under_its_own_name_and_names_its_source(name: str) -> None:
    propeller = load_propeller(name)
    assert propeller.name == name
    assert "UIUC" in propeller.source or "the maker's own table" in propeller.source


@pytest.mark.parametrize("name", airfoil_names())
def test_every_airfoil_loads_and_names_its_source(name: str) -> None:
    airfoil = find_airfoil(name)
    assert airfoil.source
    assert airfoil.thickness[0] == airfoil.camber[0] == 0.0
    assert tomllib.loads(airfoil_file(name).read_text(encoding="utf-8"))["name"]


@pytest.mark.parametrize("name", catalog_names())
def test_diameter_is_the_inches_in_the_name(name: str) -> None:
    """The maker's table of the 4.2x4 ends at 4.183 inches."""
    propeller = load_propeller(name)
    inches = float(name.split("_")[1].split("x")[0])
    assert propeller.diameter == pytest.approx(0.0254 * inches, rel=5e-3 if inches == 4.2 else 1e-9)
    assert propeller.n_blades == (3 if name.endswith("_3b") else 2)


@pytest.mark.parametrize("name", OF_THE_MAKER)
def test_blades_of_the_makers_tables_are_those_tables(name: str, reference_data: Path) -> None:
    """Entries keep some of the stations; splines through them must give the others."""
    entry = load_propeller(name)
    table = read_pe0_table(reference_data / "apc_pe0" / f"{OF_THE_MAKER[name]}-PERF.PE0")
    whole = propeller_of_table(table, name)
    assert entry.n_blades == whole.n_blades
    assert [n for _, n in entry.airfoils] == [n for _, n in whole.airfoils]
    kept = [int(np.abs(whole.r_over_R - r).argmin()) for r in entry.r_over_R]
    for key, digit in (
        ("r_over_R", 1e-5), ("c_over_R", 1e-5), ("beta_deg", 1e-3), ("sweep_over_R", 1e-5),
        ("rake_over_R", 1e-5), ("thickness_over_chord", 1e-4),
    ):  # fmt: skip
        own, of_table = getattr(entry, key), getattr(whole, key)[kept]
        np.testing.assert_allclose(own, of_table, atol=0.51 * digit)
    assert 15 <= len(kept) < 0.6 * whole.r_over_R.size


@pytest.mark.parametrize("name", ["apcsf_11x4.7_uiuc", "apcsf_10x4.7_uiuc", "apcsf_9x4.7_uiuc"])
def test_photographed_slow_flyers_have_the_sections_of_a_sister(name: str) -> None:
    propeller = load_propeller(name)
    assert propeller.airfoils == ((0.15, "e63"), (0.94, "e63"), (1.0, "naca4412"))
    assert "Not published for this blade" in propeller.source


def test_thickness_of_the_sister_is_that_of_the_makers_table(reference_data: Path) -> None:
    table = np.loadtxt(
        reference_data / "uiuc_geometry" / "apcsf_10x7.csv", delimiter=",", skiprows=1
    )
    propeller = load_propeller("apcsf_11x4.7_uiuc")
    of_sister = np.interp(propeller.r_over_R, table[:, 0] / 0.127, table[:, 3])
    np.testing.assert_allclose(propeller.thickness_over_chord, of_sister, atol=6e-5)


def test_the_sections_of_the_thesis_can_be_chosen() -> None:
    thesis, own = load_propeller("apcsf_11x4.7_thesis"), load_propeller("apcsf_11x4.7_uiuc")
    assert thesis.airfoils == ((0.15, "e63"), (1.0, "clarky"))
    assert thesis.thickness_over_chord is None
    np.testing.assert_array_equal(thesis.beta_deg, own.beta_deg)
    np.testing.assert_array_equal(thesis.c_over_R, own.c_over_R)


@pytest.mark.parametrize("name", ["apce_10x5_uiuc", "apce_10x7_uiuc", "apce_11x5.5_uiuc"])
def test_what_is_assumed_about_the_photographed_thin_electrics_is_said(name: str) -> None:
    source = load_propeller(name).source
    assert "ASSUMED, not published for this blade: sections" in source
    assert "thickness from" in source


@pytest.mark.parametrize("name", OTHERS)
def test_sections_that_stand_in_are_said(name: str) -> None:
    propeller = load_propeller(name)
    assert propeller.airfoils == ((1.0, OTHERS[name]),)
    assert "ASSUMED" in propeller.source or "A NACA 4-digit section stands in" in propeller.source


def test_the_stand_in_for_sda1075_has_its_zero_lift_angle() -> None:
    """-1.39 deg by thin-airfoil theory from the published coordinates."""
    section = find_airfoil("naca2412")
    camber = load_propeller("da4002_9x6.75_2b").camber_over_chord
    assert camber is not None
    angle = np.degrees(section.zero_lift_angle) * camber[0] / section.max_camber
    assert angle == pytest.approx(-1.39, abs=0.01)


@pytest.mark.parametrize("name", ["apcsf_10x7", "apce_16x8"])
def test_blades_collected_by_uiuc_have_the_twist_of_the_table(
    name: str, reference_data: Path
) -> None:
    propeller = load_propeller(f"{name}_uiuc")
    table = np.loadtxt(reference_data / "uiuc_geometry" / f"{name}.csv", delimiter=",", skiprows=1)
    radius = 0.5 * propeller.diameter
    for own, column, tolerance in (
        (propeller.c_over_R, table[:, 1] / radius, 6e-5),
        (propeller.beta_deg, table[:, 2], 6e-3),
        (propeller.thickness_over_chord, table[:, 3], 6e-5),
    ):
        expected = np.interp(propeller.r_over_R, table[:, 0] / radius, column)
        np.testing.assert_allclose(own, expected, atol=tolerance)


@pytest.mark.parametrize("name", [*PHOTOGRAPHED, *OTHERS])
def test_chord_and_blade_angle_are_the_published_ones(name: str, reference_data: Path) -> None:
    shipped = load_propeller(f"{name}_uiuc" if name in PHOTOGRAPHED else name)
    published = read_uiuc_geometry(
        reference_data / "uiuc_geometry" / f"{name}.csv",
        diameter=shipped.diameter,
        n_blades=shipped.n_blades,
        airfoils=shipped.airfoils,
    )
    np.testing.assert_array_equal(shipped.r_over_R, published.r_over_R)
    np.testing.assert_array_equal(shipped.c_over_R, published.c_over_R)
    np.testing.assert_array_equal(shipped.beta_deg, published.beta_deg)
