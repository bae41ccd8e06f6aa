"""The table of quantities: every quantity once, and as the records have it."""

from __future__ import annotations

import dataclasses
from collections import Counter

import pytest

from propmdao.propeller.changes import Change
from propmdao.records.air import Air
from propmdao.records.listening import Listening
from propmdao.records.models import LoadModel, NoiseModel, SelfNoiseModel
from propmdao.records.quantities import (
    ASKED,
    BROADBAND_LEVELS,
    LEVELS,
    RESULTS,
    VARIABLES,
    Quantity,
)
from propmdao.records.states import OperatingPoint

RECORDS = {
    "point": OperatingPoint,
    "point.air": Air,
    "change": Change,
    "model.loads": LoadModel,
    "model.noise": NoiseModel,
    "model.noise.broadband": SelfNoiseModel,
    "listening": Listening,
}


def repeated(names):
    return [name for name, count in Counter(names).items() if count > 1]


def test_names_options_and_keys_are_unique():
    # Thrust is asked for and found, in JSON as `point.thrust` and as `thrust`.
    found = [*RESULTS, *LEVELS, *BROADBAND_LEVELS]
    assert not repeated(found) and set(ASKED) & set(found) == {"thrust"}
    options = [quantity.option for quantity in ASKED.values() if quantity.option]
    assert not repeated(options) and all(option.startswith("--") for option in options)
    quantities = [*ASKED.values(), *RESULTS.values(), *LEVELS.values(), *BROADBAND_LEVELS.values()]
    assert repeated(quantity.json for quantity in quantities) == ["thrust"]
    assert not repeated(quantity.variable for quantity in quantities)


@pytest.mark.parametrize("quantity", ASKED.values(), ids=ASKED)
def test_what_may_be_asked_is_a_field_of_its_record_with_the_same_default(quantity: Quantity):
    fields = {field.name: field for field in dataclasses.fields(RECORDS[quantity.record])}
    default = fields[quantity.name].default
    if quantity.name == "broadband":  # a switch here, a model or none there
        assert quantity.default is False and default is None
    else:
        assert quantity.default == default


def test_every_number_of_point_air_and_change_stands_in_the_table():
    for record in ("point", "point.air", "change"):
        named = {quantity.name for quantity in ASKED.values() if quantity.record == record}
        assert named == {field.name for field in dataclasses.fields(RECORDS[record])} - {"air"}


def test_a_sweep_varies_operation_and_blade():
    columns = "rpm thrust_required speed rho twist_offset_deg chord_factor diameter n_blades"
    assert list(VARIABLES) == columns.split()
