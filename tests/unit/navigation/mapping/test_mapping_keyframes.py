import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.mapping.keyframes import Keyframes, replaced
from navette.navigation.mapping.memory import PlacedCostmap

S = 1_000_000_000


def costmap(stamp_ns: int, map_T_base: Pose2) -> PlacedCostmap:
    spec = GridSpec(0.1, 10, 10, map_T_base @ Pose2(-0.5, -0.5, 0.0))
    hits = map_T_base.apply(np.array([[0.4, 0.0]]))
    cells = np.zeros((10, 10), np.int8)
    at = map_T_base.x, map_T_base.y
    return PlacedCostmap(cells, spec, at, map_T_base, stamp_ns, hits=hits)


def drive(keyframes: Keyframes) -> None:
    """Drive 4 m straight ahead; odometry and map agree."""
    for second in range(5):
        pose = Pose2(float(second), 0.0, 0.0)
        keyframes.trace(second * S, pose)
        keyframes.add(costmap(second * S, pose), pose)


def test_costmaps_follow_the_corrected_trajectory() -> None:
    keyframes = Keyframes()
    drive(keyframes)
    # The second half of the drive was turned by 90 degrees after 2 m.
    trajectory = [(0, Pose2(0, 0, 0)), (2 * S, Pose2(2, 0, math.pi / 2))]
    corrected = keyframes.correct(trajectory)
    assert [each.map_T_base for each in corrected] == [
        pytest.approx(pose)
        for pose in (
            (0, 0, 0),
            (1, 0, 0),
            (2, 0, math.pi / 2),
            (2, 1, math.pi / 2),
            (2, 2, math.pi / 2),
        )
    ]
    np.testing.assert_allclose(corrected[4].hits, [[2.0, 2.4]])
    assert corrected[4].sensor == pytest.approx((2.0, 2.0))


def test_a_trajectory_that_moves_nothing_keeps_the_map() -> None:
    keyframes = Keyframes()
    drive(keyframes)
    unchanged = [(second * S, Pose2(second, 0.01, 0.0)) for second in range(5)]
    assert keyframes.correct(unchanged) == []
    assert keyframes.correct([]) == []


def test_near_costmaps_are_kept_once() -> None:
    keyframes = Keyframes()
    for number in range(10):
        pose = Pose2(0.1 * number, 0.0, 0.0)
        keyframes.trace(number * S, pose)
        keyframes.add(costmap(number * S, pose), pose)
    moved = keyframes.correct([(0, Pose2(0.0, 1.0, 0.0))])
    assert len(moved) == 3


def test_a_costmap_moves_with_its_pose() -> None:
    moved = replaced(costmap(0, Pose2(1, 0, 0)), Pose2(0, 2, math.pi / 2))
    np.testing.assert_allclose(moved.hits, [[0.0, 2.4]], atol=1e-12)
    assert moved.spec.origin == pytest.approx((0.5, 1.5, math.pi / 2))


def test_a_long_drive_keeps_the_odometry_that_the_trajectory_needs() -> None:
    """Corrected again and again, the map ends where one correction would put it."""
    often, once = Keyframes(), Keyframes()
    trajectory: list[tuple[int, Pose2]] = []
    for step in range(6000):
        stamp_ns = step * S // 10
        pose = Pose2(8.0 * math.sin(step / 500), 8.0 * math.cos(step / 300), step / 400)
        for each in (often, once):
            each.trace(stamp_ns, pose)
            each.add(costmap(stamp_ns, pose), pose)
        if step % 50 == 17:
            drifted = Pose2(pose.x + 1e-4 * step, pose.y, pose.yaw)
            trajectory.append((stamp_ns + S // 30, drifted))
            often.correct(trajectory)
    assert len(often._trace) < len(once._trace) / 3
    trajectory = [(stamp_ns, Pose2(0.5, 0.0, 0.1) @ p) for stamp_ns, p in trajectory]
    ends = [[each.map_T_base for each in k.correct(trajectory)] for k in (often, once)]
    assert len(ends[0]) == len(ends[1]) > 50
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)
