"""How a propeller is modelled: its loads, its noise, and how finely both are resolved."""

from __future__ import annotations

import dataclasses
from typing import Literal, get_args

from propmdao.records.fidelity import Fidelity, Marching
from propmdao.records.quantities import require_asked
from propmdao.records.wake_law import WakeLaw

#: How boundary layers are tripped, as NASA RP-1218 distinguishes them.
Trip = Literal["none", "light", "heavy"]
#: Boundary layers at the trailing edge: of the blade's own sections, or the report's fits.
Layers = Literal["sections", "bpm"]
#: Planform of the blade's tip, as NASA RP-1218 distinguishes them.
Tip = Literal["rounded", "square"]
#: x/c of a trip that is none: transition is left to the boundary layer.
FREE = 1.0
#: Trips up to this x/c on both sides make a tripped blade: boundary layers are turbulent on most of
#: it. NASA RP-1218 tripped its airfoils by grit from the leading edge to 0.2 c.
_TRIPPED = 0.5


@dataclasses.dataclass(frozen=True)
class Transition:
    """Transition of the boundary layers to turbulent flow, of the loads and of the noise.

    A field that is None is left to the propeller's description, and where that says nothing to the
    last of these: n_crit 5, no trips (`completed`).

    Attributes
    ----------
    n_crit : float or None
        Critical amplification exponent of the e^n method: 9 in a quiet wind tunnel; 5 for a
        propeller that stirs its own air.
    trip_upper, trip_lower : float or None
        x/c at which the upper (suction) and the lower side are tripped: forced transition, where
        the boundary layer is not turbulent before; 1 leaves it free. The trip itself has no drag.

    Raises
    ------
    ValueError
        If no boundary layer has such an exponent, or a trip lies outside the chord.
    """

    n_crit: float | None = None
    trip_upper: float | None = None
    trip_lower: float | None = None

    def __post_init__(self) -> None:
        """Refuse exponents that no boundary layer has and trips off the section."""
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is not None:
                require_asked(field.name, value)

    def completed(self, described: Transition | None = None) -> Transition:
        """Fill in what was left open.

        Parameters
        ----------
        described : Transition, optional
            Transition of the propeller's description, which fills before the defaults do.

        Returns
        -------
        Transition
            Transition without None.
        """
        fillers = (self, described or Transition(), Transition(5.0, FREE, FREE))
        values = {
            field.name: next(
                float(value)
                for filler in fillers
                if (value := getattr(filler, field.name)) is not None
            )
            for field in dataclasses.fields(self)
        }
        return Transition(**values)

    @property
    def free(self) -> bool:
        """Whether neither side is tripped."""
        return self.trip_upper == FREE and self.trip_lower == FREE

    @property
    def upside_down(self) -> Transition:
        """Transition of the section turned over: its trips change sides."""
        return Transition(self.n_crit, self.trip_lower, self.trip_upper)

    @property
    def trip_in_noise(self) -> Trip:
        """Trip that the broadband noise has of itself: light where both sides are tripped.

        Forced transition adds no thickness to the boundary layer, which is the light trip of NASA
        RP-1218; its heavy one is grit, which does.
        """
        tripped = all(
            place is not None and place <= _TRIPPED for place in (self.trip_upper, self.trip_lower)
        )
        return "light" if tripped else "none"

    def __str__(self) -> str:
        """Describe it in some words, completed: n_crit, and trips where there are any."""
        n_crit, *trips = dataclasses.astuple(self.completed())
        if trips == [FREE, FREE]:
            return f"n_crit {n_crit:g}"
        upper, lower = ("free" if place == FREE else f"{place:g}" for place in trips)
        return f"n_crit {n_crit:g}, trips at x/c {upper} (upper) and {lower} (lower)"


@dataclasses.dataclass(frozen=True)
class ElasticModel:
    """Material of a blade that gives under its loads, where it is not that of the propeller's file.

    Attributes
    ----------
    youngs_modulus, shear_modulus : float or None
        Stiffness in tension and in shear [Pa]; None: the propeller's.
    material_density : float or None
        Mass per volume [kg/m^3]; None: the propeller's.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    youngs_modulus: float | None = None
    shear_modulus: float | None = None
    material_density: float | None = None

    def __post_init__(self) -> None:
        """Refuse what no material has."""
        for field in dataclasses.fields(self):
            if (value := getattr(self, field.name)) is not None:
                require_asked(field.name, value)


@dataclasses.dataclass(frozen=True)
class LoadModel:
    """How the loads are computed.

    Attributes
    ----------
    viscous : bool
        Whether the lattice is held to the polars of the sections; False is inviscid flow.
    stall_delay : bool
        Whether rotation delays the stall of the sections (Du and Selig).
    wake : WakeLaw
        Law by which the prescribed wake moves.
    transition : Transition
        Transition of the boundary layers in the sections' polars; a trip of both sides trips the
        broadband noise, too.
    measured_drag : bool
        Whether the drag of the catalogue's and of NeuralFoil's polars is brought to the level that
        wind tunnels measure at equal lift; False leaves it as computed.
    elastic : ElasticModel or None
        Blade that twists and bends under its loads; None (default) is a rigid one.
    unsteady : Marching or None
        March in time; None (default) solves for the flow that repeats.
    blade_element : bool
        Whether annuli of momentum take the place of the lattice: much faster, less accurate.

    Raises
    ------
    ValueError
        If an elastic blade is to be loaded by inviscid flow, or marched in time, or blade elements
        are to be marched.
    """

    viscous: bool = True
    stall_delay: bool = True
    wake: WakeLaw = dataclasses.field(default_factory=WakeLaw)
    transition: Transition = Transition()
    measured_drag: bool = True
    elastic: ElasticModel | None = None
    unsteady: Marching | None = None
    blade_element: bool = False

    def __post_init__(self) -> None:
        """Refuse an elastic blade without the moments of its sections, and marches without wake."""
        if self.blade_element and self.unsteady is not None:
            raise ValueError("blade elements have no wake to march: leave out unsteady")
        if self.elastic is not None and self.unsteady is not None:
            raise ValueError("an elastic blade is known in steady flow alone: leave out unsteady")
        if self.elastic is not None and not self.viscous:
            raise ValueError(
                "an elastic blade needs the moments of its sections, which inviscid flow has not"
            )


@dataclasses.dataclass(frozen=True)
class SelfNoiseModel:
    """How broadband self-noise is computed.

    Attributes
    ----------
    trip : {"none", "light", "heavy"}, tuple of these, or None
        Trip of the boundary layers in the noise model, everywhere or at the propeller's stations;
        it does not change the loads. None leaves it to the propeller's description, and where that
        says nothing to the transition of the loads (`completed`).
    tip : {"rounded", "square"}
        Planform of the blade's tip. "rounded" leaves it to the propeller's description.
    layers : {"sections", "bpm"}
        Boundary layers at the trailing edge: those of the sections by the polar model, or the fits
        of NASA RP-1218 to a NACA 0012.

    Raises
    ------
    ValueError
        If one of them is another word.
    """

    trip: Trip | tuple[Trip, ...] | None = None
    tip: Tip = "rounded"
    layers: Layers = "sections"

    def __post_init__(self) -> None:
        """Refuse words that the model does not know."""
        trips = self.trip if isinstance(self.trip, tuple) else (self.trip or "none",)
        asked = [("trip", trip, Trip) for trip in trips]
        for name, value, words in (*asked, ("tip", self.tip, Tip), ("layers", self.layers, Layers)):
            known = get_args(words)
            if value not in known:
                raise ValueError(f"{name} must be one of {', '.join(known)}; it is {value!r}")

    def trips(self, n_stations: int) -> tuple[Trip, ...]:
        """Trip at each station of a propeller.

        Parameters
        ----------
        n_stations : int
            Number of its stations.

        Returns
        -------
        (n_stations,) tuple of {"none", "light", "heavy"}
            Trips from root to tip.

        Raises
        ------
        ValueError
            If the model has trips at another number of stations.
        """
        if not isinstance(self.trip, tuple):
            return (self.trip or "none",) * n_stations
        if len(self.trip) != n_stations:
            raise ValueError(f"trip has {len(self.trip)} values for {n_stations} stations")
        return self.trip

    def completed(
        self, transition: Transition, tip: Tip | None, trip: Trip | tuple[Trip, ...] | None
    ) -> SelfNoiseModel:
        """Fill in what is left to the loads and to the propeller.

        Parameters
        ----------
        transition : Transition
            Transition of the loads, completed.
        tip : {"rounded", "square"} or None
            Tip of the propeller's description; None says nothing about it.
        trip : {"none", "light", "heavy"}, tuple of these, or None
            Trip of the propeller's description, everywhere or at its stations; None says nothing
            about it.

        Returns
        -------
        SelfNoiseModel
            Model without a None. Where nothing is said, its fits of boundary layers are tripped
            where the loads are; layers of the sections are at the transition of the loads,
            whatever that is.
        """
        trip = self.trip or trip or (transition.trip_in_noise if self.layers == "bpm" else "none")
        if isinstance(trip, tuple) and len(set(trip)) == 1:
            trip = trip[0]
        rounded = self.tip == "rounded"
        return dataclasses.replace(self, trip=trip, tip=(tip or self.tip) if rounded else self.tip)


@dataclasses.dataclass(frozen=True)
class NoiseModel:
    """Which noise is computed beside the tones.

    Attributes
    ----------
    broadband : SelfNoiseModel or None
        Broadband self-noise; None (default) leaves it out.
    """

    broadband: SelfNoiseModel | None = None


@dataclasses.dataclass(frozen=True)
class Model:
    """How a propeller is modelled; hashable, fixed at compile time.

    Attributes
    ----------
    loads : LoadModel
        Model of the loads.
    noise : NoiseModel
        Model of the noise that is computed beside the tones.
    fidelity : Fidelity
        Resolution of blade, wake and sound.
    """

    loads: LoadModel = dataclasses.field(default_factory=LoadModel)
    noise: NoiseModel = NoiseModel()
    fidelity: Fidelity = Fidelity()

    def completed(
        self, described: Transition, tip: Tip | None, trip: Trip | tuple[Trip, ...] | None
    ) -> Model:
        """Fill in what the model leaves to the propeller.

        Parameters
        ----------
        described : Transition
            Transition of the propeller's description.
        tip : {"rounded", "square"} or None
            Tip of the propeller's description; None says nothing about it.
        trip : {"none", "light", "heavy"}, tuple of these, or None
            Trip of the propeller's description in broadband noise; None says nothing about it.

        Returns
        -------
        Model
            Model whose transition has no None, and whose broadband noise follows it.
        """
        transition, noise = self.loads.transition.completed(described), self.noise
        if (broadband := noise.broadband) is not None:
            noise = dataclasses.replace(noise, broadband=broadband.completed(transition, tip, trip))
        loads = dataclasses.replace(self.loads, transition=transition)
        return dataclasses.replace(self, loads=loads, noise=noise)
