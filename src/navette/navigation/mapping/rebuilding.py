"""The map fused again in a worker, while the present one is still in use."""

from collections.abc import Callable, Sequence
from typing import TypeVar

from navette.navigation.background import Background
from navette.navigation.mapping.memory import MapMemory, PlacedCostmap

T = TypeVar("T")
Change = Callable[[MapMemory], T]
OnRebuilt = Callable[[], None]
"""Called when a rebuilt map has replaced the present one."""


class RebuildingMemory:
    """A map memory that another one replaces after a correction of the trajectory.

    Fusing hundreds of costmaps takes half a second, in which a robot in the same
    process would get no command.

    Attributes:
        memory: the present map; to be changed by :meth:`change` only.

    Args:
        memory: the first map.
        worker: fuses the costmaps.
    """

    def __init__(
        self, memory: MapMemory, worker: Background, *, on_rebuilt: OnRebuilt
    ) -> None:
        self.memory = memory
        self._worker = worker
        self._on_rebuilt = on_rebuilt
        self._next: MapMemory | None = None  # that the worker fills
        self._changes: list[Change[object]] = []  # of the present map meanwhile

    def drop(self) -> None:
        """Leave the map that the worker fills."""
        self._next = None

    def change(self, change: Change[T]) -> T:
        """Change the map, and then also the one that the worker fills."""
        if self._next is not None:
            self._changes.append(change)
        return change(self.memory)

    def rebuild(self, costmaps: Sequence[PlacedCostmap]) -> None:
        """Replace the map by one of other costmaps."""
        self._changes = []
        self._next = rebuilt = self.memory.emptied()

        def fuse() -> None:
            for costmap in costmaps:
                rebuilt.fuse(costmap)

        self._worker.run(
            fuse,
            lambda _: self._finish(rebuilt),
            is_dropped=lambda: self._next is not rebuilt,
        )

    def _finish(self, rebuilt: MapMemory) -> None:
        self.memory, self._next = rebuilt, None
        for change in self._changes:
            change(rebuilt)
        self._on_rebuilt()
