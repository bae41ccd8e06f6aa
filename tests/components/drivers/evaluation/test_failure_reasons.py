"""Reasons of failed designs are counted, most frequent first, and short."""

from propmdao.components.drivers.evaluation.failure_reasons import LONGEST_REASON, FailureReasons


def reasons_of(*failures):
    reasons = FailureReasons()
    for failure in failures:
        reasons.add(failure)
    return reasons


def test_reasons_that_differ_in_numbers_are_one():
    caller = "'group.comp' <class Comp>: Error calling compute(), "
    reasons = reasons_of(
        "f is nan", f"{caller}3.1 N is out of reach\nat 1", f"{caller}4e-3 N is out of reach"
    )
    assert reasons.counts() == {"group.comp: 3.1 N is out of reach": 2, "f is nan": 1}
    assert reasons.text() == "2: group.comp: 3.1 N is out of reach; 1: f is nan"


def test_what_is_rare_or_long_is_cut():
    reasons = reasons_of(*"aaabbccd", "e" * 500)
    assert reasons.text() == "3: a; 2: b; 2: c; 2: other reasons"
    assert max(map(len, reasons.counts())) == LONGEST_REASON


def test_nothing_failed():
    assert reasons_of().counts() == {} and reasons_of().text() == ""
