"""The bench without a web: what it says is what an analysis finds, and it goes on after errors."""

from __future__ import annotations

import dataclasses
import io

import jax
import numpy as np
import pytest
import soundfile

import propmdao as pm
from propmdao.analysis.comparisons import operation_and_levels
from propmdao.analysis.single_point import analyze
from propmdao.commands.designs.bench.workbench import BENT, DESCRIBED, Workbench
from propmdao.formats.toml_files import propeller_from_text


def design(notes, kind="set", number=1, held="rpm", **steps):
    """Message with some sliders moved."""
    of_start = {slider["name"]: 0 for slider in notes.last("start")["sliders"]}
    moved = {name.replace("_at_", " "): k for name, k in steps.items()}
    return {"kind": kind, "number": number, "held": held, "steps": of_start | moved}


def test_the_described_blade_has_the_numbers_of_its_analysis(bench, notes, propeller, asked):
    _, values = operation_and_levels(analyze(propeller, **records_of(asked)).to_dict())
    for row in notes.last("numbers")["rows"]:
        if row["key"]:
            assert float(row["bent"]) == pytest.approx(values[row["key"]], abs=0.006), row
            assert row["described"] == row["bent"] and float(row["change"]) == 0.0
    assert notes.last("numbers")["is_complete"]
    heads = [row["label"] for row in notes.last("numbers")["rows"] if not row["key"]]
    assert heads == ["noise at the microphone"]


def records_of(request):
    names = [field.name for field in dataclasses.fields(request)]
    return {name: getattr(request, name) for name in names}


def test_a_bent_blade_has_the_numbers_of_its_file(bench, notes, propeller, asked, tmp_path):
    begun = len(notes.all)
    bench.receive(design(notes, number=7, twist_at_4=-15, chord_at_5=20, thrust=1))
    bench.receive({"kind": "save"})
    assert bench.wait(240.0)
    said = [message for message in notes.all[begun:] if message.get("number") == 7]
    # Loads and tones first; broadband noise after.
    assert [m["is_complete"] for m in said if m["kind"] == "numbers"] == [False, True]
    assert [m["kind"] for m in said] == ["numbers", "blade", "numbers", "spectra"]
    early = next(m for m in said if m["kind"] == "numbers")
    later = {row["key"] for row in early["rows"] if row["key"] and "bent" not in row}
    assert later == {f"at oaspl_{part}" for part in ("broadband_db", "broadband_dba", "total_db",
                                                     "total_dba")}  # fmt: skip
    assert notes.last("saved")["text"].endswith("saved.toml")
    read = pm.load_propeller(tmp_path / "saved.toml")
    assert read.name == "apcsf_11x4.7 bent"
    again = analyze(read, **records_of(asked))
    assert notes.number("thrust") == pytest.approx(float(again.loads.thrust), abs=6e-5)
    heard = again.to_dict()["observers"][0]
    for key in ("oaspl_thickness_db", "oaspl_db", "oaspl_broadband_dba", "oaspl_total_dba"):
        assert notes.number(f"at {key}") == pytest.approx(heard[key], abs=6e-3)
    # Less blade angle carries less, and is beside the described blade at the same rotation speed.
    assert notes.number("thrust") < notes.number("thrust", "described")
    assert notes.number("rpm") == notes.number("rpm", "described") == 4200.0
    assert pm.load_propeller(tmp_path / "saved.toml").c_over_R[-1] > propeller.c_over_R[-1]


def test_drags_are_no_steps_of_undo_and_the_described_blade_is_not_analysed_anew(bench, notes):
    for number in range(1, 4):
        bench.receive(design(notes, "drag", number, camber_at_2=number))
    bench.receive(design(notes, "set", 4, camber_at_2=4))
    bench.receive({"kind": "undo", "number": 5})
    assert bench.wait(240.0)
    undone = notes.last("design")
    assert undone["steps"]["camber 2"] == 0 and not undone["can_undo"] and undone["can_redo"]
    assert notes.last("numbers")["number"] == 5
    assert notes.number("thrust") == notes.number("thrust", "described")


def test_the_bent_blade_is_told_before_the_described_one_where_both_are_new(bench, notes):
    bench.receive(design(notes, number=1, twist_at_3=5))
    assert bench.wait(240.0)
    begun = len(notes.all)
    bench.receive(design(notes, number=2, twist_at_3=5, rpm=-3))
    assert bench.wait(240.0)
    thrust = [
        row
        for message in notes.all[begun:]
        if message["kind"] == "numbers"
        for row in message["rows"]
        if row["key"] == "thrust"
    ]
    assert ["described" in row for row in thrust] == [False, True, False, True]
    assert len({row["bent"] for row in thrust}) == 1 and "change" not in thrust[0]


def test_only_the_latest_of_many_drags_is_evaluated(bench, notes):
    begun = len(notes.all)
    for number in range(1, 41):
        bench.receive(design(notes, "drag", number, twist_at_2=number))
    assert bench.wait(240.0)
    numbers = [m["number"] for m in notes.all[begun:] if m["kind"] == "numbers"]
    assert numbers[-2:] == [40, 40] and len(numbers) <= 4


@pytest.fixture
def compilations():
    """Names of what JAX has compiled, or found compiled, since now."""
    names: list[str] = []

    def note(name: str, _: float, **__: object) -> None:
        if "backend_compile" in name:
            names.append(name)

    jax.monitoring.register_event_duration_secs_listener(note)
    yield names
    jax.monitoring.unregister_event_duration_listener(note)


def test_nothing_is_compiled_while_a_slider_is_dragged(bench, notes, compilations):
    names = (
        "chord_at_3 twist_at_3 camber_at_3 thickness_at_3 sweep_at_3 diameter rpm speed distance"
    )
    counts = []
    for steps in (1, 2):
        for number, name in enumerate(names.split()):
            bench.receive(design(notes, "drag", number, **{name: steps}))
            assert bench.wait(240.0)
        counts.append(len(compilations))
    # What compares two blades is compiled with the first of them; after that there is nothing.
    assert counts[1] == counts[0]
    assert notes.last("numbers")["is_complete"]


@pytest.mark.slow
def test_another_number_of_blades_is_compiled_once_and_the_bench_says_so(
    bench, notes, compilations, asked
):
    for number, name in enumerate(("twist_at_1", "twist_at_2", "n_blades", "n_blades"), start=1):
        if number == 3:
            compilations.clear()
        bench.receive(design(notes, number=number, **{name: 1, "chord_at_1": number}))
        assert bench.wait(240.0)
        if number == 3:
            assert compilations and "for 3 blades" in notes.last("working")["text"]
            assert notes.last("working")["number"] == 3
            compilations.clear()
    assert compilations == [] and notes.last("working")["number"] == 3
    three = propeller_from_text(bench.text(), "text", None)
    assert three.n_blades == 3
    thrust = float(analyze(three, **records_of(asked)).loads.thrust)
    assert notes.number("thrust") == pytest.approx(thrust, abs=6e-5)


def test_a_blade_that_has_no_analysis_is_one_line_and_the_bench_goes_on(fast_bench, listener):
    notes = listener(fast_bench)
    thrust = notes.number("thrust")
    fast_bench.receive(design(notes, number=1, diameter=50, rpm=80))
    assert fast_bench.wait(240.0)
    trouble = notes.last("trouble")
    assert trouble["number"] == 1 and "\n" not in trouble["text"]
    assert "relative tip Mach number must be below 1" in trouble["text"]
    assert notes.number("thrust") == thrust
    later = listener(fast_bench)
    assert later.last("trouble") == trouble  # after the page is loaded anew, too
    fast_bench.receive({"kind": "undo", "number": 2})
    assert fast_bench.wait(240.0)
    assert later.last("numbers")["number"] == 2
    later.all.clear()
    fast_bench.connect(later)
    assert "trouble" not in [message["kind"] for message in later.all]


@pytest.mark.parametrize(
    ("message", "text"),
    [
        ({"kind": "dance"}, "there is no 'dance' on a bench"),
        ({}, "there is no None on a bench"),
        ({"kind": "set", "held": "rpm", "steps": {}}, "a design has steps of all sliders"),
        ({"kind": "set", "rpm": 99}, "steps of rpm must be a whole number within -50 ... 67"),
    ],
)
def test_what_is_no_message_is_one_line(bench, notes, message, text):
    if "rpm" in message:
        message = design(notes, rpm=message["rpm"])
    bench.receive(message)
    assert notes.last("trouble")["text"].startswith(text)


def test_the_thrust_is_held_where_it_is(bench, notes):
    thrust = notes.number("thrust")
    bench.receive({"kind": "hold", "held": "thrust", "number": 1})
    assert bench.wait(240.0)
    assert notes.last("design")["held"] == "thrust"
    assert notes.number("thrust") == pytest.approx(thrust, abs=0.02)
    bench.receive({**design(notes, number=2, held="thrust", twist_at_3=-20)})
    assert bench.wait(240.0)
    assert notes.number("thrust") == notes.number("thrust", "described")
    assert notes.number("rpm") > notes.number("rpm", "described")


def test_sounds_have_the_level_of_the_microphone(bench, notes):
    bench.receive(design(notes, number=1, twist_at_4=15))
    assert bench.wait(240.0)
    for name, column in ((DESCRIBED, "described"), (BENT, "bent")):
        content, full_scale = bench.sound(name)
        samples, rate = soundfile.read(io.BytesIO(content))
        assert rate == 48000 and np.abs(samples).max() > 0.5
        level = 20.0 * np.log10(full_scale * np.sqrt(np.mean(samples**2)) / 2e-5)
        assert level == pytest.approx(notes.number("at oaspl_total_db", column), abs=0.3)
    with pytest.raises(ValueError, match="sounds of described and bent, not of 'x'"):
        bench.sound("x")


def test_who_comes_later_is_told_all_and_who_was_there_nothing(bench, notes):
    from_now = len(notes.all)
    later = type(notes)()
    bench.connect(later)
    assert [message["kind"] for message in later.all][0] == "start"
    assert {"numbers", "blade", "spectra"} <= {message["kind"] for message in later.all}
    bench.receive(design(notes, number=9, sweep_at_5=3))
    assert bench.wait(240.0)
    assert later.last("numbers")["number"] == 9 and len(notes.all) == from_now


def test_figures_are_of_both_blades(notes):
    space, *shapes = notes.last("blade")["panels"]
    assert space["label"] == "apcsf_11x4.7, 2 blades, 279.4 mm" and len(space["data"]) == 2
    assert [trace["name"] for trace in shapes[0]["data"]] == ["A, described", "B, bent"]
    tones, bands = notes.last("spectra")["panels"]
    assert tones["label"].startswith("tones") and bands["label"].startswith("third octaves")


def test_without_a_file_nothing_is_saved_and_the_text_is_there(propeller, asked):
    bench = Workbench(propeller, asked, (1.905, -45.0), None)
    try:
        notes = []
        bench.connect(notes.append)
        bench.receive({"kind": "save"})
        assert "--save FILE.toml" in notes[-1]["text"]
        assert 'name = "apcsf_11x4.7"' in bench.text()
    finally:
        bench.close()
