"""Trips by station in broadband noise: of the propeller's file, strip by strip."""

from __future__ import annotations

import dataclasses

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.self_noise import flow_of, section_layers, self_noise
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.models import LoadModel, Model, NoiseModel, SelfNoiseModel

PROPELLER = load_propeller("apcsf_11x4.7_uiuc")
OBSERVERS = arc(1.905, [-45.0])
RADII = strip_interpolation(PROPELLER.r_over_R, COARSE.n_spanwise)
BLADE = Blade.from_propeller(PROPELLER)
OUTER = PROPELLER.r_over_R > 0.65
SHARE = np.asarray(RADII.linear @ OUTER.astype(float))  # of the outer stations in each strip
MIXED = (SHARE > 0.0) & (SHARE < 1.0)


def tripped_outside(inner, outer):
    return tuple(outer if out else inner for out in OUTER)


@pytest.fixture(scope="module")
def solved():
    return analyze(PROPELLER, rpm=4200.0, speed=5.0, observers=OBSERVERS, fidelity=COARSE)


@pytest.fixture(scope="module")
def flow(solved):
    """Strips with the boundary layers of a model."""

    def of(trip, layers):
        noise = SelfNoiseModel(trip, layers=layers)
        model = Model(LoadModel(solved.model.loads.transition), NoiseModel(noise))
        model = dataclasses.replace(model, loads=solved.model.loads)
        found = section_layers(PROPELLER, model)
        return flow_of(solved.loads, BLADE, RADII, found, solved.point.air, noise)

    return of


@pytest.fixture(scope="module")
def heard(solved):
    """Third octaves of each mechanism of the edge of some of the strips, (7, 1, n_bands)."""

    def of(flow, strips=slice(None)):
        span = np.zeros(COARSE.n_spanwise)
        span[strips] = np.asarray(flow.section.span)[strips]
        section = dataclasses.replace(flow.section, span=span)
        noise = self_noise(dataclasses.replace(flow, section=section), 2, solved.state, OBSERVERS)
        return np.stack(jax.tree.leaves(dataclasses.replace(noise, tip=0.0 * noise.tip)))

    return of


def test_the_blade_has_strips_of_both_kinds_and_between():
    assert np.any(SHARE == 0.0) and np.any(SHARE == 1.0) and np.any(MIXED)


@pytest.mark.parametrize("layers", ["sections", "bpm"])
def test_noise_of_a_blade_tripped_outside_is_the_sum_of_its_strips(flow, heard, layers):
    smooth, rough = flow("none", layers), flow("heavy", layers)
    both = flow(tripped_outside("none", "heavy"), layers)
    parts = heard(smooth, SHARE == 0.0) + heard(rough, SHARE == 1.0) + heard(both, MIXED)
    assert_allclose(heard(both), parts, rtol=1e-9, atol=1e-30)
    assert heard(both).sum() > 1.01 * min(heard(smooth).sum(), heard(rough).sum())
    assert heard(both).sum() < 0.99 * max(heard(smooth).sum(), heard(rough).sum())
    # Where both meet, the layer lies between: low Reynolds numbers make the untripped one thicker.
    ends = [np.asarray(q.layer.displacement_suction)[MIXED] for q in (smooth, rough)]
    between = np.asarray(both.layer.displacement_suction)[MIXED]
    assert np.all((between > np.min(ends, axis=0)) & (between < np.max(ends, axis=0)))


@pytest.mark.parametrize("layers", ["sections", "bpm"])
@pytest.mark.parametrize("trip", ["none", "light", "heavy"])
def test_stations_that_are_all_tripped_alike_are_the_option(flow, layers, trip):
    one, each = flow(trip, layers), flow((trip,) * OUTER.size, layers)
    for a, b in zip(jax.tree.leaves(one.layer), jax.tree.leaves(each.layer), strict=True):
        assert_allclose(b, a, rtol=1e-12)


def test_the_heavy_trip_adds_what_the_report_adds_to_its_light_one(flow):
    light, heavy = flow("light", "sections").layer, flow("heavy", "sections").layer
    for name in ("displacement_suction", "thickness_pressure", "momentum_pressure"):
        assert_allclose(getattr(light, name) / getattr(heavy, name), 0.6)


@pytest.mark.parametrize("layers", ["sections", "bpm"])
@pytest.mark.parametrize("trip", ["light", "heavy"])
def test_tripped_layers_shed_no_laminar_vortices(flow, layers, trip):
    assert not np.any(flow(trip, layers).layer.shedding)


def test_the_file_says_what_nobody_asks_for():
    described = dataclasses.replace(PROPELLER, trip=list(tripped_outside("none", "light")))
    asked = {"rpm": 4200.0, "speed": 5.0, "broadband": True, "observers": OBSERVERS}
    asked |= {"fidelity": COARSE}

    def level(propeller, **trip):
        analysis = analyze(propeller, **asked, **trip)
        return analysis.model.noise.broadband.trip, float(analysis.broadband.total.sum())

    word, found = level(described)
    assert word == described.trip
    assert level(described, trip="none") == level(PROPELLER)
    assert level(described, trip="light") == level(PROPELLER, trip="light")
    assert found != level(PROPELLER)[1]
