"""A described blade made ready for its loads: all that no operating point changes."""

from __future__ import annotations

import dataclasses
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
from jax import Array

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.edge_layers.tables import SectionLayers
from propmdao.aerodynamics.sections.laws import ViscousSections, viscous_sections
from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.sources import polar_sources
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.aerodynamics.wakes.helical import WakeTransport, wake_transport
from propmdao.analysis.elastic.deflections import Solved
from propmdao.analysis.self_noise import section_layers
from propmdao.geometry.blade import Blade
from propmdao.geometry.meshes import MeshRadii, blade_meshes, mesh_radii
from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.records.models import Model
from propmdao.records.panels import Panels
from propmdao.records.states import OperatingPoint, RotorState
from propmdao.runtime.compilation import compiled


class HeldBlade(NamedTuple):
    """A propeller that is held in its shape, with its meshes and its sections.

    Attributes
    ----------
    blade : Blade
        Blade of the propeller.
    panels : Panels
        Closed surface of the blade.
    rotor : RotorGeometry
        Lattice of the blade, tip radius and number of blades.
    sections : ViscousSections or None
        Polars of the sections; None for inviscid flow.
    wake : WakeTransport
        Law of the wake, and the ages of its nodes in axial flight.
    n_azimuths : int
        Azimuths of a period at least.
    """

    blade: Blade
    panels: Panels
    rotor: RotorGeometry
    sections: ViscousSections | None
    wake: WakeTransport
    n_azimuths: int

    def case(self, point: OperatingPoint) -> RotorCase:
        """Case of an operating point, whose rotation speed is 0 for now."""
        return RotorCase(self.rotor, point.at(0.0), self.sections, self.wake, self.n_azimuths)

    def solved(self, case: RotorCase, loads: RotorLoads | TiltedLoads, state: RotorState) -> Solved:
        """The blade with its loads."""
        return Solved(self.blade, self.panels, case, loads, state)


@dataclasses.dataclass(frozen=True)
class ModelledBlade:
    """A described blade with its change, as a model sees it.

    Attributes
    ----------
    propeller : Propeller
        The described blade.
    model : Model
        How loads and noise are computed, completed.
    changed : Propeller
        The described blade with its change.
    radii : MeshRadii
        Interpolation to the radii of its meshes.
    polars : SectionPolars or None
        Polars of its sections; None in inviscid flow.
    sources : dict of str to str
        Where the polars of each airfoil come from.
    layers : SectionLayers or None
        Boundary layers of its sections, where broadband noise asks for them.
    """

    propeller: Propeller
    model: Model
    changed: Propeller
    radii: MeshRadii
    polars: SectionPolars | None
    sources: dict[str, str]
    layers: SectionLayers | None

    @classmethod
    def of(
        cls, propeller: Propeller, change: Change, model: Model, polars: SectionPolars | None = None
    ) -> ModelledBlade:
        """Make a blade ready.

        Parameters
        ----------
        propeller : Propeller
            The described blade.
        change : Change
            What is changed of it.
        model : Model
            How loads and noise are computed, completed.
        polars : SectionPolars, optional
            Polars by `polars_for`, for tables of one's own; by default the catalogue's.

        Returns
        -------
        ModelledBlade
            The blade.

        Raises
        ------
        ValueError
            If the changed blade is none, or a section has no polars.
        """
        changed, fidelity = change.applied_to(propeller), model.fidelity
        sources: dict[str, str] = {}
        if not model.loads.viscous:
            polars = None
        elif polars is None:
            transition, measured_drag = model.loads.transition, model.loads.measured_drag
            sources = polar_sources(changed, None, transition, measured_drag)
            polars = polars_for(changed, None, transition, measured_drag)
        else:
            sources = dict.fromkeys((name for _, name in changed.airfoils), "given")
        radii = mesh_radii(changed.r_over_R, fidelity.n_spanwise, fidelity.n_surface_span)
        layers = section_layers(changed, model)
        return cls(propeller, model, changed, radii, polars, sources, layers)

    def reshaped(self, propeller: Propeller) -> ModelledBlade:
        """Make another blade of the same stations and airfoils ready, with the tables at hand.

        Parameters
        ----------
        propeller : Propeller
            Blade of another shape, or with another number of blades.

        Returns
        -------
        ModelledBlade
            The blade; polars and boundary layers are those of the same airfoils.

        Raises
        ------
        ValueError
            If the stations or the airfoils are others.
        """
        same = np.array_equal(propeller.r_over_R, self.changed.r_over_R)
        if not same or propeller.airfoils != self.changed.airfoils:
            raise ValueError("a reshaped blade has the stations and airfoils that it had")
        return dataclasses.replace(self, propeller=propeller, changed=propeller)

    @cached_property
    def unloaded(self) -> HeldBlade:
        """The blade in the shape in which it is described."""
        return self._held(self.changed)

    def held(self, propeller: Propeller) -> HeldBlade:
        """Hold a propeller of the blade's sections in its shape.

        Parameters
        ----------
        propeller : Propeller
            The changed blade, or that as far as it gives.

        Returns
        -------
        HeldBlade
            The propeller with its meshes and sections.
        """
        return self.unloaded if propeller is self.changed else self._held(propeller)

    def _held(self, propeller: Propeller) -> HeldBlade:
        model, blade = self.model, Blade.from_propeller(propeller)
        fidelity = model.fidelity
        nodes, panels = _meshes(blade, self.radii, fidelity.n_chordwise, fidelity.n_contour)
        sections = None
        if self.polars is not None:
            delay = float(model.loads.stall_delay)
            sections = viscous_sections(self.polars, blade, self.radii.strips, delay)
        rotor = RotorGeometry(nodes, 0.5 * propeller.diameter, int(propeller.n_blades))
        wake = wake_transport(model.loads.wake, fidelity.wake)
        return HeldBlade(blade, panels, rotor, sections, wake, fidelity.n_azimuths)


@partial(compiled, static_argnames=("n_chordwise", "n_contour"))
def _meshes(
    blade: Blade, radii: MeshRadii, n_chordwise: int, n_contour: int
) -> tuple[Array, Panels]:
    """Lattice and closed surface of a blade."""
    meshes = blade_meshes(blade, radii, n_chordwise, n_contour)
    return meshes.lattice, meshes.panels
