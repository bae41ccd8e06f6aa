"""The design study, run coarse and short: what it prints and writes is what the model says."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path
from types import ModuleType

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.comparisons import ROWS, at_observer
from propmdao.analysis.single_point import analyze
from propmdao.components import AcousticsComp
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.description import Propeller
from propmdao.records.fidelity import Fidelity

Analysed = Callable[..., dict[str, float]]
# Table 4.10 of the thesis, as printed: APC 11x4.7 SF, optimized, difference.
TABLE_4_10 = {
    "rotation speed, rpm": ("4200", "4636", None),  # printed: +636
    "thrust, N": ("1.20", "1.24", "+0.04"),
    "CT": ("0.040", "0.035", "-0.005"),
    "CQ": ("0.0034", "0.0026", "-0.0008"),
    "OASPL thickness, dB": ("37.88", "33.18", "-4.70"),
    "OASPL loading, dB": ("52.87", "41.33", "-11.54"),
    "OASPL total, dB": ("53.04", "38.93", "-14.11"),
    "SPL at BPF, dB": ("44.92", "37.09", "-7.83"),
    "BPF, Hz": ("140", "155", "+15"),
}


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType], coarse: Fidelity) -> ModuleType:
    module = import_study("low_noise_design")
    module.FIDELITY, module.POPULATION = coarse, 6
    return module


def run_main(study: ModuleType, folder: Path, *arguments: str) -> str:
    """Run the script's main and return what it prints."""
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(io.StringIO()) as printed:
        patch.setenv("COLUMNS", "80")
        patch.setattr("sys.argv", ["low_noise_design.py", "--output", str(folder), *arguments])
        study.main()
    return printed.getvalue()


@dataclasses.dataclass
class Run:
    """Output of a run of the script, its table read back by label and column."""

    folder: Path
    printed: str
    rows: dict[str, dict[str, str]]

    def column(self, heading: str) -> dict[str, float]:
        return {key: float(self.rows[label][heading]) for label, key, _ in ROWS}


@pytest.fixture(scope="module")
def run(study: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("study") / "new" / "folder"
    printed = run_main(study, folder, "--evaluations", "19", "--seed", "3")
    with (folder / "low_noise_design.csv").open(newline="", encoding="utf-8") as stream:
        return Run(folder, printed, {row.pop(""): row for row in csv.DictReader(stream)})


@pytest.fixture(scope="module")
def analysis(coarse: Fidelity) -> Analysed:
    """What the microphone hears of a propeller at a thrust or rpm."""

    def of(propeller: Propeller, **drive: float) -> dict[str, float]:
        observers = arc(1.905, -45.0)
        return at_observer(
            analyze(propeller, **drive, speed=8.0, observers=observers, fidelity=coarse)
        )

    return of


@pytest.mark.parametrize("heading", ["APC-SF 11x4.7", "optimum", "thesis' optimum"])
def test_columns_are_what_analyze_says_of_the_propeller(
    run: Run, analysis: Analysed, heading: str
) -> None:
    # Of the files that a user gets for the two new blades.
    name = {"optimum": "optimum.toml", "thesis' optimum": "thesis_optimum.toml"}.get(heading)
    propeller = load_propeller(run.folder / name if name else "apcsf_11x4.7_thesis")
    column = run.column(heading)
    expected = analysis(propeller, thrust=1.2)
    assert_allclose(list(column.values()), [expected[key] for key in column], rtol=1e-12)
    assert_allclose(column["thrust"], 1.2, rtol=1e-8)


def test_the_written_blade_is_the_one_that_was_optimised(run: Run) -> None:
    best = json.loads((run.folder / "best_design.json").read_text())
    (objective,) = best["objective"].values()
    (torque,) = best["constraints"].values()
    column = run.column("optimum")
    assert_allclose(column["oaspl_db"], objective["value"], atol=1e-7)
    assert_allclose(column["torque"], torque["value"], rtol=1e-8)
    for key, row in (("thickness_over_chord", "t/c"), ("design_lift_coefficient", "design lift")):
        design = best["design_variables"][f"{key}_cp"]["value"]
        shown = [float(run.rows[f"{row} {at}"]["optimum"]) for at in ("hub", "middle", "tip")]
        assert_allclose(shown, design, rtol=1e-12)


def test_the_optimum_is_feasible_and_no_louder_than_any_feasible_design(
    run: Run, study: ModuleType
) -> None:
    optimum, baseline = run.column("optimum"), run.column("APC-SF 11x4.7")
    assert optimum["torque"] <= baseline["torque"]
    objective, feasible = study.designs_tried(run.folder, baseline["torque"])
    assert len(objective) == 18  # whole generations of 6 within 19 evaluations
    assert_allclose(optimum["oaspl_db"], np.min(np.array(objective)[feasible]), atol=1e-7)


def test_the_search_starts_from_naca_4409(run: Run, study: ModuleType, analysis: Analysed) -> None:
    start = dataclasses.replace(load_propeller("apcsf_11x4.7_thesis"), airfoils=[(1.0, "naca4409")])
    objective, _ = study.designs_tried(run.folder, np.inf)
    assert_allclose(objective[0], analysis(start, thrust=1.2)["oaspl_db"], atol=1e-7)


def test_change_is_optimum_minus_baseline(run: Run) -> None:
    before, after = run.column("APC-SF 11x4.7"), run.column("optimum")
    for key, change in run.column("change").items():
        assert_allclose(change, after[key] - before[key], rtol=1e-12)


@pytest.mark.parametrize(("label", "printed"), TABLE_4_10.items())
def test_reported_numbers_are_those_of_the_thesis(
    run: Run, label: str, printed: tuple[str, str, str | None]
) -> None:
    before, after = (
        float(run.rows[label][f"reported: {heading}"]) for heading in ("APC-SF", "optimum")
    )
    assert (before, after) == (float(printed[0]), float(printed[1]))
    if printed[2] is not None:  # retyped from a third column, so a slip in one of them shows
        assert_allclose(after - before, float(printed[2]), atol=1e-9)


def test_sections_of_the_thesis_have_its_names(run: Run) -> None:
    names = [run.rows[f"section {at}"]["thesis' optimum"] for at in ("hub", "middle", "tip")]
    assert names == ["NACA 6406", "NACA 3403", "NACA 4403"]  # table 4.9


def test_printed_table_is_the_csv_rounded_and_fits_a_terminal(run: Run) -> None:
    table = run.printed[: run.printed.index("Comparable")].splitlines()
    assert max(map(len, table[1:])) <= 80  # above it stands the driver's summary
    for label, _, form in ROWS:
        (line,) = (line for line in table if line.startswith(f"{label} "))
        cells = {heading: text for heading, text in run.rows[label].items() if text}
        rounded = [
            # No change is +0.00, whichever side of it the last digit falls on.
            format(float(text), f"+z{form}" if heading == "change" else form)
            for heading, text in cells.items()
        ]
        assert line.removeprefix(label).split() == rounded


def test_note_compares_with_the_thesis_at_its_rotation_speed(run: Run, analysis: Analysed) -> None:
    at_4200 = analysis(load_propeller("apcsf_11x4.7_thesis"), rpm=4200.0)
    note = " ".join(run.printed.split())
    assert f"at 4200 rpm here: {at_4200['thrust']:.2f} N, CT {at_4200['CT']:.4f}" in note
    assert f"thickness {at_4200['oaspl_thickness_db']:.2f} dB" in note
    assert f"BPF {at_4200['spl_bpf_db']:.2f} dB" in note


@pytest.mark.parametrize("name", ["convergence", "blades", "spectrum", "pressure", "directivity"])
def test_figures_are_1200_pixels_wide(run: Run, name: str) -> None:
    image = (run.folder / f"{name}.png").read_bytes()
    assert image.startswith(b"\x89PNG")
    assert int.from_bytes(image[16:20], "big") == 1200


def test_same_seed_gives_the_same_design(run: Run, study: ModuleType, tmp_path: Path) -> None:
    problem = study.build_problem(run.column("APC-SF 11x4.7")["torque"])
    study.optimise(problem, 19, 3, tmp_path)
    again, first = ((f / "best_design.json").read_text() for f in (tmp_path, run.folder))
    assert again == first


def test_an_interrupted_run_leaves_its_best_design_and_says_where(
    study: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compute, calls = AcousticsComp.compute, []

    def interrupted(self: AcousticsComp, inputs: object, outputs: object) -> None:
        calls.append(None)
        if len(calls) == 4:
            raise KeyboardInterrupt
        compute(self, inputs, outputs)

    monkeypatch.setattr(AcousticsComp, "compute", interrupted)
    with pytest.raises(SystemExit) as stop:
        run_main(study, tmp_path)
    file = tmp_path / "best_design.json"
    assert str(file) in str(stop.value)
    assert json.loads(file.read_text())["evaluations"] <= 3


def test_without_a_feasible_design_there_is_one_line_and_no_table(
    study: ModuleType, tmp_path: Path
) -> None:
    problem = study.build_problem(1e-3)
    with pytest.raises(SystemExit, match="No design meets the constraint"):
        study.optimise(problem, 6, 1, tmp_path)
    assert not (tmp_path / "best_design.json").exists()


@pytest.mark.slow
def test_evolution_comes_within_a_twentieth_of_a_decibel_of_gradients(
    study: ModuleType, analysis: Analysed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(study, "POPULATION", 24)  # as it comes
    limit = analysis(load_propeller("apcsf_11x4.7_thesis"), thrust=1.2)["torque"]
    by_gradient = study.build_problem(limit)
    by_gradient.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-7, disp=False)
    by_gradient.run_driver()
    evolved = study.build_problem(limit)
    study.optimise(evolved, 600, 1, tmp_path)
    difference = evolved.get_val("oaspl_db") - by_gradient.get_val("oaspl_db")
    assert -1e-3 < difference < 0.05
