"""Files of blade sections: what is written is read, and what is damaged is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.bpm_file import read_bpm_file

N = 3
CONSTANT = np.array([[0.1, 0.02, 1e-3, 0.2], [0.09, 0.02, 1e-3, 0.2], [0.08, 0.02, 0.0, 0.1]])
ANGLE, SPEED = np.array([0.05, 0.04, 0.03]), np.array([40.0, 60.0, 80.0])


def bpm(path: Path, kind: int = 1, order: str = "<", flags: str = "1111011", turns: int = 1):
    """A file with the flags chord, length, thickness, edge angle, tip, angle of attack, speed."""
    head = [42, N, 0, *map(int, flags), kind]
    data = np.array(head, f"{order}i4").tobytes()
    if kind == 2:
        data += np.array([turns], f"{order}i4").tobytes() + np.array(0.5, f"{order}f4").tobytes()
        data += np.array([2], f"{order}i4").tobytes()
    if kind == 3:
        data += np.array([2], f"{order}i4").tobytes()
    columns = [k for k in range(4) if flags[k] == "1"]
    rows = [CONSTANT[:, columns].ravel()]
    for k in range(1 if kind == 1 else 2 * (turns if kind == 2 else 1)):
        rows += [[0.25 * k]] if kind != 1 else []
        rows += [ANGLE + 0.01 * k] if flags[5] == "1" else []
        rows += [[7.0 + k]] if flags[4] == "1" else []
        rows += [SPEED + k] if flags[6] == "1" else []
    path.write_bytes(data + np.concatenate(rows).astype(f"{order}f4").tobytes())
    return path


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(("kind", "n_times"), [(1, 1), (2, 2), (3, 2)])
def test_what_is_written_is_read(tmp_path: Path, order: str, kind: int, n_times: int) -> None:
    read = read_bpm_file(bpm(tmp_path / "b.dat", kind, order, "1111111"))
    assert read.n_sections == N
    columns = (read.chord, read.length, read.edge_thickness, read.edge_angle)
    for found, known in zip(columns, CONSTANT.T, strict=True):
        assert_allclose(found, known, rtol=1e-6)
    steps = np.arange(n_times)
    assert_allclose(read.angle_of_attack, ANGLE + 0.01 * steps[:, None], rtol=1e-6)
    assert_allclose(read.speed, SPEED + steps[:, None], rtol=1e-6)
    assert_allclose(read.tip_slope, 7.0 + steps)
    assert (read.times is None) == (kind == 1)
    if kind != 1:
        assert_allclose(read.times, 0.25 * steps)
    assert read.period == (0.5 if kind == 2 else None)


def test_quantities_may_be_left_out(tmp_path: Path) -> None:
    read = read_bpm_file(bpm(tmp_path / "b.dat", flags="1000010"))
    assert_allclose(read.chord, CONSTANT[:, 0], rtol=1e-6)
    assert_allclose(read.angle_of_attack[0], ANGLE, rtol=1e-6)
    assert read.length is None and read.speed is None and read.tip_slope is None


def test_several_turns_are_read(tmp_path: Path) -> None:
    read = read_bpm_file(bpm(tmp_path / "b.dat", 2, turns=3))
    assert read.speed.shape == (6, N) and read.period == 0.5


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda data: data[:-4], "112 bytes, its head speaks of 116"),
        (lambda data: data + b"1234", "120 bytes, its head speaks of 116"),
        (lambda data: b"1234" + data[4:], "not a file of blade sections"),
        (lambda data: data[:20], "not a file of blade sections"),
        (lambda data: data[:8] + b"\1\0\0\0" + data[12:], "that are all alike"),
        (lambda data: data[:12] + b"\7\0\0\0" + data[16:], "not a file of blade sections: its"),
        (lambda data: data[:40] + b"\7\0\0\0" + data[44:], "constant, periodic or aperiodic"),
        (lambda data: data[:-4] + np.array(np.nan, "<f4").tobytes(), "a value is not finite"),
    ],
)
def test_what_is_no_such_file_is_refused(tmp_path: Path, change, message: str) -> None:
    path = bpm(tmp_path / "b.dat", flags="1111011")
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(WopwopFileError) as caught:
        read_bpm_file(path)
    assert str(caught.value).startswith(f"{path}: ") and message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_sample_of_another_program_is_read(reference_data: Path) -> None:
    read = read_bpm_file(reference_data / "wopwop" / "boeing360" / "BPM.dat")
    assert read.n_sections == 50 and read.times is None
    assert_allclose(read.chord[[0, -1]], [0.134239, 0.043037], atol=1e-6)
    assert_allclose(read.speed[0, [0, -1]], [57.98744, 213.40851], rtol=1e-6)
