"""How far small propellers twist and bend under their loads, and what that does to static thrust.

Blades held rigid and blades that give, standing still, over rotation speed, beside the measured
thrust where there is one. The material is that of the propeller's file; for APC's propellers it is
the one on which the maker's files base the lowest bending frequency: 1.6 million psi for slow
flyers, 2.7 for thin electrics, specific gravity 1.7. That frequency is computed, too, without
rotation: it tests stiffness and mass together.

The maker's and the GWS blades are thin, so three moments of a degree or more each nearly cancel:
lift ahead of the elastic axis and the mass of a swept and raked blade wind it in, the nose-down
moment of cambered sections and the propeller moment turn it flat. What is left depends on the line
of the blade, which photographs do not show: the published geometry of a straight blade gives
another answer than the maker's tables.
"""

import argparse
import csv
import dataclasses
from collections.abc import Iterator, Sequence
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from rich.console import Console
from rich.table import Table

import propmdao as pm
from propmdao.analysis.elastic.deflections import beam_of_propeller
from propmdao.analysis.elastic.materials import material_of
from propmdao.analysis.wind_tunnel import read_wind_tunnel
from propmdao.records.models import ElasticModel
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.output_files import replacing
from propmdao.structures.shapes import N_SHAPES
from propmdao.structures.vibration import natural_frequencies

MEASUREMENTS = Path(__file__).parent / "measurements"
PSI = 6894.757  # Pa
SLOW_FLYER = ElasticModel(youngs_modulus=1.6e6 * PSI, material_density=1700.0)
THIN_ELECTRIC = ElasticModel(youngs_modulus=2.7e6 * PSI, material_density=1700.0)
# Material, and the measured thrust where the name is not that of the propeller's measurements.
CASES = {"apcsf_11x4.7": SLOW_FLYER, "apcsf_10x4.7": SLOW_FLYER, "apce_10x7": THIN_ELECTRIC}
RPM = (2000.0, 4000.0, 6000.0)
STATIONS = (0.5, 0.75, 0.9)  # r/R at which the twist is told
COARSE = pm.Fidelity(n_chordwise=4, n_spanwise=16)


@dataclasses.dataclass(frozen=True)
class Point:
    """A blade at a rotation speed, rigid and elastic.

    Attributes
    ----------
    rpm : float
        Rotation speed [rev/min].
    twist_deg : tuple of float
        Turn of the sections at `STATIONS`, nose up [deg].
    tip : float
        Displacement of the tip toward thrust [m].
    rigid, elastic : float
        Static CT.
    measured : float
        Measured static CT, interpolated over rotation speed; nan where there is none.
    """

    rpm: float
    twist_deg: tuple[float, ...]
    tip: float
    rigid: float
    elastic: float
    measured: float


def measured_thrust(name: str) -> tuple[np.ndarray, np.ndarray] | None:
    """Rotation speeds and static CT measured on a propeller of the catalogue; None without any."""
    file = MEASUREMENTS / f"uiuc_{name}.toml"
    if not file.is_file():
        return None
    static = read_wind_tunnel(file).static
    order = np.argsort(static.rpm)
    return static.rpm[order], static.CT[order]


def bending_frequency(propeller: pm.Propeller, material: ElasticModel) -> float:
    """Lowest natural frequency of a blade that does not turn, clamped at its first station [Hz]."""
    beam = beam_of_propeller(propeller, material_of(propeller, material))[2]
    return float(natural_frequencies(beam, 0.0, jnp.zeros((4, N_SHAPES)))[0] / (2.0 * np.pi))


def points(
    propeller: pm.Propeller, material: ElasticModel, rpms: Sequence[float]
) -> Iterator[Point]:
    """Compute a propeller at standstill, rigid and elastic."""
    measured = measured_thrust(propeller.name)
    known = {name: value for name, value in dataclasses.asdict(material).items() if value}
    for rpm in rpms:
        rigid = pm.analyze(propeller, rpm=rpm, fidelity=COARSE)
        elastic = pm.analyze(propeller, rpm=rpm, fidelity=COARSE, elastic=True, **known)
        deflection = elastic.deflection
        assert deflection is not None
        twist = np.interp(STATIONS, deflection.r_over_R, deflection.twist_deg)
        yield Point(
            rpm=rpm,
            twist_deg=tuple(float(value) for value in twist),
            tip=float(deflection.rake_over_R[-1]) * 0.5 * propeller.diameter,
            rigid=float(rigid.coefficients.CT),
            elastic=float(elastic.coefficients.CT),
            measured=np.nan
            if measured is None
            else float(np.interp(rpm, *measured, left=np.nan, right=np.nan)),
        )


def gain(values: Sequence[float]) -> float:
    """Gain of static CT from the first to the last rotation speed, in per cent."""
    return 100.0 * (values[-1] / values[0] - 1.0)


def main() -> None:
    """Compute, print and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("propellers", nargs="*", metavar="PROPELLER",
                        help="names or files that name their material; default"
                        f" {', '.join(CASES)}")  # fmt: skip
    parser.add_argument("--rpm", type=float, nargs="+", default=RPM, help="default %(default)s")
    parser.add_argument("--output", type=Path, default="results/blade_deflection",
                        help="folder, default %(default)s")  # fmt: skip
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)

    headings = ["rpm", *(f"twist\n{r} R" for r in STATIONS), "tip\nmm", "CT\nrigid", "CT\nelastic",
                "CT\nmeasured"]  # fmt: skip
    for name in options.propellers or CASES:
        propeller, material = pm.load_propeller(name), CASES.get(name, ElasticModel())
        table = Table(box=None, padding=(0, 2, 0, 0), title=propeller.name, title_justify="left")
        for heading in headings:
            table.add_column(heading, justify="right")
        computed = list(points(propeller, material, options.rpm))
        for point in computed:
            table.add_row(
                f"{point.rpm:.0f}",
                *(f"{twist:+.2f}" for twist in point.twist_deg),
                f"{1e3 * point.tip:+.2f}",
                *(f"{value:.4f}" for value in (point.rigid, point.elastic, point.measured)),
            )
        Console(highlight=False).print(table)
        gains = [gain([getattr(point, key) for point in computed]) for key in
                 ("rigid", "elastic", "measured")]  # fmt: skip
        print("gain of CT in %: rigid {:.1f}, elastic {:.1f}, measured {:.1f}".format(*gains))
        frequency = bending_frequency(propeller, material)
        print(f"lowest bending frequency, at rest: {frequency * 2.0 * np.pi / RAD_PER_S:.0f} rpm\n")
        with (
            replacing(options.output / f"{propeller.name}.csv") as beside,
            beside.open("w", newline="") as stream,
        ):
            writer = csv.writer(stream)
            writer.writerow(field.name for field in dataclasses.fields(Point))
            writer.writerows(dataclasses.astuple(point) for point in computed)


if __name__ == "__main__":
    main()
