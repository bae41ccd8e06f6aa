"""Every command of README and every code block of the pages runs as it stands there."""

import importlib.util
import re
import shlex
from pathlib import Path

import pytest

from propmdao.commands.program import main

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


PROPMDAO = [words[1:] for words in commands() if words[0] == "propmdao"]
CODE = [(page, k, code) for page in PAGES for k, code in enumerate(blocks(page, "python"))]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where a user works, with the README's propeller file in it."""
    folder = tmp_path_factory.mktemp("readme")
    (text,) = blocks("README.md", "toml")
    (folder / "my_blade.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.mark.parametrize("words", PROPMDAO, ids=" ".join)
def test_command_of_the_readme_runs(
    words: list[str], folder: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    """In the order of the page: what one writes another reads."""
    monkeypatch.chdir(folder)
    assert main(words) == 0
    captured = capsys.readouterr()
    assert captured.out.strip()
    assert "error" not in captured.err


@pytest.mark.parametrize(("page", "k", "code"), CODE, ids=[f"{p} {k}" for p, k, _ in CODE])
def test_code_block_of_a_page_runs(page: str, k: int, code: str) -> None:
    exec(compile(code, f"{page}, block {k + 1}", "exec"), {"__name__": "block"})


def test_all_blocks_are_run_or_known(checkout: Path) -> None:
    """No page has code that nobody runs."""
    for path in [checkout / "README.md", *sorted((checkout / "docs").glob("*.md"))]:
        languages = set(re.findall(r"^```(\w+)$", path.read_text(encoding="utf-8"), re.M))
        assert languages <= {"sh", "toml", "python"}, path.name
        if "python" in languages:
            page = str(path.relative_to(checkout))
            assert page in (*PAGES, "docs/plugging_in.md"), page
    assert len(PROPMDAO) > 8


def test_the_nomenclature_is_the_table_of_quantities(checkout: Path) -> None:
    spec = importlib.util.spec_from_file_location("nomenclature", checkout / "docs/nomenclature.py")
    assert spec and spec.loader
    nomenclature = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(nomenclature)
    text = nomenclature.PAGE.read_text(encoding="utf-8")
    assert nomenclature.page(text) == text
