"""Blades and wake for ParaView carry the loads and the circulation of the solution."""

from __future__ import annotations

import dataclasses
from xml.etree import ElementTree

import numpy as np
import pytest

from propmdao.figures.flow.scenes import scenes, write_scenes


@pytest.fixture(scope="module")
def turn(edgewise):
    return list(scenes(edgewise))


def areas(mesh):
    """Vector areas of the quads, toward the upper side."""
    a, b, c, d = mesh.points[mesh.quads].swapaxes(0, 1)
    return -0.5 * np.cross(c - a, d - b)


def test_panels_add_up_to_the_hub_force(edgewise, axial, turn):
    # Inviscid, so there is no profile drag, which belongs to no panel.
    force = np.array([scene.blades.values["force_N"].sum(axis=0) for scene in turn])
    np.testing.assert_allclose(force.mean(axis=0), edgewise.loads.hub_force, rtol=1e-10)
    (scene,) = scenes(axial)
    total = scene.blades.values["force_N"].sum(axis=0)
    np.testing.assert_allclose(total, axial.loads.hub_force, atol=1e-12)


def test_pressure_difference_is_the_force_along_the_normal_over_the_area(turn):
    mesh = turn[3].blades
    area = areas(mesh)
    assert np.all(area[:, 2] > 0.0)
    along = (mesh.values["force_N"] * area).sum(axis=1)
    np.testing.assert_allclose(
        mesh.values["pressure_difference_Pa"], along / (area**2).sum(axis=1), rtol=1e-10
    )


def test_blades_turn_from_x_to_y_and_each_has_what_blade_1_has_there(edgewise, turn):
    assert len(turn) == 8
    assert turn[2].time == pytest.approx(60.0 / 4200.0 / 4.0)
    for k, azimuth in ((0, 0.0), (2, 90.0), (5, 225.0)):
        first, second = turn[k].blades.points.reshape(2, -1, 3)
        where = np.degrees(np.arctan2(*first.mean(axis=0)[1::-1]))
        assert (where - azimuth + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=5.0)
        np.testing.assert_allclose(second[:, :2], -first[:, :2], atol=1e-12)
        of_blades = turn[k].blades.values["circulation_m2_per_s"].reshape(2, 2, 5)
        circulation = np.asarray(edgewise.loads.circulation)
        np.testing.assert_allclose(of_blades[0], circulation[k])
        np.testing.assert_allclose(of_blades[1], circulation[(k + 4) % 8])


def test_the_wake_leaves_the_blades_and_is_carried_aft_and_down(turn):
    for scene in turn:
        wake = scene.wake.points.reshape(2, 6, -1, 3)
        edges = scene.blades.points.reshape(2, 3, 6, 3)[:, -1]
        chord = np.linalg.norm(edges - scene.blades.points.reshape(2, 3, 6, 3)[:, 0], axis=-1)
        gap = np.linalg.norm(wake[:, :, 0] - edges, axis=-1)
        assert np.all(gap < 0.2 * chord)  # a quarter of the last panel
        behind = wake[:, :, -1].mean(axis=(0, 1))
        assert behind[0] < -0.1 and behind[2] < -0.02  # flight is along +x and +z


def test_rings_carry_what_the_blades_had_when_they_were_shed(edgewise, axial, turn):
    last = np.asarray(edgewise.loads.circulation)[:, -1]  # (8, ns), every 45 deg
    values = turn[1].wake.values
    rings = values["circulation_m2_per_s"].reshape(2, 5, -1)
    age = values["age_deg"].reshape(rings.shape)[0, 0]
    shed_at = 45.0 - age
    # The cubic through the four nearest azimuths, at those alone, is the value itself.
    for blade, ahead in ((0, 0.0), (1, 180.0)):
        at = (shed_at + ahead) / 45.0
        low, high = (last[np.floor(at + step).astype(int) % 8] for step in (0, 1))
        span = np.ptp(last, axis=0).max()
        assert np.all(rings[blade].T > np.minimum(low, high) - 0.1 * span)
        assert np.all(rings[blade].T < np.maximum(low, high) + 0.1 * span)
    (scene,) = scenes(axial)
    steady = scene.wake.values["circulation_m2_per_s"].reshape(2, 5, -1)
    expected = np.broadcast_to(np.asarray(axial.loads.circulation)[-1][:, None], steady.shape)
    np.testing.assert_array_equal(steady, expected)


def test_files_are_those_of_the_azimuths(edgewise, axial, tmp_path):
    files = write_scenes(tmp_path / "tilted", edgewise)
    assert files == [str(tmp_path / "tilted" / f"{part}.pvd") for part in ("blades", "wake")]
    for part in ("blades", "wake"):
        root = ElementTree.parse(tmp_path / "tilted" / f"{part}.pvd").getroot()
        named = [element.attrib["file"] for element in root.iter("DataSet")]
        assert named == [f"{part}_{45.0 * k:06.1f}.vtu" for k in range(8)]
        assert all((tmp_path / "tilted" / name).is_file() for name in named)
    files = write_scenes(tmp_path / "axial", axial)
    names = {"blades.vtu", "wake.vtu"}
    assert {path.name for path in (tmp_path / "axial").iterdir()} == names
    assert files == [str(tmp_path / "axial" / name) for name in sorted(names)]


def test_of_a_march_the_wakes_are_its_own(marched):
    first, last = scenes(marched)
    loads = marched.loads
    assert first.time == pytest.approx(60.0 / 4200.0 / 2.0) and last.time > first.time
    np.testing.assert_array_equal(last.wake.points, loads.snapshots[1].reshape(-1, 3))
    assert last.wake.values["age_deg"].max() < np.degrees(loads.wake_age[-1])
    # At azimuth 180 blade 2 has what blade 1 has at 0.
    of_blades = first.blades.values["circulation_m2_per_s"].reshape(2, -1)
    np.testing.assert_allclose(of_blades[1], np.ravel(loads.circulation[0]))
    ended = dataclasses.replace(
        loads, snapshots=loads.snapshots[:0], snapshot_azimuth=loads.snapshot_azimuth[:0]
    )
    (end,) = scenes(dataclasses.replace(marched, loads=ended))
    np.testing.assert_array_equal(end.wake.points, loads.wake.reshape(-1, 3))
    assert end.time == pytest.approx(2.0 * 60.0 / 4200.0)


def test_a_rotor_at_rest_has_no_scene(axial):
    at_rest = dataclasses.replace(axial, rpm=0.0)
    with pytest.raises(ValueError, match="a rotor that stands still has no wake to draw"):
        next(scenes(at_rest))
