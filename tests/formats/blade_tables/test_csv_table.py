"""Tables with heads: names and units of columns, what is assumed, what is refused."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.exchange.blades import export_csv
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller

R, CHORD, BETA = (np.array(x) for x in ([0.2, 0.6, 1.0], [0.15, 0.2, 0.05], [30.0, 15.0, 9.0]))
TIP = 0.127  # m


def table(*columns: tuple[str, object], separator: str = ",") -> str:
    heads = separator.join(head for head, _ in columns)
    rows = zip(*(values for _, values in columns), strict=True)  # type: ignore[call-overload]
    lines = [separator.join(f"{v:.9g}" if isinstance(v, float) else str(v) for v in row)
             for row in rows]  # fmt: skip
    return "\n".join([heads, *lines]) + "\n"


def read(path: Path, text: str) -> Propeller:
    path.write_text(text, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AssumedBladeWarning)
        return load_propeller(path)


@pytest.mark.parametrize(
    "columns",
    [
        [("r/R", R), ("radius [mm]", R * 127), ("c/R", CHORD), ("beta [deg]", BETA)],
        [("r_m", R * TIP), ("chord_mm", CHORD * 127), ("twist_deg", BETA)],
        [("Radius (in)", R * 5), ("Chord (in)", CHORD * 5), ("Twist (rad)", np.radians(BETA))],
        [("radius_cm", R * 12.7), ("c/D", CHORD / 2), ("theta", BETA)],
        [("r [m]", R * TIP), ("c [m]", CHORD * TIP),
         ("pitch [in]", 2 * np.pi * R * 5 * np.tan(np.radians(BETA)))],
        [("r_over_R", R), ("radius_inch", R * 5), ("chord_over_R", CHORD), ("pitch (deg)", BETA)],
    ],
)  # fmt: skip
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_the_usual_names_and_units_give_the_same_blade(
    columns: list[tuple[str, np.ndarray]], separator: str, tmp_path: Path
) -> None:
    blade = read(tmp_path / "made.csv", "# a comment\n" + table(*columns, separator=separator))
    assert blade.diameter == pytest.approx(2 * TIP)
    np.testing.assert_allclose(blade.r_over_R, R, rtol=1e-8)
    np.testing.assert_allclose(blade.c_over_R, CHORD, rtol=1e-8)
    np.testing.assert_allclose(blade.beta_deg, BETA, rtol=1e-8)
    assert blade.n_blades == 2 and blade.airfoils == ((1.0, "naca4412"),)


def test_commas_are_decimal_points_between_semicolons(tmp_path: Path) -> None:
    text = "radius [mm];c/R;beta\n25,4;0,15;30\n76,2;0,2;15\n127,0;0,05;9\n"
    blade = read(tmp_path / "made.csv", text)
    np.testing.assert_allclose(blade.c_over_R, CHORD)
    np.testing.assert_allclose(blade.r_over_R, R)


def test_the_name_says_diameter_and_blades_where_the_table_does_not(tmp_path: Path) -> None:
    text = table(("r_over_R", R), ("c_over_R", CHORD), ("beta_deg", BETA))
    assert read(tmp_path / "da4022_9x6.75_3b.csv", text).diameter == pytest.approx(0.2286)
    assert read(tmp_path / "da4022_9x6.75_3b.csv", text).n_blades == 3


def test_airfoils_stand_at_their_stations(tmp_path: Path) -> None:
    r = np.array([0.2, 0.4, 0.6, 0.8, 1.0])
    text = table(
        ("r [m]", r), ("c/R", np.full(5, 0.1)), ("twist [deg]", np.full(5, 9.0)),
        ("airfoil", ["E63", "E63", "E 63", "Clark-Y", "NACA 4412"]), ("blades", [4] * 5),
    )  # fmt: skip
    blade = read(tmp_path / "made.csv", text)
    assert blade.airfoils == ((0.2, "e63"), (0.6, "e63"), (0.8, "clarky"), (1.0, "naca4412"))
    assert blade.n_blades == 4


def test_what_is_assumed_and_not_used_is_one_warning(tmp_path: Path) -> None:
    path = tmp_path / "made.csv"
    path.write_text(table(("r [m]", R), ("c/R", CHORD), ("beta", BETA), ("sweep_mm", R), ("q", R)))
    with pytest.warns(AssumedBladeWarning) as caught:
        load_propeller(path)
    assert [str(warning.message) for warning in caught] == [
        f"{path}: assumed, for the table does not say: NACA 4412 sections from root to tip and 2 "
        "blades; not used: sweep_mm, q"
    ]


def test_twist_between_the_ends_is_referred_to_the_chord_line(tmp_path: Path) -> None:
    columns = [("r [m]", R), ("c/R", CHORD), ("t/c", [0.2, 0.12, 0.1])]
    chord = read(tmp_path / "a.csv", table(*columns, ("twist_deg", BETA)))
    ends = read(tmp_path / "b.csv", table(*columns, ("twist_deg_LE_TE", BETA)))
    steeper = ends.beta_deg - chord.beta_deg
    assert (steeper > 0.1).all() and (np.diff(steeper) < 0.0).all()  # rounder and steeper inside


def test_the_table_that_is_exported_is_read_back(tmp_path: Path) -> None:
    blade = load_propeller("apce_10x7")
    export_csv(tmp_path / "blade.csv", blade)
    with pytest.warns(AssumedBladeWarning, match="NACA 4412 sections of the table's thickness$"):
        again = load_propeller(tmp_path / "blade.csv")
    assert again.n_blades == blade.n_blades
    for key in ("r_over_R", "c_over_R", "beta_deg", "sweep_over_R", "rake_over_R"):
        np.testing.assert_allclose(getattr(again, key), getattr(blade, key), rtol=1e-9)
    own, other = Blade.from_propeller(blade), Blade.from_propeller(again)
    np.testing.assert_allclose(own.camber_over_chord, other.camber_over_chord, rtol=1e-9)
    np.testing.assert_allclose(own.thickness_over_chord, other.thickness_over_chord, rtol=1e-9)


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ([("c/R", CHORD), ("beta", BETA)], "a column of radii is missing: 'r/R', or 'radius'"),
        ([("radius", R), ("c/R", CHORD), ("beta", BETA)], "column 'radius' needs a unit, as 'rad"),
        ([("r/R", R), ("c/R", CHORD), ("beta", BETA)], "the diameter is missing: give a column of"),
        ([("r [m]", R), ("chord", CHORD), ("beta", BETA)], "column 'chord' needs a unit, as"),
        ([("r [m]", R), ("beta", BETA)], "a column is missing: 'c/R', 'c/D' or 'chord' with"),
        ([("r [m]", R), ("c/R", CHORD)], "a column of the blade angle is missing"),
        ([("r [m]", R), ("c/R", CHORD), ("pitch", BETA)], "column 'pitch' needs a unit: 'pitch ["),
        ([("r [m]", R), ("c/R", CHORD), ("beta", BETA / 57)], "column 'beta' may be in degrees or"),
        ([("r [m]", R), ("c/R", CHORD), ("chord [m]", R), ("beta", BETA)],
         "columns of c/R and chord contradict each other"),
        ([("r [m]", R), ("r/R", R**2), ("c/R", CHORD), ("beta", BETA)],
         "columns 'r/R' and 'radius' contradict each other"),
        ([("r [m]", R), ("c/R", CHORD), ("beta", BETA), ("twist", BETA)],
         "two columns hold the same quantity"),
        ([("r [m]", R), ("c/R", CHORD), ("beta", BETA), ("blades", [2, 3, 2])],
         "the number of blades must be one whole number in every row"),
        ([("r [m]", R - 0.3), ("c/R", CHORD), ("beta", BETA)], "radius must be positive; st"),
        ([("r [m]", R), ("c/R", -CHORD), ("beta", BETA)], "c_over_R must be within 1e-06 ... 10"),
        ([("r [m]", R), ("c/R", CHORD), ("beta", BETA), ("airfoil", ["mh32"] * 3)],
         "unknown airfoil 'mh32'; near: "),
    ],
)  # fmt: skip
def test_what_is_not_certain_is_refused_in_one_line(
    columns: list[tuple[str, np.ndarray]], message: str, tmp_path: Path
) -> None:
    with pytest.raises(PropellerError) as caught:
        read(tmp_path / "made.csv", table(*columns))
    assert str(caught.value).startswith(f"{tmp_path / 'made.csv'}: {message}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ": a line of heads and rows of numbers expected"),
        ("0.2,0.1,20\n1,0.1,9\n", ", line 1: a line of heads expected, not '0.2,0.1,20'"),
        ("r [m],c/R,beta\n0.2,0.1\n", ", line 2: 3 columns expected; the row has 2"),
        ("r [m],c/R,c/R\n0.2,0.1,9\n", ", line 1: two columns have the same head"),
        ("r [m],c/R,beta\n0.2,x,9\n1,0.1,9\n", ", line 2, column 'c/R': 'x' is no number"),
    ],
)
def test_a_table_that_is_none_is_refused(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(PropellerError) as caught:
        read(tmp_path / "made.csv", text)
    assert str(caught.value).startswith(f"{tmp_path / 'made.csv'}{message}")


ROTOR = {
    "rotor.csv": "property,file,description\nRtip,0.2,(m)\nRhub,0.02,(m)\nB,3,\nblade,b.csv,\n",
    "b.csv": "property,file,description\nchorddist,c.csv,\npitchdist,p.csv,\nsweepdist,s.csv,\n"
    "heightdist,h.csv,\nairfoil_files,a.csv,\nspl_k,4,\n",
    "c.csv": "r/R,c/R\n0.05,0.1\n0.5,0.2\n1.0,0.1\n",
    "p.csv": "r/R,twist (deg)\n0.15,30\n1.0,0\n",
    "s.csv": "r/R,y/R (y-distance of LE from the middle point of hub)\n0.0,0.05\n1.0,0.05\n",
    "h.csv": "r/R,z/R  (height of leading edge from top face of hub)\n0.0,0.01\n1.0,0.01\n",
    "a.csv": "r/R,Contour file,Aero file\n0.0,clarky.csv,x.csv\n1.0,naca4412.csv,y.csv\n",
}


def rotor(folder: Path, **changes: str) -> Path:
    for name, text in {**ROTOR, **changes}.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder / "rotor.csv"


def test_a_rotor_in_a_folder_of_tables(tmp_path: Path) -> None:
    """Leading edge at 0.05 R ahead and 0.01 R up; at the tip the chord of 0.1 R lies flat."""
    with pytest.warns(AssumedBladeWarning, match=r"the blade begins at r/R 0\.15, where all"):
        blade = load_propeller(rotor(tmp_path))
    assert (blade.name, blade.n_blades, blade.diameter) == ("rotor", 3, 0.4)
    np.testing.assert_allclose(blade.r_over_R, [0.15, 0.5, 1.0])
    np.testing.assert_allclose(blade.c_over_R, [0.1 + 0.1 * 0.1 / 0.45, 0.2, 0.1])
    np.testing.assert_allclose(blade.beta_deg, [30.0, 30.0 * 0.5 / 0.85, 0.0], atol=1e-12)
    assert [name for _, name in blade.airfoils] == ["clarky", "naca4412"]
    np.testing.assert_allclose([r for r, _ in blade.airfoils], [0.1, 1.0])
    assert blade.sweep_over_R[-1] == pytest.approx(-(0.05 - 0.025))
    assert blade.rake_over_R[-1] == pytest.approx(0.01)
    assert blade.rake_over_R[0] == pytest.approx(0.01 - 0.25 * blade.c_over_R[0] * 0.5)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"rotor.csv": ROTOR["rotor.csv"].replace("Rhub,0.02", "Rhub,0.3")}, "Rhub must be"),
        ({"rotor.csv": ROTOR["rotor.csv"].replace("B,3", "B,2.5")}, "B must be a whole number"),
        ({"rotor.csv": ROTOR["rotor.csv"].replace("blade,", "blades,")}, "property 'blade' is mis"),
        ({"c.csv": "r/R,c/R\n0.05,0.1\n0.9,0.1\n"}, "r/R must rise to the tip, 1"),
        ({"p.csv": "r/R,twist\n0.05,30\n1.0,0\n"}, "column 'twist' needs a unit, deg or rad"),
        ({"s.csv": "r/R,y\n0.05,30\n1.0,0\n"}, "column 'y' must be over R"),
        ({"a.csv": "r/R,Contour file\n0.0,mine.csv\n"}, "there is no contour file 'mine.csv'"),
        ({"c.csv": "r/R,c/R\n0.05,0.1\n1.0,-0.1\n"}, "c_over_R must be within 1e-06 ... 10"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_the_folder_is_one_line(
    changes: dict[str, str], message: str, tmp_path: Path
) -> None:
    with pytest.raises(PropellerError) as caught:
        load_propeller(rotor(tmp_path, **changes))
    assert message in str(caught.value) and "\n" not in str(caught.value)
    assert str(caught.value).startswith(str(tmp_path))
