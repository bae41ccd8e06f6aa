"""Broadband noise of cases: sections of blades that turn, rotors by Pegg, and PSU-WOPWOP's own."""

from __future__ import annotations

import shutil

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.broadband.boundary_layer import boundary_layer
from propmdao.acoustics.broadband.directivity import radiation
from propmdao.acoustics.broadband.pegg import LoadedRotor, pegg_noise
from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import tip_noise, trailing_edge_noise
from propmdao.acoustics.kinematics.motion import translation
from propmdao.acoustics.levels.decibels import level_db
from propmdao.analysis.wopwop.broadband_sources import (
    BANDS_HZ,
    broadband_noise,
    emission_times,
    line_blades,
    moving_edges,
)
from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.cases import read_cases
from propmdao.records.air import Air
from propmdao.records.models import SelfNoiseModel
from propmdao.records.states import RotorState

ON = {"broadbandFlag": True}
PEGG = {
    "TotalThrustFlag": "UserValue",
    "TotalThrust": 900.0,
    "TotalBladeAreaFlag": "UserValue",
    "TotalBladeArea": 0.3,
    "BladeRadiusFlag": "UserValue",
    "BladeRadius": 0.5,
    "spreadBands": True,
}
#: Sections of the nine nodes of the line, 0.2 to 0.5 m, at 100 rad/s.
BPM = {"nSect": 9, "uniformBlade": 0, "BLtrip": 1, "UFlag": "Compute", "roundBladeTip": True}
for key, value in {
    "sectChord": 0.05, "sectLength": 0.0375, "TEThickness": 5e-4, "TEflowAngle": 0.1,
    "TipLCS": 1.0, "SectAOA": 0.06,
}.items():  # fmt: skip
    BPM |= {key: value, f"{key}Flag": "UserValue"}


@pytest.fixture
def noise_of(make_case):
    """Broadband noise of a case with groups behind the rotor's container."""

    def of(*groups, container, **changes):
        folder = make_case(behind_rotor=groups, EnvironmentIn=ON, ContainerIn=container, **changes)
        (case,) = read_cases(folder)
        return case, broadband_noise(case, case.observers[0])

    return of


def test_a_rotor_by_peggs_method(noise_of):
    case, noise = noise_of(("PeggIn", PEGG), container={"PeggNoiseFlag": True})
    assert list(noise) == ["pegg"] and noise["pegg"].shape == (2, 1, BANDS_HZ.size)
    rotor = LoadedRotor(900.0, 100.0 * 0.5, 0.3)
    lift = rotor.mean_lift_coefficient(1.2)
    sight = np.array([[3.0, 0.0, -2.0], [4.0, 0.0, -2.0]])
    known = pegg_noise(BANDS_HZ, rotor, lift, sight, [0.0, 0.0, 1.0], 340.0)
    assert_allclose(noise["pegg"][:, 0], known, rtol=1e-9)


def test_sections_that_turn_are_those_of_the_rotor_code(noise_of):
    case, noise = noise_of(("BPMIn", BPM), container={"BPMNoiseFlag": True})
    radius = np.linspace(0.2, 0.5, 9)
    columns = (0.05, 0.0375, 100.0 * radius, 0.06, 5e-4, 0.1)
    section = Section(*(jnp.broadcast_to(jnp.asarray(q), 9) for q in columns))
    # Normals of the line are +z: chords lie in the plane and point against the rotation.
    edge = np.stack([radius, np.full(9, -0.75 * 0.05), np.zeros(9)], axis=1)
    axes = np.tile([0.0, -1.0, 0.0], (9, 1)), np.tile([1.0, 0.0, 0.0], (9, 1))
    strips = StripFlow(jnp.asarray(edge), *map(jnp.asarray, axes), section)
    state = RotorState(100.0, 0.0, case.air)
    model = SelfNoiseModel("heavy")
    known = rotor_self_noise(strips, 2, state, case.observers[0].position, BANDS_HZ, model)
    for name in ("pressure_side", "suction_side", "separation", "bluntness"):
        # Both sum over 24 azimuths, though not the same ones.
        ratio = noise[name][:, 0] / np.asarray(getattr(known, name))
        loud = np.asarray(getattr(known, name)) > 1e-6 * np.max(getattr(known, name))
        assert np.all(np.abs(10.0 * np.log10(ratio[loud])) < 0.02), name


def test_mechanisms_are_those_that_the_case_asks_for(noise_of):
    asked = BPM | {"TBLTEnoise": False, "LBLVSnoise": False, "bladeTipNoise": False}
    _, noise = noise_of(("BPMIn", asked), container={"BPMNoiseFlag": True})
    assert list(noise) == ["bluntness"]


def test_noise_that_nobody_asks_for_is_not_heard(make_case):
    groups = [("BPMIn", BPM), ("PeggIn", PEGG)]
    folder = make_case(behind_rotor=groups, EnvironmentIn=ON)
    with pytest.warns(UserWarning) as caught:
        (case,) = read_cases(folder)
    assert case.broadband == ()
    said = "\n".join(str(warning.message) for warning in caught)
    assert "&bpmin has no effect: bpmnoiseflag is off" in said
    assert "&peggin has no effect: peggnoiseflag is off" in said


@pytest.mark.parametrize(
    ("groups", "container", "message"),
    [
        ([], {"BPMNoiseFlag": True}, "bpmnoiseflag needs a &bpmin group behind the container"),
        ([("BPMIn", BPM | {"nSect": 8})], {"BPMNoiseFlag": True}, "a line of 8 nodes, nSect"),
        (
            [("BPMIn", BPM | {"sectChordFlag": "Compute"})],
            {"BPMNoiseFlag": True},
            "sectchord is not computed: give a 'FileValue' or a 'UserValue'",
        ),
        (
            [("BPMIn", BPM | {"SectAOAFlag": "FileValue"})],
            {"BPMNoiseFlag": True},
            "sectaoaFlag is 'FileValue', and there is no file that holds it",
        ),
        (
            [("BPMIn", BPM | {"sectLength": [0.1, 0.2]})],
            {"BPMNoiseFlag": True},
            "sectlength must be 1 or 9 finite numbers",
        ),
        (
            [("BPMIn", BPM | {"sectChord": -0.1})],
            {"BPMNoiseFlag": True},
            "sectchord must be positive at every section",
        ),
        (
            [("BPMIn", BPM | {"uniformBlade": 1})],
            {"BPMNoiseFlag": True},
            "uniformBlade = 1 is not computed",
        ),
        (
            [("PeggIn", PEGG | {"TotalThrust": -3.0})],
            {"PeggNoiseFlag": True},
            "totalthrust must be positive; it is -3",
        ),
        (
            [("PeggIn", PEGG | {"TotalBladeAreaFlag": "Compute"})],
            {"PeggNoiseFlag": True},
            "totalbladearea is not computed: give a 'UserValue'",
        ),
        ([("BWIIn", {})], {}, "noise of blades and wakes (&BWIIn) is not computed"),
    ],
)
def test_what_is_not_done_is_refused(noise_of, groups, container, message):
    with pytest.raises(WopwopFileError) as caught:
        noise_of(*groups, container=container)
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_edges_below_no_thickness_are_sharp_and_told(noise_of):
    thickness = [5e-4] * 8 + [-1e-5]
    group = ("BPMIn", BPM | {"TEThickness": thickness})
    with pytest.warns(UserWarning, match="TEThickness is below 0, down to -1e-05 m, at 1 of 9"):
        _, noise = noise_of(group, container={"BPMNoiseFlag": True})
    assert np.isfinite(noise["bluntness"]).all()


def bpm_file(path, kind, times, angles):
    """A file of nine sections with angles of attack at times, and nothing else."""
    head = [42, 9, 0, 0, 0, 0, 0, 0, 1, 0, kind]
    data = np.array(head, "<i4").tobytes()
    if kind == 2:
        period = np.array(2 * np.pi / 100.0, "<f4").tobytes()
        data += np.array(1, "<i4").tobytes() + period + np.array(len(times), "<i4").tobytes()
    if kind == 3:
        data += np.array(len(times), "<i4").tobytes()
    rows = [[time, *[angle] * 9] for time, angle in zip(times, angles, strict=True)]
    path.write_bytes(data + np.array(rows, "<f4").tobytes())


def edges_of_file(make_case, tmp_path, kind, times, angles):
    """Sections of both blades over the turn around time 0, with the angles of a file."""
    bpm_file(tmp_path / "sections.dat", kind, times, angles)
    group = BPM | {"SectAOAFlag": "FileValue", "BPMNoiseFile": "sections.dat"}
    folder = make_case(
        behind_rotor=[("BPMIn", group)], EnvironmentIn=ON, ContainerIn={"BPMNoiseFlag": True}
    )
    (case,) = read_cases(folder)
    (container,) = case.broadband
    blades = line_blades(container, container.noise)
    return [moving_edges(container, container.noise, blade, 0.0) for blade in blades]


def test_sections_that_change_around_the_turn_are_taken_at_their_times(make_case, tmp_path):
    turn = 2 * np.pi / 100.0
    times = np.linspace(0.0, turn, 361)
    angles = 0.06 + 0.02 * np.sin(100.0 * times)
    for edges in edges_of_file(make_case, tmp_path, 2, times, angles):
        known = 0.06 + 0.02 * np.sin(100.0 * np.asarray(edges.time))
        assert_allclose(edges.section.angle_of_attack[:, 4], known, atol=1e-5)
        assert_allclose(edges.tip.angle_of_attack, known, atol=1e-5)
        assert float(edges.time[-1] - edges.time[0]) == pytest.approx(turn * 47 / 48)


def test_sections_that_are_not_known_at_a_time_are_refused(make_case, tmp_path):
    times = np.linspace(0.0, 0.1, 11)
    with pytest.raises(WopwopFileError, match="sections are known from 0 to 0.1 s; noise is heard"):
        edges_of_file(make_case, tmp_path, 3, times, 0.06 + 0.0 * times)
    around = np.linspace(-0.1, 0.1, 11)
    edges, _ = edges_of_file(make_case, tmp_path, 3, around, 0.06 + around)
    assert_allclose(edges.section.angle_of_attack[:, 0], 0.06 + edges.time, atol=1e-6)


def test_times_of_emission_are_those_of_sound_that_catches_up():
    motion = (translation(velocity=[100.0, 0.0, 0.0]),)
    observers = np.array([[[50.0, 30.0, 0.0], [80.0, 30.0, 0.0]], [[-50.0, 0.0, 4.0]] * 2])
    times = np.array([0.2, 0.5])
    found = emission_times(motion, observers, times, Air())
    way = observers - found[..., None] * np.array([100.0, 0.0, 0.0])
    assert_allclose(np.linalg.norm(way, axis=-1), 340.294 * (times - found), rtol=1e-6)


# Levels of a hovering rotor that PSU-WOPWOP 3.4.3 wrote (case of VSP2WOPWOP at commit 8e5d954,
# spl_octFilt_spectrum), in the bands around 1, 2, 4, 8 and 16 kHz at observers 1 and 2 [dB]. Its
# bluntness is no number: seven sections of the file have an edge below 0.
WRITTEN_HZ = [1000.0, 2000.0, 4000.0, 8000.0, 16000.0]
WRITTEN = {
    "pressure_side": [[39.75, 46.16, 51.46, 55.87, 56.55], [37.20, 43.58, 48.83, 53.19, 53.79]],
    "suction_side": [[47.30, 52.64, 56.82, 58.52, 56.75], [45.02, 50.27, 54.31, 55.86, 53.81]],
    "separation": [[34.98, 46.63, 52.95, 53.48, 48.91], [33.68, 44.84, 50.82, 51.08, 45.92]],
    "laminar_shedding": [[34.44, 47.06, 63.99, 62.44, 51.62], [33.35, 46.62, 62.73, 60.99, 50.08]],
    "tip": [[-18.73, 1.99, 18.81, 33.33, 45.28], [-22.42, -3.00, 12.23, 26.97, 40.09]],
}


@pytest.fixture(scope="module")
def hovering(reference_data, tmp_path_factory):
    folder = tmp_path_factory.mktemp("boeing360")
    for file in (reference_data / "wopwop" / "boeing360").iterdir():
        shutil.copy(file, folder)
    with pytest.warns(UserWarning, match="below 0, down to -2.79e-05 m, at 7 of 50 sections"):
        (case,) = read_cases(folder)
    return case


def test_with_the_directivity_of_an_airfoil_sections_sound_as_psu_wopwop_has_them(hovering):
    """Its factors: RP-1218's directivity of airfoils at rest, azimuths that count alike."""
    (container,) = hovering.broadband
    noise, air = container.noise, hovering.air
    bands = jnp.asarray(WRITTEN_HZ)[:, None, None]

    @jax.jit
    def heard(edges, observer):
        way = observer - edges.position
        d = jnp.linalg.norm(way, axis=-1)
        approach = 1.0 - jnp.sum(edges.velocity * way, -1) / (air.sound_speed * d)
        normal = jnp.cross(edges.chord_direction, edges.span_direction)
        axes = (edges.chord_direction, edges.span_direction, normal)
        mach = edges.section.speed / air.sound_speed
        radiated = radiation(*(jnp.sum(way * axis, -1) for axis in axes), mach)
        section = edges.section
        layer = boundary_layer(
            section.chord, section.speed, section.angle_of_attack, air.kinematic_viscosity,
            noise.trip,
        )  # fmt: skip
        emitted = bands * approach
        edge = trailing_edge_noise(emitted, section, layer, radiated, air)
        last = jax.tree.map(lambda q: q[..., -1], radiated)
        vortex = tip_noise(emitted[..., -1], edges.tip, last, air, noise.tip)
        spectra = {name: q.mean(axis=1).sum(axis=-1) for name, q in edge._asdict().items()}
        return spectra | {"tip": vortex.mean(axis=-1)}

    for number, observer in enumerate(hovering.observers[0].position[:2]):
        parts = dict.fromkeys(WRITTEN, 0.0)
        for blade in line_blades(container, noise):
            spectra = heard(moving_edges(container, noise, blade, 0.0), observer)
            for name in parts:
                parts[name] += np.asarray(spectra[name])
        for name in ("pressure_side", "suction_side", "separation", "tip"):
            difference = np.asarray(level_db(parts[name])) - WRITTEN[name][number]
            # At 1 kHz separation depends on the angle by tens of decibels.
            assert np.all(np.abs(difference[1:]) < 0.7), (name, difference)


def test_edges_that_move_are_louder_than_psu_wopwop_has_them(hovering):
    """Brooks and Burley's factor for moving edges, near the plane of a tip at Mach 0.63."""
    noise = broadband_noise(hovering, hovering.observers[0])
    rows = [int(np.argmin(np.abs(BANDS_HZ - f))) for f in WRITTEN_HZ]
    for name in ("pressure_side", "suction_side"):
        levels = np.asarray(level_db(noise[name][:2, 0]))[:, rows]
        difference = levels - np.array(WRITTEN[name])
        assert np.all((difference > 4.0) & (difference < 6.5)), (name, difference)
