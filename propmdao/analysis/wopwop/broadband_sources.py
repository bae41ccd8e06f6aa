"""Broadband noise of PSU-WOPWOP cases: of blade sections that move, and of rotors by Pegg."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.broadband.moving_edges import MovingEdges, moving_self_noise
from propmdao.acoustics.broadband.pegg import LoadedRotor, pegg_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import SelfNoise, third_octave_centers
from propmdao.acoustics.kinematics.motion import Motion, place, poses
from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.geometry_file import read_geometry
from propmdao.formats.wopwop.loading_file import read_loading
from propmdao.formats.wopwop.namelists.broadband_groups import BpmNoise, PeggNoise
from propmdao.formats.wopwop.namelists.case_records import BroadbandContainer, Case, ObserverGrid
from propmdao.formats.wopwop.sources import is_line, key_offset_in_time
from propmdao.records.air import Air

Array = NDArray[np.float64]

#: Mid-band frequencies of the third octaves [Hz].
BANDS_HZ = third_octave_centers(50.0, 20e3)
#: Parts of the noise, by name: mechanisms of sections, and whole rotors.
PARTS = tuple(
    field.name for field in dataclasses.fields(SelfNoise) if field.name != "inflow_turbulence"
) + ("pegg",)
_AZIMUTHS = 48  # of a turn: observers of cases are often in the plane, where 24 are too few
_ROUNDS, _SAME_TIME = 200, 1e-9  # of the search for the time of emission [s]


class LineBlade(NamedTuple):
    """Sections of a blade in its own frame.

    Attributes
    ----------
    motion : Motion
        Motion of the blade.
    nodes, normal : (n, 3) arrays
        Quarter-chord points of the sections [m], and unit vectors normal to their chords.
    offset : float
        Offset of its data that are periodic [s].
    """

    motion: Motion
    nodes: Array
    normal: Array
    offset: float


def broadband_noise(case: Case, grid: ObserverGrid) -> dict[str, Array]:
    """Third octaves of a case's broadband noise in each segment of the observers' record.

    Parameters
    ----------
    case : Case
        The case.
    grid : ObserverGrid
        Observers of the case.

    Returns
    -------
    dict of (n_observers, n_segments, n_bands) arrays
        Mean squares of those of `PARTS` that the case has, without absorption [Pa^2]. A segment has
        the noise of the turn that is heard in its middle.

    Raises
    ------
    WopwopFileError
        If a container lacks what the noise needs, in one line.
    """
    there, middles = _hearing(grid)
    parts: dict[str, Array] = {}
    for container in case.broadband:
        noise = container.noise
        emitted = emission_times(container.motion, there, middles, case.air)
        if isinstance(noise, PeggNoise):
            spectra = {"pegg": _pegg(container, noise, case.air, there, emitted)}
        else:
            spectra = _sections(container, noise, case.air, grid, emitted)
        for name, bands in spectra.items():
            parts[name] = parts.get(name, 0.0) + bands
    low, high = grid.band_hz
    inside = (BANDS_HZ >= low) & (BANDS_HZ <= high)
    return {name: np.where(inside, part, 0.0) for name, part in parts.items()}


def distances(case: Case, grid: ObserverGrid) -> Array:
    """Ways of the sound that observers hear in the middle of each segment.

    Parameters
    ----------
    case : Case
        The case.
    grid : ObserverGrid
        Observers of the case.

    Returns
    -------
    (n_observers, n_segments) array
        Mean over the containers that sound, each from the origin of its frame [m].
    """
    motions = [container.motion for container in case.containers]
    motions += [container.motion for container in case.broadband]
    motions = motions or [()]  # of a case without sources, from the ground's origin
    there, middles = _hearing(grid)
    emitted = [emission_times(motion, there, middles, case.air) for motion in motions]
    return float(case.air.sound_speed) * (middles - np.mean(emitted, axis=0))


def _hearing(grid: ObserverGrid) -> tuple[Array, Array]:
    """Where observers are in the middle of segments, (n_observers, n_segments, 3), and when."""
    middles = grid.segment_starts + 0.5 * grid.segment
    return grid.position[:, None] + grid.velocity * middles[:, None], middles


def emission_times(motion: Motion, observers: Array, times: Array, air: Air) -> Array:
    """Times at which the origin of a frame, slower than sound, emits what observers hear.

    Parameters
    ----------
    motion : Motion
        Motion of the frame.
    observers : (..., n, 3) array
        Where the observers are when they hear it [m].
    times : (n,) array
        When they hear it [s].
    air : Air
        The air.

    Returns
    -------
    (..., n) array
        Source times [s].
    """
    emitted = np.broadcast_to(times, observers.shape[:-1])
    for _ in range(_ROUNDS):
        before = emitted
        origin = poses(motion, before.ravel()).origin.reshape(observers.shape)
        distance = np.linalg.norm(observers - origin, axis=-1)
        emitted = times - distance / float(air.sound_speed)
        if np.abs(emitted - before).max() < _SAME_TIME:
            break
    return emitted


def _sections(
    container: BroadbandContainer, noise: BpmNoise, air: Air, grid: ObserverGrid, emitted: Array
) -> dict[str, Array]:
    """Mechanisms of all blades, each (n_observers, n_segments, n_bands)."""
    wanted = {
        "pressure_side": noise.turbulent_edge,
        "suction_side": noise.turbulent_edge,
        "separation": noise.turbulent_edge,
        "laminar_shedding": noise.laminar_shedding,
        "bluntness": noise.bluntness,
        "tip": noise.tip_vortex,
    }
    shape = (*emitted.shape, BANDS_HZ.size)
    parts = {name: np.zeros(shape) for name, is_heard in wanted.items() if is_heard}
    velocity, bands = jnp.asarray(grid.velocity), jnp.asarray(BANDS_HZ)
    for blade in line_blades(container, noise):
        for place_there in np.ndindex(emitted.shape):
            mechanisms = moving_self_noise(
                moving_edges(container, noise, blade, float(emitted[place_there])),
                jnp.asarray(grid.position[place_there[0]]),
                velocity,
                bands,
                air,
                noise.trip,
                noise.tip,
            )
            for name, part in parts.items():
                part[place_there] += np.asarray(getattr(mechanisms, name))
    return parts


def line_blades(container: BroadbandContainer, noise: BpmNoise) -> list[LineBlade]:
    """Find the blades of a container: lines of nodes, one for each section.

    Parameters
    ----------
    container : BroadbandContainer
        The container.
    noise : BpmNoise
        Sections of the blades.

    Returns
    -------
    list of LineBlade
        A blade for each such line in the files within the container.

    Raises
    ------
    WopwopFileError
        If there is none, or one changes its shape.
    """
    n = noise.sections.n_sections
    blades = []
    for within in container.blades:
        geometry = read_geometry(within.geometry)
        lines = [zone for zone in geometry.zones if is_line(zone) and zone.values[0, 0].size == n]
        loads = () if within.loading is None else read_loading(within.loading).zones
        shifts = (key_offset_in_time(zone, within.key_offset) for zone in loads)
        offset = next((shift for shift in shifts if shift), 0.0)
        for zone in lines:
            if zone.keys is not None or zone.normals_at_faces is not None:
                raise WopwopFileError(
                    f"{within.geometry}: line {zone.name!r} must be constant, with normals at its"
                    " nodes, for broadband noise"
                )
            values = zone.values[0].reshape(6, -1).T.astype(float)
            blades.append(LineBlade(within.motion, values[:, :3], values[:, 3:], offset))
    if not blades:
        raise WopwopFileError(
            f"{container.title}: broadband noise needs geometry files within the container with a"
            f" line of {n} nodes, nSect"
        )
    return blades


def moving_edges(
    container: BroadbandContainer, noise: BpmNoise, blade: LineBlade, emitted: float
) -> MovingEdges:
    """Sections of a blade over the turn around a source time.

    Parameters
    ----------
    container : BroadbandContainer
        Container of the blade, which tells how it turns.
    noise : BpmNoise
        Sections of the blades.
    blade : LineBlade
        The blade: its line is taken for the quarter chord.
    emitted : float
        Source time in the middle of the turn [s].

    Returns
    -------
    MovingEdges
        Trailing edges and the flow over them; one time of a container that does not turn.

    Raises
    ------
    WopwopFileError
        If a section does not move, or the times are not those of the file.
    """
    fractions = np.zeros(1)
    if container.turning:
        turn = 2.0 * np.pi / abs(container.turning)
        fractions = ((np.arange(_AZIMUTHS) + 0.5) / _AZIMUTHS - 0.5) * turn
    times = emitted + fractions
    pose, data = poses(blade.motion, times), noise.sections
    span = np.gradient(blade.nodes, axis=0)
    span /= np.linalg.norm(span, axis=1)[:, None]
    chordwise = np.cross(span, blade.normal)
    chordwise /= np.linalg.norm(chordwise, axis=1)[:, None]
    _, velocity, _ = place(pose, blade.nodes)
    if not np.all(np.linalg.norm(velocity, axis=-1) > 0.0):
        raise WopwopFileError(f"{container.title}: broadband noise is of sections that move")
    turned = pose.rotation
    ahead = np.sum((chordwise @ np.swapaxes(turned, 1, 2))[0] * velocity[0], axis=-1) > 0.0
    chordwise = np.where(ahead[:, None], -chordwise, chordwise)
    edge = blade.nodes + 0.75 * np.asarray(data.chord)[:, None] * chordwise
    position, velocity, _ = place(pose, edge)
    along = span @ np.swapaxes(turned, 1, 2)
    backward = chordwise @ np.swapaxes(turned, 1, 2)
    across = velocity - along * np.sum(velocity * along, axis=-1, keepdims=True)

    def at_times(values: Array | None) -> Array:
        return np.asarray(_in_time(container, noise, values, times + blade.offset))

    speed = np.linalg.norm(across, axis=-1) if data.speed is None else at_times(data.speed)
    angle, slope = at_times(data.angle_of_attack), at_times(data.tip_slope)
    # A whole turn's arrays, whatever changes over it: one compiled code for all.
    chord, length, speed, angle, thickness, wedge = (
        np.broadcast_to(np.asarray(q), position.shape[:2])
        for q in (data.chord, data.length, speed, angle, data.edge_thickness, data.edge_angle)
    )
    section = Section(*map(jnp.asarray, (chord, length, speed, angle, thickness, wedge)))
    tip = jax.tree.map(lambda q: q[..., -1], section)
    tip = dataclasses.replace(tip, angle_of_attack=tip.angle_of_attack * slope[..., 0])
    moving = {
        "time": times,
        "position": position,
        "velocity": velocity,
        "chord_direction": backward,
        "span_direction": along,
    }
    arrays = {name: jnp.asarray(values) for name, values in moving.items()}
    return MovingEdges(**arrays, section=section, tip=tip)


def _in_time(
    container: BroadbandContainer, noise: BpmNoise, values: Array | None, times: Array
) -> Array:
    """Data of a file at source times, (n_times or 1, n)."""
    assert values is not None
    table, data = np.asarray(values).reshape(len(values), -1), noise.sections
    if data.times is None or len(table) == 1:
        return table
    known = data.times
    if data.period is None and (times.min() < known[0] or times.max() > known[-1]):
        raise WopwopFileError(
            f"{container.title}: sections are known from {known[0]:g} to {known[-1]:g} s; noise is"
            f" heard of {times.min():g} to {times.max():g} s"
        )
    columns = [np.interp(times, known, column, period=data.period) for column in table.T]
    return np.stack(columns, axis=1)


def _pegg(
    container: BroadbandContainer, noise: PeggNoise, air: Air, observers: Array, emitted: Array
) -> Array:
    """Third octaves of a rotor by Pegg's method, (n_observers, n_segments, n_bands)."""
    rate = noise.rotation_speed or abs(container.turning or 0.0)
    axis = container.shaft if noise.axis is None else noise.axis
    if not rate or axis is None:
        raise WopwopFileError(
            f"{container.title}: Pegg's method needs the rotation of the rotor: a base with"
            " rotation = .true., or rotSpeed and hubAxis as 'UserValue'"
        )
    motion = container.shaft_motion if noise.axis is None else container.motion
    rotor = LoadedRotor(noise.thrust, rate * noise.blade_radius, noise.blade_area)
    lift = noise.lift_coefficient or rotor.mean_lift_coefficient(air.density)
    times = emitted.ravel()
    origin = poses(container.motion, times).origin
    sight = observers.reshape(-1, 3) - origin
    # In the frame of the shaft, where its axis stays.
    turned = np.einsum("tji,tj->ti", poses(motion, times).rotation, sight)
    spectra = pegg_noise(BANDS_HZ, rotor, lift, turned, axis, air.sound_speed)
    return np.asarray(spectra).reshape(*emitted.shape, -1)
