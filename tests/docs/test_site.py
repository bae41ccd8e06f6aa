"""The documentation site leaves nothing out, and no command in it is one that there is not.

``make docs`` builds it and runs the code of its notebooks, the pages with a head for Jupyter.
"""

import importlib.util
import json
import pkgutil
import re
import shlex
import sys
from pathlib import Path

import pytest

import propmdao
from propmdao.commands.program import build_parser
from propmdao.propeller.electric_drive import drive_result
from propmdao.propeller.motors import catalog_motor

DOCS = Path(__file__).parents[2] / "docs"
PAGES = {str(path.relative_to(DOCS)): path.read_text("utf-8") for path in DOCS.rglob("*.md")}
NOTEBOOKS = {page for page, text in PAGES.items() if text.startswith("---\njupytext:")}
pytestmark = pytest.mark.skipif(not PAGES, reason="not run from a source checkout")


def fences(text: str, head: str) -> list[str]:
    return re.findall(rf"^```{re.escape(head)}\n(.*?)^```", text, re.S | re.M)


def documented(page: str) -> set[str]:
    return set(re.findall(r"^\.\. auto(?:class|function):: (\w+)$", PAGES[page], re.M))


def test_every_name_of_the_front_door_is_documented() -> None:
    assert documented("reference/api.md") == set(propmdao.__all__) - {"__version__"}


def test_every_component_is_documented() -> None:
    import propmdao.components

    assert documented("reference/components.md") == set(propmdao.components.__all__)


def test_every_page_is_in_the_table_of_contents() -> None:
    listed = {
        line.strip() + ".md"
        for tree in fences(PAGES["index.md"], "{toctree}")
        for line in tree.splitlines()
        if line and not line.startswith(":")
    }
    assert listed | {"index.md"} == PAGES.keys()


@pytest.mark.parametrize("page", sorted(PAGES))
def test_code_is_run_and_commands_are_known(page: str) -> None:
    """Code stands in cells that the build runs, or on the pages of test_pages.py."""
    text = PAGES[page]
    cells = fences(text, "{code-cell} python")
    assert bool(cells) == (page in NOTEBOOKS)
    languages = set(re.findall(r"^```(\w+)$", text, re.M))
    assert languages <= {"sh", "toml", "text", "python"}
    assert not (page in NOTEBOOKS and "python" in languages)
    parser = build_parser()
    for line in "".join(fences(text, "sh")).splitlines():
        words = shlex.split(line, comments=True)
        if words and words[0].endswith("propmdao"):
            parser.parse_args(words[1:])  # leaves the test with what is wrong
        elif words and words[0] == "python":
            assert (DOCS.parent / words[1]).is_file() or words[1] == "-m", line


@pytest.mark.parametrize("page", sorted(NOTEBOOKS))
def test_commands_of_notebooks_fail_the_build(page: str) -> None:
    """A line with ! may fail unseen; a %%bash cell does not."""
    for cell in fences(PAGES[page], "{code-cell} python"):
        assert not re.search(r"^!", cell, re.M), cell


NUMBER = re.compile(r"^\|.*\| `(propmdao\.[\w.]+)` \| ([-+.\de]+) \|$", re.M)


def test_numbers_of_the_theory_are_those_of_the_code() -> None:
    numbers = {
        name: float(value)
        for page, text in PAGES.items()
        if page.startswith("theory/")
        for name, value in NUMBER.findall(text)
    }
    assert len(numbers) > 25
    for name, value in numbers.items():
        assert pkgutil.resolve_name(_with_colon(name)) == pytest.approx(value, rel=1e-9), name


def _with_colon(name: str) -> str:
    """Dotted name with a colon before what is an attribute of a module: a class, a constant."""
    parts = name.split(".")
    first = next(k for k, part in enumerate(parts) if part[:1].isupper() or part[:1] == "_")
    return f"{'.'.join(parts[:first])}:{'.'.join(parts[first:])}"


def test_sources_that_the_theory_names_exist() -> None:
    """Where an equation is coded, or checked."""
    for page, text in PAGES.items():
        for path in re.findall(r"`((?:propmdao|components|studies|tests|docs)/[\w./]+)`", text):
            assert (DOCS.parent / path).exists(), f"{page}: {path}"


def test_validation_book_says_what_its_tests_hold() -> None:
    book = _script("validation_book")
    file = "tests/validation/test_hover_noise.py"
    checks = {
        "test_a": book.Check("test_a_level[3600]", [("x | y < 2", "np.float64(1.23456789) < 2")]),
        "test_b": book.Check("test_b", [("1 < 2", "1 < 2")], "failed", "AssertionError: 3 < 2"),
        "test_c": book.Check("test_c", outcome="skipped", reason="no data"),
    }
    kept = {"panel": "p", "labels": ("x, m", "y"), "log": False, "joined": True}
    for x, y in ((2.0, 3.0), (1.0, 5.0)):  # the second test has the point in front
        checks["test_b"].drawn.append(
            kept | {"x": [x], "computed": {"ours": [y]}, "compared with": {"theirs": [y]}}
        )
    text = book.book({file: checks})
    title = "APC-SF 11x4.7 in hover against the microphones of an anechoic chamber, nothing fitted"
    assert f"[{title}](#" in text and "| 3 | 1 | 1 | 1 |" in text and f"## {title}\n" in text
    assert r"| a level[3600] | `x \| y < 2` | `1.235 < 2` | met |" in text
    assert "| b | AssertionError: 3 < 2 |  | **missed** |\n|  | `1 < 2` | `1 < 2` |  |" in text
    assert "| c | no data |  | left out |" in text
    assert "```{image} figures/validation/hover_noise.png\n" in text
    (axes,) = book.figure(book.curves(checks)).axes
    assert [line.get_xydata().tolist() for line in axes.get_lines()] == [[[1, 5], [2, 3]]] * 2
    assert (axes.get_title(), axes.get_xlabel(), axes.get_ylabel()) == ("p", "x, m", "y")
    assert [line.get_linestyle() != "None" for line in axes.get_lines()] == [True, False]
    dots = [comparison | {"joined": False} for comparison in checks["test_b"].drawn]
    (axes,) = book.figure({"p": dots}).axes
    assert [line.get_linestyle() for line in axes.get_lines()] == ["None"] * 2


def test_index_of_an_accented_letter_is_beside_it() -> None:
    pytest.importorskip("sphinx")
    formula = _script("mathml").mathml
    plain = re.sub(r"\s|<math[^>]*>|</math>", "", formula(r"\dot v_n", block=True))
    assert plain.startswith('<msub><moveraccent="true"><mi>v</mi><mo')
    assert plain.endswith("</mover><mi>n</mi></msub>")
    assert "munderover" in formula(r"\sum_{j=1}^N j < 2 \; r", block=True)


def test_the_json_schema_is_that_of_results() -> None:
    schema = _script("json_schema")
    assert schema.FILE.read_text("utf-8") == schema.text()
    jsonschema = pytest.importorskip("jsonschema")
    fidelity = propmdao.Fidelity(2, 4, n_contour=5, n_surface_span=4, n_harmonics=2)
    analysis = propmdao.analyze(
        propmdao.load_propeller("apcsf_11x4.7"), rpm=4200.0, broadband=True, fidelity=fidelity,
        observers=propmdao.arc(1.905, [-45.0]),
    )  # fmt: skip
    result = json.loads(json.dumps(analysis.to_dict()))
    motor = catalog_motor("axi_2204_54")
    result["drive"] = drive_result(motor, analysis.rpm, float(analysis.loads.torque), 10.0)
    jsonschema.validate(result, schema.schema())
    del result["observers"][0]["oaspl_db"]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(result, schema.schema())


def _script(name: str):
    """A script of docs/ as a module."""
    spec = importlib.util.spec_from_file_location(name, DOCS / f"{name}.py")
    assert spec and spec.loader
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_imports_of_notebooks_are_documented() -> None:
    """What a tutorial or how-to takes from behind the front door has a place in the reference."""
    known = set(re.findall(r"^\.\. auto\w+:: ([\w.]+)$", PAGES["reference/parts.md"], re.M))
    needed = {
        f"{module}.{name}"
        for page in NOTEBOOKS
        for cell in fences(PAGES[page], "{code-cell} python")
        for module, names in re.findall(r"^from (propmdao\.[\w.]+) import (.*)$", cell, re.M)
        for name in names.split(", ")
        if module != "propmdao.components"
    }
    assert needed <= known, sorted(needed - known)
