"""The whole map as messages, of which only the changed cells are copied."""

import sys
from dataclasses import dataclass

from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.navigation.grids import (
    NO_CELLS,
    CellWindow,
    GridSpec,
    grid_to_message,
    resize_grid_message,
    update_grid_message,
)
from navette.navigation.grids.spec import Cells

# The newest, the one before it, which a slow reader may still have, and one to change.
_MOST_KEPT = 3
# References to an object that only its owner has: the owner's, and the argument.
_UNUSED = 2


@dataclass
class _Kept:
    """A message, and the cells that have changed since."""

    message: OccupancyGrid
    spec: GridSpec
    outdated: CellWindow

    @property
    def is_unused(self) -> bool:
        """Whether no reader has the message or an array that shares its cells."""
        return (
            sys.getrefcount(self.message) <= _UNUSED
            and sys.getrefcount(self.message.data) <= _UNUSED
        )

    def fit(self, spec: GridSpec) -> None:
        """Use another extent; a larger one needs memory for what is added only."""
        if spec != self.spec:
            resize_grid_message(self.message, spec)
            self.spec, self.outdated = spec, CellWindow.whole(spec.shape)


class WholeMaps:
    """Messages of a map that changes in small parts.

    A message that was handed over belongs to its readers. Once none of them has it any
    more it becomes the next message, which differs in a few cells: at 200 m a new one
    takes 10 ms, most of it for new memory.
    """

    def __init__(self) -> None:
        self._kept: list[_Kept] = []

    def note_change(self, window: CellWindow | None) -> None:
        """Note which cells changed; None: all of them, and perhaps the extent."""
        for kept in self._kept:
            changed = CellWindow.whole(kept.spec.shape) if window is None else window
            kept.outdated = kept.outdated.union(changed)

    def message(
        self, cells: Cells, spec: GridSpec, frame_id: str, stamp_ns: int
    ) -> OccupancyGrid:
        """Return the map (H, W) as a message that does not change while it is used."""
        for index, kept in enumerate(self._kept):
            if kept.is_unused:
                kept.fit(spec)
                update_grid_message(
                    kept.message, cells, kept.outdated, frame_id, stamp_ns
                )
                kept.outdated = NO_CELLS
                self._kept.append(self._kept.pop(index))
                return kept.message
        message = grid_to_message(cells, spec, frame_id, stamp_ns)
        self._kept = [*self._kept, _Kept(message, spec, NO_CELLS)][-_MOST_KEPT:]
        return message
