"""A rotor of 65 x 80 surface points flies past a microphone: time and peak memory of the record.

Each run is a process of its own, so that its memory is its own; the time is that of the record
alone, compiling included, as a user waits for it.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time

import pytest

SPEED, RPM, MISS = 8.0, 4000.0, 30.0  # m/s, rev/min, m
RATE, TOP = 44100, 5000.0  # samples per second, Hz


@pytest.mark.parametrize("method", ["tones along the track", "marching"])
def test_flyover(benchmark, method):
    """30 s by tones along the track; 0.1 s, a three-hundredth of it, by marching."""

    def run() -> tuple[float, float]:
        seconds = 30.0 if method == "tones along the track" else 0.1
        arguments = [sys.executable, __file__, method, str(seconds)]
        result = subprocess.run(arguments, capture_output=True, text=True, check=True)
        wall, mebibytes = map(float, result.stdout.split())
        return wall, mebibytes

    wall, mebibytes = benchmark.pedantic(run, rounds=1)
    benchmark.extra_info["record_s"] = wall
    benchmark.extra_info["peak_memory_mib"] = mebibytes


def _main(method: str, seconds: float) -> None:
    import jax.numpy as jnp
    import numpy as np

    from propmdao.acoustics.kinematics.motion import translation
    from propmdao.acoustics.kinematics.reception import Observers
    from propmdao.acoustics.sources.flyover import flyover_histories
    from propmdao.acoustics.sources.rotors import Rotor, equally_spaced, rotor_histories
    from propmdao.analysis.single_point import analyze
    from propmdao.formats.propellers import load_propeller
    from propmdao.geometry.blade import Blade, span_interpolation
    from propmdao.geometry.surface import surface_nodes, surface_panels, surface_span
    from propmdao.records.air import Air
    from propmdao.records.units import RAD_PER_S

    propeller = load_propeller("apcsf_11x4.7")
    span = span_interpolation(propeller.r_over_R, surface_span(propeller.r_over_R[0], 80))
    panels = surface_panels(surface_nodes(Blade.from_propeller(propeller), span, 65))
    loads = analyze(propeller, rpm=RPM, speed=SPEED).loads.point_loads
    rotor = Rotor(equally_spaced(propeller.n_blades), RPM * RAD_PER_S, panels, loads)
    flight = (translation((0, 0, -15 * SPEED), velocity=(0, 0, SPEED)),)
    microphone = Observers(jnp.array([[MISS, 0.0, 0.0]]), jnp.zeros(3))
    times = np.arange(round(seconds * RATE)) / RATE
    begin = time.perf_counter()
    if method == "marching":
        rotor_histories([rotor], microphone, times, Air(), flight)
    else:
        flyover_histories([rotor], microphone, times, Air(), flight, TOP)
    wall = time.perf_counter() - begin
    print(wall, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)


if __name__ == "__main__":
    _main(sys.argv[1], float(sys.argv[2]))
