"""Words: descriptions that make sense alone, names that are nouns, one name for a constant."""

import ast
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest

# Beginnings of descriptions that need the name above them. An editor shows a description alone.
FRAGMENT = re.compile(r"(Of |Their |Its |As `|As for|As in)")
SECTIONS = ("Parameters", "Attributes", "Inputs", "Outputs", "Options", "Returns", "Raises")
# Words that say nothing of what they name.
NO_NAMES = {"of", "at", "by", "found", "heard", "given", "one", "way", "how"}
CLOSURE_LINES = 5
PER_MINUTE = re.compile(
    r"\b(np|numpy|math|jnp)\.pi / 30(\.0*)?\b|\b30(\.0*)? / (np|numpy|math|jnp)\.pi\b"
)


@pytest.fixture(scope="module")
def sources(checkout: Path) -> dict[str, str]:
    """Text of every module by its path; studies as well."""
    return {
        str(path.relative_to(checkout)): path.read_text(encoding="utf-8")
        for folder in ("propmdao", "components", "studies")
        for path in sorted((checkout / folder).rglob("*.py"))
        # propmdao/components are the same files as components/, through the link
        if path.relative_to(checkout).parts[:2] != ("propmdao", "components")
    }


def descriptions(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Line and first line of each description in the sections of public docstrings."""
    for node in _public(tree):
        lines = (ast.get_docstring(node) or "").split("\n")
        section = ""
        for number, (above, line) in enumerate(pairwise(lines), start=1):
            if line and set(line) == {"-"}:
                section = above
            elif section in SECTIONS and above[:1].strip() and line[:1] == " ":
                yield node.body[0].lineno + number, line.strip()


def _public(
    node: ast.Module | ast.ClassDef,
) -> Iterator[ast.Module | ast.ClassDef | ast.FunctionDef]:
    """A module or class and everything public in it, functions with their closures left out."""
    yield node
    for child in node.body:
        if isinstance(child, ast.ClassDef | ast.FunctionDef) and not child.name.startswith("_"):
            if isinstance(child, ast.ClassDef):
                yield from _public(child)
            else:
                yield child


def names_bound(
    node: ast.AST, in_short_closure: bool = False, depth: int = 0
) -> Iterator[tuple[int, str]]:
    """Line and name of all variables and arguments, those of short closures left out."""
    for child in ast.iter_child_nodes(node):
        short, inside = in_short_closure, depth
        if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            lines = (child.end_lineno or child.lineno) - child.lineno + 1
            closure = depth > 0 or isinstance(child, ast.Lambda)
            short = in_short_closure or (closure and lines <= CLOSURE_LINES)
            inside = depth + 1
        if not short:
            if isinstance(child, ast.Name) and isinstance(child.ctx, ast.Store):
                yield child.lineno, child.id
            elif isinstance(child, ast.arg):
                yield child.lineno, child.arg
        yield from names_bound(child, short, inside)


def test_descriptions_make_sense_alone(sources):
    fragments = [
        f"{path}:{line}: {text}"
        for path, source in sources.items()
        if not path.startswith("studies")
        for line, text in descriptions(ast.parse(source))
        if FRAGMENT.match(text)
    ]
    assert not fragments, "\n".join(["say the subject:", *fragments])


def test_names_are_nouns(sources):
    """A preposition or participle may name something only within a closure of a few lines."""
    words = [
        f"{path}:{line}: {name}"
        for path, source in sources.items()
        for line, name in names_bound(ast.parse(source))
        if name in NO_NAMES
    ]
    assert not words, "\n".join(["name what it is:", *words])


def test_no_loop_is_used_as_an_if(sources):
    loops = [
        f"{path}:{node.lineno}"
        for path, source in sources.items()
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.For) and len(node.body) == 1 and isinstance(node.body[0], ast.Raise)
    ]
    assert not loops, "\n".join(["take the first and ask whether there is one:", *loops])


def test_revolutions_per_minute_are_converted_in_one_place(sources):
    places = [
        f"{path}:{number}: {line.strip()}"
        for path, source in sources.items()
        if path != "propmdao/records/units.py"
        for number, line in enumerate(source.splitlines(), start=1)
        if PER_MINUTE.search(line)
    ]
    assert not places, "\n".join(["use propmdao.records.units.RAD_PER_S:", *places])
