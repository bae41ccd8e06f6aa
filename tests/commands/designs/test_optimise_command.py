"""``propmdao optimise``: from the line that is typed to the folder; on coarse meshes."""

from __future__ import annotations

import csv
import functools
import json
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import propmdao as pm
from propmdao.commands.program import main

PROPELLER = "apcsf_11x4.7_uiuc"
SMALL = pm.Fidelity(n_chordwise=2, n_spanwise=4, n_contour=5, n_surface_span=4, n_harmonics=2)
ASKED = ["--thrust", "2", "--free", "twist", "--minimise", "power"]


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Analyses and design problems on meshes that are quick."""
    pytest.importorskip("matplotlib")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # OpenMDAO warns of itself
        from propmdao.commands.designs import design_results
        from propmdao.components.designs import problem_in_words

    quick = functools.partial(problem_in_words.design_problem, fidelity=SMALL)
    monkeypatch.setattr(problem_in_words, "design_problem", quick)
    monkeypatch.setattr(design_results, "analyze", functools.partial(pm.analyze, fidelity=SMALL))


def test_a_folder_has_the_blade_its_history_and_can_be_gone_on_with(
    coarse: None, tmp_path: Path, capsys: pytest.CaptureFixture[str], refused: Callable[..., str]
) -> None:
    folder = tmp_path / "results"
    asked = [*ASKED, "--twist", "-5:5", "--torque-max", "baseline", "--results", str(folder)]
    assert main(["optimise", PROPELLER, *asked, "--iterations", "2"]) == 0
    printed = capsys.readouterr()
    assert "design 1: shaft power, W" in printed.err
    assert {file.name for file in folder.iterdir()} >= {
        f"{PROPELLER}_quiet.toml", "history.csv", "history.png", "blades.png", "comparison.csv",
        "record.json", "best_design.json", "cases.sql",
    }  # fmt: skip
    record = json.loads((folder / "record.json").read_text())
    before, after = record["results"]
    assert after["shaft_power"] < before["shaft_power"]
    assert after["torque"] < 1.0001 * before["torque"]
    assert after["thrust"] == pytest.approx(2.0) == before["thrust"]
    assert record["search"]["limits"] == {"torque": "baseline"}
    assert record["search"]["free"] == {"twist": [-5.0, 5.0]}
    # The blade in the file is the one that was found, and the rest is as described.
    blade = pm.load_propeller(folder / f"{PROPELLER}_quiet.toml")
    described = pm.load_propeller(PROPELLER)
    np.testing.assert_array_equal(blade.c_over_R, described.c_over_R)
    assert 0.1 < np.abs(blade.beta_deg - described.beta_deg).max() <= 5.0
    assert float(pm.analyze(blade, thrust=2.0, fidelity=SMALL).loads.torque) == pytest.approx(
        after["torque"]
    )
    with (folder / "history.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    powers = [float(row["shaft power, W"]) for row in rows]
    assert powers[0] == pytest.approx(before["shaft_power"], rel=1e-5)

    # Again: from the best design there is, and silently.
    assert main(["optimise", PROPELLER, *asked, "--iterations", "1", "--quiet"]) == 0
    assert "design 1" not in capsys.readouterr().err
    with (folder / "history.csv").open() as stream:
        again = [float(row["shaft power, W"]) for row in csv.DictReader(stream)]
    assert again[0] == pytest.approx(min(powers), rel=1e-6)

    other = [word if word != "-5:5" else "-4:5" for word in asked]
    message = refused("optimise", PROPELLER, *other)
    assert "holds another search: free is" in message


def test_evolution_is_polished_and_resumes(
    coarse: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = [*ASKED, "--de", "--population", "5", "--generations", "1", "--results", str(tmp_path)]
    assert main(["optimise", PROPELLER, *asked]) == 0
    first = capsys.readouterr()
    assert "polished by" in first.err and "generation 1:" in first.err
    record = json.loads((tmp_path / "record.json").read_text())
    designed = (tmp_path / f"{PROPELLER}_quiet.toml").read_bytes()
    before, after = record["results"]
    assert after["shaft_power"] < before["shaft_power"]
    assert (tmp_path / "evolution.checkpoint").exists()
    assert main(["optimise", PROPELLER, *asked]) == 0
    assert (tmp_path / f"{PROPELLER}_quiet.toml").read_bytes() == designed


def test_the_model_of_broadband_noise_is_asked_of_the_search_and_of_both_blades(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # OpenMDAO warns of itself
        from propmdao.commands.designs import design_results, design_search
        from propmdao.components.designs import problem_in_words
        from propmdao.components.drivers.search_history import SearchHistory
    asked: list[dict[str, Any]] = []

    def analyze(*blade_and_point: Any, **options: Any) -> None:
        asked.append(options)
        raise ValueError("that is enough")

    one = np.ones(1)
    history = SearchHistory(objective=one, violation=0.0 * one, constraint=["none"])
    monkeypatch.setattr(
        problem_in_words, "design_problem", lambda *of, **words: asked.append(words)
    )
    monkeypatch.setattr(design_search, "run_search", lambda *of: history)
    monkeypatch.setattr(
        problem_in_words, "designed_blade", lambda prob, name: pm.load_propeller(PROPELLER)
    )
    monkeypatch.setattr(design_results, "analyze", analyze)
    noise = ["--arc", "1.9", "-45", "--trip", "heavy", "--layers", "bpm"]
    assert main(["optimise", PROPELLER, "--thrust", "2", *noise, "--results", str(tmp_path)]) == 2
    assert "that is enough" in capsys.readouterr().err
    search, analysis = asked
    assert (search["trip"], search["layers"]) == ("heavy", "bpm")
    assert (analysis["trip"], analysis["layers"], analysis["broadband"]) == ("heavy", "bpm", True)
    assert json.loads((tmp_path / "record.json").read_text())["search"]["layers"] == "bpm"


@pytest.mark.slow  # two processes compile the analysis
def test_workers_find_what_one_process_finds(tmp_path: Path) -> None:
    from propmdao.commands.designs.design_search import run_search
    from propmdao.components import design_problem

    def searched(n_workers: int) -> tuple[list[float], Any]:
        factory = functools.partial(
            design_problem, PROPELLER, pm.OperatingPoint(thrust=2.0), free=("twist",),
            minimise="power", limits={"torque": "baseline"}, fidelity=SMALL,
        )  # fmt: skip
        prob, folder = factory(), tmp_path / str(n_workers)
        folder.mkdir()
        search = {"method": "evolution", "population": 6, "generations": 1, "seed": 3}
        history = run_search(prob, folder, {**search, "workers": n_workers}, "power", factory)
        return history.objective.tolist(), prob.get_val("beta_cp")

    (one, blade), (two, same) = searched(1), searched(2)
    assert one[-1] < 0.98 * min(one[:12])  # polished
    np.testing.assert_allclose(two[:12], one[:12], rtol=1e-9)  # two generations of six
    np.testing.assert_allclose(same, blade, atol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--thrust 2", "--results"),
        ("--results r", "--thrust"),
        ("--thrust 2 --results r", "dba is heard by observers: there are none"),
        ("--thrust 2 --results r --minimise power --layers bpm", "minimise or limit dba or db"),
        ("--thrust 2 --results r --minimise noise", "invalid choice: 'noise'"),
        ("--thrust 2 --results r --free chords", "there is no 'chords'; there are chord, twist"),
        ("--thrust 2 --results r --camber -0.01:0.01", "--camber is the range of a free camber"),
        ("--thrust 2 --results r --chord 1.5:0.5", "LOW must be below HIGH"),
        ("--thrust 2 --results r --torque-max low", "'low' is not a number"),
        ("--thrust 2 --results r --torque-max 0", "limit of torque must be within"),
        ("--thrust 2 --results r --population 9", "--population is of differential evolution"),
        ("--thrust 2 --results r --de --population 4", "--population must be at least 5; it is 4"),
        ("--thrust 2 --results r --iterations 0", "--iterations must be at least 1; it is 0"),
        ("--thrust 2 --results r --also-at 1", "--also-at takes THRUST, SPEED and perhaps"),
        ("--thrust 2 --results r --also-at 1 2 3 4", "as in --also-at 2 10 70; it has 4 values"),
        ("--thrust 2 --results r --incidence 151", "incidence_deg must be within 0 ... 150 deg"),
        ("--thrust 2 --results r --also-at 1 2 -3", "incidence_deg must be within 0 ... 150 deg"),
        ("--thrust 2 --results r --also-at -1 0", "thrust must be within"),
        ("--thrust 2 --results r/x/record.json", "is a file, not a folder"),
        ("--thrust 2 --results r/x --minimise power", "its record.json is of no search"),
        (f"--thrust 2 --results r --minimise power --name {PROPELLER}", "give another one"),
    ],
)
def test_bad_input_is_refused_in_one_line_before_the_work(
    refused: Callable[..., str], tmp_path: Path, monkeypatch: Any, arguments: str, message: str
) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    Path("r/x").mkdir(parents=True)
    Path("r/x/record.json").write_text("{}")
    assert message in refused("optimise", PROPELLER, *arguments.split())
    assert {path.name for path in tmp_path.rglob("*")} == {"r", "x", "record.json"}
