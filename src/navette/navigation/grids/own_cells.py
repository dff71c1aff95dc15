"""Cells that a user's method returned."""

from typing import Any

import numpy as np

from navette.navigation.grids.spec import LETHAL, UNKNOWN, Cells
from navette.params.plugins import MethodFaultError, checked_array


def checked_cells(name: str, returned: Any, shape: tuple[int, int]) -> Cells:
    """Return costs of a user's method as cells.

    Raises:
        MethodFaultError: another shape, not finite, or out of −1 … 100.
    """
    expected = f"costs −1 … 100 of shape {shape}"
    costs = checked_array(name, returned, expected, lambda s: s == shape)
    if costs.min() < UNKNOWN or costs.max() > LETHAL:
        raise MethodFaultError(
            f"{name} returned costs {costs.min():g} … {costs.max():g}; expected "
            f"{expected}"
        )
    return np.rint(costs).astype(np.int8)
