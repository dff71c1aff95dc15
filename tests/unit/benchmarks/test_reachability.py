"""Reachability from exact geometry, and the random drives that it judges."""

import numpy as np
import pytest
from random_goals import ROBOTS, random_goal
from reachability import Reach, WorldGeometry, goal_reach

from navette.geometry import ACKERMANN, DIFFERENTIAL, Pose2

BODY = np.array([(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)])


def box(x: float, y: float, wide: float, deep: float) -> np.ndarray:
    unit = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
    return unit * (wide, deep) + (x, y)


def room(door_m: float) -> list[np.ndarray]:
    """A room of 6 m × 4 m with a wall across and a door in its middle."""
    side = (4 - door_m) / 2
    return [
        box(0, 2.1, 6.4, 0.2),
        box(0, -2.1, 6.4, 0.2),
        box(3.1, 0, 0.2, 4),
        box(-3.1, 0, 0.2, 4),
        box(0, door_m / 2 + side / 2, 0.1, side),
        box(0, -door_m / 2 - side / 2, 0.1, side),
    ]


@pytest.mark.parametrize(
    ("door_m", "goal", "reach"),
    [
        (0.56, (2.0, 0.0), Reach.SURE),
        (0.42, (2.0, 0.0), Reach.UNSURE),
        (0.3, (2.0, 0.0), Reach.ENCLOSED),
        (0.0, (2.0, 0.0), Reach.ENCLOSED),
        (0.8, (5.0, 0.0), Reach.ENCLOSED),
    ],
)
def test_a_door_decides(door_m: float, goal: tuple[float, float], reach: Reach) -> None:
    start = Pose2(-2.0, 0.7, 2.0)
    found = goal_reach(
        room(door_m), BODY, start, goal, drive=DIFFERENTIAL, tolerance_m=0.3
    )
    assert found is reach


@pytest.mark.parametrize(
    ("radius_m", "reach"), [(0.8, Reach.SURE), (30.0, Reach.UNSURE)]
)
def test_a_car_needs_room_to_turn(radius_m: float, reach: Reach) -> None:
    """The door lies ahead to the left, and the goal beyond it."""
    found = goal_reach(
        room(0.7),
        BODY,
        Pose2(-2.0, -1.2, 0.0),
        (2.2, 0.0),
        drive=ACKERMANN,
        tolerance_m=0.3,
        turning_radius_m=radius_m,
    )
    assert found is reach


def test_a_goal_deep_in_an_obstacle_is_blocked() -> None:
    obstacles = [*room(0.8), box(1.6, 0.0, 1.6, 1.6)]
    start = Pose2(-2.0, 0.0, 0.0)
    found = goal_reach(
        obstacles, BODY, start, (1.6, 0.0), drive=DIFFERENTIAL, tolerance_m=0.3
    )
    assert found is Reach.BLOCKED


def test_open_poses_keep_the_exact_distance() -> None:
    wall = box(0.0, 1.0, 4.0, 0.2)
    world = WorldGeometry.around([wall], BODY, np.array([(0.0, -1.0)]), 0.5)
    opened = world.open_poses(0.05)
    heading, _, column = world.index_of(Pose2(0.0, 0.0, 0.0))
    ys = world.spec.origin.y + (np.arange(world.spec.height) + 0.5) * (
        world.spec.resolution
    )
    below = ys < 1.0
    assert (opened[heading, below, column] == (ys[below] < 0.9 - 0.2 - 0.05)).all()
    across = opened[18, below, column]  # turned by 90°
    assert (across == (ys[below] < 0.9 - 0.3 - 0.05)).all()


@pytest.mark.parametrize("robot", ROBOTS)
def test_random_drives_are_the_same_for_a_seed(robot: str) -> None:
    one, other = random_goal(robot, 3), random_goal(robot, 3)
    assert (one.start, one.goal, one.kinds) == (other.start, other.goal, other.kinds)
    assert np.array_equal(
        np.concatenate(one.obstacles), np.concatenate(other.obstacles)
    )
    assert random_goal(robot, 4).start != one.start
