"""The table of quantities: every quantity once, and as the records have it."""

from __future__ import annotations

import dataclasses
import math
from collections import Counter

import pytest

from propmdao.propeller.changes import Change
from propmdao.records.air import Air, Turbulence
from propmdao.records.fidelity import Marching
from propmdao.records.listening import Listening
from propmdao.records.models import (
    ElasticModel,
    LoadModel,
    NoiseModel,
    SelfNoiseModel,
    Transition,
)
from propmdao.records.quantities import (
    ASKED,
    BROADBAND_LEVELS,
    HUB_LOADS,
    LEVELS,
    RESULTS,
    VARIABLES,
    require_asked,
)
from propmdao.records.states import OperatingPoint
from propmdao.records.units import Quantity, Range

RECORDS = {
    "point": OperatingPoint,
    "point.air": Air,
    "point.turbulence": Turbulence,
    "change": Change,
    "model.loads": LoadModel,
    "model.loads.transition": Transition,
    "model.loads.elastic": ElasticModel,
    "model.loads.unsteady": Marching,
    "model.noise": NoiseModel,
    "model.noise.broadband": SelfNoiseModel,
    "listening": Listening,
}


def repeated(names):
    return [name for name, count in Counter(names).items() if count > 1]


def test_names_options_and_keys_are_unique():
    # Thrust is asked for and found, in JSON as `point.thrust` and as `thrust`.
    found = [*RESULTS, *HUB_LOADS, *LEVELS, *BROADBAND_LEVELS]
    assert not repeated(found) and set(ASKED) & set(found) == {"thrust"}
    options = [quantity.option for quantity in ASKED.values() if quantity.option]
    assert not repeated(options) and all(option.startswith("--") for option in options)
    tables = ASKED, RESULTS, HUB_LOADS, LEVELS, BROADBAND_LEVELS
    quantities = [quantity for table in tables for quantity in table.values()]
    assert repeated(name for quantity in quantities for name in quantity.columns) == ["thrust"]
    assert not repeated(quantity.variable for quantity in quantities)


@pytest.mark.parametrize("quantity", ASKED.values(), ids=ASKED)
def test_what_may_be_asked_is_a_field_of_its_record_with_the_same_default(quantity: Quantity):
    fields = {field.name: field for field in dataclasses.fields(RECORDS[quantity.record])}
    default = fields[quantity.name].default
    if quantity.name in (
        "broadband",
        "elastic",
        "unsteady",
    ):  # a switch here, a model or none there
        assert quantity.default is False and default is None
    else:
        assert quantity.default == default


def test_every_number_of_point_air_and_change_stands_in_the_table():
    for record in ("point", "point.air", "point.turbulence", "change", "model.loads.transition"):
        named = {quantity.name for quantity in ASKED.values() if quantity.record == record}
        fields = {field.name for field in dataclasses.fields(RECORDS[record])}
        assert named == fields - {"air", "turbulence"}


@pytest.mark.parametrize(
    "quantity",
    [
        quantity
        for quantity in ASKED.values()
        if quantity.record
        in ("point", "point.air", "point.turbulence", "change", "model.loads.transition")
    ],
    ids=lambda quantity: quantity.name,
)
def test_every_number_has_a_range_and_its_default_is_in_it(quantity: Quantity):
    assert quantity.allowed is not None
    assert quantity.default is None or quantity.default in quantity.allowed
    for wrong in (math.nan, math.inf, -math.inf, 1e300):
        with pytest.raises(ValueError, match=f"{quantity.name} must be .*within .*; it is"):
            require_asked(quantity.name, wrong)


def test_a_range_holds_its_ends_and_says_zero_where_that_is_allowed():
    turning = Range(0.5, 2.0, "rpm", or_zero=True)
    assert [value in turning for value in (0.0, 0.1, 0.5, 2.0, 2.1)] == [
        True,
        False,
        True,
        True,
        False,
    ]
    assert str(turning) == "0 or within 0.5 ... 2 rpm" and str(Range(0, 1)) == "within 0 ... 1"
    with pytest.raises(ValueError, match="^x must be a number; it is None$"):
        turning.require("x", None)


def test_a_vector_has_a_column_for_each_axis_and_a_number_one():
    assert HUB_LOADS["hub_force"].columns == ("hub_force_x", "hub_force_y", "hub_force_z")
    assert RESULTS["eta"].columns == ("eta",)


def test_a_sweep_varies_operation_and_blade():
    operation, blade = "speed incidence_deg rho", "twist_offset_deg chord_factor diameter n_blades"
    assert list(VARIABLES) == f"rpm thrust_required {operation} {blade}".split()
