"""The catalogue: every entry loads, says where it comes from and follows the published numbers."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.propellers import load_propeller
from propmdao.formats.uiuc import read_uiuc_geometry
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.catalog import airfoil_file, airfoil_names, catalog_names


def test_the_catalogue_holds_the_propellers_that_validation_needs() -> None:
    assert {"apcsf_11x4.7", "apcsf_10x4.7", "apce_10x7"} <= set(catalog_names())
    assert {"e63", "clarky"} <= set(airfoil_names())


@pytest.mark.parametrize("name", catalog_names())
def test_every_propeller_loads_under_its_own_name_and_names_its_source(name: str) -> None:
    propeller = load_propeller(name)
    assert propeller.name == name
    assert "UIUC" in propeller.source


@pytest.mark.parametrize("name", airfoil_names())
def test_every_airfoil_loads_and_names_its_source(name: str) -> None:
    airfoil = find_airfoil(name)
    assert airfoil.source
    assert airfoil.thickness[0] == airfoil.camber[0] == 0.0
    assert tomllib.loads(airfoil_file(name).read_text(encoding="utf-8"))["name"]


@pytest.mark.parametrize("name", [name for name in catalog_names() if not name.endswith("_thesis")])
def test_diameter_is_the_inches_in_the_name(name: str) -> None:
    propeller = load_propeller(name)
    inches = float(name.split("_")[1].split("x")[0])
    assert propeller.diameter == pytest.approx(0.0254 * inches, abs=1e-12)
    assert propeller.n_blades == 2


@pytest.mark.parametrize("name", ["apcsf_11x4.7", "apcsf_10x4.7", "apcsf_9x4.7"])
def test_slow_flyers_have_the_sections_of_the_makers_table_of_a_sister(name: str) -> None:
    propeller = load_propeller(name)
    assert propeller.airfoils == ((0.15, "e63"), (0.94, "e63"), (1.0, "naca4412"))
    assert "Not published for this blade" in propeller.source


def test_thickness_of_the_sister_is_that_of_the_makers_table(reference_data: Path) -> None:
    table = np.loadtxt(
        reference_data / "uiuc_geometry" / "apcsf_10x7.csv", delimiter=",", skiprows=1
    )
    propeller = load_propeller("apcsf_11x4.7")
    of_sister = np.interp(propeller.r_over_R, table[:, 0] / 0.127, table[:, 3])
    np.testing.assert_allclose(propeller.thickness_over_chord, of_sister, atol=6e-5)


def test_the_sections_of_the_thesis_can_be_chosen() -> None:
    thesis, own = load_propeller("apcsf_11x4.7_thesis"), load_propeller("apcsf_11x4.7")
    assert thesis.airfoils == ((0.15, "e63"), (1.0, "clarky"))
    assert thesis.thickness_over_chord is None
    np.testing.assert_array_equal(thesis.beta_deg, own.beta_deg)
    np.testing.assert_array_equal(thesis.c_over_R, own.c_over_R)


@pytest.mark.parametrize("name", ["apce_10x5", "apce_10x7", "apce_11x5.5"])
def test_what_is_assumed_about_the_thin_electrics_is_said(name: str) -> None:
    source = load_propeller(name).source
    assert "ASSUMED, not published for this blade: sections" in source
    assert "thickness from" in source


@pytest.mark.parametrize("name", ["apcsf_10x7", "apce_16x8"])
def test_blades_of_the_makers_own_table(name: str, reference_data: Path) -> None:
    propeller = load_propeller(name)
    table = np.loadtxt(reference_data / "uiuc_geometry" / f"{name}.csv", delimiter=",", skiprows=1)
    radius = 0.5 * propeller.diameter
    for own, column, tolerance in (
        (propeller.c_over_R, table[:, 1] / radius, 6e-5),
        (propeller.beta_deg, table[:, 2], 6e-3),
        (propeller.thickness_over_chord, table[:, 3], 6e-5),
    ):
        expected = np.interp(propeller.r_over_R, table[:, 0] / radius, column)
        np.testing.assert_allclose(own, expected, atol=tolerance)


UIUC_GEOMETRIES = ["apcsf_9x4.7", "apcsf_10x4.7", "apcsf_11x4.7", "apce_10x5", "apce_10x7",
                   "apce_11x5.5"]  # fmt: skip


@pytest.mark.parametrize("name", UIUC_GEOMETRIES)
def test_chord_and_blade_angle_are_the_published_ones(name: str, reference_data: Path) -> None:
    shipped = load_propeller(name)
    published = read_uiuc_geometry(
        reference_data / "uiuc_geometry" / f"{name}.csv",
        diameter=shipped.diameter,
        n_blades=shipped.n_blades,
        airfoils=shipped.airfoils,
    )
    np.testing.assert_array_equal(shipped.r_over_R, published.r_over_R)
    np.testing.assert_array_equal(shipped.c_over_R, published.c_over_R)
    np.testing.assert_array_equal(shipped.beta_deg, published.beta_deg)
