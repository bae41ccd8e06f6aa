"""Formats by a table: every entry works, and an entry is all that a new format needs."""

from __future__ import annotations

import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

from propmdao.commands.program import build_parser
from propmdao.formats import endings
from propmdao.formats.endings import FileFormat, PolarReader, PropellerWriter
from propmdao.formats.polars import load_polars
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.checks import PropellerError

TABLES = (endings.PROPELLER_READERS, endings.PROPELLER_WRITERS, endings.POLAR_READERS)
ENTRIES = [form for table in TABLES for form in table.values()]


def read_nothing(*paths: Path) -> str:
    """Stands for the reader of a new format."""
    return " ".join(path.name for path in paths)


@pytest.mark.parametrize("form", ENTRIES, ids=lambda form: form.function)
def test_every_entry_names_a_function(form: FileFormat) -> None:
    assert callable(pkgutil.resolve_name(form.function))


def test_formats_are_described_by_their_contents() -> None:
    table = {".a": ENTRIES[0], ".b": ENTRIES[0], "": FileFormat("others", "x:y")}
    assert endings.described(table) == ".a or .b (propeller file), any other ending (others)"


def test_tables_are_looked_at_without_the_modules_of_the_formats() -> None:
    """The help of a command line shows them, and must not take seconds."""
    code = "import propmdao.formats.endings, sys; assert not {'numpy', 'jax'} & {*sys.modules}"
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.fixture
def new_format(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "new_format", sys.modules[__name__])
    entry = ("new file", "new_format:read_nothing")
    monkeypatch.setitem(endings.PROPELLER_READERS, ".new", FileFormat(*entry))
    monkeypatch.setitem(endings.PROPELLER_WRITERS, ".new", PropellerWriter(*entry))
    monkeypatch.setitem(endings.POLAR_READERS, ".new", PolarReader(*entry))


@pytest.mark.usefixtures("new_format")
def test_an_entry_is_all_that_a_new_format_needs(tmp_path: Path) -> None:
    assert load_propeller(tmp_path / "blade.NEW") == "blade.NEW"
    assert load_polars(tmp_path / "a.new") == "a.new"
    assert ".new (new file)" in " ".join(help_of("analyze").split())
    with pytest.raises(PropellerError, match=r"path of a file: .*, \.new \(new file\)"):
        load_propeller("nothing")


def help_of(command: str) -> str:
    (commands,) = (a for a in build_parser()._actions if a.dest == "name")
    assert isinstance(commands.choices, dict)
    return str(commands.choices[command].format_help())


def test_the_catalogue_goes_before_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("apcsf_11x4.7").write_text("something else")
    assert load_propeller("apcsf_11x4.7").n_blades == 2


def test_a_file_that_no_reader_is_for_lists_those_there_are(tmp_path: Path) -> None:
    path = tmp_path / "blade.step"
    path.touch()
    with pytest.raises(PropellerError) as caught:
        load_propeller(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: no propeller is read from a file with the ending '.step'")
    assert ".csv (table of a blade with heads), .txt or .dat (" in message and "\n" not in message
