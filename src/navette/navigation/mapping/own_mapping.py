"""Mapping methods of the user: what they get, and the checks of what they return."""

from typing import Any, Protocol

import numpy as np

from navette.navigation.grids import UNKNOWN, GridSpec, checked_cells, merge
from navette.navigation.grids.spec import Cells
from navette.navigation.mapping.methods import MAPPINGS
from navette.navigation.mapping.params import MapMemoryParams
from navette.params.plugins import own_call


class UpdateMethod(Protocol):
    """A mapping method as a function of arrays."""

    def update(self, cells: Cells, seen: Cells, grid: GridSpec) -> Any:
        """Return the new map (H, W): −1 unknown, 0 free … 100 occupied.

        Args:
            cells: (H, W) the map so far; it may grow between two calls.
            seen: (H, W) the newest costmap on the same cells; −1 where it saw nothing.
            grid: geometry of both in the map frame.
        """


class OwnMapping:
    """Maps of a user's method; its faults raise MethodFaultError."""

    def __init__(self, method: UpdateMethod, name: str) -> None:
        self._method = method
        self._name = f"mapping {name}: update(cells, seen, grid)"

    def update(
        self, cells: Cells, spec: GridSpec, costmap: Cells, costmap_spec: GridSpec
    ) -> Cells:
        """Return the map with a costmap, whose geometry is in the map frame.

        Raises:
            MethodFaultError: the method raised, or returned something else.
        """
        seen = np.full(spec.shape, UNKNOWN, np.int8)
        merge(seen, spec, costmap, costmap_spec)
        update = self._method.update
        returned = own_call(self._name, update, cells.copy(), seen, spec)
        return checked_cells(self._name, returned, spec.shape)


def own_mapping(params: MapMemoryParams) -> OwnMapping | None:
    """Return the user's method of ``params.fusion``; None for one of Navette's."""
    method = MAPPINGS.load(params.fusion)
    if method.entry != "update":
        return None
    return OwnMapping(method.make(params), method.name)
