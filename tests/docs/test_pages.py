"""Every command of README and every code block of the pages runs as it stands there."""

import importlib.util
import re
import runpy
import shlex
import subprocess
from pathlib import Path

import pytest

from propmdao.commands.program import build_parser, main
from propmdao.formats.propellers import load_propeller

ROOT = Path(__file__).parents[2]
PAGES = ("README.md", "docs/conventions.md", "docs/architecture.md")


def blocks(page: str, *languages: str) -> list[str]:
    path = ROOT / page
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    return re.findall(rf"```(?:{'|'.join(languages)})\n(.*?)```", text, re.S)


def commands() -> list[list[str]]:
    """Words of every line of the README's shell blocks."""
    lines = "".join(blocks("README.md", "sh", "bash", "console")).splitlines()
    return [words for line in lines if (words := shlex.split(line, comments=True))]


STUDIES = [words[1:] for words in commands() if words[0] == "python"]
MAKE = [words[1:] for words in commands() if words[0] == "make"]
PROPMDAO = [words[1:] for words in commands() if words[0].endswith("propmdao")]
CODE = [(page, k, code) for page in PAGES for k, code in enumerate(blocks(page, "python"))]
#: Words of commands that compile for long. `tests/commands` asks for the same without the physics,
#: and the notebooks with such commands run in `make docs`.
LONG = {"--incidence", "3000:5000:500", "--wav", "flyover", "my_blade.toml", "sweep"}
#: Compiles a lattice of its own; the sign of its forces is held by the tests of `AerodynamicsComp`.
LONG_CODE = [("docs/conventions.md", 1)]


def slow_where(condition: bool) -> list[pytest.MarkDecorator]:
    return [pytest.mark.slow] if condition else []


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where a user works, with the README's propeller file in it."""
    folder = tmp_path_factory.mktemp("readme")
    (text,) = blocks("README.md", "toml")
    (folder / "my_blade.toml").write_text(text, encoding="utf-8")
    return folder


def test_propeller_file_of_the_readme_is_read(folder: Path) -> None:
    assert load_propeller(folder / "my_blade.toml").n_blades > 1


def test_commands_of_the_readme_are_understood() -> None:
    for words in PROPMDAO:
        if "--help" not in words:  # which ends the program
            assert vars(build_parser().parse_args(words))["name"] == words[0]


@pytest.mark.parametrize(
    "words",
    [pytest.param(words, marks=slow_where(not LONG.isdisjoint(words))) for words in PROPMDAO],
    ids=" ".join,
)
def test_command_of_the_readme_runs(
    words: list[str], folder: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    """In the order of the page: what one writes another reads."""
    monkeypatch.chdir(folder)
    try:
        status = main(words)
    except SystemExit as end:  # --help
        status = end.code
    assert status == 0
    captured = capsys.readouterr()
    assert captured.out.strip()
    assert "error" not in captured.err


@pytest.mark.parametrize("words", STUDIES, ids=" ".join)
def test_study_of_the_readme_starts(
    words: list[str], checkout: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    """What a study does is tested in tests/studies; here, that this line would start it."""
    script = checkout / words[0]
    if script.name in ("mission.py", "level_flight.py"):
        pytest.importorskip("dymos")
    if script.name == "openconcept_mission.py":
        pytest.importorskip("openconcept")
    if script.name == "aviary_mission.py":
        pytest.importorskip("aviary")
    monkeypatch.syspath_prepend(script.parent)
    monkeypatch.setattr("sys.argv", [str(script), "--help"])
    with pytest.raises(SystemExit) as end:
        runpy.run_path(str(script), run_name="__main__")
    assert end.value.code == 0
    known = capsys.readouterr().out
    assert all(option in known for option in words[1:] if option.startswith("--"))


@pytest.mark.parametrize("words", MAKE, ids=" ".join)
def test_target_of_the_readme_exists(words: list[str], checkout: Path) -> None:
    subprocess.run(["make", "--dry-run", *words], cwd=checkout, check=True, capture_output=True)


@pytest.mark.parametrize(
    ("page", "k", "code"),
    [pytest.param(*block, marks=slow_where(block[:2] in LONG_CODE)) for block in CODE],
    ids=[f"{page} {k}" for page, k, _ in CODE],
)
def test_code_block_of_a_page_runs(page: str, k: int, code: str) -> None:
    exec(compile(code, f"{page}, block {k + 1}", "exec"), {"__name__": "block"})


def test_all_blocks_are_run_or_known(checkout: Path) -> None:
    """No page has code that nobody runs."""
    for path in [checkout / "README.md", *sorted((checkout / "docs").rglob("*.md"))]:
        languages = set(re.findall(r"^```(\w+)$", path.read_text(encoding="utf-8"), re.M))
        assert languages <= {"sh", "toml", "text", "python"}, path.name
        if "python" in languages:  # cells of notebooks, {code-cell}, are run by `make docs`
            page = str(path.relative_to(checkout))
            # The last two have tests of their own.
            assert page in (*PAGES, "docs/plugging_in.md", "docs/howto/clusters.md"), page
    assert len(PROPMDAO) > 8
    assert {("install",), ("study",), ("test",)} <= {tuple(words) for words in MAKE}
    programs = {words[0] for words in commands()}
    assert programs <= {"propmdao", ".venv/bin/propmdao", "python", "make"}
    every = (checkout / "studies").glob("*/*.py")
    scripts = {path for path in every if "__main__" in path.read_text(encoding="utf-8")}
    shown = {checkout / words[0] for words in STUDIES}
    assert shown | {checkout / "studies/design/low_noise_design.py"} == scripts  # make study


def test_the_nomenclature_is_the_table_of_quantities(checkout: Path) -> None:
    spec = importlib.util.spec_from_file_location("nomenclature", checkout / "docs/nomenclature.py")
    assert spec and spec.loader
    nomenclature = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(nomenclature)
    text = nomenclature.PAGE.read_text(encoding="utf-8")
    assert nomenclature.page(text) == text
