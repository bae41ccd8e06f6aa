"""Tables of pages: numbers found, levels, inputs, stations of a propeller."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from propmdao.analysis.comparisons import LEVEL_ROWS, OPERATION, flat_values, operation_and_levels
from propmdao.figures.pages.parts import Table
from propmdao.propeller.description import Propeller
from propmdao.records.quantities import ASKED

_SILENCE, _SILENT = -199.0, "silent"  # dB; silence is -200 dB
_PLACE = {"radius": "radius, m", "elevation_deg": "elevation, deg", "azimuth_deg": "azimuth, deg"}
_STATIONS = {
    "r_over_R": ("r/R", ".3f"),
    "c_over_R": ("chord c/R", ".4f"),
    "beta_deg": ("blade angle, deg", ".2f"),
    "thickness_over_chord": ("thickness t/c", ".4f"),
    "sweep_over_R": ("sweep/R", ".4f"),
    "rake_over_R": ("rake/R", ".4f"),
}


def first_numbers(result: Mapping[str, Any]) -> dict[str, str]:
    """Numbers of an operating point that are read first.

    Parameters
    ----------
    result : dict
        With the keys of ``propmdao analyze --json``.

    Returns
    -------
    dict of str to str
        Numbers with their units by name; with observers the level where it is loudest.
    """
    rows, values = operation_and_levels({**result, "observers": []})
    shown = {}
    for label, key, form in rows:
        name, _, unit = label.partition(", ")
        shown[name] = f"{format(values[key], form)} {unit}".rstrip()
    observers = result["observers"]
    if observers:
        key = "oaspl_total_dba" if "oaspl_total_dba" in observers[0] else "oaspl_dba"
        name = "loudest observer" if key == "oaspl_total_dba" else "loudest observer, tones"
        shown[name] = level_dba(max(place[key] for place in observers))
    return shown


def level(value: float) -> str:
    """Text of a level.

    Parameters
    ----------
    value : float
        Level [dB].

    Returns
    -------
    str
        The level, or a word for silence, which is -200 dB.
    """
    return f"{value:.1f}" if value > _SILENCE else _SILENT


def level_dba(value: float) -> str:
    """Text of an A-weighted level with its unit.

    Parameters
    ----------
    value : float
        Level [dBA].

    Returns
    -------
    str
        The level, or a word for silence.
    """
    return f"{level(value)} dBA" if value > _SILENCE else level(value)


def levels(observers: Sequence[Mapping[str, Any]]) -> Table:
    """Tabulate levels at all observers.

    Parameters
    ----------
    observers : sequence of dict
        Observers of a result, one at least.

    Returns
    -------
    Table
        A row for each observer.
    """
    # What is alike everywhere stands above; what is read first, the total, stands first.
    differs = {
        key: head
        for key, head in _PLACE.items()
        if key == "elevation_deg" or len({place[key] for place in observers}) > 1
    }
    known = [(label, key) for label, key in reversed(LEVEL_ROWS) if key in observers[0]]
    head = ["observer", *differs.values(), *(label for label, _ in known)]
    rows = [
        [
            str(number),
            *(f"{place[key]:.4g}" for key in differs),
            *(level(place[key]) for _, key in known),
        ]
        for number, place in enumerate(observers, start=1)
    ]
    alike = [
        f"{text.partition(',')[0]} {observers[0][key]:.4g} {text.partition(', ')[2]}"
        for key, text in _PLACE.items()
        if key not in differs
    ]
    caption = "; ".join(["Levels at the observers, re 20 µPa, rms", *alike])
    return Table(caption, head, rows, n_words=0)


def mechanisms(observers: Sequence[Mapping[str, Any]]) -> Table:
    """Tabulate broadband noise by mechanism.

    Parameters
    ----------
    observers : sequence of dict
        Observers of a result with broadband noise, one at least.

    Returns
    -------
    Table
        A row for each observer.
    """
    names = list(observers[0]["broadband_dba"])
    rows = [
        [str(number), *(level(place["broadband_dba"][name]) for name in names)]
        for number, place in enumerate(observers, start=1)
    ]
    head = ["observer", *(name.replace("_", " ") for name in names)]
    return Table("Broadband noise by mechanism, dBA re 20 µPa", head, rows, n_words=0)


def beside(results: Mapping[str, Mapping[str, Any]], observer: int | None) -> Table:
    """Tabulate results of several propellers beside each other.

    Parameters
    ----------
    results : mapping of str to dict
        Results by the name of the propeller, with the keys of ``propmdao analyze --json``.
    observer : int or None
        Index of the observer whose levels are shown; None where nobody listens.

    Returns
    -------
    Table
        Operating points and levels, each after the first with its change from it.
    """
    columns = {}
    for name, result in results.items():
        rows, columns[name] = operation_and_levels(result, observer or 0)
    first, *others = columns
    head = ["", first, *(text for name in others for text in (name, "change"))]
    cells = []
    for label, key, form in rows:
        if not key:
            cells.append([label])
            continue
        values = [column.get(key) for column in columns.values()]
        row = [label, _cell(values[0], form)]
        for value in values[1:]:
            row += [_cell(value, form), _change(values[0], value, form)]
        cells.append(row)
    return Table("Operating points and levels", head, cells)


def _cell(value: Any, form: str) -> str:
    if not isinstance(value, float):
        return ""
    return _SILENT if value < _SILENCE else format(value, form)


def _change(first: Any, value: Any, form: str) -> str:
    """Change of a number; there is none from silence or to it."""
    if not (isinstance(first, float) and isinstance(value, float)):
        return ""
    return "" if min(first, value) < _SILENCE else format(value - first, f"+z{form}")


def band(result: Mapping[str, Any]) -> Table:
    """Tabulate what inputs that are not known for sure do to the numbers.

    Parameters
    ----------
    result : dict
        With the keys of ``propmdao analyze --json``, among them the band.

    Returns
    -------
    Table
        A row for each number, a column for each input: the change with the input at its upper end
        and at its lower end.
    """
    effects, whole = result["band"]["effects"], result["band"]
    operation = {key: (label, form) for label, key, form in OPERATION}
    labels, values = [], dict[str, Any]()
    for key in whole["above"]:
        if key == "spl_bpf_db":
            values[key] = [place[key] for place in result["observers"]]
            labels += [
                (f"tone at blade passage, observer {k}, dB", ".2f")
                for k, _ in enumerate(values[key], start=1)
            ]
        else:
            labels.append(operation[key])
            values[key] = result[key]
    # With each input, and all together: changes at the upper and at the lower end.
    ends = [(e["changes"][1], e["changes"][0]) for e in effects] + [
        (whole["above"], whole["below"])
    ]
    columns = [tuple(None if end is None else flat_values(end) for end in pair) for pair in ends]
    rows = [
        [label, format(value, form)]
        + [" / ".join("-" if e is None else f"{e[k]:+z{form}}" for e in pair) for pair in columns]
        for k, ((label, form), value) in enumerate(zip(labels, flat_values(values), strict=True))
    ]
    heads = [
        f"{e['name']} {e['ends'][0]:g} to {e['ends'][1]:g} {e['unit']}".rstrip() for e in effects
    ]
    caption = (
        "Changes with an input at its upper / lower end; band: root of the sum of their squares"
    )
    return Table(caption, ["", "value", *heads, "band"], rows)


def inputs(result: Mapping[str, Any]) -> Table:
    """Tabulate everything that was asked, with what it means.

    Parameters
    ----------
    result : dict
        With keys of ``propmdao analyze --json``: point, change, model, listening, polars, those
        that there are.

    Returns
    -------
    Table
        A row for each input.
    """
    by_key = {quantity.json: quantity for quantity in ASKED.values()}
    asked: list[list[str]] = []
    parts = {name: result[name] for name in ("point", "change", "model") if name in result}
    if "listening" in result:
        parts["around"] = result["listening"]["surroundings"]
    for part, content in parts.items():
        asked.append([{"around": "ground and air"}.get(part, part)])
        for path, value in _leaves(content):
            quantity = by_key.get(path[-1])
            meaning = quantity.meaning if quantity else " ".join(path).replace("_", " ")
            unit = _unit(quantity.unit) if quantity else ""
            asked.append([meaning, _value(value), unit])
    for airfoil, source in result.get("polars", {}).items():
        asked.append([f"polars of {airfoil}", source, ""])
    return Table("Inputs", ["what", "value", "unit"], asked, n_words=3)


def _leaves(content: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Every value of nested dictionaries with its keys."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield from _leaves(value, (*path, key))
    else:
        yield path, content


def _unit(unit: str) -> str:
    """A unit of OpenMDAO for people."""
    return unit.replace("**3", "³").replace("**2", "²").replace("*", " ")


def _value(value: Any) -> str:
    """Text of an input."""
    if value is None:
        return "not given"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.7g}" if isinstance(value, float) else str(value)


def stations(name: str, propeller: Propeller) -> Table:
    """Tabulate the stations of a propeller.

    Parameters
    ----------
    name : str
        Name of the propeller.
    propeller : Propeller
        The propeller.

    Returns
    -------
    Table
        A row for each station.
    """
    columns = [getattr(propeller, name) for name in _STATIONS]
    known = [
        (head, form, values)
        for (head, form), values in zip(_STATIONS.values(), columns, strict=True)
        if values is not None
    ]
    rows = [
        [format(float(value), form) for (_, form, _), value in zip(known, station, strict=True)]
        for station in zip(*(values for *_, values in known), strict=True)
    ]
    heads = [head for head, *_ in known]
    return Table(f"Stations of {name}", heads, rows, n_words=0)


def described(propeller: Mapping[str, Any]) -> Table:
    """Tabulate what a propeller is, before any change, and where its numbers come from.

    Parameters
    ----------
    propeller : dict
        The propeller of a result.

    Returns
    -------
    Table
        Diameter, blades, checksum of the description, source.
    """
    rows = [
        ["diameter", f"{propeller['diameter']:.5g} m"],
        ["blades", str(propeller["n_blades"])],
        ["checksum", propeller["checksum"]],
        ["source", propeller["source"] or "not given"],
    ]
    return Table(f"Propeller {propeller['name']}", ["as described", ""], rows, n_words=2)
