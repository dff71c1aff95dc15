from navette.geometry import Pose2
from navette.navigation.mapping.placement import PlacementQueue

WAIT_NS = 500


def poses_until(newest_ns: int, oldest_ns: int = 0):
    """A robot that moves 1 m per 100 ns, known between two stamps."""

    def pose_at(stamp_ns: int) -> Pose2 | None:
        if not oldest_ns <= stamp_ns <= newest_ns:
            return None
        return Pose2(stamp_ns / 100, 0.0, 0.0)

    return pose_at, newest_ns


def test_a_costmap_gets_the_pose_at_its_own_stamp() -> None:
    """The fault to avoid: the newest pose at hand would leave phantom cells."""
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 150, 200)
    ready, dropped = queue.take(*poses_until(200), 200)
    assert [(r.item, r.map_T_base.x) for r in ready] == [("a", 1.5)]
    assert not dropped
    assert len(queue) == 0


def test_it_waits_for_the_odometry_that_comes_after_it() -> None:
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 150, 150)
    assert queue.take(*poses_until(100), 160) == ([], [])
    assert len(queue) == 1
    ready, _ = queue.take(*poses_until(200), 200)
    assert [r.stamp_ns for r in ready] == [150]


def test_it_is_dropped_when_no_pose_comes() -> None:
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 150, 150)
    assert queue.take(lambda _: None, None, 649) == ([], [])
    ready, dropped = queue.take(lambda _: None, None, 650)
    assert not ready
    assert [(d.stamp_ns, d.reason) for d in dropped] == [
        (150, "no pose arrived for it")
    ]
    assert len(queue) == 0


def test_it_is_dropped_when_older_than_the_history() -> None:
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 50, 300)
    ready, dropped = queue.take(*poses_until(300, oldest_ns=100), 300)
    assert not ready
    assert [d.reason for d in dropped] == ["its pose is no longer known"]


def test_order_is_kept_and_the_oldest_gives_way() -> None:
    queue = PlacementQueue[str](WAIT_NS, capacity=2)
    for stamp, item in ((110, "a"), (120, "b"), (130, "c")):
        queue.add(item, stamp, stamp)
    ready, _ = queue.take(*poses_until(125), 130)
    assert [r.item for r in ready] == ["b"]
    ready, _ = queue.take(*poses_until(200), 200)
    assert [r.item for r in ready] == ["c"]


def test_clear_forgets() -> None:
    queue = PlacementQueue[str](WAIT_NS)
    queue.add("a", 150, 150)
    queue.clear()
    assert len(queue) == 0
