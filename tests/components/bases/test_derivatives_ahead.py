"""Derivatives of components are compiled side by side, and none twice."""

from __future__ import annotations

from collections.abc import Callable

import openmdao.api as om
import pytest

from propmdao.components.bases import jax_component
from propmdao.components.bases.jax_component import JaxComponent

TRACED: list[str] = []


class Curve(JaxComponent):
    """y = f(x), a number; the function says when it is traced."""

    def initialize(self) -> None:
        self.options.declare("curve")

    def setup(self) -> None:
        self.add_input("x", 0.5)
        self.add_output("y")
        self.function = self.options["curve"]


def curve(name: str) -> Callable[..., dict]:
    def function(inputs: dict, constants: None, static: None) -> dict:
        TRACED.append(name)
        return {"y": inputs["x"] ** 2}

    return function


@pytest.fixture
def chain() -> om.Problem:
    """x -> a -> b and, to the side, c, which is asked for by nobody."""
    TRACED.clear()
    prob = om.Problem(reports=False)
    for name in "abc":
        prob.model.add_subsystem(name, Curve(curve=curve(name)))
    prob.model.connect("a.y", "b.x")
    prob.model.connect("a.y", "c.x")
    prob.setup(mode="rev")
    prob.set_val("a.x", 0.5)
    prob.run_model()
    assert sorted(TRACED) == ["a", "b", "c"]
    TRACED.clear()
    return prob


def test_the_first_product_begins_those_of_all_that_are_asked_for(
    chain: om.Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[str] = []
    begin = JaxComponent.compile_derivatives

    def tell(self: JaxComponent, inputs: dict) -> None:
        begun.append(self.name)
        begin(self, inputs)

    monkeypatch.setattr(jax_component.JaxComponent, "compile_derivatives", tell)
    for _ in range(2):
        total = chain.compute_totals(of=["b.y"], wrt=["a.x"])["b.y", "a.x"]
        assert total == pytest.approx(2 * 0.25 * 2 * 0.5)
    assert sorted(begun) == ["a", "b"]
    assert sorted(TRACED) == ["a", "b"]  # what was begun is what was used


def test_forward_products_begin_none(chain: om.Problem) -> None:
    chain.setup(mode="fwd")
    chain.run_model()
    chain.compute_totals(of=["b.y"], wrt=["a.x"])
    assert not any(component._has_begun for component in (chain.model.a, chain.model.b))
