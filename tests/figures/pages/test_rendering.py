"""Pages as files: whole in themselves, with text that is only text."""

from __future__ import annotations

import base64
import copy
import dataclasses
import gzip
import hashlib
import json
from html.parser import HTMLParser

import pytest

pytest.importorskip("jinja2")
pytest.importorskip("plotly")

import plotly.graph_objects as go
from plotly.offline import get_plotlyjs

from propmdao.figures.pages.diagrams import diagram
from propmdao.figures.pages.diagrams import text as plotly_text
from propmdao.figures.pages.parts import Figure, Section
from propmdao.figures.pages.rendering import html, write_page
from propmdao.runtime.output_files import OutputError

VOID = {"meta", "link", "img", "br", "input", "hr"}


class Elements(HTMLParser):
    """Elements of a page with their attributes and the text within."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None], list[str]]] = []
        self.open: list[tuple[str, dict[str, str | None], list[str]]] = []
        self.feed(text)
        self.close()
        assert self.open == []  # every element is closed, in its order

    def handle_starttag(self, tag, attributes):
        element = (tag, dict(attributes), [])
        self.found.append(element)
        if tag not in VOID:
            self.open.append(element)

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        for *_, within in self.open:
            within.append(data)

    def texts(self, tag: str) -> list[str]:
        return ["".join(within) for name, _, within in self.found if name == tag]


@pytest.fixture(scope="module")
def elements(text):
    return Elements(text)


def test_what_a_file_says_is_text(text, elements, page):
    assert page.title.startswith("</script>") and "{{ 7*7 }}" in page.title
    assert elements.texts("h1") == [page.title]
    assert elements.texts("title") == [page.title]
    # Figures and Plotly as data, and the page's own script: no more than these.
    kinds = [attributes.get("type") for tag, attributes, _ in elements.found if tag == "script"]
    assert kinds == ["application/json", "application/gzip", None]
    tags = {tag for tag, *_ in elements.found}
    assert not tags & {"img", "iframe", "object", "embed", "form", "base", "link", "i", "b"}
    assert "window.hit" not in elements.texts("script")[2]
    assert any("<i>warned</i>" in item for item in elements.texts("li"))
    handlers = [
        name for _, attributes, _ in elements.found for name in attributes if name[:2] == "on"
    ]
    assert handlers == []


def test_what_a_file_says_is_text_in_figures(elements, page):
    figures = json.loads(elements.texts("script")[0])
    (space,) = [figure for figure in figures if "scene" in figure["layout"]]
    assert space["data"][0]["type"] == "surface"
    # Plotly takes tags in names for markup: none is left.
    assert plotly_text("<b>a</b> &lt;") == "&lt;b&gt;a&lt;/b&gt; &amp;lt;"
    names = [trace.get("name", "") for figure in figures for trace in figure["data"]]
    assert plotly_text(page.title) in names and not [name for name in names if "<" in name]


def test_nothing_is_loaded_from_elsewhere(elements):
    for _, attributes, _ in elements.found:
        for name in ("src", "href", "srcset", "action", "data", "poster"):
            target = attributes.get(name)
            assert target is None or target.startswith(("#", "data:audio/flac;base64,"))
    assert "url(" not in elements.texts("style")[0] and "@import" not in elements.texts("style")[0]


def test_the_policy_lets_only_the_two_scripts_of_the_page_run(elements):
    (policy,) = (
        attributes["content"]
        for tag, attributes, _ in elements.found
        if tag == "meta" and attributes.get("http-equiv") == "Content-Security-Policy"
    )
    _, packed, own = elements.texts("script")
    plotly = gzip.decompress(base64.b64decode(packed)).decode()
    assert plotly.splitlines() == get_plotlyjs().splitlines()
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    hashes = [base64.b64encode(hashlib.sha256(s.encode()).digest()).decode() for s in (own, plotly)]
    assert rules["default-src"] == "'none'"
    assert rules["script-src"].split() == [f"'sha256-{digest}'" for digest in hashes]


def test_figures_are_what_plotly_knows(page):
    panels = [
        panel
        for section in page.sections
        for part in section.parts
        if isinstance(part, Figure)
        for chosen in part.panels.values()
        for panel in chosen
    ]
    assert len(panels) > 15
    for panel in panels:
        # Raises at what it does not know, and takes what it is given apart.
        go.Figure(copy.deepcopy({"data": panel.data, "layout": panel.layout}))


def test_every_figure_has_words_for_who_does_not_see_it(elements):
    plots = [a for tag, a, _ in elements.found if tag == "div" and a.get("role") == "img"]
    assert len(plots) > 15
    assert all(len(str(attributes["aria-label"])) > 20 for attributes in plots)
    players = [a for tag, a, _ in elements.found if tag == "audio"]
    assert len(players) == 3 and all(a["aria-label"] and "controls" in a for a in players)
    headings = [int(tag[1]) for tag, *_ in elements.found if tag in ("h1", "h2", "h3")]
    assert headings[0] == 1 and headings.count(1) == 1


def test_a_page_without_its_sounds_takes_less_than_three_megabytes(text):
    start, n = 0, len(text)
    while (start := text.find("data:audio/flac;base64,", start)) >= 0:
        end = text.index('"', start)
        n -= end - start
        start = end
    assert 1.5e6 < n < 3e6


def test_a_number_that_is_none_is_refused(page):
    wrong = diagram("wrong", [{"type": "scatter", "y": [float("nan")]}], ("x", "y"))
    figure = Figure("wrong", "nothing", {"all": [wrong]})
    with pytest.raises(ValueError, match="not JSON compliant"):
        html(dataclasses.replace(page, sections=[Section("wrong", [figure])]))


def test_a_page_is_written_or_refused_in_one_line(page, text, tmp_path):
    write_page(tmp_path / "page.html", page)
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == text
    with pytest.raises(OutputError):
        write_page(tmp_path / "nowhere" / "page.html", page)
