"""Both meshes of a blade from one set of radii."""

from __future__ import annotations

import jax
import numpy as np

from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_nodes, lattice_span, strip_radii
from propmdao.geometry.meshes import blade_meshes, mesh_radii, propeller_surface
from propmdao.geometry.surface import surface_nodes, surface_panels, surface_span
from propmdao.propeller.description import Propeller


def test_radii_are_those_of_the_lattice_its_strips_and_the_surface(twisted: Propeller) -> None:
    radii = mesh_radii(twisted.r_over_R, 6, 5)
    np.testing.assert_array_equal(radii.lattice.r_over_R, lattice_span(0.2, 6))
    np.testing.assert_array_equal(radii.strips.r_over_R, strip_radii(0.2, 6))
    np.testing.assert_array_equal(radii.surface.r_over_R, surface_span(0.2, 5))


def test_meshes_are_the_lattice_and_the_surface_of_the_blade(twisted: Propeller) -> None:
    blade, radii = Blade.from_propeller(twisted), mesh_radii(twisted.r_over_R, 6, 5)
    meshes = blade_meshes(blade, radii, 4, 9)
    surface = surface_nodes(blade, radii.surface, 9)
    np.testing.assert_array_equal(meshes.lattice, lattice_nodes(blade, radii.lattice, 4))
    np.testing.assert_array_equal(meshes.surface, surface)
    np.testing.assert_array_equal(meshes.panels.center, surface_panels(surface).center)
    np.testing.assert_array_equal(propeller_surface(twisted, 9, 5), surface)


def test_meshes_pass_through_jit(twisted: Propeller) -> None:
    blade, radii = Blade.from_propeller(twisted), mesh_radii(twisted.r_over_R, 6, 5)
    compiled = jax.jit(blade_meshes, static_argnums=(2, 3))(blade, radii, 4, 9)
    for name, plain in blade_meshes(blade, radii, 4, 9)._asdict().items():
        np.testing.assert_allclose(getattr(compiled, name), plain, atol=1e-16)
