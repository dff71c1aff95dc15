"""Costmaps wait for the pose at their stamp."""

from dataclasses import dataclass

from navette.geometry import Pose2
from navette.navigation.mapping.placement import PlacementQueue

WAIT_NS = 500


@dataclass
class PosesUntil:
    """A robot that moves 1 m per 100 ns, with poses between two stamps."""

    stamp_ns: int | None
    oldest_ns: int = 0

    def pose_at(self, stamp_ns: int) -> Pose2 | None:
        if self.stamp_ns is None or not self.oldest_ns <= stamp_ns <= self.stamp_ns:
            return None
        return Pose2(stamp_ns / 100, 0.0, 0.0)


def test_a_costmap_gets_the_pose_at_its_own_stamp() -> None:
    """The newest pose instead would leave phantom cells."""
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 150, 200)
    ready, dropped = queue.take(PosesUntil(200), 200)
    assert [(r.item, r.map_T_base.x) for r in ready] == [("a", 1.5)]
    assert not dropped
    assert len(queue) == 0


def test_a_costmap_waits_for_later_odometry() -> None:
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 150, 150)
    assert queue.take(PosesUntil(100), 160) == ([], [])
    assert len(queue) == 1
    ready, _ = queue.take(PosesUntil(200), 200)
    assert [r.stamp_ns for r in ready] == [150]


def test_a_costmap_without_a_pose_is_dropped() -> None:
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 150, 150)
    assert queue.take(PosesUntil(None), 649) == ([], [])
    ready, dropped = queue.take(PosesUntil(None), 650)
    assert not ready
    assert [(d.stamp_ns, d.reason) for d in dropped] == [
        (150, "no pose arrived for it")
    ]
    assert len(queue) == 0


def test_a_costmap_older_than_the_history_is_dropped() -> None:
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 50, 300)
    ready, dropped = queue.take(PosesUntil(300, oldest_ns=100), 300)
    assert not ready
    assert [d.reason for d in dropped] == ["its pose is no longer stored"]


def test_a_full_queue_drops_its_oldest_item() -> None:
    queue = PlacementQueue[str](WAIT_NS, capacity=2)
    for stamp, item in ((110, "a"), (120, "b"), (130, "c")):
        queue.add(item, stamp, stamp)
    ready, _ = queue.take(PosesUntil(125), 130)
    assert [r.item for r in ready] == ["b"]
    ready, _ = queue.take(PosesUntil(200), 200)
    assert [r.item for r in ready] == ["c"]
