"""What the differences to the wind tunnel depend on.

Of APC-SF 11x4.7 and APC-E 10x7, one thing at a time is changed that is not known for sure: twist,
sections, stall delay, transition, transport of the wake. Then the question is turned round: which
twist offset would each measured CT need, and is the power right where the thrust is?

Nothing here is fitted, and nothing of it is in the catalogue.
"""

import argparse
import dataclasses
from collections.abc import Iterator
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from aerodynamic_validation import measurements, show, write_csv
from scipy.optimize import brentq

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars import neuralfoil_tables
from propmdao.aerodynamics.sections.polars.family import SectionPolars, shape_values
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.shipped import limits, shape, shipped_tables
from propmdao.aerodynamics.solutions.axial import WAKE_AGES, Flow, induced_velocity
from propmdao.aerodynamics.solutions.lattice_loads import (
    LatticeLoads,
    lattice_geometry,
    loads_with_wake,
)
from propmdao.aerodynamics.vortices.cores import core_radius
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.analysis.single_point import SOUND_SPEED
from propmdao.analysis.wind_tunnel import (
    Evaluate,
    Points,
    WindTunnel,
    calibrated_twist_deg,
    computed,
    errors,
)
from propmdao.figures import comparisons
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import (
    lattice_interpolation,
    lattice_nodes,
    strip_interpolation,
)
from propmdao.propeller.description import Propeller

PITCH = {"apcsf_11x4.7": 0.11938, "apce_10x7": 0.1778}  # m, the maker's: 4.7 and 7 in
OUTBOARD = 0.55  # r/R from which the maker's table of the sister 10x7SF has its nominal pitch
DENSITY, AIR_VISCOSITY = 1.225, 1.46e-5  # kg/m3, m2/s
N_CRIT = (1.0, 9.0)  # beside the catalogue's 5: dirty and clean air
# Cambers and thicknesses of sections at another n_crit, enough for these two blades.
CAMBER, THICKNESS = np.array([0.0, 0.03, 0.045, 0.06]), np.array([0.03, 0.045, 0.09, 0.155])
FORMATS = {"changed": "", "static CT": "+.1f", "static CP": "+.1f", "CT to J 0.5": "+.1f",
           "CP to J 0.5": "+.1f", "trend": ".2f", "twist": "+.2f", "then CT": "+.1f",
           "then CP": "+.1f"}  # fmt: skip


def chosen(tunnel: WindTunnel) -> WindTunnel:
    """Every third static point and every sixth with flight speed: enough for mean errors."""
    return dataclasses.replace(tunnel, static=tunnel.static[::3], dynamic=tunnel.dynamic[::6])


def variants(propeller: Propeller, with_n_crit: bool) -> Iterator[tuple[str, Propeller, Evaluate]]:
    """The propeller with one thing changed, and how it is analysed."""
    change = partial(dataclasses.replace, propeller)
    beta, r = propeller.beta_deg, propeller.r_over_R
    yield "nothing", propeller, computed
    yield "twist +1 deg", change(beta_deg=beta + 1.0), computed
    yield "twist -1 deg", change(beta_deg=beta - 1.0), computed
    nominal = np.degrees(np.arctan(PITCH[propeller.name] / (np.pi * propeller.diameter * r)))
    yield "nominal pitch outboard", change(beta_deg=np.where(r < OUTBOARD, beta, nominal)), computed
    for label, airfoils in {
        "E63 to Clark-Y": ((0.15, "e63"), (1.0, "clarky")),
        "E63": ((0.15, "e63"),),
        "Clark-Y": ((0.15, "clarky"),),
    }.items():
        if airfoils != tuple(propeller.airfoils):
            yield f"sections {label}", change(airfoils=airfoils), computed
    if propeller.name == "apcsf_11x4.7":
        yield "sections of the thesis", load_propeller("apcsf_11x4.7_thesis"), computed
    yield "no stall delay", propeller, partial(computed, stall_delay=False)
    for n_crit in N_CRIT if with_n_crit else ():
        yield (
            f"n_crit {n_crit:g}",
            propeller,
            partial(computed, polars=polars_at(propeller, n_crit)),
        )
    for transport in (0.75, 1.5):
        wake = partial(computed_with_wake, transport=transport)
        yield f"drift of the wake x {transport:g}", propeller, wake


def polars_at(propeller: Propeller, n_crit: float) -> SectionPolars:
    """Polars of the propeller's sections for another critical amplification."""
    polars, shipped = polars_for(propeller), shipped_tables().values
    names = [
        next(name for name, table in shipped.items() if np.array_equal(table, values))
        for values in polars.values
    ]
    return dataclasses.replace(
        polars,
        camber=jnp.asarray(np.concatenate([-CAMBER[:0:-1], CAMBER])),
        thickness=jnp.asarray(THICKNESS),
        values=jnp.asarray(np.stack([_shape_at(name, n_crit) for name in names])),
    )


@lru_cache
def _shape_at(name: str, n_crit: float) -> np.ndarray:
    grid = neuralfoil_tables.neuralfoil_grid(*shape(name), CAMBER, THICKNESS, n_crit)
    return shape_values(grid[0], *limits(*grid))


@partial(jax.jit, static_argnames="n_blades")
def _loads(flow: Flow, n_blades: int, w: float, transport: float) -> LatticeLoads:
    """Loads in a wake that drifts and contracts as if w were transport times what it is."""
    omega, ages = flow.rotation_speed, jnp.asarray(WAKE_AGES)
    trailing = flow.lattice.rings.corner[-1]
    wake = helical_wake(trailing, ages, n_blades, flow.radius, omega, flow.speed, transport * w)
    core = core_radius(ages, omega, AIR_VISCOSITY, 1e-4 * flow.radius)
    return loads_with_wake(
        flow.lattice, wake, core, omega, flow.speed, w, flow.density, flow.sections
    )


def computed_with_wake(
    propeller: Propeller, at: Points, twist_offset_deg: float, *, transport: float
) -> Points:
    """As `computed`, with the induced velocity in the wake times `transport`."""
    propeller = dataclasses.replace(propeller, beta_deg=propeller.beta_deg + twist_offset_deg)
    blade, stations = Blade.from_propeller(propeller), propeller.r_over_R
    nodes = lattice_nodes(blade, lattice_interpolation(stations, 24), 8)
    strips = strip_interpolation(stations, 24)
    sections = viscous_sections(polars_for(propeller), blade, strips, SOUND_SPEED)
    n, radius = propeller.n_blades, 0.5 * propeller.diameter
    lattice, found = lattice_geometry(nodes, n, radius), []
    for rpm, j in zip(at.rpm, at.J, strict=True):
        omega, speed = rpm * np.pi / 30.0, j * rpm / 60.0 * propeller.diameter
        flow = Flow(lattice, radius, omega, speed, DENSITY, sections)

        def missing(w: float, flow: Flow = flow) -> float:
            return float(induced_velocity(flow, n * _loads(flow, n, w, transport).thrust)) - w

        tip_speed = omega * radius
        w = brentq(missing, 1e-3 * tip_speed - 0.25 * speed, 0.3 * tip_speed, xtol=1e-6)
        loads = _loads(flow, n, w, transport)
        of = coefficients(
            n * loads.thrust, n * loads.torque, omega, speed, DENSITY, propeller.diameter
        )
        found.append((float(of.CT), float(of.CP)))
    return Points(at.rpm, at.J, *np.array(found).T)


def sensitivities(case: str, tunnel: WindTunnel, with_n_crit: bool) -> list[dict[str, Any]]:
    """Mean errors of every variant in per cent; then calibrated on static CT."""
    rows, propeller, both = [], load_propeller(case), (tunnel.static, tunnel.dynamic)
    for label, blade, evaluate in variants(propeller, with_n_crit):
        twist = calibrated_twist_deg(blade, tunnel.static, evaluate)
        published, calibrated = (
            _mean(tunnel, *(evaluate(blade, of, offset) for of in both)) for offset in (0.0, twist)
        )
        then = {"then CT": calibrated["CT to J 0.5"], "then CP": calibrated["CP to J 0.5"]}
        rows.append({"changed": label, **published, "twist": twist, **then})
    return rows


def _mean(tunnel: WindTunnel, static: Points, dynamic: Points) -> dict[str, float]:
    of = errors(tunnel, static, dynamic)
    named = {"static CT": of.static_ct, "static CP": of.static_cp, "CT to J 0.5": of.low_ct,
             "CP to J 0.5": of.low_cp}  # fmt: skip
    means = {name: 100.0 * float(np.nanmean(values)) for name, values in named.items()}
    return means | {"trend": of.trend}


def twist_needed(propeller: Propeller, measured: Points) -> tuple[np.ndarray, np.ndarray]:
    """Twist offset [deg] that gives each measured CT, and the error of CP with it [%]."""
    twist, cp = np.zeros((2, measured.rpm.size))
    for i in range(measured.rpm.size):
        one = measured[i : i + 1]
        twist[i] = calibrated_twist_deg(propeller, one)
        cp[i] = 100.0 * (computed(propeller, one, twist[i]).CP[0] / one.CP[0] - 1.0)
    return twist, cp


def fits_over_rpm(rpm: np.ndarray, twist: np.ndarray) -> str:
    """How well two laws describe the twist needed in hover."""
    lines = []
    for name, x in (("rpm^2", rpm**2), ("log rpm", np.log(rpm))):
        left = twist - np.polyval(np.polyfit(x, twist, 1), x)
        lines.append(f"linear in {name}: {np.sqrt(np.mean(left**2)):.2f} deg rms left over")
    return f"from {twist[0]:+.2f} to {twist[-1]:+.2f} deg; {', '.join(lines)}"


def main() -> None:
    """Vary, print the tables, write the files."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="a few points, without n_crit")
    parser.add_argument("--output", type=Path, default="results/aerodynamic_sensitivity",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    output = options.output.absolute()
    output.mkdir(parents=True, exist_ok=True)
    with_n_crit = not options.quick and neuralfoil_tables.neuralfoil_installed()
    if not with_n_crit:
        print("n_crit is left out: it takes NeuralFoil, pip install 'propmdao[polars]', a while")
    for case in PITCH:
        tunnel = measurements(case, quick=True) if options.quick else chosen(measurements(case))
        rows = sensitivities(case, tunnel, with_n_crit)
        write_csv(output / f"{case}.csv", [dict.fromkeys(FORMATS, "") | row for row in rows])
        print(f"\n{case}: mean errors in %; the same calibrated on static CT (twist in deg)")
        show(rows, FORMATS)

        propeller, climbing = load_propeller(case), tunnel.dynamic[tunnel.dynamic.J <= 0.5]
        still, moving = (twist_needed(propeller, of) for of in (tunnel.static, climbing))
        print(
            f"Twist offset for the measured static CT: {fits_over_rpm(tunnel.static.rpm, still[0])}"
        )
        labels = "twist offset for the measured CT, deg", "error of CP with it, %"
        figure = comparisons.over_rpm_and_advance_ratio(
            tunnel.static, climbing, dict(zip(labels, zip(still, moving, strict=True), strict=True))
        )
        figure.savefig(output / f"{case}_twist_needed.png")
        points = zip(
            *(np.append(getattr(tunnel.static, name), getattr(climbing, name)) for name in
              ("rpm", "J")), *np.concatenate([still, moving], axis=1), strict=True
        )  # fmt: skip
        write_csv(
            output / f"{case}_twist_needed.csv",
            [dict(zip(("rpm", "J", "twist", "CP error"), point, strict=True)) for point in points],
        )
    print(f"\nAll rows and the figures: {output}")


if __name__ == "__main__":
    main()
