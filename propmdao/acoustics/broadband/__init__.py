"""Broadband self-noise by Brooks, Pope and Marcolini: one airfoil or a whole rotor."""

from propmdao.acoustics.broadband.boundary_layer import BoundaryLayer, boundary_layer
from propmdao.acoustics.broadband.directivity import Radiation, radiation
from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import (
    SelfNoise,
    third_octave_centers,
    tip_noise,
    trailing_edge_noise,
)

__all__ = [
    "BoundaryLayer",
    "Radiation",
    "Section",
    "SelfNoise",
    "StripFlow",
    "boundary_layer",
    "radiation",
    "rotor_self_noise",
    "third_octave_centers",
    "tip_noise",
    "trailing_edge_noise",
]
