"""OpenMDAO components, the group that connects them, and drivers."""

from propmdao.components.acoustics_comp import AcousticsComp
from propmdao.components.broadband_comp import BroadbandComp
from propmdao.components.designs.problem_in_words import design_problem, designed_blade
from propmdao.components.drivers.differential_evolution_driver import DifferentialEvolutionDriver
from propmdao.components.drivers.evolution.constrained_search import Generation
from propmdao.components.drivers.gradient_search import run_slsqp
from propmdao.components.drivers.sweep_driver import SweepDriver
from propmdao.components.geometry_comp import GeometryComp
from propmdao.components.loads.aerodynamics_comp import AerodynamicsComp
from propmdao.components.loads.marched_aerodynamics_comp import MarchedAerodynamicsComp
from propmdao.components.loads.rotation_speed_comp import RotationSpeedComp
from propmdao.components.loads.trimmed_aerodynamics_comp import TrimmedAerodynamicsComp
from propmdao.components.motor_comp import MotorComp
from propmdao.components.noise_objective_comp import NoiseObjectiveComp
from propmdao.components.propeller_group import PropellerGroup

__all__ = [
    "AcousticsComp",
    "AerodynamicsComp",
    "BroadbandComp",
    "DifferentialEvolutionDriver",
    "Generation",
    "GeometryComp",
    "MarchedAerodynamicsComp",
    "MotorComp",
    "NoiseObjectiveComp",
    "PropellerGroup",
    "RotationSpeedComp",
    "SweepDriver",
    "TrimmedAerodynamicsComp",
    "design_problem",
    "designed_blade",
    "run_slsqp",
]
