"""Files of OpenVSP: the blade where its propeller component puts it, and round trips.

`placed` repeats, step by step, how OpenVSP places a section (PropPositioner::Update): it is the
published description that the files are held to, for OpenVSP itself has no wheel.
"""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, PchipInterpolator

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.exchange.bem import read_bem, write_bem
from propmdao.formats.exchange.vspscript import write_vspscript
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.surface import surface_nodes
from propmdao.propeller.airfoils.airfoil import Airfoil
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller

SWEPT = Propeller(
    name="swept",
    diameter=0.3,
    n_blades=3,
    r_over_R=np.array([0.2, 0.4, 0.7, 0.9, 1.0]),
    c_over_R=np.array([0.15, 0.2, 0.18, 0.12, 0.06]),
    beta_deg=np.array([34.0, 25.0, 15.0, 11.0, 9.0]),
    airfoils=[(0.2, "naca4412"), (1.0, "naca2406")],
    sweep_over_R=np.array([-0.01, -0.02, 0.0, 0.05, 0.1]),
    rake_over_R=0.02,
)
COLUMNS = "radius chord twist rake skew sweep thickness cli axial tangential".split()


def turn(axis: int, degrees: float) -> np.ndarray:
    """A turn about an axis by the right hand."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = cos, -sin, sin, cos
    return matrix


def placed(row: dict[str, float], points: np.ndarray, feather: float, cone: float) -> np.ndarray:
    """Points x, z over chord of a section in our axes, over the tip radius.

    In OpenVSP's axes x is against thrust, y along the blade, z against the rotation.
    """
    chord = row["chord"]
    p = np.stack([-points[:, 1] * chord, 0.0 * points[:, 0], (points[:, 0] - 0.5) * chord])
    p = p + np.array([[row["rake"]], [0.0], [row["skew"]]])
    p = turn(1, row["twist"]) @ p
    p = p + np.array([[row["axial"]], [row["radius"]], [row["tangential"]]])
    p = turn(2, cone) @ turn(1, feather) @ turn(0, row["sweep"]) @ p
    return np.stack([p[1], -p[2], -p[0]], axis=1)


def bem_rows(text: str) -> list[dict[str, float]]:
    n = int(re.search(r"^Num_Sections: (\d+)$", text, re.M)[1])  # type: ignore[index]
    lines = text.splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith("Radius/R")) + 1
    return [
        dict(zip(COLUMNS, map(float, line.split(",")), strict=True))
        for line in lines[start : start + n]
    ]


def bem_contours(text: str) -> list[np.ndarray]:
    blocks = re.split(r"^Section \d+ X, Y\n", text, flags=re.M)[1:]
    return [np.array([[float(w) for w in line.split(",")] for line in b.split("\n") if line])
            for b in blocks]  # fmt: skip


@pytest.fixture(scope="module")
def bem(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("bem") / "swept.bem"
    assert write_bem(path, SWEPT) == 5
    return path


def nodes_of(propeller: Propeller, r: np.ndarray, n_contour: int = 161) -> np.ndarray:
    """Our own surface, over the tip radius: (n_span, n_contour, 3), lower side first."""
    span = span_interpolation(propeller.r_over_R, r)
    nodes = np.asarray(surface_nodes(Blade.from_propeller(propeller), span, n_contour))
    return nodes[::-1].swapaxes(0, 1) / (0.5 * propeller.diameter)


def test_openvsp_puts_the_sections_of_a_bem_file_where_ours_are(bem: Path) -> None:
    text = bem.read_text()
    rows, sections = bem_rows(text), bem_contours(text)
    ours = nodes_of(SWEPT, SWEPT.r_over_R)
    theirs = [placed(row, points, 0.0, 0.0) for row, points in zip(rows, sections, strict=True)]
    np.testing.assert_allclose(theirs, ours, atol=2e-8)


def test_a_bem_file_has_the_lines_that_openvsp_scans_for(bem: Path) -> None:
    """The patterns of its reader, `PropGeom::ReadBEM`, in their order."""
    number = r"-?\d+\.\d+"
    scans = [r".*", r"Num_Sections: \d+", r"Num_Blade: \d+", rf"Diameter: {number}",
             rf"Beta 3/4 \(deg\): {number}", rf"Feather \(deg\): {number}",
             rf"Pre_Cone \(deg\): {number}", rf"Center: {number}, {number}, {number}",
             rf"Normal: {number}, {number}, {number}", r"Radius/R, .*"]  # fmt: skip
    scans += [", ".join([number] * 10)] * 5
    lines = [line for line in bem.read_text().splitlines() if line]
    assert all(re.fullmatch(s, line) for s, line in zip(scans, lines, strict=False))
    assert "Num_Blade: 3" in lines and "Diameter: 0.30000000" in lines
    assert max(map(len, lines)) < 255


def test_a_round_trip_keeps_the_blade_and_its_naca_sections(bem: Path) -> None:
    with pytest.warns(
        AssumedBladeWarning, match="metres; NACA 4-digit .* and zero-lift angle at 5 of 5"
    ):
        back = load_propeller(bem)
    assert (back.name, back.diameter, back.n_blades) == ("swept", 0.3, 3)
    for key in ("r_over_R", "c_over_R", "beta_deg", "sweep_over_R", "rake_over_R"):
        np.testing.assert_allclose(getattr(back, key), getattr(SWEPT, key), atol=3e-8)
    np.testing.assert_allclose(nodes_of(back, back.r_over_R), nodes_of(SWEPT, back.r_over_R),
                               atol=3e-4)  # fmt: skip


def test_sections_of_the_catalogue_come_back(tmp_path: Path) -> None:
    """E63 to Clark-Y: the ends are known again, what is blended is not."""
    ends = ((0.0, "e63"), (0.45, "e63"), (0.85, "clarky"), (1.0, "clarky"))
    blade = dataclasses.replace(SWEPT, airfoils=ends, thickness_over_chord=np.full(5, 0.08))
    write_bem(tmp_path / "known.bem", blade)
    with pytest.warns(AssumedBladeWarning, match="zero-lift angle at 1 of 5 stations"):
        back = read_bem(tmp_path / "known.bem")
    assert [name for _, name in back.airfoils] == ["e63", "e63", "naca4412", "clarky", "clarky"]
    ours, theirs = nodes_of(blade, SWEPT.r_over_R), nodes_of(back, SWEPT.r_over_R)
    np.testing.assert_allclose(theirs[[0, 1, 3, 4]], ours[[0, 1, 3, 4]], atol=1e-4)
    write_bem(tmp_path / "e63.bem", dataclasses.replace(SWEPT, airfoils=[(1.0, "e63")]))
    with pytest.warns(AssumedBladeWarning, match="lengths in metres$"):
        read_bem(tmp_path / "e63.bem")


def test_other_sections_keep_thickness_and_zero_lift_angle(tmp_path: Path) -> None:
    blade = dataclasses.replace(SWEPT, airfoils=[(0.2, "e63"), (1.0, "clarky")])
    write_bem(tmp_path / "blend.bem", blade)
    with pytest.warns(AssumedBladeWarning):
        back = read_bem(tmp_path / "blend.bem")
    camber, thickness = (lines[2] for lines in blade.sections())  # blended half and half or so
    section = Airfoil("blend", camber, thickness)
    naca = find_airfoil("naca4412")
    read = Blade.from_propeller(back)
    angle = float(read.camber_over_chord[2]) * naca.zero_lift_angle / naca.max_camber
    assert angle == pytest.approx(section.zero_lift_angle, rel=1e-5)
    assert float(read.thickness_over_chord[2]) == pytest.approx(section.max_thickness, rel=1e-6)


def test_without_contours_the_design_lift_counts(bem: Path, tmp_path: Path) -> None:
    path = tmp_path / "bare.bem"
    path.write_text(bem.read_text().split("\nSection 0")[0])
    with pytest.warns(AssumedBladeWarning, match="thickness and design lift at 5 of 5 stations"):
        back = read_bem(path)
    np.testing.assert_allclose(
        back.camber_over_chord, Blade.from_propeller(SWEPT).camber_over_chord, rtol=2e-3
    )


def test_rake_skew_sweep_feather_and_cone_are_understood(tmp_path: Path) -> None:
    """The quarter chord, chord direction and radius of each section where OpenVSP puts them."""
    rows = [dict(zip(COLUMNS, values, strict=True)) for values in (
        (0.2, 0.15, 30.0, 0.010, 0.02, 2.0, 0.12, 0.5, -0.02, 0.01),
        (0.6, 0.18, 14.0, -0.01, 0.03, 5.0, 0.10, 0.4, -0.03, 0.00),
        (1.0, 0.07, 8.00, -0.02, 0.01, 9.0, 0.08, 0.3, -0.05, -0.02))]  # fmt: skip
    feather, cone = 4.0, 3.0
    lines = ["...BEM Propeller...", "Num_Sections: 3", "Num_Blade: 4", "Diameter: 2.0",
             "Beta 3/4 (deg): 15.0", f"Feather (deg): {feather}", f"Pre_Cone (deg): {cone}",
             "Center: 1.0, 2.0, 3.0", "Normal: -1.0, 0.0, 0.0", "", "Radius/R, C/R"]  # fmt: skip
    lines += [", ".join(map(str, row.values())) for row in rows]
    path = tmp_path / "turned.bem"
    path.write_text("\n".join(lines))
    with pytest.warns(AssumedBladeWarning):
        blade = read_bem(path)
    quarter = np.array([placed(row, np.array([[0.25, 0.0]]), feather, cone)[0] for row in rows])
    tip = quarter[-1, 0]
    assert blade.diameter == pytest.approx(2.0 * tip) and blade.n_blades == 4
    np.testing.assert_allclose(blade.r_over_R, quarter[:, 0] / tip, rtol=1e-12)
    np.testing.assert_allclose(blade.sweep_over_R, -quarter[:, 1] / tip, atol=1e-12)
    np.testing.assert_allclose(blade.rake_over_R, quarter[:, 2] / tip, atol=1e-12)
    np.testing.assert_allclose(blade.beta_deg, [34.0, 18.0, 12.0])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("Radius/R, Chord/R", "r, c", "no BEM file of OpenVSP"),
        ("Diameter: 0.30000000", "", "entry 'Diameter: ...' is missing"),
        ("Num_Blade: 3", "Num_Blade: three", "Num_Blade: 'three' is no number"),
        ("Num_Blade: 3", "Num_Blade: 2.5", "Num_Blade must be a whole number; it is 2.5"),
        ("Num_Sections: 5", "Num_Sections: 6", "line 17: 10 numbers of a section expected"),
        ("Num_Sections: 5", "Num_Sections: -5", "Num_Sections must be 2 ... 1000; it is -5"),
        ("Feather (deg): 0.0", "Feather (deg): 190.0", "Feather (deg) must be within -90 ... 90"),
        ("0.15000000", "-0.1500000", "c_over_R must be within 1e-06 ... 10; station 1"),
    ],
)
def test_what_is_wrong_is_one_line(
    bem: Path, tmp_path: Path, old: str, new: str, message: str
) -> None:
    text = bem.read_text()
    assert old in text
    path = tmp_path / "wrong.bem"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(PropellerError, match=re.escape(message)) as caught:
        read_bem(path)
    assert str(caught.value).startswith(str(path)) and "\n" not in str(caught.value)


def arrays_of(script: str) -> dict[str, np.ndarray]:
    found = re.findall(r"array<double> (\w+) = \{ (.*) \};", script)
    return {name: np.array([float(word) for word in values.split(",")]) for name, values in found}


def test_the_script_builds_the_same_surface(tmp_path: Path) -> None:
    """Its curves and contours, placed as OpenVSP does, are our blade, between stations too."""
    path = tmp_path / "swept.vspscript"
    assert write_vspscript(path, SWEPT) == 5
    script = path.read_text()
    arrays = arrays_of(script)
    curves = dict(re.findall(r"SetPCurve\( prop, PROP_(\w+), r, (\w+), PCHIP \);", script))
    keys = "CHORD TWIST RAKE SKEW SWEEP THICK CLI AXIAL TANGENTIAL".split()
    assert list(curves) == keys
    sections = re.findall(r"SetSection\( prop, (\d+), ([\d.]+), x, (\w+) \);", script)
    # Insertion in the order of the lines leaves the sections in the order of their radii.
    order: list[float] = []
    for index, radius, _ in sections:
        order.insert(int(index), float(radius))
    np.testing.assert_array_equal(order, SWEPT.r_over_R)
    shape = np.stack([arrays[z] for _, _, z in sorted(sections, key=lambda s: float(s[1]))])
    values = {key: arrays[name] for key, name in zip(COLUMNS[1:], curves.values(), strict=True)}
    ours = nodes_of(SWEPT, arrays["r"])
    for k, r in enumerate(arrays["r"]):
        row = {"radius": r} | {key: column[k] for key, column in values.items()}
        z = np.array([np.interp(r, SWEPT.r_over_R, column) for column in shape.T])
        np.testing.assert_allclose(
            placed(row, np.stack([arrays["x"], z], axis=1), 0.0, 0.0), ours[k], atol=2e-4
        )


def test_monotone_cubics_of_the_script_are_near_our_splines(tmp_path: Path) -> None:
    """OpenVSP runs through the points of a curve by PCHIP."""
    path = tmp_path / "blade.vspscript"
    blade = load_propeller("apcsf_11x4.7")
    write_vspscript(path, blade)
    arrays = arrays_of(path.read_text())
    r = np.linspace(blade.r_over_R[0], 1.0, 500)
    for name, ours, close in (("chord", blade.c_over_R, 5e-4), ("twist", blade.beta_deg, 0.05)):
        theirs = PchipInterpolator(arrays["r"], arrays[name])(r)
        np.testing.assert_allclose(theirs, CubicSpline(blade.r_over_R, ours)(r), atol=close)


def test_a_name_cannot_break_out_of_the_script(tmp_path: Path) -> None:
    path = tmp_path / "named.vspscript"
    write_vspscript(path, dataclasses.replace(SWEPT, name='a"\n\\); Abort(); //'))
    lines = path.read_text().splitlines()
    assert lines[0].startswith("// a___); Abort(); //,")
    assert '    SetGeomName( prop, "a___); Abort(); //" );' in lines
