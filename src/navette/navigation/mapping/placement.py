"""Costmaps that wait for the pose at their stamp.

A scan and the odometry around it arrive in either order. A costmap placed with
whatever pose is at hand leaves phantom obstacles, so it waits until the pose at its
own stamp can be told, and is dropped if that does not happen.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from navette.geometry import Pose2

Item = TypeVar("Item")


@dataclass(frozen=True)
class Ready(Generic[Item]):
    """An item whose pose is known: ``map_T_base`` at its stamp."""

    item: Item
    stamp_ns: int
    map_T_base: Pose2


@dataclass(frozen=True)
class Dropped:
    """An item that was given up, and why."""

    stamp_ns: int
    reason: str


class PlacementQueue(Generic[Item]):
    """First in, first out; at most ``capacity`` wait, for at most ``wait_ns``."""

    def __init__(self, wait_ns: int, capacity: int = 8) -> None:
        self.wait_ns = wait_ns
        self._waiting: deque[tuple[int, int, Item]] = deque(maxlen=capacity)

    def __len__(self) -> int:
        return len(self._waiting)

    def clear(self) -> None:
        """Forget what waits."""
        self._waiting.clear()

    def add(self, item: Item, stamp_ns: int, now_ns: int) -> None:
        """Let an item wait; of too many the oldest is forgotten."""
        self._waiting.append((stamp_ns, now_ns, item))

    def take(
        self,
        pose_at: Callable[[int], Pose2 | None],
        newest_pose_ns: int | None,
        now_ns: int,
    ) -> tuple[list[Ready[Item]], list[Dropped]]:
        """Items that can be placed now, and those given up; the rest waits on.

        Args:
            pose_at: map_T_base at a stamp, or None where it is not known.
            newest_pose_ns: stamp of the newest pose, None before the first.
            now_ns: the node's time.
        """
        ready: list[Ready[Item]] = []
        dropped: list[Dropped] = []
        still: list[tuple[int, int, Item]] = []
        for stamp_ns, arrived_ns, item in self._waiting:
            pose = pose_at(stamp_ns)
            if pose is not None:
                ready.append(Ready(item, stamp_ns, pose))
            elif newest_pose_ns is not None and stamp_ns <= newest_pose_ns:
                dropped.append(Dropped(stamp_ns, "its pose is no longer known"))
            elif now_ns - arrived_ns >= self.wait_ns:
                dropped.append(Dropped(stamp_ns, "no pose arrived for it"))
            else:
                still.append((stamp_ns, arrived_ns, item))
        self._waiting.clear()
        self._waiting.extend(still)
        return ready, dropped
