"""The one-call face: same numbers as its parts, plain results, clear refusals."""

import json

import jax
import numpy as np
import pytest
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import arc, point, sphere
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.meshes import propeller_surface
from propmdao.geometry.surface import surface_panels
from propmdao.records.listening import Surroundings
from propmdao.records.quantities import LEVELS

SLOW_FLYER = load_propeller("apcsf_11x4.7_uiuc")


def run(**asked):
    return analyze(SLOW_FLYER, fidelity=COARSE, **asked).to_dict()


def test_required_thrust_is_met_and_agrees_with_the_rpm_found():
    trimmed = run(thrust=1.2, speed=8.0)
    given = run(rpm=trimmed["rpm"], speed=8.0)
    assert trimmed["thrust"] == pytest.approx(1.2, rel=1e-6)
    assert given["torque"] == pytest.approx(trimmed["torque"], rel=1e-9)


def test_results_are_consistent_plain_numbers():
    result = run(rpm=4200.0, speed=8.0, observers=arc([1.905, 3.0], [-45.0, 0.0]))
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert result["CP"] == pytest.approx(2 * np.pi * result["CQ"])
    assert result["shaft_power"] == pytest.approx(result["torque"] * 4200 * np.pi / 30)
    assert result["eta"] == pytest.approx(result["thrust"] * 8.0 / result["shaft_power"])
    below, beside = result["observers"]
    assert (below["radius"], below["elevation_deg"]) == (1.905, -45.0)
    assert (beside["radius"], beside["elevation_deg"]) == (3.0, 0.0)
    for observer in (below, beside):
        levels = [harmonic["spl_db"] for harmonic in observer["harmonics"]]
        assert observer["spl_bpf_db"] == levels[0]
        energy = 10 * np.log10(sum(10 ** (level / 10) for level in levels))
        assert observer["oaspl_db"] == pytest.approx(energy)
        bands = [band["spl_db"] for band in observer["third_octave"]]
        assert 10 * np.log10(sum(10 ** (level / 10) for level in bands)) == pytest.approx(energy)
        assert [h["frequency_hz"] for h in observer["harmonics"]] == pytest.approx(
            [140, 280, 420, 560, 700]
        )


def test_observers_on_a_circle_hear_what_each_would_alone():
    places = sphere(1.5, [-45.0, -20.0], [0.0, 45.0, 130.0, 250.0])
    asked = {"rpm": 4200.0, "speed": 8.0, "broadband": True, "fidelity": COARSE}
    together = analyze(SLOW_FLYER, observers=places, **asked)
    surface = propeller_surface(SLOW_FLYER, COARSE.n_contour, COARSE.n_surface_span)
    loads, n_blades = together.loads.point_loads, SLOW_FLYER.n_blades
    panels = jax.jit(surface_panels)(surface)
    known = tones(panels, loads, n_blades, together.state, places, COARSE.n_harmonics)
    for name, amplitude in known.parts.items():
        scale = np.abs(amplitude).max()
        np.testing.assert_allclose(together.tones.parts[name], amplitude, atol=1e-11 * scale)
    # At 45 degrees the 24 azimuths of the broadband noise are the same ones.
    levels = np.asarray(together.broadband.total)
    np.testing.assert_allclose(levels[1], levels[0], rtol=1e-12)


def test_hover_and_standstill_are_ordinary():
    hover = run(rpm=4200.0)
    assert hover["thrust"] > 3.0 and hover["eta"] == 0.0 and hover["J"] == 0.0
    still = run(rpm=0.0, speed=8.0, observers=arc(1.905, [-45.0, 0.0]))
    assert still["thrust"] == still["torque"] == still["CT"] == still["J"] == 0.0
    assert still["converged"] and still["observers"][0]["oaspl_db"] == -200.0
    json.dumps(still, allow_nan=False)


def test_viscosity_takes_thrust_and_adds_power():
    viscous, inviscid = (run(rpm=4200.0, speed=8.0, viscous=on) for on in (True, False))
    assert [one["model"]["loads"]["viscous"] for one in (viscous, inviscid)] == [True, False]
    assert viscous["polars"] and not inviscid["polars"]
    assert viscous["thrust"] < 0.95 * inviscid["thrust"]
    assert viscous["eta"] < 0.9 * inviscid["eta"]
    without_delay = run(rpm=4200.0, stall_delay=False)
    assert without_delay["thrust"] < run(rpm=4200.0)["thrust"]


def test_broadband_noise_adds_to_the_tones():
    where = {"rpm": 4200.0, "observers": arc(1.905, [-45.0, 0.0])}
    tones, both = run(**where), run(**where, broadband=True)
    for alone, total in zip(tones["observers"], both["observers"], strict=True):
        assert total["harmonics"] == alone["harmonics"]
        # oaspl_db and oaspl_dba are of the tones, whatever else is heard.
        assert alone.keys() < total.keys()
        assert all(total[name] == alone[name] for name in LEVELS)
        noise = total["oaspl_broadband_db"]
        energy = 10 * np.log10(10 ** (alone["oaspl_db"] / 10) + 10 ** (noise / 10))
        assert total["oaspl_total_db"] == pytest.approx(energy)
        weighted = (10 ** (total[name] / 10) for name in ("oaspl_dba", "oaspl_broadband_dba"))
        assert total["oaspl_total_dba"] == pytest.approx(10 * np.log10(sum(weighted)))
        bands = [band["spl_db"] for band in total["third_octave"]]
        assert 10 * np.log10(sum(10 ** (level / 10) for level in bands)) == pytest.approx(energy)
        assert total["oaspl_total_dba"] > alone["oaspl_dba"] + 5.0
        mechanisms = [key for key in total["broadband"][0] if key.endswith("_db")]
        for band in total["broadband"]:
            powers = [10 ** (band[key] / 10) for key in mechanisms if key != "spl_db"]
            assert band["spl_db"] == pytest.approx(10 * np.log10(sum(powers)), abs=1e-6)
    json.dumps(both, allow_nan=False)


def test_twist_offset_turns_the_whole_blade():
    by_offset = run(rpm=4200.0, speed=8.0, twist_offset_deg=2.0)
    assert by_offset["thrust"] > 1.3 * run(rpm=4200.0, speed=8.0)["thrust"]


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ({}, "give either rpm or thrust"),
        ({"rpm": 4000.0, "thrust": 1.0}, "give either rpm or thrust"),
        ({"rpm": -1.0}, "rpm must be 0 or within 0.001 ... 1000000 rpm; it is -1"),
        ({"rpm": float("nan")}, "1000000 rpm; it is nan"),
        ({"thrust": 0.0}, "thrust must be within 1e-09 ... 1000000000 N; it is 0"),
        ({"rpm": 4000.0, "speed": -2.0}, "speed must be within 0 ... 1000 m/s; it is -2"),
        ({"rpm": 4000.0, "density": 0.0}, "density must be within 0.0001 ... 2000 kg/m3; it is 0"),
        ({"rpm": 4000.0, "observers": arc(0.1, [0.0])}, "observer 1 is inside the source region"),
        ({"rpm": 40000.0}, "relative tip Mach number must be below 1"),
        ({"thrust": 900.0}, "thrust 900 N is out of reach at 0 m/s"),
        ({"thrust": 1.0, "speed": 310.0}, "speed must be below 306"),
    ],
)
def test_bad_input_is_refused_in_one_line(asked, says):
    with pytest.raises(ValueError) as error:
        run(**asked)
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_on_the_ground_all_is_six_decibels_louder_and_nothing_else_changes():
    """Observers on the ground 3 m below a hovering rotor, or wherever the ground is: the same."""
    places = point(5.0, np.degrees(np.arcsin(-0.6)), [0.0, 70.0])
    free = run(rpm=4200.0, observers=places, broadband=True)
    for ground in ("flush", 3.0):
        heard = run(rpm=4200.0, observers=places, broadband=True, surroundings=Surroundings(ground))
        assert heard["thrust"] == free["thrust"]
        assert heard["listening"]["surroundings"]["ground"] == ground
        for ours, theirs in zip(heard["observers"], free["observers"], strict=True):
            assert ours["azimuth_deg"] == theirs["azimuth_deg"]
            for name in (
                "oaspl_db",
                "oaspl_dba",
                "oaspl_thickness_db",
                "oaspl_broadband_db",
                "oaspl_total_db",
                "oaspl_total_dba",
            ):
                assert ours[name] - theirs[name] == pytest.approx(20 * np.log10(2), abs=1e-6)


def test_in_axial_flight_it_is_as_loud_all_around_until_the_ground_is_on_one_side():
    places = point(2.0, 10.0, [0.0, 90.0, 180.0])
    free, level = (
        [o["oaspl_db"] for o in run(rpm=4200.0, speed=8.0, observers=places, **how)["observers"]]
        for how in ({}, {"surroundings": Surroundings(2.0, level_flight=True)})
    )
    assert np.ptp(free) < 1e-6
    # Azimuth 0 is down: 3 cm above the ground.
    assert 5.5 < level[0] - free[0] < 6.1 and np.ptp(level) > 1.0


def test_tripped_blades_shed_no_laminar_vortices():
    asked = {"rpm": 4200.0, "speed": 8.0, "observers": arc(2.0, [-20.0, 0.0]), "broadband": True}
    untripped, tripped = (run(**asked, layers="bpm", trip=trip) for trip in ("none", "heavy"))
    said = [one["model"]["noise"]["broadband"]["trip"] for one in (untripped, tripped)]
    assert said == ["none", "heavy"]
    shed = [band["laminar_shedding_db"] for band in tripped["observers"][0]["broadband"]]
    assert max(shed) == -200.0
    loud, quiet = (one["observers"][0]["oaspl_broadband_db"] for one in (untripped, tripped))
    assert loud - quiet > 5.0
    assert tripped["thrust"] == untripped["thrust"]
