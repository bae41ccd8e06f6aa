"""The progress bar of a driver."""

from __future__ import annotations

from openmdao.core.driver import Driver
from openmdao.utils.options_dictionary import OptionsDictionary
from tqdm import tqdm


def declare_progress(options: OptionsDictionary) -> None:
    """Declare whether there is a bar, as `progress_bar` reads it."""
    options.declare(
        "progress", True, types=bool, desc="Progress bar on stderr, if it is a terminal."
    )


def progress_bar(driver: Driver, total: int, unit: str) -> tqdm:
    """Bar that counts what a driver has done, under the driver's name.

    Parameters
    ----------
    driver : Driver
        Driver with the option of `declare_progress`.
    total : int
        Count at which the bar is full.
    unit : str
        Word for one of what is counted.

    Returns
    -------
    tqdm
        Bar, a context manager; it stays silent where the option or stderr ask for it.
    """
    silent = None if driver.options["progress"] else True  # None: where stderr is no terminal
    return tqdm(total=total, desc=driver._get_name(), unit=unit, disable=silent)
