"""How a propeller is modelled: its loads, its noise, and how finely both are resolved."""

from __future__ import annotations

import dataclasses
from typing import Literal, get_args

from propmdao.records.fidelity import Fidelity
from propmdao.records.quantities import Range, require_asked
from propmdao.records.wake_law import WakeLaw

#: How boundary layers are tripped, as NASA RP-1218 distinguishes them.
Trip = Literal["none", "light", "heavy"]
#: Planform of the blade's tip, as NASA RP-1218 distinguishes them.
Tip = Literal["rounded", "square"]
# Amplification of a wind tunnel full of turbulence and of the stillest air.
_N_CRIT = Range(0.1, 30.0)


@dataclasses.dataclass(frozen=True)
class Transition:
    """Transition of the boundary layers in the polars of the sections.

    Attributes
    ----------
    n_crit : float
        Critical amplification exponent of the e^n method. The catalogue's polars have 5, for a
        propeller's own turbulence lowers the 9 of a quiet wind tunnel. Polars of other exponents
        are made by NeuralFoil (extra ``polars``).

    Raises
    ------
    ValueError
        If no boundary layer has such an exponent.
    """

    n_crit: float = 5.0

    def __post_init__(self) -> None:
        """Refuse exponents that no boundary layer has."""
        _N_CRIT.require("n_crit", self.n_crit)


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
        Transition of the boundary layers in the sections' polars.
    elastic : ElasticModel or None
        Blade that twists and bends under its loads; None (default) is a rigid one.

    Raises
    ------
    ValueError
        If an elastic blade is to be loaded by inviscid flow.
    """

    viscous: bool = True
    stall_delay: bool = True
    wake: WakeLaw = dataclasses.field(default_factory=WakeLaw)
    transition: Transition = Transition()
    elastic: ElasticModel | None = None

    def __post_init__(self) -> None:
        """Refuse an elastic blade without the moments of its sections."""
        if self.elastic is not None and not self.viscous:
            raise ValueError(
                "an elastic blade needs the moments of its sections, which inviscid flow has not"
            )


@dataclasses.dataclass(frozen=True)
class SelfNoiseModel:
    """How broadband self-noise is computed.

    Attributes
    ----------
    trip : {"none", "light", "heavy"}
        Trip of the boundary layers in the noise model; it does not change the loads.
    tip : {"rounded", "square"}
        Planform of the blade's tip.

    Raises
    ------
    ValueError
        If trip or tip is another word.
    """

    trip: Trip = "none"
    tip: Tip = "rounded"

    def __post_init__(self) -> None:
        """Refuse words that the model does not know."""
        for name, known in (("trip", get_args(Trip)), ("tip", get_args(Tip))):
            value = getattr(self, name)
            if value not in known:
                raise ValueError(f"{name} must be one of {', '.join(known)}; it is {value!r}")


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
