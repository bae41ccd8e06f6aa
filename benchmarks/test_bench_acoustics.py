"""Time that the tones of a full surface take: 5,200 panels, 10 harmonics, one and nine observers.

Gathering 5,200 panels and 216 forces on 98 rings is a product of 98 polynomials and 20 parts of the
harmonics, 60 of forces: 12 million multiplications and additions, 1.2 ms of one core at 10 a
nanosecond. An observer hears 98 rings at 56 azimuths, 5,500 in all: 70 operations for the way, 45
for cosine and sine, and 22 for each of 10 harmonics of four components. That is 1.8 million, 0.2 ms
at 8 a nanosecond. So the floor is 1.4 ms for one observer and 3.2 ms for nine.

Measured on a busy machine, time of the processor: 6 and 9 ms, the reverse derivative 34 ms for
nine. Each panel by itself took 6 and 50 ms, the derivative 400 ms.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.lattice import lattice_nodes, lattice_span
from propmdao.geometry.surface import surface_nodes, surface_panels, surface_span
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads
from propmdao.records.states import RotorState


@pytest.fixture(scope="module", params=[1, 9], ids="observers-{}".format)
def case(request):
    """Return (panels, loads, observers): what `tones` is differentiated by in a design."""
    propeller = load_propeller("apcsf_11x4.7")
    blade = Blade.from_propeller(propeller)
    root = propeller.r_over_R[0]
    surface = span_interpolation(propeller.r_over_R, surface_span(root, 80))
    lattice = span_interpolation(propeller.r_over_R, lattice_span(root, 24))
    position = lattice_nodes(blade, lattice, 8).reshape(-1, 3)
    loads = PointLoads(position, jnp.ones_like(position))
    elevation_deg = [-45.0] if request.param == 1 else np.linspace(-45.0, 45.0, request.param)
    panels = surface_panels(surface_nodes(blade, surface, 65))
    return panels, loads, jnp.asarray(arc(1.905, elevation_deg))


def hear(panels, loads, observers):
    return tones(panels, loads, 2, RotorState(440.0, 8.0, Air()), observers, 10).total


def timed(benchmark, function, *arguments):
    compiled = jax.jit(function).lower(*arguments).compile()
    benchmark(lambda: jax.block_until_ready(compiled(*arguments)))


def test_tones(benchmark, case):
    timed(benchmark, hear, *case)


def test_forward_derivative(benchmark, case):
    timed(benchmark, lambda *values: jax.jvp(hear, values, values), *case)


def test_reverse_derivative(benchmark, case):
    weights = jnp.ones((len(case[2]), 10), complex)
    timed(benchmark, lambda *values: jax.vjp(hear, *values)[1](weights), *case)
