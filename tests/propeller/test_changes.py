"""Changes of a described blade: the described one stays, the changed one says so."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest

from propmdao.formats.propellers import load_propeller
from propmdao.propeller.changes import Change
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.identity import checksum

PROPELLER = load_propeller("apcsf_11x4.7")


def test_nothing_is_changed_by_default():
    assert Change().applied_to(PROPELLER) is PROPELLER
    assert str(Change()) == ""


def test_each_change_does_what_it_says_and_nothing_else():
    change = Change(twist_offset_deg=-1.5, chord_factor=1.1, diameter=0.3, n_blades=3)
    changed = change.applied_to(PROPELLER)
    np.testing.assert_allclose(changed.beta_deg, PROPELLER.beta_deg - 1.5, rtol=1e-14)
    np.testing.assert_allclose(changed.c_over_R, 1.1 * PROPELLER.c_over_R, rtol=1e-14)
    assert (changed.diameter, changed.n_blades) == (0.3, 3)
    others = {field.name for field in dataclasses.fields(PROPELLER)}
    for name in others - {"beta_deg", "c_over_R", "diameter", "n_blades", "source"}:
        np.testing.assert_equal(getattr(changed, name), getattr(PROPELLER, name))


def test_the_source_of_a_changed_blade_says_what_was_changed():
    change = Change(twist_offset_deg=-1.5, chord_factor=1.1, diameter=0.3, n_blades=3)
    said = "blade angle -1.5 deg everywhere, chord times 1.1, diameter 0.3 m, 3 blades"
    assert str(change) == said
    assert change.applied_to(PROPELLER).source == f"{PROPELLER.source} Changed: {said}."
    sourceless = dataclasses.replace(PROPELLER, source="")
    assert Change(n_blades=3).applied_to(sourceless).source == "Changed: 3 blades."


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"chord_factor": 0.0}, "chord_factor must be within 0.001 ... 100; it is 0"),
        ({"chord_factor": 99.0}, "c_over_R must be within 1e-06 ... 10; station"),
        ({"diameter": -0.3}, "diameter must be within 0.001 ... 1000 m; it is -0.3"),
        ({"diameter": 1e-300}, "diameter must be within 0.001 ... 1000 m; it is 1e-300"),
        ({"n_blades": 0}, "n_blades must be within 1 ... 40; it is 0"),
        ({"n_blades": 100_000}, "n_blades must be within 1 ... 40; it is 100000"),
        ({"n_blades": 2.5}, "n_blades must be a whole number; it is 2.5"),
        ({"twist_offset_deg": math.nan}, "twist_offset_deg must be within -180 ... 180 deg"),
        ({"twist_offset_deg": 90.0}, "beta_deg must be within -90..90; station 1"),
    ],
)
def test_what_no_blade_can_be_is_refused_in_one_line(change, message):
    with pytest.raises(PropellerError, match=re.escape(message)) as error:
        Change(**change).applied_to(PROPELLER)
    assert "\n" not in str(error.value)


def test_the_checksum_is_that_of_the_numbers():
    assert checksum(load_propeller("apcsf_11x4.7")) == checksum(PROPELLER)
    assert checksum(Change(twist_offset_deg=1e-9).applied_to(PROPELLER)) != checksum(PROPELLER)
    assert len(checksum(PROPELLER)) == 8 and int(checksum(PROPELLER), 16) >= 0


@pytest.mark.parametrize("name", ["twist_offset_deg", "chord_factor"])
def test_a_change_that_is_no_number_is_named_itself(name):
    """Not the distribution that it would have changed."""
    for value in (float("nan"), float("inf"), "1"):
        with pytest.raises(ValueError, match=f"^{name} must be "):
            Change(**{name: value})
