"""A propeller with sections that a study has chosen has them, and can be read again."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.formats.naca_blade import with_naca_sections
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade

R, CAMBER, THICKNESS = [0.15, 0.5, 1.0], [0.061, 0.0, 0.02], [0.12, 0.0534, 0.047]


@pytest.fixture
def blade(tmp_path):
    base = load_propeller("apcsf_11x4.7")
    return with_naca_sections(
        base, "new", R, CAMBER, THICKNESS, tmp_path, beta_deg=base.beta_deg + 1.0
    )


def test_camber_and_thickness_are_linear_between_the_sections(blade):
    geometry = Blade.from_propeller(blade)
    assert_allclose(
        geometry.thickness_over_chord, np.interp(blade.r_over_R, R, THICKNESS), rtol=1e-12
    )
    assert_allclose(
        geometry.camber_over_chord, np.interp(blade.r_over_R, R, CAMBER), rtol=1e-3, atol=1e-12
    )


def test_other_attributes_are_kept_or_changed_as_asked(blade):
    base = load_propeller("apcsf_11x4.7")
    assert_allclose(blade.beta_deg, base.beta_deg + 1.0)
    assert_allclose(blade.c_over_R, base.c_over_R)
    assert (blade.diameter, blade.n_blades) == (base.diameter, base.n_blades)


def test_its_file_says_the_same(blade, tmp_path):
    again = load_propeller(tmp_path / "new.toml")
    assert again.name == "new"
    for written, read in zip(blade.sections(), again.sections(), strict=True):
        assert_allclose(read, written, atol=1e-12)


def test_its_polars_are_those_of_the_catalogue(blade):
    weights = np.asarray(polars_for(blade).weights)
    assert weights.shape == (len(blade.r_over_R), 1)  # one shape: NACA 4-digit
