"""A blade that gives: its limits, its loads and shape that belong together, what it refuses."""

import dataclasses
import json

import numpy as np
import pytest
from shared_mesh import COARSE

from propmdao.analysis.elastic.materials import ElasticError, material_of
from propmdao.analysis.elastic.modelled_blade import ModelledBlade
from propmdao.analysis.request import Request
from propmdao.analysis.single_point import analyze
from propmdao.analysis.sweeping.sweeps import sweep
from propmdao.formats.propellers import load_propeller
from propmdao.formats.toml_files import read_toml, write_toml
from propmdao.propeller.changes import Change
from propmdao.propeller.checks import PropellerError
from propmdao.records.models import ElasticModel, LoadModel

MADE = load_propeller("apcsf_11x4.7")
NOTHING = {"youngs_modulus": None, "material_density": None}  # of a material
# Of the maker's material (1.6 million psi, specific gravity 1.7), its root as thin as the airfoil.
BLADE = dataclasses.replace(MADE, area_over_c2=None)
RIGID = dataclasses.replace(BLADE, **NOTHING)


def run(propeller=BLADE, **asked):
    return analyze(propeller, **{"rpm": 5000.0, "fidelity": COARSE} | asked)


@pytest.fixture(scope="module")
def given():
    return run(elastic=True)


def test_a_stiff_and_light_blade_is_the_rigid_one():
    stiff = {"elastic": True, "youngs_modulus": 1e13, "material_density": 1.0}
    for rpm, left in ((5000.0, 2e-4), (500.0, 0.0)):
        rigid, held = run(rpm=rpm), run(rpm=rpm, **stiff)
        assert rigid.deflection is None and rigid.to_dict()["deflection"] is None
        assert np.abs(held.deflection.twist_deg).max() <= 10.0 * left  # [deg]
        assert float(held.loads.thrust) == pytest.approx(float(rigid.loads.thrust), rel=left, abs=0)


def test_loads_and_shape_belong_together(given):
    """The deflected blade, held rigid, has the loads that the elastic one was found with."""
    held = run(given.changed_propeller)
    assert float(held.loads.thrust) == pytest.approx(float(given.loads.thrust), rel=1e-9)
    assert 0.1 < np.abs(given.deflection.twist_deg).max() < 10.0
    assert given.deflection.rake_over_R[-1] > 0.0  # thrust bends it forward
    assert not given.deflection.twist_deg[0] and not given.deflection.rake_over_R[0]


def test_twice_as_stiff_gives_half_at_a_low_speed():
    slow = [
        run(rpm=100.0, elastic=True, youngs_modulus=modulus).deflection.rake_over_R[-1]
        for modulus in (11e9, 22e9)
    ]
    assert slow[0] / slow[1] == pytest.approx(2.0, rel=2e-3)


def test_thrust_asked_for_is_that_of_the_blade_that_gives(given):
    thrust = float(given.loads.thrust)
    trimmed = run(rpm=None, thrust=thrust, elastic=True)
    assert float(trimmed.loads.thrust) == pytest.approx(thrust, rel=1e-6)
    assert trimmed.rpm == pytest.approx(5000.0, rel=1e-5)


def test_results_say_how_far_it_gave_and_of_what(given):
    result = json.loads(json.dumps(given.to_dict(), allow_nan=False))
    deflection = result["deflection"]
    assert set(deflection) == {"r_over_R", "twist_deg", "sweep_over_R", "rake_over_R"}
    assert len(deflection["twist_deg"]) == RIGID.r_over_R.size
    elastic = run(elastic=True, youngs_modulus=20e9).to_dict()
    assert elastic["model"]["loads"]["elastic"]["youngs_modulus"] == 20e9
    assert Request.from_dict(elastic).model.loads.elastic == ElasticModel(youngs_modulus=20e9)


def test_full_roots_give_less():
    """Sections four times as full as the airfoils', as where a blade runs into its hub.

    Slowly turning, for at speed tension holds the blade rather than its root.
    """
    area = np.where(RIGID.r_over_R < 0.3, 0.12, 0.03)
    thin, full = (
        run(blade, rpm=1000.0, elastic=True)
        for blade in (BLADE, dataclasses.replace(BLADE, area_over_c2=area))
    )
    assert full.deflection.rake_over_R[-1] < 0.9 * thin.deflection.rake_over_R[-1]
    with pytest.raises(PropellerError, match="area_over_c2 must be within .*; station 1"):
        dataclasses.replace(BLADE, area_over_c2=-area)


def test_material_is_the_files_unless_asked_for(tmp_path):
    area = np.full(RIGID.r_over_R.size, 0.04)
    write_toml(tmp_path / "blade.toml", dataclasses.replace(BLADE, area_over_c2=area))
    propeller = read_toml(tmp_path / "blade.toml")
    np.testing.assert_array_equal(propeller.area_over_c2, area)
    material = material_of(propeller, ElasticModel(material_density=1200.0))
    assert (material.youngs_modulus, material.density) == (MADE.youngs_modulus, 1200.0)
    assert material.shear_modulus == pytest.approx(MADE.youngs_modulus / 2.7)
    assert material_of(propeller, ElasticModel(shear_modulus=4e9)).shear_modulus == 4e9


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (
            {"elastic": True},
            r"apcsf_11x4.7 has no youngs_modulus \[Pa\], which an elastic blade needs: give it in"
            " the propeller file or by --youngs-modulus",
        ),
        (
            {"elastic": True, "youngs_modulus": 2e9},
            r"has no material_density \[kg/m\*\*3\].*--material-density",
        ),
        ({"youngs_modulus": 2e9}, "youngs_modulus is about an elastic blade: ask for elastic, too"),
        ({"elastic": True, "youngs_modulus": 11.0}, "youngs_modulus must be within .*; it is 11"),
        ({"elastic": True, "viscous": False}, "needs the moments of its sections"),
    ],
)
def test_what_is_missing_is_said(asked, message):
    with pytest.raises(ValueError, match=message):
        run(RIGID, **asked)


def test_a_blade_that_does_not_stand_its_loads_is_refused():
    with pytest.raises(ElasticError, match="the blade does not stand its loads"):
        run(elastic=True, youngs_modulus=2e6)


def test_propeller_refuses_what_no_material_has():
    with pytest.raises(PropellerError, match="material_density must be within .*; it is -1"):
        dataclasses.replace(RIGID, material_density=-1.0)


def test_sweeps_do_not_pretend(tmp_path):
    with pytest.raises(ValueError, match="rigid blades"):
        sweep(BLADE, [{"rpm": 4000.0}], tmp_path / "sweep.csv", elastic=True)
    assert LoadModel().elastic is None


def test_a_reshaped_blade_keeps_its_stations_and_airfoils():
    model = Request.of(rpm=5000.0, fidelity=COARSE).completed(MADE).model
    modelled = ModelledBlade.of(MADE, Change(), model)
    wide = dataclasses.replace(MADE, c_over_R=1.1 * MADE.c_over_R)
    made = modelled.reshaped(wide)
    assert made.changed is wide and made.polars is modelled.polars
    assert float(made.unloaded.blade.chord_over_R[0]) == pytest.approx(1.1 * MADE.c_over_R[0])
    moved = MADE.r_over_R.copy()
    moved[1] += 0.001
    others = (
        dataclasses.replace(MADE, r_over_R=moved),
        dataclasses.replace(MADE, airfoils=[(0.2, "naca4412")]),
    )
    for other in others:
        with pytest.raises(ValueError, match="has the stations and airfoils that it had"):
            modelled.reshaped(other)
