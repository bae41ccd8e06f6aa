"""Geometry and loading files: sizes as documented, round trips, and foreign files."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.geometry_file import GeometryFile, read_geometry, write_geometry
from propmdao.formats.wopwop.loading_file import LoadingFile, read_loading, write_loading
from propmdao.formats.wopwop.outputs.pressure_file import read_pressure
from propmdao.formats.wopwop.zones import Zone


def assert_same(a, b) -> None:
    for field in dataclasses.fields(a):
        left, right = getattr(a, field.name), getattr(b, field.name)
        if field.name == "zones":
            for one, other in zip(left, right, strict=True):
                assert_same(one, other)
        elif field.name == "faces":
            assert left == right
        else:
            np.testing.assert_array_equal(left, right)


def in_time(zone: Zone, period: float | None) -> Zone:
    values = zone.values * np.float32([1.0, 1.5, 2.0]).reshape(3, 1, 1, 1)
    keys = np.float32([0.0, 0.1, 0.2])
    return dataclasses.replace(zone, values=values, keys=keys, period=period)


def test_sizes_of_constant_files(tmp_path, geometry, loading):
    """Header, zone headers, four bytes for each number."""
    write_geometry(tmp_path / "g.dat", geometry)
    write_loading(tmp_path / "l.dat", loading)
    nodes = sum(zone.values[0, 0].size for zone in geometry.zones)
    assert (tmp_path / "g.dat").stat().st_size == 1100 + 2 * 40 + 24 * nodes
    assert (tmp_path / "l.dat").stat().st_size == 1080 + 4 + 40 + 12 * 9


def test_words_of_the_headers_are_where_the_format_has_them(tmp_path, geometry, loading):
    write_geometry(tmp_path / "g.dat", geometry)
    write_loading(tmp_path / "l.dat", loading)
    data = (tmp_path / "g.dat").read_bytes()
    assert data[:4] == b"\x2a\0\0\0"
    assert np.frombuffer(data[1068:1100], "<i4").tolist() == [1, 2, 1, 1, 1, 1, 0, 0]
    assert np.frombuffer(data[1132:1140], "<i4").tolist() == [5, 11]  # iMax, jMax
    first = geometry.zones[0].values[0, 0]
    np.testing.assert_array_equal(np.frombuffer(data[1180:], "<f4")[: first.size], first.ravel())
    words = np.frombuffer((tmp_path / "l.dat").read_bytes()[1036:1084], "<i4")
    assert words.tolist() == [2, 2, 1, 1, 1, 2, 3, 1, 0, 0, 1, -2]


@pytest.mark.parametrize("byte_order", ["<", ">"])
@pytest.mark.parametrize("padding", [b" ", b"\0"])
@pytest.mark.parametrize("times", ["constant", "periodic", "aperiodic"])
def test_round_trip(tmp_path, geometry, loading, times, byte_order, padding):
    for file, write, read in (
        (geometry, write_geometry, read_geometry),
        (loading, write_loading, read_loading),
    ):
        zones = file.zones
        if times != "constant":
            period = 0.25 if times == "periodic" else None
            zones = tuple(in_time(zone, period) for zone in zones)
        file = dataclasses.replace(file, zones=zones, byte_order=byte_order, padding=padding)
        write(tmp_path / "a.dat", file)
        again = read(tmp_path / "a.dat")
        assert_same(file, again)
        write(tmp_path / "b.dat", again)
        assert (tmp_path / "a.dat").read_bytes() == (tmp_path / "b.dat").read_bytes()


def test_normals_at_faces(tmp_path, geometry):
    zone = geometry.zones[0]
    normals = np.ones((1, 3, zone.values.shape[2] - 1, zone.values.shape[3] - 1), np.float32)
    zone = dataclasses.replace(zone, values=zone.values[:, :3], normals_at_faces=normals)
    write_geometry(tmp_path / "a.dat", GeometryFile((zone,)))
    assert_same(GeometryFile((zone,)), read_geometry(tmp_path / "a.dat"))


def unstructured(zone: Zone) -> Zone:
    """The same surface: its nodes in a row, the faces listed; the first quadrangle as triangles."""
    j_max, i_max = zone.values.shape[2:]
    number = 1 + np.arange(j_max * i_max).reshape(j_max, i_max)
    corners = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = [tuple(map(int, face)) for face in np.stack(corners, axis=-1).reshape(-1, 4)]
    a, b, c, d = faces[0]
    faces[:1] = [(a, b, c), (a, c, d)]
    return Zone(zone.name, zone.values.reshape(1, 6, -1), faces=tuple(faces))


def test_unstructured_round_trip(tmp_path, geometry):
    """The header counts nodes and faces and lists the nodes around each."""
    zone = unstructured(geometry.zones[0])
    n, n_faces = zone.values.shape[2], len(zone.faces)
    write_geometry(tmp_path / "g.dat", GeometryFile((zone,)))
    data = (tmp_path / "g.dat").read_bytes()
    assert np.frombuffer(data[1076:1080], "<i4") == 2
    assert np.frombuffer(data[1132:1144], "<i4").tolist() == [n, n_faces, 3]
    assert len(data) == 1100 + 32 + 8 + 2 * 16 + (n_faces - 2) * 20 + 24 * n
    assert_same(GeometryFile((zone,)), read_geometry(tmp_path / "g.dat"))
    values = Zone("pressure", np.ones((1, 1, n_faces), np.float32))
    loading = LoadingFile((values,), (1,), 1, data=1, at_faces=True)
    write_loading(tmp_path / "l.dat", loading)
    assert (tmp_path / "l.dat").stat().st_size == 1080 + 4 + 36 + 4 * n_faces
    assert_same(loading, read_loading(tmp_path / "l.dat"))


def test_faces_of_nodes_that_are_not_there(tmp_path, geometry):
    zone = unstructured(geometry.zones[0])
    zone = dataclasses.replace(zone, faces=((1, 2, 99), *zone.faces[1:]))
    write_geometry(tmp_path / "g.dat", GeometryFile((zone,)))
    with pytest.raises(WopwopFileError, match=r"nodes 1 \.\.\. 55; it has \[1, 2, 99\]"):
        read_geometry(tmp_path / "g.dat")


def test_grids_and_faces_do_not_go_into_one_file(tmp_path, geometry):
    zones = (geometry.zones[1], unstructured(geometry.zones[0]))
    with pytest.raises(ValueError, match="must all be structured or all unstructured"):
        write_geometry(tmp_path / "g.dat", GeometryFile(zones))


class TestBadFiles:
    @pytest.fixture
    def file(self, tmp_path, geometry) -> Path:
        write_geometry(tmp_path / "g.dat", geometry)
        return tmp_path / "g.dat"

    def refused(self, file: Path, message: str, read=read_geometry) -> None:
        with pytest.raises(WopwopFileError, match=message) as caught:
            read(file)
        assert str(caught.value).startswith(str(file))
        assert "\n" not in str(caught.value)

    def test_missing(self, tmp_path):
        self.refused(tmp_path / "nothing.dat", "No such file")

    @pytest.mark.parametrize("size", [4, 11, 500, 1090, 1150, 1500])
    def test_truncated(self, file, size):
        file.write_bytes(file.read_bytes()[:size])
        self.refused(file, "truncated: .* the file has")

    def test_not_a_number(self, file):
        data = bytearray(file.read_bytes())
        data[1200:1204] = np.float32(np.nan).tobytes()
        file.write_bytes(data)
        self.refused(file, "zone 'box' holds infinities or NaN")

    def test_too_long(self, file):
        file.write_bytes(file.read_bytes() + bytes(8))
        self.refused(file, "8 bytes more than its header says")

    @pytest.mark.parametrize("content", [b"", b"\x2a", b"solid blade\n" * 200, bytes(2000)])
    def test_foreign(self, file, content):
        file.write_bytes(content)
        self.refused(file, "not a PSU-WOPWOP binary file; it begins with")

    def test_the_other_kind(self, file, tmp_path, loading):
        self.refused(file, "file type", read_loading)
        write_loading(tmp_path / "l.dat", loading)
        self.refused(tmp_path / "l.dat", "file type")

    @pytest.mark.parametrize(
        ("word", "value", "message"),
        [
            (1, 2, "version must be 1; it is 2"),
            (268, 0, "number of zones must be at least 1; it is 0"),
            (269, 3, r"grid must be one of 1 \(structured\), 2 \(unstructured\); it is 3"),
            (270, 5, "time dependence of the geometry must be one of .* it is 5"),
            (272, 2, r"precision must be one of 1 \(single\); it is 2"),
            (283, -5, "iMax must be at least 1; it is -5"),
            (283, 2**31 - 1, "truncated"),
        ],
    )
    def test_header_of_another_format(self, file, word, value, message):
        data = bytearray(file.read_bytes())
        data[4 * word : 4 * word + 4] = np.array(value, "<i4").tobytes()
        file.write_bytes(data)
        self.refused(file, message)

    def test_zone_numbers_of_another_geometry(self, tmp_path, loading):
        path = tmp_path / "l.dat"
        write_loading(path, dataclasses.replace(loading, zone_numbers=(3,)))
        self.refused(path, r"zone numbers must be 1 \.\.\. 2; one is 3", read_loading)

    def test_zones_that_do_not_go_together_are_not_written(self, tmp_path, geometry):
        zones = (geometry.zones[0], in_time(geometry.zones[1], None))
        with pytest.raises(ValueError, match="must have the same time dependence"):
            write_geometry(tmp_path / "a.dat", GeometryFile(zones))

    def test_long_text_is_not_written(self, tmp_path, loading: LoadingFile):
        with pytest.raises(ValueError, match="text must be at most 1024 bytes"):
            write_loading(tmp_path / "a.dat", dataclasses.replace(loading, comment="x" * 1025))


class TestPressure:
    NAMES = " Observer Time (s)\n ThicknessAcoustic Pressure\n LoadingAcoustic Pressure\n"

    @pytest.fixture
    def stem(self, tmp_path) -> Path:
        """2 x 1 observers, 3 times; p = 100 function + 10 time + observer."""
        numbers = [100 * f + 10 * t + i for f in range(4) for t in range(3) for i in range(2)]
        (tmp_path / "p.nam").write_text(self.NAMES + " TotalAcoustic Pressure\n")
        (tmp_path / "p.fn").write_text("2 1 3 4\n" + "\n".join(map(str, numbers)))
        (tmp_path / "p.x").write_text("2 1 3\n" + "\n".join(map(str, numbers[:18])))
        return tmp_path / "p"

    def test_order_of_the_numbers(self, stem):
        p = read_pressure(stem)
        assert p.loading[1].tolist() == [201, 211, 221]
        assert p.position[1, 2].tolist() == [21, 121, 221]

    @pytest.mark.parametrize("order", ["<", ">"])
    def test_binary_files_hold_the_same(self, stem, order):
        text = read_pressure(stem)
        for ending, n_sizes in ((".fn", 4), (".x", 3)):
            path = stem.with_suffix(ending)
            words = path.read_text().split()
            sizes = np.array(words[:n_sizes], f"{order}i4")
            path.write_bytes(sizes.tobytes() + np.array(words[n_sizes:], f"{order}f4").tobytes())
        assert_same(read_pressure(stem), text)
        path.write_bytes(path.read_bytes()[:-1])
        with pytest.raises(WopwopFileError, match=r"p.x: truncated: 83 bytes"):
            read_pressure(stem)

    TEC = (
        'TITLE="PSU-WOPWOP"\nVARIABLES="Observer Time (s)","Thickness Acoustic Pressure (Pa)",'
        '"Loading Acoustic Pressure (Pa)","Total Acoustic Pressure (Pa)"\nTEXT X=2,T="mic"\n\n'
    )

    def test_a_single_observer(self, tmp_path):
        (tmp_path / "p.tec").write_text(self.TEC + " 0.0 1.0 2.0 3.0\n  1E-1 -1. .5 -.5\n")
        p = read_pressure(tmp_path / "p.tec")
        np.testing.assert_array_equal(p.time, [[0, 0.1]])
        np.testing.assert_array_equal(p.total, [[3, -0.5]])
        assert p.position.shape == (1, 2, 3) and np.isnan(p.position).all()

    @pytest.mark.parametrize(
        ("content", "message"),
        [
            ("hello", "it names no VARIABLES"),
            (TEC + "1 2 3\n", "rows must have 4 numbers"),
            (TEC, "rows must have 4 numbers"),
            (TEC + "1 2 3 x\n", "not a Tecplot file"),
            (TEC.replace("Loading", "Other") + "1 2 3 4\n", "no 'loading' among Observer Time"),
        ],
    )
    def test_broken_single_observers(self, tmp_path, content, message):
        (tmp_path / "p.tec").write_text(content)
        with pytest.raises(WopwopFileError, match=message):
            read_pressure(tmp_path / "p.tec")

    @pytest.mark.parametrize(
        ("ending", "content", "message"),
        [
            ("fn", "2 1 3 4\n1 2 3", "3 numbers do not fill its sizes"),
            ("fn", "2 1 3 4\n1 x 3", "not a PLOT3D text file"),
            ("fn", "", "do not fill its sizes"),
            ("x", "1 1 3\n" + "1 " * 9, "do not go together"),
            ("nam", NAMES + " other", "no 'total' among"),
            ("x", "\x80\x81", "it is not text in ASCII"),
        ],
    )
    def test_broken_files(self, stem, ending, content, message):
        Path(f"{stem}.{ending}").write_text(content, encoding="latin-1")
        with pytest.raises(WopwopFileError, match=message):
            read_pressure(stem)


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_a_period_is_positive_and_times_are_numbers(tmp_path, loading, value):
    zone = in_time(loading.zones[0], 0.25)
    file = tmp_path / "l.dat"
    write_loading(file, dataclasses.replace(loading, zones=(zone,)))
    good = file.read_bytes()
    period = good.index(np.float32(0.25).tobytes())
    file.write_bytes(good[:period] + np.float32(value).tobytes() + good[period + 4 :])
    with pytest.raises(WopwopFileError, match="the period of zone 'line loads' must be positive"):
        read_loading(file)
    key = good.index(np.float32(0.2).tobytes())
    file.write_bytes(good[:key] + np.float32(np.nan).tobytes() + good[key + 4 :])
    with pytest.raises(WopwopFileError, match="zone 'line loads' holds infinities or NaN"):
        read_loading(file)
