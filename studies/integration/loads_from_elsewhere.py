"""Noise of a rotor whose blade loads come from another code: the acoustics of propmdao alone.

Give a table of one blade with the columns r_m, length_m, thrust_n_per_m, drag_n_per_m and, for
thickness noise, section_area_m2: elements along the blade, the force ON THE BLADE per length along
the axis and against the rotation. Blades may stand at any azimuths. The default table is a rotor
that has been computed by other codes, too.

Prints levels of the tones around the rotor, and writes a PSU-WOPWOP case of it if asked to.
"""

import argparse
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

import propmdao as pm
from propmdao.acoustics.kinematics.motion import translation
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.acoustics.levels.weighting import oaspl_dba
from propmdao.acoustics.sources.moving_sources import compact_sections
from propmdao.acoustics.sources.periodic import rotor_tones
from propmdao.acoustics.sources.rotors import Rotor
from propmdao.formats.wopwop.write_case import write_rotor_case
from propmdao.records.loads import PointLoads
from propmdao.records.units import RAD_PER_S

HERE = Path(__file__).parent
COLUMNS = ("r_m", "length_m", "thrust_n_per_m", "drag_n_per_m")
SOURCES = ("thickness", "loading")
N_TONES = 10  # of the blade passage, or multiples of the rotation for unequal blades


def read_blade(path: Path) -> dict[str, np.ndarray]:
    """Columns of the table."""
    try:
        rows = path.read_text(encoding="utf-8").splitlines()
        rows = [row for row in rows if row.strip() and not row.startswith("#")]
        table = np.genfromtxt(rows, delimiter=",", names=True, dtype=float)
    except (OSError, UnicodeDecodeError, ValueError) as error:
        raise SystemExit(f"{path}: not a table of loads: {error}") from None
    names = table.dtype.names or ()
    for column in COLUMNS:
        if column not in names:
            raise SystemExit(f"{path}: no column {column}; there are {', '.join(names) or 'none'}")
    blade = {name: np.atleast_1d(table[name]) for name in names}
    for name, values in blade.items():
        if not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values))[0]) + 1
            raise SystemExit(f"{path}: {name} must be a number in every row; row {row} has none")
    return blade


def make_rotor(blade: dict[str, np.ndarray], azimuths_deg: list[float], rpm: float) -> Rotor:
    """Forces on the fluid, which are the opposite of those on the blade, along a line on +x."""
    r, length, zero = blade["r_m"], blade["length_m"], 0 * blade["r_m"]
    position = np.stack([r, zero, zero], axis=-1)
    along, up = blade["drag_n_per_m"] * length, blade["thrust_n_per_m"] * length
    loads = PointLoads(jnp.asarray(position), jnp.asarray(np.stack([zero, along, -up], axis=-1)))
    area = blade.get("section_area_m2")
    panels = None if area is None else compact_sections(position, area * length)
    return Rotor(np.radians(azimuths_deg), rpm * RAD_PER_S, panels, loads)


def print_levels(
    rotor: Rotor, speed: float, air: pm.Air, distance: float, elevations_deg: list[float]
) -> None:
    """Levels at microphones that fly along, on an arc around the rotor."""
    places = pm.arc(distance, elevations_deg)
    tones = rotor_tones(rotor, (0, 0, speed), air, places, N_TONES)
    weighted = oaspl_dba(tones.frequency_hz, tones.total)
    table = Table(box=box.SIMPLE, pad_edge=False, collapse_padding=True)
    headings = (
        "elevation\ndeg",
        f"{float(tones.frequency_hz[0]):.1f} Hz\ndB",
        *(f"{name}\ndB" for name in SOURCES),
        "OASPL\ndB",
        "tones\ndBA",
    )
    for heading in headings:
        table.add_column(heading, justify="right")
    levels = (
        spl_db(tones.total)[:, 0],
        *(oaspl_db(tones.parts[name]) for name in SOURCES),
        oaspl_db(tones.total),
        weighted,
    )
    for row in zip(elevations_deg, *levels, strict=True):
        # what cancels on the axis leaves rounding
        table.add_row(
            f"{row[0]:g}", *(f"{x:.1f}" if x > -100 else "-" for x in map(float, row[1:]))
        )
    Console().print(table)


def main() -> None:
    """Read the table, print levels, write the case."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("table", nargs="?", type=Path, default=HERE / "loads_from_elsewhere.csv")
    parser.add_argument("--azimuths", type=float, nargs="+", default=[0.0, 180.0], metavar="DEG",
                        help="of the blades, default 0 180; unequal spacing is fine")  # fmt: skip
    parser.add_argument("--rpm", type=float, default=1400.0)
    parser.add_argument("--speed", type=float, default=0.0, help="axial flight [m/s], default 0")
    parser.add_argument("--rho", type=float, default=1.226, help="air density [kg/m3]")
    parser.add_argument("--sound-speed", type=float, default=340.0, help="[m/s]")
    parser.add_argument("--distance", type=float, default=30.48, help="of the microphones [m]")
    parser.add_argument("--elevations", type=float, nargs="+", default=[-90.0, -45.0, 0.0, 45.0],
                        metavar="DEG", help="from the rotor plane, negative below")  # fmt: skip
    parser.add_argument(
        "--wopwop", type=Path, metavar="FOLDER", help="write a PSU-WOPWOP case of the loads"
    )
    options = parser.parse_args()
    blade = read_blade(options.table)
    rotor = make_rotor(blade, options.azimuths, options.rpm)
    n_blades, length = len(options.azimuths), blade["length_m"]
    thrust = n_blades * np.sum(blade["thrust_n_per_m"] * length)
    torque = n_blades * np.sum(blade["drag_n_per_m"] * length * blade["r_m"])
    print(
        f"{n_blades} blades at {options.rpm:g} rpm: thrust {thrust:.4g} N, torque {torque:.4g} N m"
    )
    air = pm.Air(density=options.rho, sound_speed=options.sound_speed)
    try:
        print_levels(rotor, options.speed, air, options.distance, options.elevations)
        if options.wopwop is not None:
            velocity = np.array([0.0, 0.0, options.speed])
            places = pm.arc(options.distance, options.elevations)
            observers = Observers(jnp.asarray(places), jnp.asarray(velocity))
            times = np.arange(1024) * 60 / options.rpm / 1024
            flight = (translation(velocity=velocity),)
            write_rotor_case(options.wopwop, [rotor], [None], observers, times, air, flight)
    except ValueError as error:
        raise SystemExit(str(error)) from None


if __name__ == "__main__":
    main()
