"""Where polars come from: own tables first, then the catalogue at its transitions, NeuralFoil."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars import propeller_polars, sources
from propmdao.aerodynamics.sections.polars.attached import AttachedPolars
from propmdao.aerodynamics.sections.polars.family import blade_tables
from propmdao.aerodynamics.sections.polars.high_angle import ATTACHED_DEG
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import REYNOLDS
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.shipped import SHIPPED
from propmdao.aerodynamics.sections.polars.sources import polar_sources
from propmdao.aerodynamics.sections.polars.table import (
    PolarError,
    PolarSubstituteWarning,
    PolarTable,
    section_coefficients,
)
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller
from propmdao.records.models import FREE, Transition
from propmdao.runtime.caches import FOLDER_VARIABLE

Section = Callable[..., PolarTable]


LEVEL = "drag at the measured level"


@pytest.fixture
def without_neuralfoil(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sources, "neuralfoil_installed", lambda: False)


@pytest.fixture
def drag_of_n_crit(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """A NeuralFoil whose sections are flat plates with a drag of n_crit thousandths.

    Their moment is the x/c of the upper trip less that of the lower one, in tenths.
    """

    def grid(camber_shape, thickness_shape, max_camber, max_thickness, transition):
        shape = max_camber.size, max_thickness.size, REYNOLDS.size, ATTACHED_DEG.size
        cl = np.broadcast_to(2.0 * np.pi * np.radians(ATTACHED_DEG), shape)
        cd = np.full(shape, 1e-3 * transition.n_crit)
        cm = np.full(shape, 0.1 * (transition.trip_upper - transition.trip_lower))
        limits = (np.full(shape[:-1], position) for position in (10, 40))
        return AttachedPolars(np.stack([cl, cd, cm], axis=2), *limits)

    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    monkeypatch.setattr(propeller_polars, "neuralfoil_grid", grid)
    monkeypatch.setattr(propeller_polars, "neuralfoil_settings", lambda: "flat plates")
    monkeypatch.setattr(sources, "neuralfoil_installed", lambda: True)
    propeller_polars._neuralfoil_values.cache_clear()
    yield
    propeller_polars._neuralfoil_values.cache_clear()


def test_where_a_section_has_no_polars_those_of_another_stand_in_and_it_is_said(
    propeller: Callable[..., Propeller], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sources, "neuralfoil_installed", lambda: False)
    says = r"'naca2212' has no polars.*NACA 4-digit.*own=\{'naca2212'.*\[polars\]"
    with pytest.warns(PolarSubstituteWarning, match=says):
        polars = polars_for(propeller((0.0, "naca2212")))
    np.testing.assert_array_equal(polars.values, polars_for(propeller((0.0, "naca2412"))).values)


@pytest.mark.parametrize("known", ["e63", "clarky", "naca4409", "naca0012"])
def test_coordinates_of_a_known_shape_have_its_polars(
    propeller: Callable[..., Propeller],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    known: str,
) -> None:
    monkeypatch.setattr(sources, "neuralfoil_installed", lambda: False)
    section = find_airfoil(known)
    x = np.append(CHORD_FRACTION[::-1], CHORD_FRACTION[1:])
    half = 0.5 * section.thickness
    z = np.append((section.camber + half)[::-1], (section.camber - half)[1:])
    file = tmp_path / "mine.dat"
    np.savetxt(file, np.transpose([x, z]), fmt="%.5f", header="mine", comments="")
    polars = polars_for(propeller((0.0, str(file))))
    np.testing.assert_array_equal(polars.values, polars_for(propeller((0.0, known))).values)


def test_a_users_table_goes_before_the_catalogue(
    propeller: Callable[..., Propeller], section: Section
) -> None:
    own = section("naca0012")
    described = propeller((0.0, "clarky"), (1.0, "e63"))
    polars = polars_for(described, own={"clarky": own})
    span = span_interpolation(described.r_over_R, [0.2, 1.0])
    table = blade_tables(polars, Blade.from_propeller(described), span)
    cl = section_coefficients(table, jnp.full(2, 0.05), jnp.full(2, 1e5))[0]
    assert cl[0] < 0.75 * cl[1]
    with pytest.raises(PolarError, match="must hold one section"):
        polars_for(described, own={"clarky": section("naca0012", 2)})


def test_the_catalogue_has_the_transition_that_is_taken_by_default(
    propeller: Callable[..., Propeller],
) -> None:
    assert Transition().completed() == Transition(5.0, FREE, FREE) in SHIPPED
    described = propeller((0.0, "e63"), (1.0, "clarky"))
    by_name = polars_for(described, transition=Transition(5.0))
    np.testing.assert_array_equal(by_name.values, polars_for(described).values)


@pytest.mark.usefixtures("drag_of_n_crit")
@pytest.mark.parametrize("airfoils", [["e63", "clarky"], ["naca4412", "naca2212"]])
def test_all_shapes_are_made_at_another_transition(
    propeller: Callable[..., Propeller], airfoils: list[str]
) -> None:
    described = propeller(*zip((0.0, 1.0), airfoils, strict=True))
    polars = polars_for(described, transition=Transition(11.0))
    np.testing.assert_allclose(polars.weights, polars_for(described).weights)
    at_no_angle = np.asarray(polars.values[..., 1, :, polars.alpha.size // 2])
    np.testing.assert_allclose(at_no_angle, np.log(11e-3), atol=1e-4)


@pytest.mark.usefixtures("without_neuralfoil")
def test_another_transition_without_neuralfoil_is_refused(
    propeller: Callable[..., Propeller], section: Section
) -> None:
    described = propeller((0.0, "e63"))
    says = r"airfoil 'e63' at n_crit 11 .*NeuralFoil.*\[polars\].*n_crit 3 to 9 .*0.05 \(lower\)$"
    for find in (polars_for, polar_sources):
        with pytest.raises(PolarError, match=says):
            find(described, transition=Transition(11.0))
    own = {"e63": section("naca0012")}  # a table of one's own needs no NeuralFoil
    polars = polars_for(described, own, Transition(11.0))
    np.testing.assert_array_equal(polars.values, polars_for(described, own).values)


def test_sources_are_told_by_airfoil(
    propeller: Callable[..., Propeller], section: Section, monkeypatch: pytest.MonkeyPatch
) -> None:
    described = propeller((0.0, "e63"), (0.5, "naca2212"), (1.0, "clarky"))
    own = {"clarky": section("clarky")}
    monkeypatch.setattr(sources, "neuralfoil_installed", lambda: True)
    assert polar_sources(described, own) == {
        "e63": f"catalogue, n_crit 5, {LEVEL}",
        "naca2212": f"NeuralFoil, n_crit 5, {LEVEL}",
        "clarky": "user's table",
    }
    assert polar_sources(described, own, Transition(8.5)) == {
        "e63": f"catalogue, n_crit 8.5, {LEVEL}",
        "naca2212": f"NeuralFoil, n_crit 8.5, {LEVEL}",
        "clarky": "user's table",
    }
    assert polar_sources(described, own, Transition(11.0)) == {
        "e63": f"NeuralFoil, n_crit 11, {LEVEL}",
        "naca2212": f"NeuralFoil, n_crit 11, {LEVEL}",
        "clarky": "user's table",
    }
    monkeypatch.setattr(sources, "neuralfoil_installed", lambda: False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # `polars_for` has warned
        substitute = polar_sources(described, own)["naca2212"]
    assert substitute == f"catalogue, n_crit 5, {LEVEL}, a NACA 4-digit section in its place"


def test_the_transition_of_the_description_holds_where_none_is_asked_for(
    propeller: Callable[..., Propeller],
) -> None:
    described = dataclasses.replace(propeller((0.0, "e63")), n_crit=9.0)
    assert polar_sources(described) == {"e63": f"catalogue, n_crit 9, {LEVEL}"}
    plain = propeller((0.0, "e63"))
    at_nine = polars_for(plain, transition=Transition(9.0))
    np.testing.assert_array_equal(polars_for(described).values, at_nine.values)
    assert polar_sources(described, transition=Transition(3.0)) == {
        "e63": f"catalogue, n_crit 3, {LEVEL}"
    }


@pytest.mark.usefixtures("drag_of_n_crit")
def test_made_polars_are_kept(
    propeller: Callable[..., Propeller],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    described = propeller((0.0, "e63"))
    first = polars_for(described, transition=Transition(11.0), measured_drag=False)
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert said.startswith("propmdao: NeuralFoil makes the polars of airfoil 'e63' at n_crit 11, o")
    propeller_polars._neuralfoil_values.cache_clear()
    with monkeypatch.context() as patch:
        patch.setattr(propeller_polars, "neuralfoil_grid", None)  # nobody may ask it again
        again = polars_for(described, transition=Transition(11.0), measured_drag=False)
    assert capsys.readouterr().err == ""
    np.testing.assert_array_equal(first.values, again.values)
    for other in (Transition(12.0), Transition(11.0, 0.1, 0.1)):
        polars_for(described, transition=other, measured_drag=False)
    monkeypatch.setattr(propeller_polars, "neuralfoil_settings", lambda: "other flat plates")
    propeller_polars._neuralfoil_values.cache_clear()
    polars_for(described, transition=Transition(11.0), measured_drag=False)
    assert capsys.readouterr().err.count("\n") == 3
    assert len(list((tmp_path / "polars").iterdir())) == 4


@pytest.mark.usefixtures("drag_of_n_crit")
def test_trips_change_sides_where_a_section_is_turned_over(
    propeller: Callable[..., Propeller],
) -> None:
    """A section of negative camber is one of positive camber seen from below."""
    polars = polars_for(propeller((0.0, "e63")), transition=Transition(5.0, 0.1, 0.4))
    camber, at_no_angle = np.asarray(polars.camber), polars.alpha.size // 2
    moment = np.asarray(polars.values[0, :, 0, 2, 0, at_no_angle])
    # The upper side is upper on both: the moment of the flat plates above is that of their trips.
    np.testing.assert_allclose(moment, -0.03, atol=2e-5)
    assert camber[0] < 0.0 < camber[-1]
