"""Files that commands write: checked before the work, not after it."""

from __future__ import annotations

import contextlib
import csv
import importlib.util
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.runtime.output_files import (
    OutputError,
    replacing,
    replacing_in,
    require_folder,
    require_writable,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def require_output(option: str, path: Path, ending: str = "") -> None:
    """Refuse a file that cannot be written.

    Parameters
    ----------
    option : str
        Option that names the file.
    path : Path
        The file.
    ending : str
        Ending that the file needs; any by default.

    Raises
    ------
    ValueError
        If it ends otherwise or cannot be written.
    """
    if ending and path.suffix.lower() != ending:
        raise ValueError(f"{option} {path}: the file must end in {ending}")
    with _naming(option):
        require_writable(path)


def require_output_folder(option: str, folder: Path) -> None:
    """Refuse a folder that cannot be made or written to.

    Parameters
    ----------
    option : str
        Option that names the folder.
    folder : Path
        The folder.

    Raises
    ------
    ValueError
        If it cannot.
    """
    with _naming(option):
        require_folder(folder)


def require_matplotlib(option: str) -> None:
    """Refuse figures where matplotlib, an extra, is not installed.

    Asked last: what is wrong with a request is wrong everywhere, what is missing is missing here.

    Parameters
    ----------
    option : str
        Option that asks for figures.

    Raises
    ------
    ValueError
        If it is not installed.
    """
    if importlib.util.find_spec("matplotlib") is None:
        raise ValueError(f"{option} needs matplotlib: pip install 'propmdao[plots]'")


def write_csv(path: Path, heads: Iterable[str], rows: Iterable[Iterable[Any]]) -> None:
    """Write a table as a CSV file.

    Parameters
    ----------
    path : Path
        CSV file to write or replace.
    heads : iterable of str
        Heads of the columns.
    rows : iterable of iterable
        Cells of each row.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    with replacing(path) as file, file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(heads)
        writer.writerows(rows)


def save_figures(folder: Path, figures: Mapping[str, Figure]) -> list[str]:
    """Write figures as PNG files.

    Parameters
    ----------
    folder : Path
        Folder of the files, made where there is none.
    figures : mapping of str to Figure
        Figures by the name of the file.

    Returns
    -------
    list of str
        The files.

    Raises
    ------
    OutputError
        If the folder cannot be written.
    """
    with replacing_in(folder) as files:
        for name, figure in figures.items():
            figure.savefig(files / f"{name}.png")
    return [str(folder / f"{name}.png") for name in figures]


@contextlib.contextmanager
def _naming(option: str) -> Iterator[None]:
    """Put an option in front of what is wrong with its file."""
    try:
        yield
    except OutputError as error:
        raise ValueError(f"{option} {error}") from None
