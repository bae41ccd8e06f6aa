"""What the variables of components mean, as N2 diagrams and lists of variables show it."""

from __future__ import annotations

from propmdao.records.quantities import (
    ASKED,
    BROADBAND_LEVELS,
    HUB_LOADS,
    LEVELS,
    RESULTS,
)

#: Meanings by name: those of the table of quantities, then arrays of the blade and between
#: components. A thrust that is asked for is no thrust that is found.
MEANINGS = {
    quantity.variable: quantity.meaning
    for table in (ASKED, RESULTS, HUB_LOADS, LEVELS, BROADBAND_LEVELS)
    for quantity in table.values()
} | {
    "thrust_required": "thrust of all blades that the rotation speed is found for",
    "chord_over_R": "chord at the stations over tip radius",
    "beta": "blade angle at the stations",
    "sweep_over_R": "quarter chord aft, against the rotation, at the stations over tip radius",
    "rake_over_R": "quarter chord toward thrust at the stations over tip radius",
    "thickness_over_chord": "maximum thickness over chord at the stations",
    "camber_over_chord": "maximum camber over chord at the stations",
    "design_lift_coefficient": "lift coefficient at the ideal angle of attack at the stations",
    "lattice_nodes": "corner points of the vortex lattice of blade 1",
    "surface_nodes": "points of the section contours of blade 1",
    "section_polars": "polars of the sections in the middle of the strips",
    "section_thickness_over_chord": "maximum thickness over chord in the middle of the strips",
    "section_layers": "boundary layers at the trailing edge in the middle of the strips",
    "circulation": "circulation of the vortex rings of blade 1",
    "load_position": "places of the loads of blade 1",
    "load_force": "forces of blade 1 on the fluid",
    "section_speed": "speed through the air in the middle of the strips",
    "section_angle_of_attack": "angle of attack from the chord line in the middle of the strips",
    "section_lift_coefficient": "lift coefficient in the middle of the strips",
    "observer_position": "initial positions of the observers from the rotor centre",
    "mean_square_pressure": "mean square of the pressure of each harmonic",
    "frequency": "frequencies of the harmonics",
    "broadband_mean_square_pressure": "mean square of the broadband pressure in each third octave",
    "band_frequency": "middle frequencies of the third octaves",
}
