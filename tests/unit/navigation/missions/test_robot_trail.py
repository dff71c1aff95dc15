"""The way back along the trail of the robot."""

import math

import pytest

from navette.geometry import Pose2
from navette.navigation.missions.robot.trail import DrivenTrail


def driven(*xs: float) -> DrivenTrail:
    """Trail of a robot that drives along x in steps of 2 cm to one x after another."""
    trail, at = DrivenTrail(), 0.0
    for x in xs:
        count = round(abs(x - at) / 0.02)
        for step in range(count + 1):
            trail.add(Pose2(at + (x - at) * step / count, 0.0, 0.0))
        at = x
    return trail


def test_the_way_back_has_the_length_and_the_headings_of_the_drive() -> None:
    back = driven(2.0).back(Pose2(2.0, 0.0, 0.0), 1.0)
    assert back[0] == Pose2(2.0, 0.0, 0.0)
    assert back[-1].x == pytest.approx(1.0, abs=0.06)
    assert all(pose.yaw == 0.0 for pose in back)


@pytest.mark.parametrize("turned_back_at", [0.8, 0.97, 1.2])
def test_a_robot_that_has_backed_up_does_not_go_forward_again(
    turned_back_at: float,
) -> None:
    back = driven(1.3, turned_back_at).back(Pose2(turned_back_at, 0.0, 0.2), 0.5)
    assert max(pose.x for pose in back[1:]) < turned_back_at + 0.06
    assert back[-1].x == pytest.approx(turned_back_at - 0.5, abs=0.1)


def test_a_robot_that_turned_round_has_a_way_back_to_where_it_turned() -> None:
    trail = driven(1.0)
    for step in range(20):
        trail.add(Pose2(1.0 - 0.02 * step, 0.0, math.pi))
    back = trail.back(Pose2(0.6, 0.0, math.pi), 0.3)
    assert back[-1].x == pytest.approx(0.9, abs=0.06)
