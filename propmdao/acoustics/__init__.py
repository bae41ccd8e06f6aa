"""Tonal and broadband noise of propellers, its levels and its way to the observer.

What is used most stands here; the modules hold the rest: `broadband`, `time_levels`,
`perceived_noise`, `epnl`, `sound`.
"""

from propmdao.acoustics.bands import (
    bands_in_bins,
    third_octaves_of_spectrum,
    tones_in_bands,
    tones_in_bins,
)
from propmdao.acoustics.flyover import flyover_histories
from propmdao.acoustics.formulation1a import Tones, require_subsonic_tip, tones
from propmdao.acoustics.ground import (
    fixed_observers,
    flyover_track,
    ground_line,
    line_of_sight,
)
from propmdao.acoustics.levels import (
    a_weighting,
    energy_sum_db,
    level_db,
    level_dba,
    mean_square,
    oaspl_db,
    oaspl_dba,
    pressure_history,
    spl_db,
    third_octave,
)
from propmdao.acoustics.motion import rotation, translation
from propmdao.acoustics.moving_sources import AperiodicLoads, PeriodicLoads, compact_sections
from propmdao.acoustics.observers import (
    arc,
    circle,
    directions,
    grid,
    hemisphere,
    labels,
    point,
    require_outside_rotor,
    sphere,
)
from propmdao.acoustics.periodic import rotor_tones
from propmdao.acoustics.propagation import (
    Air,
    absorb,
    absorb_tones,
    absorption_db_per_m,
    mirrored,
    on_hard_ground,
    with_reflection,
)
from propmdao.acoustics.reception import Observers
from propmdao.acoustics.rotors import PressureHistory, Rotor, equally_spaced, rotor_histories
from propmdao.acoustics.spectrum import narrowband, third_octaves_of_record

__all__ = [
    "Air",
    "AperiodicLoads",
    "Observers",
    "PeriodicLoads",
    "PressureHistory",
    "Rotor",
    "Tones",
    "a_weighting",
    "absorb",
    "absorb_tones",
    "absorption_db_per_m",
    "arc",
    "bands_in_bins",
    "circle",
    "compact_sections",
    "directions",
    "energy_sum_db",
    "equally_spaced",
    "fixed_observers",
    "flyover_histories",
    "flyover_track",
    "grid",
    "ground_line",
    "hemisphere",
    "labels",
    "level_db",
    "level_dba",
    "line_of_sight",
    "mean_square",
    "mirrored",
    "narrowband",
    "oaspl_db",
    "oaspl_dba",
    "on_hard_ground",
    "point",
    "pressure_history",
    "require_outside_rotor",
    "require_subsonic_tip",
    "rotation",
    "rotor_histories",
    "rotor_tones",
    "spl_db",
    "sphere",
    "third_octave",
    "third_octaves_of_record",
    "third_octaves_of_spectrum",
    "tones",
    "tones_in_bands",
    "tones_in_bins",
    "translation",
    "with_reflection",
]
