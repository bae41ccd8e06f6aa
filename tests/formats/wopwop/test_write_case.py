"""Cases of ours, written for PSU-WOPWOP and read back: the same pressure."""

from __future__ import annotations

import dataclasses
import warnings

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.motion import poses, rotation, translation
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.sources.moving_sources import AperiodicLoads, PeriodicLoads
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced, mirrored, rotor_histories
from propmdao.analysis.wopwop.foreign_case import run_case
from propmdao.formats.propellers import load_propeller
from propmdao.formats.wopwop.blade_files import blade_geometry, blade_loading
from propmdao.formats.wopwop.cases import read_cases
from propmdao.formats.wopwop.geometry_file import read_geometry
from propmdao.formats.wopwop.loading_file import read_loading
from propmdao.formats.wopwop.sources import loading_sources, thickness_sources
from propmdao.formats.wopwop.write_case import write_rotor_case
from propmdao.geometry.blade import Blade
from propmdao.geometry.surface import (
    surface_interpolation,
    surface_nodes,
    surface_panels,
)
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads

AIR, OMEGA = Air(density=1.2, sound_speed=340.0), 1200.0


@pytest.fixture(scope="module")
def nodes():
    propeller = load_propeller("apcsf_11x4.7_uiuc")
    span = surface_interpolation(propeller.r_over_R, 8)
    made = jax.jit(surface_nodes, static_argnums=2)
    return np.asarray(made(Blade.from_propeller(propeller), span, 11))


@pytest.fixture(scope="module")
def loads():
    """Two rows over the chord, two forces at one and the same point."""
    r = np.repeat(0.14 * np.linspace(0.2, 0.95, 6), 2)
    position = np.stack([r, np.where(np.arange(12) % 2, 0.005, -0.005), 0.1 * r], axis=-1)
    position[3] = position[2]
    force = np.stack([0.1 * r, 2.0 * r, -30.0 * r], axis=-1)
    return PointLoads(jnp.asarray(position), jnp.asarray(force))


@pytest.fixture(scope="module")
def rotor(nodes, loads):
    panels = jax.jit(surface_panels)(nodes)
    return Rotor(equally_spaced(2, 0.4), OMEGA, panels, loads)


def test_the_files_hold_the_panels(nodes, loads, rotor):
    geometry = blade_geometry(nodes, loads)
    assert [zone.name for zone in geometry.zones] == [
        "skin",
        "trailing edge",
        "root",
        "tip",
        "loads",
    ]
    parts = [thickness_sources(zone, np.zeros(1)) for zone in geometry.zones[:-1]]
    center, area = (
        np.concatenate([getattr(part, name)[0] for part in parts])
        for name in ("position", "vector")
    )
    of_panels = np.asarray(rotor.panels.center), np.asarray(rotor.panels.vector_area)
    for of_files, own in zip((center, area), of_panels, strict=True):
        assert of_files.shape == own.shape
    tensors = [
        np.einsum("ni,nj->ij", *map(np.asarray, pair)) for pair in ((center, area), of_panels)
    ]
    np.testing.assert_allclose(area.sum(axis=0), 0, atol=1e-10)
    # the volume three times, off the diagonal nothing
    np.testing.assert_allclose(tensors[0], tensors[1], atol=1e-6 * tensors[1].max())


def test_the_line_gives_back_every_force(nodes, loads):
    geometry = blade_geometry(nodes, loads)
    file = blade_loading(loads, len(geometry.zones), OMEGA)
    assert file.zone_numbers == (-5,)
    back = loading_sources(geometry.zones[-1], file.zones[0], file, np.zeros(1), ())
    assert back.position.shape == (1, 11, 3)
    np.testing.assert_allclose(back.vector[0].sum(axis=0), np.sum(loads.force, axis=0), rtol=1e-6)
    moments = [np.cross(x, f).sum(axis=0) for x, f in (
        (back.position[0], back.vector[0]), (loads.position, loads.force)
    )]  # fmt: skip
    np.testing.assert_allclose(moments[0], moments[1], atol=1e-6 * np.abs(moments[1]).max())


def written_and_run(folder, rotors, surfaces, velocity=(0.0, 0.0, 0.0), flight=(), n=128):
    observers = Observers(jnp.asarray(arc(1.5, [-40.0, 15.0])), jnp.asarray(velocity, float))
    times = np.arange(n) * 2 * np.pi / OMEGA / n
    write_rotor_case(folder, rotors, surfaces, observers, times, AIR, flight)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        results = run_case(folder)
    assert [result.observers for result in results] == ["observer 1", "observer 2"]
    own = rotor_histories(rotors, observers, times, AIR, flight)
    for i, result in enumerate(results):
        np.testing.assert_allclose(result.pressure.time[0], times, atol=1e-12)
        np.testing.assert_allclose(result.pressure.position[0, 0], observers.position[i])
        for name in ("thickness", "loading"):
            expected = own.parts[name][i]
            # single precision of the files
            np.testing.assert_allclose(
                getattr(result.pressure, name)[0], expected, atol=1e-4 * np.ptp(expected)
            )


def test_a_rotor_in_axial_flight(tmp_path, rotor, nodes):
    velocity = np.array([0.0, 0.0, 20.0])
    flight = (translation(velocity=velocity),)
    written_and_run(tmp_path / "new" / "case", [rotor], [nodes], velocity, flight)
    assert read_geometry(tmp_path / "new" / "case" / "rotor1_geometry.dat").zones[0].name == "skin"
    assert read_loading(tmp_path / "new" / "case" / "rotor1_loading.dat").frame == 3


def test_two_rotors_on_tilted_shafts_with_unsteady_loads(tmp_path, rotor, nodes, loads):
    psi = 2 * np.pi * np.arange(48) / 48
    change = (1 + 0.3 * np.cos(psi) - 0.2 * np.sin(psi))[:, None, None]
    mount = (translation((0.1, 0.3, 0.0)), rotation((0, 1, 0), 0.2))
    left = dataclasses.replace(
        rotor,
        azimuths=[0.3, 2.5],
        loads=PeriodicLoads(loads.position, jnp.asarray(change * loads.force)),
        mount=mount,
    )
    right = dataclasses.replace(mirrored(left), mount=(translation((0.1, -0.3, 0.0)), mount[1]))
    surfaces = [nodes, (nodes * [1, -1, 1])]
    written_and_run(tmp_path, [left, right], surfaces, flight=(translation(velocity=(30, 0, 5)),))


def test_each_blades_own_loads(tmp_path, rotor, loads):
    times = np.linspace(-0.02, 0.02, 401)
    change = 1 + 0.2 * np.sin(np.array([[300.0], [500.0]]) * times)
    own = AperiodicLoads(
        loads.position, jnp.asarray(times), jnp.asarray(change[..., None, None] * loads.force)
    )
    rotor = dataclasses.replace(rotor, panels=None, loads=own)
    written_and_run(tmp_path, [rotor], [None])
    assert (tmp_path / "rotor1_loading2.dat").is_file()


def test_what_cannot_be_written(tmp_path, rotor, nodes):
    nothing = Rotor([0.0], OMEGA)
    listeners = Observers(jnp.ones((1, 3)), jnp.zeros(3))
    t = np.linspace(0, 1, 9)
    with pytest.raises(ValueError, match="must have a surface or loads"):
        write_rotor_case(tmp_path, [nothing], [None], listeners, t, AIR)
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(ValueError, match="file: cannot be written: File exists"):
        write_rotor_case(file, [rotor], [nodes], listeners, t, AIR)
    one = PointLoads(jnp.ones((1, 3)), jnp.ones((1, 3)))
    with pytest.raises(ValueError, match="must act at 2 or more points"):
        write_rotor_case(tmp_path, [Rotor([0.0], OMEGA, loads=one)], [None], listeners, t, AIR)


def test_a_swinging_frame_is_written_and_read_again(tmp_path, loads):
    """AngleType 'Periodic': A0 - A1 cos psi - B1 sin psi - ..."""
    outer = (
        translation((1.0, 0, 0), velocity=(0, 0, 3.0)),
        rotation((0, 1, 0), angle=0.1, swing=[[0.02, 0.0], [-0.03, 0.01]], swing_rate=50.0),
    )
    rotor = Rotor(equally_spaced(2), OMEGA, loads=loads)
    observers = Observers(jnp.array([[9.0, 0, 0]]), jnp.zeros(3))
    folder, times = tmp_path / "case", np.linspace(0.0, 0.1, 9)
    write_rotor_case(folder, [rotor], [None], observers, times, AIR, outer)
    assert "periodic" in (folder / "case.nam").read_text().lower()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (case,) = read_cases(folder)
    read = poses(case.containers[0].motion, times)
    turning = rotation((0, 0, 1), rate=OMEGA)
    expected = poses((*outer, *rotor.mount, turning), times)
    np.testing.assert_allclose(read.rotation, expected.rotation, atol=1e-12)
    np.testing.assert_allclose(read.origin, expected.origin, atol=1e-12)
    both = rotation((0, 1, 0), rate=1.0, swing=[[0.1], [0.0]], swing_rate=2.0)
    with pytest.raises(ValueError, match="takes two of PSU-WOPWOP's changes of base"):
        write_rotor_case(folder, [rotor], [None], observers, times, AIR, (both,))
