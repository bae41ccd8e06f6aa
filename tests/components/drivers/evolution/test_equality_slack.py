"""The slack of equality constraints: a quantile of the first violations, which shrinks to none."""

import numpy as np

from propmdao.components.drivers.evaluation.candidate import Candidate
from propmdao.components.drivers.evolution.equality_slack import EqualitySlack


def candidate(*violation):
    return Candidate(np.zeros(1), 0.0, 0.0, np.array([0.0, *violation]))


def test_only_equalities_have_a_slack_which_shrinks_to_none():
    slack = EqualitySlack(np.array([False, True, False]), 10)
    assert slack.n_shrinking == 6
    slack.begin(
        [candidate(q, 7.0) for q in range(11)] + [Candidate.failed(np.zeros(1), 3, "stalled")]
    )
    by_generation = np.array([slack.at(generation) for generation in range(11)])
    assert by_generation[0].tolist() == [0.0, 2.0, 0.0]
    assert (np.diff(by_generation[:7, 1]) < 0.0).all()
    assert not by_generation[6:].any() and not by_generation[:, [0, 2]].any()


def test_without_equalities_or_a_success_there_is_none():
    assert EqualitySlack(np.array([False, False]), 10).n_shrinking == 0
    slack = EqualitySlack(np.array([False, True]), 10)
    slack.begin([Candidate.failed(np.zeros(1), 2, "stalled")])
    assert not slack.at(0).any()


def test_no_slack_makes_a_failed_design_feasible():
    failed = Candidate.failed(np.zeros(1), 2, "stalled")
    assert np.isinf(failed.relaxed_violation(np.array([0.0, 9.0]))).all()
    assert candidate(3.0).relaxed_violation(np.array([0.0, 2.0])).tolist() == [0.0, 1.0]
