"""A coarse analysis of a blade whose name tries what a name must not do, and its page."""

from __future__ import annotations

import dataclasses

import pytest
from shared_mesh import COARSE

import propmdao as pm

HOSTILE = "</script><script>window.hit=1</script><img src=x onerror='window.hit=1'> & {{ 7*7 }} $x$"
SECONDS = 0.5


@pytest.fixture(scope="session")
def hostile_analysis():
    propeller = dataclasses.replace(
        pm.load_propeller("apcsf_11x4.7"), name=HOSTILE, source=f"book {HOSTILE}"
    )
    return pm.analyze(
        propeller,
        rpm=4200.0,
        broadband=True,
        observers=pm.arc(1.905, [-45.0, 0.0, 45.0]),
        fidelity=COARSE,
    )


@pytest.fixture(scope="session")
def origin():
    from propmdao.figures.pages.parts import Origin

    return Origin(
        "propmdao analyze '<b>x</b>'",
        "2026-11-27",
        {"propmdao": "1", "jax": "2"},
        ["<i>warned</i>"],
    )


@pytest.fixture(scope="session")
def page(hostile_analysis, origin):
    pytest.importorskip("jinja2")
    pytest.importorskip("plotly")
    from propmdao.figures.pages.analysis_page import analysis_page

    return analysis_page(hostile_analysis, hostile_analysis.to_dict(), origin, SECONDS)


@pytest.fixture(scope="session")
def text(page):
    from propmdao.figures.pages.rendering import html

    return html(page)
