"""Coefficients by their definitions, and nothing where nothing turns."""

import numpy as np
import pytest

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.records.air import Air
from propmdao.records.states import RotorState


def test_definitions_with_n_in_revolutions_per_second():
    n, D, rho, T, Q, V = 70.0, 0.28, 1.2, 1.5, 0.03, 8.0
    c = coefficients(T, Q, RotorState(2 * np.pi * n, V, Air(density=rho)), D)
    assert pytest.approx(V / (n * D)) == c.J
    assert pytest.approx(T / (rho * n**2 * D**4)) == c.CT
    assert pytest.approx(Q / (rho * n**2 * D**5)) == c.CQ
    assert pytest.approx(2 * np.pi * n * Q / (rho * n**3 * D**5)) == c.CP
    assert c.eta == pytest.approx(T * V / (2 * np.pi * n * Q))


def test_at_rest_all_are_zero():
    c = coefficients(0.0, 0.0, RotorState(0.0, 8.0, Air()), 0.28)
    assert (c.J, c.CT, c.CQ, c.CP, c.eta) == (0.0,) * 5
