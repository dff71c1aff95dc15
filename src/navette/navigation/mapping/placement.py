"""Queue of costmaps that wait for the pose at their stamp.

A scan and the odometry around it arrive in either order. A costmap placed with another
pose leaves phantom obstacles, so it waits until the pose at its stamp is available, and
is dropped otherwise.
"""

from collections import deque
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from navette.geometry import Pose2

Item = TypeVar("Item")


class PoseHistory(Protocol):
    """Poses by stamp, as :class:`~navette.runtime.stage.odometry.PoseTracker`."""

    @property
    def stamp_ns(self) -> int | None:
        """Stamp of the newest pose; None before the first."""

    def pose_at(self, stamp_ns: int) -> Pose2 | None:
        """Return map_T_base interpolated at a stamp; None outside the history."""


@dataclass(frozen=True)
class Ready(Generic[Item]):
    """An item with ``map_T_base`` at its stamp."""

    item: Item
    stamp_ns: int
    map_T_base: Pose2


@dataclass(frozen=True)
class Dropped:
    """A dropped item and the reason."""

    stamp_ns: int
    reason: str


class PlacementQueue(Generic[Item]):
    """FIFO of at most ``capacity`` items, each waiting for at most ``wait_ns``."""

    def __init__(self, wait_ns: int, capacity: int = 8) -> None:
        self.wait_ns = wait_ns
        self._waiting: deque[tuple[int, int, Item]] = deque(maxlen=capacity)

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, item: Item, stamp_ns: int, now_ns: int) -> None:
        """Append an item; a full queue drops its oldest."""
        self._waiting.append((stamp_ns, now_ns, item))

    def take(
        self,
        poses: PoseHistory,
        now_ns: int,
    ) -> tuple[list[Ready[Item]], list[Dropped]]:
        """Return the items that can be placed now, and the dropped ones.

        Args:
            poses: provides map_T_base at a stamp, or None if not available.
            now_ns: the node's time.
        """
        ready: list[Ready[Item]] = []
        dropped: list[Dropped] = []
        still: list[tuple[int, int, Item]] = []
        for stamp_ns, arrived_ns, item in self._waiting:
            pose = poses.pose_at(stamp_ns)
            if pose is not None:
                ready.append(Ready(item, stamp_ns, pose))
            elif poses.stamp_ns is not None and stamp_ns <= poses.stamp_ns:
                dropped.append(Dropped(stamp_ns, "its pose is no longer stored"))
            elif now_ns - arrived_ns >= self.wait_ns:
                dropped.append(Dropped(stamp_ns, "no pose arrived for it"))
            else:
                still.append((stamp_ns, arrived_ns, item))
        self._waiting.clear()
        self._waiting.extend(still)
        return ready, dropped
