"""The propeller as a user describes it, checked."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from propmdao.propeller import checks
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.checks import PropellerError
from propmdao.records.quantities import require_asked

if TYPE_CHECKING:
    from propmdao.records.models import Tip, Transition, Trip

FloatArray = npt.NDArray[np.float64]


#: Station arrays of a propeller, in the order of its file.
DISTRIBUTIONS = (
    "r_over_R",
    "c_over_R",
    "beta_deg",
    "thickness_over_chord",
    "sweep_over_R",
    "rake_over_R",
    "camber_over_chord",
    "area_over_c2",
    "trailing_edge_over_R",
    "trailing_edge_angle_deg",
)
#: Those of them that follow from the airfoils where they are not described.
_OF_AIRFOILS = (
    "thickness_over_chord",
    "camber_over_chord",
    "area_over_c2",
    "trailing_edge_over_R",
    "trailing_edge_angle_deg",
)
#: Those that may be one number for all stations.
_UNIFORM = ("sweep_over_R", "rake_over_R", "trailing_edge_over_R", "trailing_edge_angle_deg")
#: Planforms of a blade's tip, as `propmdao.records.models.Tip` has them.
TIPS = ("rounded", "square")
#: Trips of the boundary layers in broadband noise, as `propmdao.records.models.Trip` has them.
TRIPS = ("none", "light", "heavy")
#: Transition of the boundary layers, optional numbers of a propeller's file.
TRANSITION = ("n_crit", "trip_upper", "trip_lower")
#: Material of a propeller, none of which need be known.
MATERIAL = ("youngs_modulus", "shear_modulus", "material_density")


@dataclasses.dataclass(frozen=True, eq=False)
class Propeller:
    """Description of a propeller: its stations, sections and blades.

    A changed propeller is ``dataclasses.replace(propeller, beta_deg=propeller.beta_deg + 1)``. With
    other stations a sweep or a rake that is the same everywhere, as by default, stays that.

    Attributes
    ----------
    name : str
        Name of the propeller.
    diameter : float
        Diameter from tip to tip [m].
    n_blades : int
        Number of blades.
    r_over_R : (n_stations,) array
        Radii of the stations over the tip radius, rising; the last is the tip, 1.
    c_over_R, beta_deg : (n_stations,) arrays
        Chord over tip radius and blade angle from the rotor plane [deg].
    airfoils : sequence of (float, str)
        Pairs of r/R and airfoil (catalogue name, "naca4412" or a .dat path), rising in r/R;
        airfoils are blended linearly between, held constant beyond.
    thickness_over_chord : (n_stations,) array, optional
        Maximum thickness over chord; the airfoils' own by default.
    sweep_over_R : (n_stations,) array or number, optional
        Distance of the quarter chord aft (against rotation) of the radial line over the tip radius,
        0 by default.
    rake_over_R : (n_stations,) array or number, optional
        Distance of the quarter chord from the rotor plane toward thrust over the tip radius, 0 by
        default.
    camber_over_chord : (n_stations,) array, optional
        Maximum camber over chord, to which the camber line is scaled; the airfoils' own by default.
    area_over_c2 : (n_stations,) array, optional
        Cross-section of the solid blade over the chord squared, for elastic blades; by default that
        of the airfoils at their thickness. Roots that run into a hub have more.
    trailing_edge_over_R : (n_stations,) array or number, optional
        Thickness of the blunt trailing edge over the tip radius, for broadband noise; the airfoils'
        own by default, which where blades are printed or moulded is too sharp.
    trailing_edge_angle_deg : (n_stations,) array or number, optional
        Angle between the surfaces at the trailing edge [deg]; the airfoils' own by default.
    tip : {"rounded", "square"}, optional
        Planform of the tip, for broadband noise; None, the default, says nothing about it.
    trip : {"none", "light", "heavy"} or sequence of these, optional
        Trip of the boundary layers in broadband noise (it does not change the loads), everywhere or
        one for each station from root to tip; None, the default, says nothing about it. An analysis
        may ask for another one.
    source : str
        Origin of the numbers.
    n_crit, trip_upper, trip_lower : float, optional
        Transition of its boundary layers, as `propmdao.records.models.Transition` has it; None, the
        default, says nothing about it. An analysis may ask for another one.
    youngs_modulus, shear_modulus : float, optional
        Stiffness of the blade's material in tension and in shear [Pa], for elastic blades.
    material_density : float, optional
        Density of the blade's material [kg/m^3].

    Raises
    ------
    PropellerError
        If a value is missing, not finite, out of range or an airfoil is unknown.
    """

    name: str
    diameter: float
    n_blades: int
    r_over_R: FloatArray
    c_over_R: FloatArray
    beta_deg: FloatArray
    airfoils: Sequence[tuple[float, str]]
    thickness_over_chord: FloatArray | None = None
    sweep_over_R: FloatArray = dataclasses.field(default_factory=lambda: np.zeros(()))
    rake_over_R: FloatArray = dataclasses.field(default_factory=lambda: np.zeros(()))
    camber_over_chord: FloatArray | None = None
    area_over_c2: FloatArray | None = None
    trailing_edge_over_R: FloatArray | None = None
    trailing_edge_angle_deg: FloatArray | None = None
    tip: Tip | None = None
    trip: Trip | tuple[Trip, ...] | None = None
    source: str = ""
    n_crit: float | None = None
    trip_upper: float | None = None
    trip_lower: float | None = None
    youngs_modulus: float | None = None
    shear_modulus: float | None = None
    material_density: float | None = None

    def __post_init__(self) -> None:
        for key in ("name", "source"):
            if not isinstance(getattr(self, key), str):
                raise PropellerError(f"{key} must be text; it is {getattr(self, key)!r}")
        # The attribute of a frozen dataclass can only be set this way.
        object.__setattr__(self, "diameter", checks.number("diameter", self.diameter))
        require_asked("diameter", self.diameter, PropellerError)
        if not isinstance(self.n_blades, int | np.integer) or isinstance(self.n_blades, bool):
            raise PropellerError(f"n_blades must be a whole number; it is {self.n_blades!r}")
        require_asked("n_blades", self.n_blades, PropellerError)
        for key in (*TRANSITION, *MATERIAL):
            if (value := getattr(self, key)) is not None:
                object.__setattr__(self, key, checks.number(key, value))
                require_asked(key, value, PropellerError)

        r = checks.stations(self.r_over_R)
        object.__setattr__(self, "r_over_R", r)
        for key in DISTRIBUTIONS[1:]:
            value = getattr(self, key)
            if key in _OF_AIRFOILS and value is None:
                continue
            if key in _UNIFORM:
                value = _everywhere(key, value, r)
            object.__setattr__(self, key, checks.distribution(key, value, r))
        chord, beta, thickness = self.c_over_R, self.beta_deg, self.thickness_over_chord
        checks.require_within("c_over_R", checks.CHORD, chord, r)
        for key in ("sweep_over_R", "rake_over_R"):
            checks.require_within(key, checks.OFFSET, getattr(self, key), r)
        checks.require("beta_deg", "be within -90..90", np.abs(beta) <= 90.0, beta, r)
        if thickness is not None:
            checks.require_within("thickness_over_chord", checks.THICKNESS, thickness, r)
        if self.camber_over_chord is not None:
            checks.require_within("camber_over_chord", checks.CAMBER, self.camber_over_chord, r)
        if self.area_over_c2 is not None:
            checks.require_within("area_over_c2", checks.AREA, self.area_over_c2, r)
        for key, allowed in (
            ("trailing_edge_over_R", checks.EDGE),
            ("trailing_edge_angle_deg", checks.EDGE_ANGLE),
        ):
            if (value := getattr(self, key)) is not None:
                checks.require_within(key, allowed, value, r)
        if self.tip not in (None, *TIPS):
            raise PropellerError(f"tip must be one of {', '.join(TIPS)}; it is {self.tip!r}")
        if self.trip is not None:
            object.__setattr__(self, "trip", checks.words("trip", TRIPS, self.trip, r))
        object.__setattr__(self, "airfoils", checks.airfoil_pairs(self.airfoils))

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make arrays read-only again, which pickling forgets."""
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        self.__dict__.update(state)

    @property
    def transition(self) -> Transition:
        """Transition of the boundary layers as far as it is described."""
        from propmdao.records.models import Transition  # slow to import

        return Transition(**{key: getattr(self, key) for key in TRANSITION})

    def sections(self) -> tuple[FloatArray, FloatArray]:
        """Blend the airfoils to the stations, linearly in r/R.

        Returns
        -------
        camber, thickness : (n_stations, n_chord) arrays
            Camber line and full thickness over chord, on
            `airfoils.airfoil.CHORD_FRACTION`; both are those of the airfoils, not scaled to
            `thickness_over_chord` and `camber_over_chord`.
        """
        airfoils = [find_airfoil(name) for _, name in self.airfoils]
        positions = [position for position, _ in self.airfoils]
        weights = np.stack(
            [np.interp(self.r_over_R, positions, unit) for unit in np.eye(len(airfoils))], axis=1
        )
        camber = weights @ np.stack([airfoil.camber for airfoil in airfoils])
        return camber, weights @ np.stack([airfoil.thickness for airfoil in airfoils])


def _everywhere(key: str, value: Any, r: FloatArray) -> Any:
    """Values at the stations of what is one number, or was at a propeller's old stations."""
    if np.ndim(value) == 0:
        return np.full(r.size, checks.number(key, value))
    # Only a propeller's own arrays are read-only: a user's list of another length is a mistake.
    described = isinstance(value, np.ndarray) and not value.flags.writeable
    if described and value.size != r.size and np.all(value == value[0]):
        return np.full(r.size, value[0])
    return value
