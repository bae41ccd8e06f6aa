"""What components refuse: inputs and results that are no numbers, and complex steps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import openmdao.api as om

from propmdao.runtime.finite import Axis, NotFiniteError, require_finite


def require_real(component: om.ExplicitComponent) -> None:
    """Refuse a complex step.

    Parameters
    ----------
    component : om.ExplicitComponent
        Component whose function is of real numbers.

    Raises
    ------
    RuntimeError
        If OpenMDAO is under complex step.
    """
    if component.under_complex_step:
        raise RuntimeError(
            f"{type(component).__name__} has exact derivatives and no complex step: check them"
            ' with method="fd", and let groups around it take its derivatives'
        )


def require_numbers(
    kind: str,
    values: Mapping[str, Any],
    axes: Mapping[str, tuple[Axis, ...]] | None = None,
    where: str = "",
) -> None:
    """Refuse variables that are not finite.

    Parameters
    ----------
    kind : str
        Beginning of the message before the name, such as "input "; may be empty.
    values : mapping of str to array
        Variables by name.
    axes : mapping of str to tuple, optional
        Words for the leading axes of variables, for the message.
    where : str
        End of the message.

    Raises
    ------
    om.AnalysisError
        If a variable is not finite; the message has its name and place.
    """
    try:
        for name, value in values.items():
            require_finite(kind + name, value, *(axes or {}).get(name, ()), where=where)
    except NotFiniteError as error:
        raise om.AnalysisError(str(error)) from error


def require_finite_products(products: Mapping[str, Any], seeds: Mapping[str, Any]) -> None:
    """Refuse derivatives that are not finite, unless the seeds were not.

    Parameters
    ----------
    products : mapping of str to array
        Products of derivatives by the name of the variable that they are of.
    seeds : mapping of str to array
        Seeds by variable; what is wrong with them is not this component's.

    Raises
    ------
    om.AnalysisError
        If a product is not finite.
    """
    if all(np.isfinite(seed).all() for seed in seeds.values()):
        require_numbers("derivative at ", products)
