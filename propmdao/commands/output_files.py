"""Files that commands write: checked before the work, not after it."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def require_writable(option: str, path: Path, ending: str) -> None:
    """Refuse a file that cannot be written.

    Parameters
    ----------
    option : str
        Which names it.
    path : Path
        The file.
    ending : str
        That it needs.

    Raises
    ------
    ValueError
        If it ends otherwise or there is no such folder.
    """
    if path.suffix.lower() != ending:
        raise ValueError(f"{option} {path}: the file must end in {ending}")
    if not path.absolute().parent.is_dir():
        raise ValueError(f"{option} {path}: there is no folder {path.parent}")


def require_figures(option: str) -> None:
    """Refuse figures where matplotlib, an extra, is not installed.

    Parameters
    ----------
    option : str
        Which asks for figures.

    Raises
    ------
    ValueError
        If it is not.
    """
    if importlib.util.find_spec("matplotlib") is None:
        raise ValueError(f"{option} needs matplotlib: pip install 'propmdao[plots]'")


def save_figures(folder: Path, figures: Mapping[str, Figure]) -> list[str]:
    """Write figures as PNG files.

    Parameters
    ----------
    folder : Path
        Made where there is none.
    figures : mapping of str to Figure
        By the name of the file.

    Returns
    -------
    list of str
        The files.

    Raises
    ------
    ValueError
        If the folder cannot be written.
    """
    files = [folder / f"{name}.png" for name in figures]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for file, figure in zip(files, figures.values(), strict=True):
            figure.savefig(file)
    except OSError as error:
        raise ValueError(f"{folder}: {error.strerror or error}") from None
    return [str(file) for file in files]
