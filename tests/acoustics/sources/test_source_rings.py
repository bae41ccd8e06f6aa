"""Sources gathered on rings sound like each of them by itself."""

from __future__ import annotations

import dataclasses
import operator

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.sources.source_rings import rings_needed
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.surface import surface_interpolation, surface_nodes, surface_panels
from propmdao.propeller.catalog import catalog_names
from propmdao.records.loads import PointLoads

ON_BOTH_SIDES = [-60.0, 0.0, 30.0]


def with_blade(rotor, blade, stations, mesh=(13, 20)):
    """Give a rotor the surface of a blade, and forces of the size of its panels on all of them."""
    nodes = surface_nodes(blade, surface_interpolation(stations, mesh[1]), mesh[0])
    panels = surface_panels(nodes)
    return rotor.with_(panels=panels, loads=PointLoads(panels.center, 1e3 * panels.vector_area))


def one_by_one(rotor, observers, n_harmonics):
    """Add up the tones of sources so few that each has a ring of its own."""
    few = int(np.prod(rings_needed(rotor.n_blades * n_harmonics))) // 2
    missing = -rotor.panels.center.shape[0] % few
    panels, loads = jax.tree.map(
        lambda q: jnp.pad(q, ((0, missing), (0, 0))).reshape(-1, few, 3),
        (rotor.panels, rotor.loads),
    )
    pieces = [
        rotor.with_(panels=jax.tree.map(pick, panels), loads=jax.tree.map(pick, loads))
        for pick in map(operator.itemgetter, range(len(panels.center)))
    ]
    every = [piece.tones(observers, n_harmonics).parts for piece in pieces]
    return jax.tree.map(lambda *q: sum(q), *every)


def around(radius):
    """Observers at 1.5 tip radii, at 14 and far away, in the rotor's plane and on both sides."""
    return np.concatenate([arc(r * radius, ON_BOTH_SIDES) for r in (1.5, 14.0, 1e3)])


def assert_sum_of_each(rotor, places):
    """Compare all harmonics within 80 dB of the loudest one of their observer.

    Near the tip the azimuths of the Fourier integral leave 0.01 dB.
    """
    reference = one_by_one(rotor, places, 10)
    for name, product in rotor.tones(places).parts.items():
        expected = np.abs(np.asarray(reference[name]))
        audible = expected > 1e-4 * expected.max(axis=1, keepdims=True)
        error_db = 20 * np.abs(np.log10(np.abs(np.asarray(product)) / expected))
        error_db = np.where(audible, error_db, 0.0)
        assert error_db[:3].max() < 0.01
        assert error_db[3:].max() < 1e-3


@pytest.mark.parametrize(
    ("name", "tip_mach", "advance"),
    [("apcsf_11x4.7", 0.2, 0.0), ("apcff_4.2x4", 0.8, 0.5)],
)
def test_all_sources_are_the_sum_of_each(slow_flyer, name, tip_mach, advance):
    """In hover, and in fast flight at a high tip speed."""
    propeller = load_propeller(name)
    radius, tip_speed = 0.5 * propeller.diameter, 340.0 * tip_mach
    rotor = slow_flyer.with_(rotation_speed=tip_speed / radius, speed=advance * tip_speed)
    rotor = with_blade(rotor, Blade.from_propeller(propeller), propeller.r_over_R)
    assert_sum_of_each(rotor, around(radius))


def test_six_blades_with_sweep_and_rake(slow_flyer):
    """A blade that is long in every direction, at orders up to 60."""
    propeller = load_propeller("apcsf_11x4.7")
    blade, x = Blade.from_propeller(propeller), propeller.r_over_R
    bent = dataclasses.replace(blade, sweep_over_R=0.4 * x**3, rake_over_R=0.2 * x**2)
    rotor = slow_flyer.with_(n_blades=6, rotation_speed=0.7 * 340.0 / 0.1397, speed=60.0)
    rotor = with_blade(rotor, bent, x)
    assert_sum_of_each(rotor, around(0.1397))


def test_sources_without_strength_make_no_difference(slow_flyer):
    """Wherever they are said to be."""
    places = arc(1.9, [-30.0, 10.0])
    loads = PointLoads(
        jnp.concatenate([slow_flyer.loads.position, jnp.ones((1, 3))]),
        jnp.concatenate([slow_flyer.loads.force, jnp.zeros((1, 3))]),
    )
    alone, with_silent = (r.tones(places) for r in (slow_flyer, slow_flyer.with_(loads=loads)))
    np.testing.assert_allclose(with_silent.total, alone.total, rtol=1e-12)
    silent = slow_flyer.with_(
        panels=jax.tree.map(jnp.zeros_like, slow_flyer.panels),
        loads=jax.tree.map(jnp.zeros_like, slow_flyer.loads),
    )
    assert np.all(np.asarray(silent.tones(places).total) == 0.0)


def test_force_on_the_shaft(point_force):
    """A turning force at the very centre is the limit of one beside it, with its derivative."""
    force, places = (0.3, -0.2, 1.0), arc(1.9, [-30.0, 10.0])
    there, beside = (
        point_force((x, 0.0, 0.01), force, n_blades=1).tones(places).parts["loading"]
        for x in (0.0, 1e-9)
    )
    assert np.abs(there[:, 0]).min() > 1e-6
    np.testing.assert_allclose(there, beside, rtol=1e-6, atol=1e-8 * np.abs(there).max())

    def first_tone(force):
        rotor = point_force((0.0, 0.0, 0.01), (0.0, 0.0, 0.0), n_blades=1)
        loads = PointLoads(rotor.loads.position, force[None])
        return jnp.abs(rotor.with_(loads=loads).tones(places).parts["loading"][0, 0])

    slope = jax.grad(first_tone)(jnp.asarray(force))
    assert float(slope @ jnp.asarray(force)) == pytest.approx(float(first_tone(jnp.asarray(force))))


@pytest.mark.slow
@pytest.mark.parametrize("name", catalog_names())
def test_catalogue_from_hover_to_windmill(slow_flyer, name):
    """The default surface, slow and fast, near and far."""
    propeller = load_propeller(name)
    radius, blade = 0.5 * propeller.diameter, Blade.from_propeller(propeller)
    for tip_mach, advance in ((0.2, 0.0), (0.2, 0.5), (0.6, 0.2)):
        rotor = slow_flyer.with_(
            n_blades=propeller.n_blades,
            rotation_speed=tip_mach * 340.0 / radius,
            speed=advance * tip_mach * 340.0,
        )
        rotor = with_blade(rotor, blade, propeller.r_over_R, mesh=(65, 80))
        assert_sum_of_each(rotor, around(radius))
