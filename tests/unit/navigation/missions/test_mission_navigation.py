"""The tree of a navigation before its first tick."""

from pathlib import Path

import pytest
from tree_robot import Planted

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.navigation.missions.navigation import (
    Navigation,
    NavigationEnd,
    TreeNavigator,
)


@pytest.mark.parametrize(
    ("pose_after_s", "how"), [(1.5, "reached"), (2.5, "failed"), (0.0, "reached")]
)
def test_the_tree_starts_when_the_pose_is_known_or_after_two_seconds(
    tmp_path: Path, pose_after_s: float, how: str
) -> None:
    planted = Planted(tmp_path, '<GetCurrentPose current_pose="{here}"/>')
    robot, ends = planted.robot, list[NavigationEnd]()
    navigator = TreeNavigator(robot, ())
    robot.here = None
    navigator.start(Navigation([PoseStamped()], planted.path, on_end=ends.append))
    for tick in range(30):
        if tick / 10 >= pose_after_s:
            robot.here = Pose2(0.0, 0.0, 0.0)
        navigator.step()
        if ends:
            break
        robot.wait(0.1)
    assert [end.how for end in ends] == [how]
    assert robot.now_ns == round(min(pose_after_s, 2.0) * 1e9)
