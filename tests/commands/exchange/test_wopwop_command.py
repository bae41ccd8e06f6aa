"""``propmdao wopwop``: what it prints, writes and refuses."""

from __future__ import annotations

import csv
import json
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced
from propmdao.commands.program import main
from propmdao.formats.wopwop.namelists.groups import read_namelists, write_namelists
from propmdao.formats.wopwop.write_case import write_rotor_case
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads

OMEGA = 400.0


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A two-bladed rotor of forces on a line, no surface; two observers, one turn."""
    r = np.linspace(0.05, 0.2, 6)
    position = np.stack([r, 0 * r, 0 * r], axis=-1)
    loads = PointLoads(position, np.stack([0 * r, 0.2 + 0 * r, -1 + 0 * r], axis=-1))
    rotor = Rotor(equally_spaced(2), OMEGA, loads=loads)
    observers = Observers(np.array([[2.0, 0, -1.0], [2.0, 0, 1.0]]), np.zeros(3))
    times = np.arange(64) * 2 * np.pi / OMEGA / 64
    write_rotor_case(
        tmp_path / "case", [rotor], [None], observers, times, Air(density=1.2, sound_speed=340.0)
    )
    return tmp_path / "case"


def change(folder: Path, name: str, **values: object) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        groups = [(group.name, dict(group.values)) for group in read_namelists(folder / "case.nam")]
    next(found for group, found in groups if group == name).update(values)
    write_namelists(folder / "case.nam", groups)


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    assert main(["wopwop", *map(str, arguments)]) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.startswith("propmdao wopwop: error: ")
    assert output.err.count("\n") == 1
    return output.err


def test_json_has_the_levels_of_the_record(folder: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["wopwop", str(folder), "--json", "--out", str(folder / "p.csv")]) == 0
    output = capsys.readouterr()
    assert output.err == ""
    groups = json.loads(output.out)
    assert [group["title"] for group in groups] == ["observer 1", "observer 2"]
    assert groups[0]["bin_width_hz"] == pytest.approx(OMEGA / (2 * np.pi))
    with (folder / "p.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 2 * 64
    for group in groups:
        (observer,) = group["observers"]
        mine = [row for row in rows if row["title"] == group["title"]]
        p = np.array([float(row["total_pa"]) for row in mine])
        np.testing.assert_allclose(
            [float(mine[0][q]) for q in ("x_m", "y_m", "z_m")], observer["position"]
        )
        assert observer["oaspl_db"] == pytest.approx(20 * np.log10(p.std() / 20e-6), abs=1e-9)
        assert observer["oaspl_loading_db"] == observer["oaspl_db"]
        assert observer["oaspl_thickness_db"] == -200.0
        assert observer["oaspl_dba"] < observer["oaspl_db"]
        passage = observer["peaks"][0]
        assert passage["frequency_hz"] == pytest.approx(OMEGA / np.pi)
        # nearly all of it is the first tone, and nothing is louder than all
        assert observer["oaspl_db"] - 0.1 < passage["spl_db"] <= observer["oaspl_db"]


def test_tables_are_the_json_rounded(folder: Path, capsys: pytest.CaptureFixture[str]):
    main(["wopwop", str(folder), "--json"])
    (observer,) = json.loads(capsys.readouterr().out)[0]["observers"]
    assert main(["wopwop", str(folder)]) == 0
    text = capsys.readouterr().out
    assert "case.nam: observer 1, 64 times" in text
    line = next(line for line in text.splitlines() if line.strip().startswith("1 "))
    loading, dba = (f"{observer[key]:.1f}" for key in ("oaspl_loading_db", "oaspl_dba"))
    assert line.split() == ["1", "2", "0", "-1", "-", loading, loading, dba, "127.3"]
    assert "Tones at observer 1, the loudest:" in text


def test_keys_without_effect_are_named_on_stderr(folder: Path, capsys: pytest.CaptureFixture[str]):
    change(folder, "environmentin", colour=3)
    change(folder, "observerin", flavour=3)
    assert main(["wopwop", str(folder), "--json"]) == 0
    output = capsys.readouterr()
    assert json.loads(output.out)
    lines = output.err.splitlines()
    assert len(lines) == 2
    assert all(line.startswith("propmdao wopwop: warning: ") for line in lines)
    assert "&environmentin: colour is not known and has no effect" in lines[0]
    assert "&observerin 'observer 1': flavour" in lines[1]


def test_broadband_noise_and_levels_are_told_and_written(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        groups = [(group.name, dict(group.values)) for group in read_namelists(folder / "case.nam")]
    flags = {"broadbandflag": True, "spectrumflag": True, "oaspldbflag": True, "selflag": True}
    groups[0][1].update(flags, asciioutputflag=True)
    for name, values in groups:
        if name == "observerin":
            values["octaveflag"] = True
    turning = next(k for k, (name, values) in enumerate(groups) if "rotation" in values)
    owner = max(k for k, (name, _) in enumerate(groups[:turning]) if name == "containerin")
    groups[owner][1]["peggnoiseflag"] = True
    values = {"totalthrust": 5.0, "totalbladearea": 0.004, "bladeradius": 0.2}
    pegg = values | {f"{key}flag": "UserValue" for key in values}
    n_bases = groups[owner][1]["nbbase"]
    groups.insert(owner + 1 + n_bases, ("peggin", pegg))
    write_namelists(folder / "case.nam", groups)
    assert main(["wopwop", str(folder), "--json", "--levels", str(folder / "levels")]) == 0
    found = json.loads(capsys.readouterr().out)
    (observer,) = found[0]["observers"]
    powers = [10 ** (0.1 * observer[key]) for key in ("oaspl_db", "oaspl_broadband_db")]
    together = 10 * np.log10(sum(powers))
    assert observer["oaspl_total_db"] == pytest.approx(together, abs=1e-9)
    bands = np.array([band["spl_db"] for band in observer["third_octave"]])
    assert 10 * np.log10(np.sum(10 ** (0.1 * bands))) == pytest.approx(together, abs=1e-6)
    seconds = found[0]["duration"] * 63 / 64
    exposure = observer["oaspl_total_dba"] + 10 * np.log10(seconds)
    assert observer["sel_dba"] == pytest.approx(exposure, abs=1e-6)
    names = sorted(path.name for path in (folder / "levels" / "case_1").iterdir())
    stems = ("OASPLdB", "spl_mspBB", "spl_octFilt_spectrum", "spl_spectrum")
    assert names == [f"{stem}.{end}" for stem in stems for end in ("fn", "nam", "x")]
    assert main(["wopwop", str(folder)]) == 0
    assert f"{observer['sel_dba']:.1f}" in capsys.readouterr().out


def truncate(folder: Path) -> None:
    file = folder / "rotor1_loading.dat"
    file.write_bytes(file.read_bytes()[:-8])


def other_order(folder: Path) -> None:
    file = folder / "rotor1_geometry.dat"
    file.write_bytes(b"\x00\x2a\x00\x00" + file.read_bytes()[4:])


def foreign(folder: Path) -> None:
    (folder / "rotor1_geometry.dat").write_text("solid blade\n" * 200)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (truncate, "rotor1_loading.dat: truncated: "),
        (other_order, "not a PSU-WOPWOP binary file; it begins with 00 2a 00 00"),
        (foreign, "not a PSU-WOPWOP binary file"),
        (lambda folder: (folder / "case.nam").write_text("hello"), "not a Fortran namelist file"),
        (lambda folder: (folder / "cases.nam").unlink(), "cases.nam: No such file"),
        (
            lambda folder: change(folder, "observerin", xloc=0.1, zloc=0.0),
            "observer 1 comes to 0.1 m from the centre of the sources; the region's radius is 0.2",
        ),
        (
            lambda folder: change(folder, "environmentconstants", c=75.0),
            "sources must be slower than sound (75 m/s); their Mach number is 1.067",
        ),
    ],
)
def test_bad_cases_are_one_line(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    spoil: Callable[[Path], object],
    message: str,
):
    spoil(folder)
    assert message in refused(capsys, folder)


def test_an_output_that_cannot_be_written(folder: Path, capsys: pytest.CaptureFixture[str]):
    missing = folder / "nowhere" / "p.csv"
    assert "there is no folder" in refused(capsys, folder, "--out", missing)
    assert "it is a folder" in refused(capsys, folder, "--out", folder)


def test_help_explains_the_options(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit) as exit_:
        main(["wopwop", "--help"])
    assert exit_.value.code == 0
    text = capsys.readouterr().out
    assert all(option in text for option in ("CASEDIR", "--json", "--out", "examples:"))


def test_coordinates_are_whole_in_tables(folder: Path, capsys: pytest.CaptureFixture[str]):
    """What rounding leaves of a cosine is 0; nothing is cut where the terminal is narrow."""
    change(folder, "observerin", xloc=-1234.5, yloc=2.565e-16, zloc=-0.34567)
    assert main(["wopwop", str(folder)]) == 0
    text = capsys.readouterr().out
    line = next(line for line in text.splitlines() if line.strip().startswith("1 "))
    assert line.split()[1:4] == ["-1234.5", "0", "-0.3457"]
    assert "\u2026" not in text


def test_silence_is_a_dash(folder: Path, capsys: pytest.CaptureFixture[str]):
    change(folder, "environmentin", loadingnoiseflag=False, totalnoiseflag=False)
    assert main(["wopwop", str(folder)]) == 0
    line = next(q for q in capsys.readouterr().out.splitlines() if q.strip().startswith("1 "))
    assert line.split()[4:7] == ["-", "-", "-"]
