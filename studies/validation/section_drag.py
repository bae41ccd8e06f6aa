"""Drag of sections against two wind tunnels, and the level that is taken from them.

25 sections at Re 40 to 205 thousand: measured over computed drag at equal lift, for NeuralFoil's
polars as they are and for drag brought to the measured level
(`propmdao.aerodynamics.sections.polars.measured_drag`). The two numbers of that level are fitted
here, to all sections and to all but one in turn, which shows how far a section may be off that
nobody fitted to. It needs NeuralFoil (the extra ``polars``), whose AeroSandbox has the
coordinates, and the measured points in the folder that the environment variable
PROPMDAO_REFERENCE_DATA names (``section_polars/uiuc_lsat_drag.csv``, ``soartech8_drag.csv``:
section, Re, alpha_deg, cl, cd).
"""

import argparse
import csv
import dataclasses
import importlib
import os
import warnings
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.optimize import least_squares

from propmdao.aerodynamics.sections.polars.high_angle import ATTACHED_DEG
from propmdao.aerodynamics.sections.polars.measured_drag import (
    TUNNEL_LEVEL,
    TUNNEL_N_CRIT,
    at_measured_level,
)
from propmdao.aerodynamics.sections.polars.neuralfoil_tables import (
    neuralfoil_installed,
    neuralfoil_polars,
)
from propmdao.propeller.airfoils.airfoil import Airfoil, naca4
from propmdao.propeller.airfoils.contours import AirfoilFrameWarning
from propmdao.propeller.airfoils.coordinates import airfoil_from_coordinates
from propmdao.records.models import Transition
from propmdao.runtime.output_files import replacing

FILES = ("uiuc_lsat_drag.csv", "soartech8_drag.csv")
#: Names in AeroSandbox's database where they are not the measured model's in small letters.
COORDINATES = {
    "CLARKY-B": "clarky", "CLARK-Y": "clarky", "E374B": "e374", "E387A": "e387", "E387C": "e387",
    "FX63-137B": "fx63137", "LRN1007B": "lrn1007", "NACA6409": "n6409", "RG15B": "rg15",
    "S7012B": "s7012", "SD7032D": "sd7032", "SD7037A": "sd7037",
}  # fmt: skip
FORMULAS = {"NACA2414": (0.02, 0.4, 0.14), "NACA2.5411": (0.025, 0.4, 0.11)}
N_CRIT = 5.0
REYNOLDS_BANDS = {"40": (0, 5e4), "60": (5e4, 7e4), "80": (7e4, 9e4), "100": (9e4, 1.5e5),
                  "200": (1.5e5, 1e6)}  # fmt: skip
THICKNESS_BANDS = {"up to 6 %": (0.0, 0.06), "6 to 9 %": (0.06, 0.0895), "9 to 10.5 %":
                   (0.0895, 0.105), "above 10.5 %": (0.105, 1.0)}  # fmt: skip
LIFT_BANDS = {"below 0.1": (-9.0, 0.1), "0.1 to 0.3": (0.1, 0.3), "0.3 to 0.6": (0.3, 0.6),
              "0.6 to 0.9": (0.6, 0.9), "0.9 to 1.1": (0.9, 1.1),
              "above 1.1": (1.1, 9.0)}  # fmt: skip
_TAIL = 0.2  # logarithm from which a point counts as part of the tail in the fit: burst bubbles


@dataclasses.dataclass(frozen=True)
class Measured:
    """Drag measured at given lift, a row a point.

    Attributes
    ----------
    section : (n,) array of str
        Name of the model.
    re, cl, cd : (n,) arrays
        Reynolds numbers and coefficients.
    """

    section: np.ndarray
    re: np.ndarray
    cl: np.ndarray
    cd: np.ndarray


def measured_points(reference_data: Path) -> Measured:
    """Read the measured points of both tunnels."""
    rows = []
    for name in FILES:
        with open(reference_data / "section_polars" / name, encoding="utf-8", newline="") as file:
            rows += list(csv.DictReader(file))
    numbers = ([float(row[key]) for row in rows] for key in ("Re", "cl", "cd"))
    return Measured(np.array([row["section"] for row in rows]), *map(np.array, numbers))


def airfoil_of(section: str) -> Airfoil:
    """Get the design coordinates of a measured model."""
    if section in FORMULAS:
        return naca4(*FORMULAS[section])
    name = COORDINATES.get(section, section.lower())
    x, z = importlib.import_module("aerosandbox").Airfoil(name).coordinates.T
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AirfoilFrameWarning)  # open trailing edges
        return airfoil_from_coordinates(name, x, z)


def drag_at_lift(cl: np.ndarray, cd: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Drag of a polar at lift coefficients between its stalls, nan at others.

    Parameters
    ----------
    cl, cd : (n_attached,) arrays
        Coefficients at `ATTACHED_DEG`.
    wanted : (n,) array
        Lift coefficients.

    Returns
    -------
    (n,) array
        Drag coefficients.
    """
    near = np.flatnonzero(np.abs(ATTACHED_DEG) <= 20.0)
    middle = int(np.flatnonzero(ATTACHED_DEG == 0.0)[0])
    first = near[0] + int(cl[near[0] : middle].argmin())
    last = middle + int(cl[middle : near[-1] + 1].argmax())
    rising = np.maximum.accumulate(cl[first : last + 1]) + 1e-9 * np.arange(last + 1 - first)
    drag = np.exp(np.interp(wanted, rising, np.log(cd[first : last + 1])))
    return np.where((wanted > rising[0]) & (wanted < rising[-1]), drag, np.nan)


@dataclasses.dataclass(frozen=True)
class Computed:
    """Polars of the measured models at their Reynolds numbers.

    Attributes
    ----------
    thickness : dict of str to float
        Maximum thickness over chord by model.
    reynolds : dict of str to array
        Reynolds numbers by model.
    at_5, in_tunnel : dict of str to (3, n_re, n_attached) array
        Coefficients at n_crit 5 and at that of the tunnels.
    """

    thickness: dict[str, float]
    reynolds: dict[str, np.ndarray]
    at_5: dict[str, np.ndarray]
    in_tunnel: dict[str, np.ndarray]

    @classmethod
    def of(cls, points: Measured) -> "Computed":
        """Compute them with NeuralFoil."""
        made = cls({}, {}, {}, {})
        for section in np.unique(points.section):
            airfoil, re = airfoil_of(section), np.unique(points.re[points.section == section])
            made.thickness[section], made.reynolds[section] = airfoil.max_thickness, re
            for n_crit, kept in ((N_CRIT, made.at_5), (TUNNEL_N_CRIT, made.in_tunnel)):
                polar = neuralfoil_polars(
                    airfoil.camber[None],
                    airfoil.thickness[None],
                    ATTACHED_DEG,
                    re,
                    Transition(n_crit).completed(),
                )
                kept[section] = np.concatenate(polar[:3])
        return made

    def at_level(self, level: tuple[float, float] = TUNNEL_LEVEL) -> dict[str, np.ndarray]:
        """Polars of n_crit 5 with their drag at the measured level."""
        return {
            section: at_measured_level(polar, self.in_tunnel[section], re, level)
            for (section, polar), re in zip(self.at_5.items(), self.reynolds.values(), strict=True)
        }

    def logarithms(self, polars: dict[str, np.ndarray], points: Measured) -> np.ndarray:
        """Logarithm of measured over computed drag at equal lift, nan beyond the stalls."""
        logarithms = np.full(points.cl.size, np.nan)
        for section, (cl, cd, _) in polars.items():
            for row, re in enumerate(self.reynolds[section]):
                chosen = (points.section == section) & (points.re == re)
                drag = drag_at_lift(cl[row], cd[row], points.cl[chosen])
                logarithms[chosen] = np.log(points.cd[chosen] / drag)
        return logarithms


def left_out(computed: Computed, points: Measured) -> tuple[np.ndarray, np.ndarray]:
    """Fit the two numbers of the level, to all sections and to all but one in turn.

    Returns
    -------
    level : (2,) array
        The level fitted to all.
    logarithms : (n,) array
        Logarithm of measured over computed drag, of each section with a level fitted to the others.
    """
    # The logarithm is linear in the level.
    at_none, *at_one = (
        computed.logarithms(computed.at_level(level), points)
        for level in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    )
    slopes = np.stack([raised - at_none for raised in at_one], axis=1)
    known = np.isfinite(at_none)

    def fit(chosen: np.ndarray) -> np.ndarray:
        residual = lambda level: at_none[chosen] + slopes[chosen] @ level  # noqa: E731
        level: np.ndarray = least_squares(residual, np.zeros(2), loss="soft_l1", f_scale=_TAIL).x
        return level

    remaining = np.full(at_none.size, np.nan)
    # Models of one section share its coordinates, and are left out together.
    shape = np.array([COORDINATES.get(name, name.lower()) for name in points.section])
    for name in np.unique(shape):
        own = shape == name
        remaining[own] = at_none[own] + slopes[own] @ fit(known & ~own)
    return fit(known), remaining


def statistics(logarithms: np.ndarray) -> list[str]:
    """Number of points, median ratio, standard deviation, and that without the tails."""
    known = logarithms[np.isfinite(logarithms)]
    middle = np.median(known)
    spread = 1.4826 * np.median(np.abs(known - middle))
    return [str(known.size), f"{np.exp(middle):.2f}", f"{known.std():.2f}", f"{spread:.2f}"]


def rows_of(
    columns: dict[str, np.ndarray], points: Measured, thickness: np.ndarray
) -> list[list[str]]:
    """Rows of the table: median ratio and spread without tails of each column, by groups."""
    groups = {"all": np.ones(points.re.size, bool)}
    for title, values, bands in (
        ("Re, thousand", points.re, REYNOLDS_BANDS),
        ("t/c", thickness, THICKNESS_BANDS),
        ("cl", points.cl, LIFT_BANDS),
    ):
        groups |= {
            f"{title}: {name}": (values > a) & (values <= b) for name, (a, b) in bands.items()
        }
    everywhere = np.all([np.isfinite(values) for values in columns.values()], axis=0)
    rows = []
    for name, chosen in groups.items():
        if not (chosen & everywhere).any():
            continue
        of_group = [statistics(values[chosen & everywhere]) for values in columns.values()]
        rows.append([name, of_group[0][0], *(f"{row[1]} ({row[3]})" for row in of_group)])
    return rows


def main() -> None:
    """Print the table, draw the figure, write the points."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default="results/section_drag",
                        help="folder, default %(default)s")  # fmt: skip
    output = parser.parse_args().output.absolute()
    folder = os.environ.get("PROPMDAO_REFERENCE_DATA")
    if not folder:
        raise SystemExit("PROPMDAO_REFERENCE_DATA is not set: there are no measured points to read")
    if not neuralfoil_installed():
        raise SystemExit("the sections' polars take NeuralFoil: pip install 'propmdao[polars]'")
    points = measured_points(Path(folder))
    computed = Computed.of(points)
    level, remaining = left_out(computed, points)
    columns = {
        "n_crit 5": computed.logarithms(computed.at_5, points),
        "n_crit 9": computed.logarithms(computed.in_tunnel, points),
        "measured level": computed.logarithms(computed.at_level(), points),
        "fitted without its section": remaining,
    }
    thickness = np.array([computed.thickness[section] for section in points.section])
    table = Table("", "points", *columns, title="Measured over computed drag at equal lift: median "
                  "(standard deviation of the logarithm, without tails)")  # fmt: skip
    for row in rows_of(columns, points, thickness):
        table.add_row(*row)
    console = Console(width=120)
    console.print(table)
    inside = np.abs(remaining[np.isfinite(remaining)])
    console.print(
        f"Level fitted to all: {level[0]:+.3f}, {level[1]:+.3f}; taken: {TUNNEL_LEVEL}. "
        f"Of sections left out 68 % of the points are within {np.quantile(inside, 0.68):.2f}, "
        f"the mean difference is {inside.mean():.2f}."
    )
    output.mkdir(parents=True, exist_ok=True)
    with (
        replacing(output / "points.csv") as beside,
        beside.open("w", encoding="utf-8", newline="") as file,
    ):
        writer = csv.writer(file)
        writer.writerow(["section", "Re", "cl", "cd", *columns])
        for i, section in enumerate(points.section):
            ratios = (f"{np.exp(values[i]):.3f}" for values in columns.values())
            writer.writerow([section, points.re[i], points.cl[i], points.cd[i], *ratios])
    groups = {
        f"Re {name} thousand": (points.re > a) & (points.re <= b)
        for name, (a, b) in REYNOLDS_BANDS.items()
    }
    from propmdao.figures.measured import section_drag as drag_figures
    from propmdao.figures.style import save

    figure = drag_figures.drag_ratios(
        points.cl, groups,
        {"n_crit 5, as computed": np.exp(columns["n_crit 5"]),
         "drag at the measured level": np.exp(columns["measured level"])},
    )  # fmt: skip
    save(figure, output / "section_drag.png")
    print(f"All points and the figure: {output}")


if __name__ == "__main__":
    main()
