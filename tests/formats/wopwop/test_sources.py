"""Forces on the fluid from what the files hold on surfaces."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from propmdao.acoustics.kinematics.motion import rotation, translation
from propmdao.formats.wopwop.loading_file import LoadingFile
from propmdao.formats.wopwop.sources import loading_sources, thickness_sources
from propmdao.formats.wopwop.zones import Zone

TAU = np.linspace(0.0, 0.1, 5)


def on_nodes(surface: Zone, values: list[float]) -> Zone:
    shape = surface.values.shape[2:]
    return Zone("data", np.float32(values)[None, :, None, None] * np.ones(shape, np.float32))


def test_pressure_pushes_the_fluid_outward(geometry):
    surface = geometry.zones[0]
    file = LoadingFile((on_nodes(surface, [100.0]),), (1,), 2, data=1)
    forces = loading_sources(surface, file.zones[0], file, TAU, ())
    area = thickness_sources(surface, TAU).vector
    np.testing.assert_allclose(forces.vector, 100.0 * area, rtol=1e-6)


def test_loading_vectors_are_per_area_and_on_the_blade(geometry):
    surface = geometry.zones[0]
    file = LoadingFile((on_nodes(surface, [0.0, 2.0, 50.0]),), (1,), 2)
    total = loading_sources(surface, file.zones[0], file, TAU, ()).vector[0].sum(axis=0)
    skin = 2 * (0.3 * 0.04 + 0.3 * 0.01 + 0.04 * 0.01)
    np.testing.assert_allclose(total, -skin * np.array([0.0, 2.0, 50.0]), rtol=1e-6)


def test_vectors_in_the_grounds_frame_stay_where_they_point(geometry, loading):
    """Seen from the turning patch they turn back."""
    file = dataclasses.replace(loading, frame=1)
    motion = (rotation((0, 0, 1), 0.3, 40.0),)
    given = loading_sources(geometry.zones[1], file.zones[0], file, TAU, motion)
    local = loading_sources(geometry.zones[1], file.zones[0], loading, TAU, motion).vector[0]
    cos, sin = np.cos(0.3 + 40.0 * TAU[2]), np.sin(0.3 + 40.0 * TAU[2])
    back = np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    np.testing.assert_allclose(given.vector[2], local @ back.T, atol=1e-12)
    # -Omega x F
    rate = np.cross([0, 0, -40.0], given.vector[2])
    np.testing.assert_allclose(given.vector_rate[2], rate, atol=1e-9)


def test_vectors_in_the_mixed_frame_turn_with_the_patch(geometry, loading):
    """Where that has the ground's axes at time 0: there all readings of "mixed" agree."""
    mixed = dataclasses.replace(loading, frame=2)
    flown = translation((0, 0, 5.0), velocity=(0, 0, 8.0))
    motion = (flown, rotation((0, 0, 1), rate=40.0))
    given, local = (
        loading_sources(geometry.zones[1], loading.zones[0], file, TAU, motion)
        for file in (mixed, loading)
    )
    np.testing.assert_array_equal(given.vector, local.vector)
    turned = (*motion, rotation((0, 0, 1), np.pi))
    with pytest.raises(ValueError, match="only; here it is turned: use 1 or 3"):
        loading_sources(geometry.zones[1], loading.zones[0], mixed, TAU, turned)


def test_a_flapping_surface_keeps_its_panels_and_gains_a_velocity(geometry):
    surface = geometry.zones[0]
    phase = np.linspace(0, 2 * np.pi, 49)
    values = np.repeat(surface.values, phase.size, axis=0)
    values[:, 2] += 0.01 * np.sin(phase).astype(np.float32)[:, None, None]
    moving = dataclasses.replace(surface, values=values, keys=phase.astype("f4"), period=0.1)
    still, sources = thickness_sources(surface, TAU), thickness_sources(moving, TAU)
    omega = 2 * np.pi / 0.1
    np.testing.assert_allclose(sources.vector, still.vector + 0 * sources.vector, atol=1e-8)
    speed = 0.01 * omega * np.cos(omega * TAU)
    np.testing.assert_allclose(sources.position_rate[:, 0, 2], speed, atol=1e-3 * 0.01 * omega)


def test_an_unstructured_surface_is_the_same_surface(geometry):
    """Quadrangles in a list, one of them as two triangles: the same areas and forces."""
    grid = geometry.zones[0]
    j_max, i_max = grid.values.shape[2:]
    number = 1 + np.arange(j_max * i_max).reshape(j_max, i_max)
    corners = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = np.stack(corners, axis=-1).reshape(-1, 4).tolist()
    a, b, c, d = faces.pop(5)
    faces += [[a, b, c], [a, c, d]]
    free = Zone("free", grid.values.reshape(1, 6, -1), faces=tuple(map(tuple, faces)))
    expected, product = (thickness_sources(zone, TAU) for zone in (grid, free))
    kept = np.delete(np.arange(expected.vector.shape[1]), 5)
    np.testing.assert_allclose(product.vector[:, :-2], expected.vector[:, kept], atol=1e-9)
    np.testing.assert_allclose(product.position[:, :-2], expected.position[:, kept], atol=1e-8)
    np.testing.assert_allclose(product.vector[:, -2:].sum(axis=1), expected.vector[:, 5], atol=1e-9)
    pressure = Zone("p", np.full((1, 1, len(faces)), 100.0, np.float32))
    file = LoadingFile((pressure,), (1,), 1, data=1, at_faces=True)
    forces = loading_sources(free, pressure, file, TAU, ())
    np.testing.assert_allclose(forces.vector, 100.0 * product.vector, rtol=1e-6)
    at_nodes = Zone("p", np.full((1, 1, number.size), 100.0, np.float32))
    file = LoadingFile((at_nodes,), (1,), 1, data=1)
    forces = loading_sources(free, at_nodes, file, TAU, ())
    np.testing.assert_allclose(forces.vector, 100.0 * product.vector, rtol=1e-6)


@pytest.mark.parametrize(("data", "message"), [(3, "flow data"), (1, "surface pressure is given")])
def test_data_that_are_not_computed(geometry, loading, data, message):
    file = dataclasses.replace(loading, data=data)
    with pytest.raises(ValueError, match=message):
        loading_sources(geometry.zones[1], file.zones[0], file, TAU, ())
