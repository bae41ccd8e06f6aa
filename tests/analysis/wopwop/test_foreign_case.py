"""Cases: the same pressure as the Fourier form, and what is not computed says so."""

from __future__ import annotations

import dataclasses
import warnings

import jax.numpy as jnp
import numpy as np
import pytest

import propmdao.analysis.wopwop.foreign_case as foreign_case
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.analysis.wopwop.foreign_case import run_case
from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.namelists.groups import read_namelists, write_namelists
from propmdao.formats.wopwop.sources import thickness_sources
from propmdao.formats.wopwop.zones import Zone
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.records.states import RotorState
from propmdao.runtime.finite import NotFiniteError

OMEGA, N_HARMONICS = 100.0, 3
OBSERVERS = np.array([[3.0, 0.0, -2.0], [4.0, 0.0, -2.0]])


@pytest.fixture
def reference(reference_at):
    return reference_at(0.0)


@pytest.fixture
def reference_at(geometry, loading):
    """Tones of the same rotor: lengths of the line by the trapezoidal rule, forces reversed."""
    r = geometry.zones[1].values[0, 0].ravel().astype(float)
    length = np.full(r.size, r[1] - r[0]) * np.where(np.isin(np.arange(r.size), [0, 8]), 0.5, 1)
    force = -loading.zones[0].values[0, :, :, 0].T * length[:, None]
    loads = PointLoads(jnp.asarray(np.stack([r, 0 * r, 0 * r], -1)), jnp.asarray(force))
    box = thickness_sources(geometry.zones[0], np.zeros(1))
    panels = Panels(box.position[0], box.vector[0])

    def at(speed):
        state = RotorState(OMEGA, speed, Air(density=1.2, sound_speed=340.0))
        return tones(panels, loads, 2, state, OBSERVERS, N_HARMONICS)

    return at


def amplitudes(pressure):
    spectrum = np.conj(np.fft.rfft(pressure)) / pressure.shape[-1]
    return spectrum[:, 2 * np.arange(1, N_HARMONICS + 1)]


def agree(product, expected):
    np.testing.assert_allclose(
        amplitudes(product), expected, atol=2e-4 * np.abs(expected[:, 0]).min()
    )


def test_panels_of_a_closed_box_enclose_its_volume(geometry):
    box = thickness_sources(geometry.zones[0], np.zeros(1))
    np.testing.assert_allclose(box.vector[0].sum(axis=0), 0, atol=1e-8)
    volume = np.sum(box.position[0] * box.vector[0]) / 3
    assert volume == pytest.approx(0.3 * 0.04 * 0.01, rel=1e-6)


def test_constant_loads(make_case, reference):
    (result,) = run_case(make_case())
    assert (result.case, result.observers) == ("case.nam", "microphones")
    np.testing.assert_allclose(result.pressure.position[:, 0], OBSERVERS)
    agree(result.pressure.thickness, reference.parts["thickness"])
    agree(result.pressure.loading, reference.parts["loading"])
    agree(result.pressure.total, reference.total)
    assert np.abs(result.pressure.total.mean(axis=1)).max() < 1e-12  # high-pass


def changing(loading, keys, period, force):
    """The same loads, given by (n_times, 3)."""
    values = np.float32(force)[:, :, None, None] * np.ones((9, 1), np.float32)
    zone = Zone(
        "line loads", values, np.float32(keys), None if period is None else np.float32(period)
    )
    return dataclasses.replace(loading, zones=(zone,))


@pytest.mark.parametrize("last_repeats", [True, False])
def test_periodic_loads_in_the_grounds_frame(make_case, loading, reference, last_repeats):
    """Loads constant on the blade turn in the ground's frame; each blade has its own key offset."""
    keys = np.linspace(0, 2 * np.pi, 73)[: 73 if last_repeats else 72]
    force = np.stack([np.sin(keys), -np.cos(keys), 10 + 0 * keys], -1)
    unsteady = changing(loading, keys, 2 * np.pi / OMEGA, force)
    (result,) = run_case(make_case(loading=dataclasses.replace(unsteady, frame=1)))
    agree(result.pressure.loading, reference.parts["loading"])


def test_aperiodic_loads(make_case, loading, reference):
    times = np.linspace(-0.1, 0.1, 9)
    table = changing(loading, times, None, [[0.0, -1.0, 10.0]] * 9)
    (result,) = run_case(make_case(loading=table))
    agree(result.pressure.loading, reference.parts["loading"])


def test_aperiodic_loads_that_end_too_early(make_case, loading):
    table = changing(loading, np.linspace(0, 0.02, 9), None, [[0.0, -1.0, 10.0]] * 9)
    with pytest.raises(
        WopwopFileError, match=r"zone 2 'line': table over 0 \.\.\. 0.02 s is asked"
    ):
        run_case(make_case(loading=table))


def test_a_rotor_and_observers_that_fly_along(make_case, reference_at):
    folder = make_case(ObserverIn={"nbBase": 1})
    groups = [(group.name, dict(group.values)) for group in read_namelists(folder / "case.nam")]
    fly = ("cb", {"TranslationType": "KnownFunction", "VH": [0.0, 0.0, 20.0]})
    names = [name for name, _ in groups]
    rotor, observers = names.index("containerin"), names.index("observerin")
    groups[rotor][1]["nbbase"] = 2
    groups[rotor + 1 : rotor + 1] = [fly]
    groups[observers + 1 : observers + 1] = [fly]
    write_namelists(folder / "case.nam", groups)
    (result,) = run_case(folder)
    way = 20.0 * result.pressure.time[0, -1]
    np.testing.assert_allclose(result.pressure.position[0, -1], OBSERVERS[0] + [0, 0, way])
    agree(result.pressure.total, reference_at(20.0).total)


def test_unknown_keys_are_named(make_case):
    folder = make_case(EnvironmentIn={"colour": 3})
    with pytest.warns(UserWarning, match="&environmentin: colour is not known") as caught:
        run_case(folder)
    assert len(caught) == 1


def test_a_case_that_is_wholly_understood_warns_of_nothing(make_case):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run_case(make_case())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"EnvironmentConstants": {"c": -1.0}}, "rho and c must be positive"),
        ({"EnvironmentConstants": {"rho": "air"}}, "rho must be a number; it is 'air'"),
        ({"ObserverIn": {"xMin": float("nan")}}, "xmin must be a number; it is nan"),
        ({"EnvironmentIn": {"nbSourceContainers": 2}}, "&containerin is missing"),
        ({"EnvironmentIn": {"nbObserverContainers": 2}}, "&observerin expected here"),
        ({"ObserverIn": {"nt": 1}}, r"nt must be a whole number, 2 \.\.\. 1048576; it is 1$"),
        ({"ObserverIn": {"nt": 10**12}}, r"2 \.\.\. 1048576; it is 1000000000000$"),
        ({"ObserverIn": {"nbz": 10**9}}, r"nbz must be a whole number, 1 \.\.\. 10000; it is"),
        ({"ObserverIn": {"nbx": 5000, "nby": 5000}}, "nbx x nby x nbz must be at most 10000"),
        ({"ObserverIn": {"nt": 1 << 20, "nbx": 100}}, "at most 10000 observers and 16777216 press"),
        ({"ObserverIn": {"tMax": 1e300}}, r"tmax must be -1e\+12 \.\.\. 1e\+12; it is 1e\+300"),
        (
            {"ContainerIn": {"dTau": 1e-15}},
            "dTau must be 5.95e-08 s or more, for a rec",
        ),
        ({"ContainerIn": {"dTau": -1e-3}}, "dTau must be 5.95e-08 s or more"),
        ({"EnvironmentIn": {"loadingNoiseFlag": 3}}, "loadingnoiseflag must be .true. or .false.;"),
        ({"CB": {"Omega": 5.0, "AngleType": None}}, "omega needs AngleType 'KnownFunction'"),
        ({"CB": {"windFrame": True}}, "a wind frame"),
        ({"ObserverIn": {"attachedTo": "tail"}}, "attachedTo 'tail': there is no such container"),
        ({"ObserverIn": {"attachedTo": "Blade 1"}}, "observers must be fixed or in uniform motion"),
        ({"omega": 800.0}, "sources must be slower than sound"),
        (
            {"ObserverIn": {"fileName": "grid.xyz"}},
            r"observers of a file \(fileName\) are not read",
        ),
        (
            {"ObserverIn": {"xMin": 0.2, "zMin": 0.0}},
            "observer 1 comes to 0.2 m from the centre of the sources; the region's radius is 0.5",
        ),
    ],
)
def test_bad_cases_are_one_clear_line(make_case, changes, message):
    with pytest.raises(WopwopFileError, match=message) as caught:
        run_case(make_case(**changes))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "solid blade\n",
        "&casename\n caseNameFile = 'x.nam'",
        "&casename\n caseNameFile = 'x\n/\n",
    ],
)
def test_foreign_namelists(tmp_path, text, capsys):
    (tmp_path / "cases.nam").write_text(text)
    with pytest.raises(WopwopFileError, match=r"cases.nam: not a Fortran namelist file"):
        run_case(tmp_path)
    assert capsys.readouterr().out == ""


def test_missing_files(tmp_path, make_case):
    with pytest.raises(WopwopFileError, match=r"nowhere.cases.nam: No such file"):
        run_case(tmp_path / "nowhere")
    folder = make_case()
    (folder / "loading.dat").unlink()
    with pytest.raises(WopwopFileError, match=r"loading.dat: No such file"):
        run_case(folder)


def test_loads_that_do_not_fit(make_case, loading):
    short = Zone("line loads", loading.zones[0].values[:, :, :5])
    with pytest.raises(WopwopFileError, match="data of zone 'line loads' must be 1 x 9 .* 1 x 5"):
        run_case(make_case(loading=dataclasses.replace(loading, zones=(short,))))
    with pytest.raises(WopwopFileError, match="mixed frame"):
        run_case(make_case(loading=dataclasses.replace(loading, frame=2)))


def rewritten(folder, change):
    """Change the groups of a case, a list of (name, values)."""
    groups = [(group.name, dict(group.values)) for group in read_namelists(folder / "case.nam")]
    change(groups)
    write_namelists(folder / "case.nam", groups)
    return folder


def pitched(folder, **angle):
    """Let each blade pitch about its own axis, within its azimuth."""

    def change(groups):
        for place in reversed(range(len(groups))):
            if "anglevalue" in groups[place][1]:
                groups[place - 1][1]["nbbase"] = 2
                pitch = {"AngleType": "Periodic", "A0": 0.02, "A1": 0.01, "B1": -0.03} | angle
                groups.insert(place + 1, ("cb", pitch | {"AxisValue": [1, 0, 0]}))

    return rewritten(folder, change)


def test_a_periodic_angle_follows_the_rotor_around_it(make_case):
    """PSU-WOPWOP takes psi from the base with rotation = .true.; ours had to be told Omega."""
    told = run_case(pitched(make_case(), Omega=OMEGA))[0].pressure
    found = run_case(pitched(make_case()))[0].pressure
    np.testing.assert_array_equal(found.total, told.total)
    still = run_case(make_case())[0].pressure
    assert np.abs(found.loading - still.loading).max() > 0.01 * np.ptp(still.loading)


def test_a_periodic_angle_counts_from_the_azimuth_of_the_rotor(make_case):
    """A rotor that begins a quarter of a turn later, cos psi and sin psi exchanged to match."""
    turned = run_case(pitched(make_case(CB={"Psi0": np.pi / 2})))[0].pressure
    # psi = Omega t + pi/2: A1 cos psi + B1 sin psi = -A1 sin Omega t + B1 cos Omega t
    told = pitched(make_case(CB={"Psi0": np.pi / 2}), Omega=OMEGA, A1=-0.03, B1=-0.01)
    np.testing.assert_allclose(
        turned.total, run_case(told)[0].pressure.total, rtol=1e-9, atol=1e-12
    )


def test_a_periodic_angle_without_a_rotor_is_refused(make_case):
    with pytest.raises(WopwopFileError, match="needs an Omega, or rotation = .true. in a base aro"):
        run_case(pitched(make_case(CB={"rotation": False})))


def test_a_case_as_vspaero_writes_it(make_case):
    """Names without quotes, no c, dTau = 0, groups without a slash, angles without a type."""
    expected = run_case(make_case(EnvironmentConstants={"c": 342.0}, ContainerIn={"dTau": None}))
    folder = make_case(EnvironmentConstants={"c": None}, ContainerIn={"dTau": 0.0})
    text = (folder / "case.nam").read_text()
    text = text.replace("'geometry.dat'", "geometry.dat").replace("'loading.dat'", "loading.dat")
    text = text.replace("rho = 1.2\n/", "rho = 1.2\n").replace(
        "AngleType = 'TimeIndependent'\n", "\n"
    )
    assert "geometry.dat\n" in text and "'TimeIndependent'" not in text
    (folder / "case.nam").write_text(text + "&BPMIn nSect = 5 /\n&ContainerIn title = more /\n")
    with pytest.warns(UserWarning) as caught:
        results = run_case(folder)
    np.testing.assert_array_equal(results[0].pressure.total, expected[0].pressure.total)
    messages = [str(warning.message) for warning in caught]
    assert [
        any(part in message for message in messages)
        for part in (
            "c is not given; it is 342, as PSU-WOPWOP has it",
            "it ends where the next begins",
            "&bpmin has no effect",
            "&containerin 'more': it has no effect: the case is complete before it",
        )
    ] == [True] * 4
    assert len(messages) == 4


def test_the_total_takes_thickness_and_loading(make_case):
    """Flags as PSU-WOPWOP has them: off if not given, and the total needs both."""
    both = run_case(make_case())[0].pressure
    assert np.ptp(both.thickness) > 0 and np.ptp(both.loading) > 0
    for flags, thickness, loading in (
        ({"totalNoiseFlag": True, "thicknessNoiseFlag": False}, True, True),
        ({"thicknessNoiseFlag": True}, True, False),
        ({"loadingNoiseFlag": True, "thicknessNoiseFlag": False}, False, True),
    ):
        part = run_case(make_case(EnvironmentIn=flags))[0].pressure
        np.testing.assert_array_equal(part.thickness, both.thickness * thickness)
        np.testing.assert_array_equal(part.loading, both.loading * loading)


def test_observers_in_the_frame_of_an_aircraft(make_case):
    """Without a location, one stands where the bases of its own frame put it."""
    asked = {"attachedTo": "aircraft", "nbBaseObsContFrame": 1, "nbBaseLocalFrame": 1}
    folder = make_case(ObserverIn=asked | {f"nb{q}": None for q in "xyz"})

    def change(groups):
        names = [name for name, _ in groups]
        observers, rotor = names.index("observerin"), names.index("containerin")
        flight = ("cb", {"TranslationType": "KnownFunction", "VH": [0.0, 0.0, 5.0]})
        groups[rotor:rotor] = [
            ("containerin", {"title": "aircraft", "nbcontainer": 1, "nbbase": 1})
        ]
        groups[rotor + 1 : rotor + 1] = [flight]
        groups[observers + 1 : observers + 1] = [
            ("cb", {"TranslationValue": [3.0, 0.0, 0.0]}),
            ("cb", {"TranslationValue": [0.0, 0.0, -2.0]}),
        ]

    (result,) = run_case(rewritten(folder, change))
    np.testing.assert_allclose(result.pressure.position[0, 0], OBSERVERS[0])
    way = result.pressure.position[0, -1] - OBSERVERS[0]
    np.testing.assert_allclose(way, [0.0, 0.0, 5.0 * result.pressure.time[0, -1]])


def test_containers_as_deep_as_no_case_has_them(make_case):
    def change(groups):
        place = [name for name, _ in groups].index("containerin")
        groups[place:place] = [("containerin", {"title": "shell", "nbcontainer": 1})] * 3000

    with pytest.raises(WopwopFileError, match="containers must be at most 50 deep") as caught:
        run_case(rewritten(make_case(), change))
    assert "\n" not in str(caught.value)


def test_observers_run_together_hear_what_each_hears_alone(make_case, monkeypatch):
    """Far and near ones in two grids, in batches of three of which the last is filled up."""
    grid = {"nbx": 2, "xMin": 3.0, "xMax": 40.0, "nby": 2, "yMin": -1.0, "yMax": 5.0}

    def change(groups):
        place = [name for name, _ in groups].index("observerin")
        alone = {key: q for key, q in groups[place][1].items() if key[:2] not in ("nb", "xm", "ym")}
        alone = {key: q for key, q in alone.items() if key[:2] != "zm"}
        groups[place + 1 : place + 1] = [
            ("observerin", alone | {"title": "alone", "xloc": 7.0, "zloc": -1.0})
        ]

    folder = rewritten(
        make_case(ObserverIn=grid, EnvironmentIn={"nbObserverContainers": 2}), change
    )
    monkeypatch.setattr(foreign_case, "_AT_ONCE", 1)
    alone = run_case(folder)
    monkeypatch.setattr(foreign_case, "_AT_ONCE", 3)
    together = run_case(folder)
    assert [len(result.pressure.total) for result in together] == [4, 1]
    assert [result.observers for result in together] == ["microphones", "alone"]
    for one, other in zip(alone, together, strict=True):
        np.testing.assert_allclose(other.pressure.position, one.pressure.position)
        # other source times: the error of the interpolation
        scale = np.abs(one.pressure.total).max(axis=1, keepdims=True)
        assert (np.abs(other.pressure.total - one.pressure.total) < 1e-4 * scale).all()


def test_pressures_that_are_no_numbers_are_refused(make_case, monkeypatch):
    def broken(name, sources, motion, tau, observers, times, air):
        return np.full((len(observers.position), times.size), np.nan)

    monkeypatch.setattr(foreign_case, "source_history", broken)
    with pytest.raises(NotFiniteError, match="thickness noise of observer 1, 0 s is nan, in case"):
        run_case(make_case())
