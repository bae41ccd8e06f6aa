"""What an elastic blade is made of."""

from __future__ import annotations

from propmdao.propeller.description import MATERIAL, Propeller
from propmdao.records.models import ElasticModel
from propmdao.records.quantities import ASKED
from propmdao.structures.beam import Material

#: Young's over shear modulus where the latter is not given: Poisson's ratio 0.35, as of plastics.
YOUNG_OVER_SHEAR = 2.7


class ElasticError(ValueError):
    """The blade does not come to rest under its loads, or its material is not known."""


def material_of(propeller: Propeller, model: ElasticModel) -> Material:
    """Find what a propeller is made of.

    Parameters
    ----------
    propeller : Propeller
        The described blade, which may name its material.
    model : ElasticModel
        What is known better.

    Returns
    -------
    Material
        The material; the shear modulus, where neither has it, is Young's over `YOUNG_OVER_SHEAR`.

    Raises
    ------
    ElasticError
        If Young's modulus or the density is not known.
    """
    known = {}
    for name in MATERIAL:
        asked = getattr(model, name)
        known[name] = getattr(propeller, name) if asked is None else asked
        if known[name] is None and name != "shear_modulus":
            raise ElasticError(
                f"{propeller.name} has no {name} [{ASKED[name].unit}], which an elastic blade"
                f" needs: give it in the propeller file or by {ASKED[name].option}"
            )
    young, shear = known["youngs_modulus"], known["shear_modulus"]
    return Material(
        youngs_modulus=young,
        shear_modulus=young / YOUNG_OVER_SHEAR if shear is None else shear,
        density=known["material_density"],
    )
