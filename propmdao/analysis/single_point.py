"""One call from a described propeller to its loads and its noise."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Any, Unpack

import jax
import numpy as np
from jax import Array

from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.acoustics.kinematics.limits import require_outside_rotor, require_subsonic_tip
from propmdao.acoustics.kinematics.rings import rings_of
from propmdao.acoustics.propagation.paths import bands_by_paths, sound_paths, tones_by_paths
from propmdao.acoustics.signals import Tones
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.acoustics.sources.periodic import rotor_tones
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.sections.polars.family import SectionPolars, warn_outside_sections
from propmdao.aerodynamics.sections.polars.table import warn_outside
from propmdao.aerodynamics.solutions import axial, blade_element, periodic
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.marched_loads import Progress
from propmdao.aerodynamics.solutions.period import tilted_elements
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.aerodynamics.trim import Solver, rotation_bounds, solve_for_thrust, trim
from propmdao.aerodynamics.wakes.edgewise import (
    edgewise_advance_ratio,
    is_slow,
    longer,
    warn_if_fast,
)
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.analysis.elastic.deflections import Solved, deflected
from propmdao.analysis.elastic.materials import material_of
from propmdao.analysis.elastic.modelled_blade import ModelledBlade
from propmdao.analysis.flights.marching import marched, require_marchable
from propmdao.analysis.request import Asked, Request
from propmdao.analysis.results import MECHANISMS, Analysis
from propmdao.analysis.self_noise import BANDS_HZ, flow_of, self_noise
from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.records.air import require_known_air
from propmdao.records.listening import Listening, Surroundings
from propmdao.records.models import Model
from propmdao.records.panels import Panels
from propmdao.records.states import OperatingPoint, RotorState
from propmdao.records.units import RAD_PER_S
from propmdao.records.wake_law import WakeGrid
from propmdao.runtime.compilation import compile_ahead
from propmdao.runtime.finite import require_finite

_Begin = Callable[[Any], None]


def analyze(
    propeller: Propeller,
    point: OperatingPoint | None = None,
    *,
    change: Change | None = None,
    model: Model | None = None,
    listening: Listening | None = None,
    polars: SectionPolars | None = None,
    progress: Progress | None = None,
    **asked: Unpack[Asked],
) -> Analysis:
    """Analyse a propeller at a rotation speed, or at the one that gives a thrust.

    ``analyze(propeller, rpm=4200, speed=8)`` is short for
    ``analyze(propeller, OperatingPoint(rpm=4200, speed=8))``: single values go into the record that
    holds them. A record that is given takes no single values.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    point : OperatingPoint, optional
        Rotation speed or thrust, flight speed, air.
    change : Change, optional
        What is changed of the described blade; by default nothing.
    model : Model, optional
        How loads and noise are computed.
    listening : Listening, optional
        Observers that fly along with the rotor, ground, absorption; by default nobody listens.
    polars : SectionPolars, optional
        Polars by `polars_for`, for tables of one's own; by default the catalogue's.
    progress : callable, optional
        Called after every step of a march in time, with a `MarchProgress`.
    **asked
        Single values: rpm, thrust [N], speed [m/s], incidence_deg, density [kg/m^3] and the rest of
        the air; turbulence_intensity [m/s], turbulence_length_scale [m]; twist_offset_deg,
        chord_factor, diameter, n_blades; viscous, blade_element, stall_delay, n_crit, trip_upper,
        trip_lower, measured_drag, elastic, youngs_modulus, shear_modulus [Pa], material_density
        [kg/m^3], unsteady, revolutions, average, timestep_deg, start, wake_motion, gust_speed
        [m/s], gust_shape, gust_start, gust_length, broadband, trip, layers, fidelity; observers,
        (n, 3) positions [m] as `propmdao.arc` makes them, surroundings.

    Returns
    -------
    Analysis
        Loads and noise, with all that was asked.

    Raises
    ------
    ValueError
        Bad input, in one line; `ElasticError` among them when a blade does not stand its loads or
        its material is not known, `TrimError` when the thrust is out of reach within
        `rotation_bounds`, and `NotFiniteError` when a result would be no number: nothing could be
        done with it, while one that has not converged is there to be looked at.
    """
    records = {"point": point, "change": change, "model": model, "listening": listening}
    request = Request.of(records, **asked).completed(propeller)
    require_analysable(propeller, request)
    modelled = ModelledBlade.of(propeller, request.change, request.model, polars)
    return analysis_of(modelled, request, progress=progress)


def require_analysable(propeller: Propeller, request: Request) -> None:
    """Refuse what is known to have no analysis, before the work.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    request : Request
        What is asked, completed.

    Raises
    ------
    ValueError
        In one line.
    """
    point, listening, loads = request.point, request.listening, request.model.loads
    changed = request.change.applied_to(propeller)
    require_outside_rotor(listening.observers, 0.5 * changed.diameter)
    if listening.surroundings.absorption:
        require_known_air(point.air)
    if loads.unsteady is not None:
        require_marchable(point)
    if loads.elastic is not None:
        point.require_axial("an elastic blade")
        material_of(changed, loads.elastic)


def analysis_of(
    modelled: ModelledBlade,
    request: Request,
    solved: Solved | None = None,
    progress: Progress | None = None,
) -> Analysis:
    """Loads and noise of a blade that is ready, at an operating point.

    Parameters
    ----------
    modelled : ModelledBlade
        The blade as the request changes and models it.
    request : Request
        What is asked, completed; `require_analysable` has seen it.
    solved : Solved, optional
        Loads that are known, of a batch; by default they are solved for.
    progress : callable, optional
        Called after every step of a march in time.

    Returns
    -------
    Analysis
        Loads and noise.

    Raises
    ------
    ValueError
        Where `analyze` raises it.
    """
    point, model, listening = request.point, request.model, request.listening
    fidelity, elastic = model.fidelity, model.loads.elastic
    paths = sound_paths(listening.observers, listening.surroundings, point.incidence_deg)
    points = paths.reshape(-1, 3)

    def held(propeller: Propeller) -> Solved:
        """Loads of a propeller that is held in its shape."""
        shape = modelled.held(propeller)
        case = shape.case(point)
        begin = partial(_begin_tones, shape.panels, case, points, fidelity.n_harmonics)
        return shape.solved(case, *_loads(case, request, progress, begin))

    deflection = None
    if elastic is not None:
        deflection, solved = deflected(
            modelled.changed, material_of(modelled.changed, elastic), held
        )
    elif solved is None:
        solved = held(modelled.changed)
    blade, panels, case, loads, state = solved
    if modelled.polars is not None:
        warn_outside_sections(modelled.polars, blade, modelled.changed.r_over_R)
        _warn_outside_polars(case, loads)

    sound = _tones(panels, loads, case.rotor.n_blades, state, points, fidelity.n_harmonics)
    noise = None
    if (broadband := model.noise.broadband) is not None:
        strips, layers = modelled.radii.strips, modelled.layers
        flow = flow_of(loads, blade, strips, layers, point.air, broadband)
        rings = rings_of(points)
        is_steady = flow.section.speed.ndim == 1
        noise = self_noise(
            flow,
            case.rotor.n_blades,
            state,
            rings.position if is_steady else points,
            broadband,
            turbulence=point.turbulent,
        )
        if is_steady:
            noise = jax.tree.map(lambda bands: np.asarray(bands)[rings.ring], noise)
        noise = _noise_by_paths(noise, paths, state, listening.surroundings)
    diameter = modelled.changed.diameter
    analysis = Analysis(
        propeller=modelled.propeller,
        request=request,
        rpm=float(state.rotation_speed) / RAD_PER_S if point.rpm is None else float(point.rpm),
        loads=loads,
        coefficients=coefficients(loads.thrust, loads.torque, state, diameter),
        tones=tones_by_paths(sound, paths, state, listening.surroundings),
        broadband=noise,
        polars=modelled.sources,
        deflection=deflection,
    )
    _require_numbers(analysis)
    return analysis


def _loads(
    case: RotorCase, request: Request, progress: Progress | None, begin: _Begin
) -> tuple[Any, RotorState]:
    """Loads at the operating point by the model that is asked for, and the rotor's state there."""
    point, model = request.point, request.model
    if model.loads.unsteady is not None:
        return marched(case, point, model, progress)
    if point.incidence_deg == 0.0:
        return _solve(blade_element if model.loads.blade_element else axial, case, point, begin)
    if not model.loads.blade_element:
        return _tilted(case, point, model)
    tilted, state = _solve(tilted_elements, case, point)
    warn_if_fast(edgewise_advance_ratio(state, float(case.rotor.radius)), stacklevel=4)
    return tilted, state


def _solve(
    solver: Solver, case: RotorCase, point: OperatingPoint, begin: _Begin = lambda _: None
) -> tuple[Any, RotorState]:
    """Loads at the operating point, and the state of the rotor there.

    While the loads are compiled, `begin` is called with the shapes of what they will be.
    """
    radius, speed = float(case.rotor.radius), float(point.speed)
    if point.thrust is not None:
        bounds, thrust = rotation_bounds(radius, speed), float(point.thrust)
        compile_ahead(
            solve_for_thrust, solver, case, thrust, bounds, then=lambda found: begin(found.loads)
        )
        rotation_speed, loads = trim(solver, case, thrust, bounds)
        return loads, point.at(rotation_speed)
    assert point.rotation_speed is not None
    state = point.at(point.rotation_speed)
    require_subsonic_tip(radius, state)
    case = case.turning(point.rotation_speed)
    compile_ahead(solver.solve, case, then=begin)
    return solver.solve(case), state


def _tilted(case: RotorCase, point: OperatingPoint, model: Model) -> tuple[TiltedLoads, RotorState]:
    """Loads at an incidence; in slow flight, where the wake stays near, with a longer one."""
    grid, radius = model.fidelity.period_wake, float(case.rotor.radius)

    def solved(grid: WakeGrid) -> tuple[TiltedLoads, RotorState, float]:
        wake = wake_transport(model.loads.wake, grid)
        loads, state = _solve(periodic, dataclasses.replace(case, wake=wake), point)
        return loads, state, edgewise_advance_ratio(state, radius)

    known = point.rotation_speed
    slow = known is not None and is_slow(edgewise_advance_ratio(point.at(known), radius))
    loads, state, ratio = solved(longer(grid) if slow else grid)
    if is_slow(ratio) and not slow:
        loads, state, ratio = solved(longer(grid))
    warn_if_fast(ratio, stacklevel=4)
    return loads, state


def _begin_tones(
    panels: Panels, case: RotorCase, points: np.ndarray, n_harmonics: int, loads: Any
) -> None:
    """Begin to compile the tones of loads whose shapes are known: what `_tones` will call."""
    if isinstance(loads, RotorLoads) and len(points):
        ends, state = rings_of(points).position, case.state
        compile_ahead(
            tones, panels, loads.point_loads, case.rotor.n_blades, state, ends, n_harmonics
        )


def _tones(
    panels: Panels,
    loads: RotorLoads | TiltedLoads,
    n_blades: int,
    state: RotorState,
    points: np.ndarray,
    n_harmonics: int,
) -> Tones:
    """Tones at the ends of all ways to the observers."""
    if isinstance(loads, RotorLoads):
        # A steady rotor's field turns with it: each circle of observers is worked out once.
        rings = rings_of(points)
        sound = tones(panels, loads.point_loads, n_blades, state, rings.position, n_harmonics)
        order = n_blades * np.arange(1, n_harmonics + 1)
        turned = np.exp(1j * rings.azimuth[:, None] * order)
        return sound.each(lambda amplitude: np.asarray(amplitude)[rings.ring] * turned)
    rotor = Rotor(equally_spaced(n_blades), float(state.rotation_speed), panels, loads.point_loads)
    return rotor_tones(rotor, state.velocity, state.air, points, n_harmonics)


def _noise_by_paths(
    noise: SelfNoise, paths: np.ndarray, state: RotorState, surroundings: Surroundings
) -> SelfNoise:
    """Broadband noise at the observers, from that at the ends of all ways to them."""
    if surroundings == Surroundings():
        return noise
    return jax.tree.map(
        lambda power: bands_by_paths(power, BANDS_HZ, paths, state, surroundings), noise
    )


def _require_numbers(analysis: Analysis) -> None:
    """Refuse results that are no numbers, what others follow from first."""
    where = f", at {analysis.rpm:g} rpm and {analysis.point.speed:g} m/s"
    loads, noise = analysis.loads, analysis.broadband
    strips = [f"r/R {r:.2f}" for r in np.asarray(loads.strips.r_over_R)]
    azimuths: tuple[str, ...] = ("azimuth",) if isinstance(loads, TiltedLoads) else ()
    of_sections = {
        "section_speed": loads.sections.relative_speed,
        "section_lift_coefficient": loads.sections.lift_coefficient,
    }
    by_strip = {"strip_thrust": loads.strip_thrust, "strip_torque": loads.strip_torque}
    for name, values in of_sections.items():
        require_finite(name, values, *azimuths, strips, where=where)
    for name, values in by_strip.items():
        require_finite(name, values, strips, where=where)
    for record in (loads, analysis.coefficients):
        for field in dataclasses.fields(record):
            if isinstance(value := getattr(record, field.name), Array | np.ndarray | np.floating):
                require_finite(field.name, value, where=where)
    for name, values in {
        "load_position": loads.point_loads.position,
        "load_force": loads.point_loads.force,
    }.items():
        require_finite(name, values, *azimuths[: values.ndim - 2], "load", where=where)
    for name, pressure in analysis.tones.parts.items():
        require_finite(f"{name} noise", pressure, "observer", "harmonic", where=where)
    bands = [f"{frequency:g} Hz" for frequency in BANDS_HZ]
    for name in () if noise is None else MECHANISMS:
        require_finite(f"broadband {name}", getattr(noise, name), "observer", bands, where=where)


def _warn_outside_polars(case: RotorCase, loads: RotorLoads | TiltedLoads) -> None:
    """Tell of strips whose Reynolds or Mach number the polars do not reach."""
    assert case.sections is not None
    strips, air = loads.strips, case.state.air
    # At an incidence the mean over the turn: on the retreating side the air may stand still.
    speed = np.atleast_2d(np.asarray(loads.sections.relative_speed)).mean(axis=0)
    if np.all(speed > 0.0):
        kinematic_viscosity = float(air.dynamic_viscosity) / float(air.density)
        reynolds = speed * np.asarray(strips.chord) / kinematic_viscosity
        mach = speed / float(air.sound_speed)
        warn_outside(case.sections.polars, reynolds, strips.r_over_R, mach)
