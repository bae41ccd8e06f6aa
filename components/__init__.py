"""OpenMDAO components, the group that connects them, and drivers."""

from propmdao.components.constrained_search import Generation
from propmdao.components.differential_evolution_driver import DifferentialEvolutionDriver
from propmdao.components.geometry_comp import GeometryComp

__all__ = ["DifferentialEvolutionDriver", "Generation", "GeometryComp"]
