"""`import propmdao` gives what a script needs, and is quick for who needs little."""

from __future__ import annotations

import inspect
import subprocess
import sys

import pytest

import propmdao

SLOW = {"jax", "numpy", "scipy", "openmdao", "matplotlib", "rich"}


def left_out(code: str) -> None:
    """Run code in a process of its own that must not import what is slow."""
    check = f"import sys\nslow = {SLOW!r} & set(sys.modules)\nassert not slow, slow"
    result = subprocess.run(
        [sys.executable, "-c", f"{code}\n{check}"], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr


def test_importing_the_package_imports_nothing_slow() -> None:
    left_out("import propmdao, propmdao.records.quantities; dir(propmdao), propmdao.__version__")


@pytest.mark.parametrize("command", ["", "list", "analyze", "sweep", "flyover", "export", "wopwop"])
def test_help_imports_nothing_slow(command: str) -> None:
    arguments = [*command.split(), "--help"]
    left_out(
        "from propmdao.commands.program import main\n"
        f"try: main({arguments})\n"
        "except SystemExit as end: assert end.code == 0"
    )


@pytest.mark.parametrize("name", sorted(set(propmdao.__all__) - {"__version__"}))
def test_every_name_is_imported_when_it_is_used_and_says_what_it_is(name: str) -> None:
    value = getattr(propmdao, name)
    assert inspect.isclass(value) or inspect.isfunction(value)
    assert value.__name__ == name and value.__module__.startswith("propmdao.")
    # A frozen dataclass without a docstring would show its signature.
    summary = (value.__doc__ or "").splitlines()[0]
    assert summary.endswith(".") and not summary.startswith(f"{name}(")


def test_names_are_listed_once_and_stand_in_the_list_of_the_editor() -> None:
    assert len(set(propmdao.__all__)) == len(propmdao.__all__)
    assert set(propmdao.__all__) <= set(dir(propmdao))


def test_a_name_that_there_is_not_is_refused_as_by_any_module() -> None:
    with pytest.raises(AttributeError, match="module 'propmdao' has no attribute 'analyse'"):
        _ = propmdao.analyse
