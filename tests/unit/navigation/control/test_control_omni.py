"""The rules of a robot that drives forward hold for one that moves sideways."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.control import ControlParams, FollowerInputs
from navette.navigation.control.followers import make_follower
from navette.navigation.control.limits import SpeedCap
from navette.navigation.control.states import ControlState

PARAMS = ControlParams(
    drive="omni",
    method="omni_tracking",
    max_side_speed_mps=0.5,
    cruise_speed_mps=0.5,
    goal_tolerance_m=0.2,
    footprint_m=(0.25, 0.25, -0.25, 0.25, -0.25, -0.25, 0.25, -0.25),
)
DT = 0.05


def speeds(
    heading: float,
    each: Callable[[Any, int, Callable[..., np.ndarray]], None],
    *,
    at_m: float = 0.0,
    speed: float = 0.0,
    steps: int = 60,
) -> list[float]:
    """Return the speed of each step along a path of 3 m with a fixed heading.

    Args:
        heading: of the path, seen from the robot.
        each: called before each step with follower, step, and a function from points
            along and across the path to the map.
        at_m: start on the path.
        speed: measured at the start.
    """

    def turned(points: Any) -> np.ndarray:
        along, across = np.atleast_2d(points).T
        c, s = math.cos(heading), math.sin(heading)
        return np.column_stack([c * along - s * across, s * along + c * across])

    follower = make_follower(PARAMS)
    length = np.linspace(0.0, 3.0, 61)
    way = turned(np.column_stack([length, 0 * length]))
    follower.set_path(np.column_stack([way, 0 * length]))
    follower.set_obstacles(np.empty((0, 2)), 0.0)
    place = turned((at_m, 0.0))[0]
    velocity = turned((speed, 0.0))[0]
    found = []
    for step in range(steps):
        each(follower, step, turned)
        forward, side = velocity.tolist()
        inputs = FollowerInputs(Pose2(*place, 0.0), forward, 0.0, side_speed=side)
        output = follower.step(inputs, DT)
        if output.state is ControlState.REACHED:
            break
        velocity = np.array((output.command.speed, output.command.side))
        place = place + DT * velocity
        found.append(float(np.hypot(*velocity)))
    return found


def with_limit(follower: Any, step: int, turned: Any) -> None:
    follower.limit_speed(SpeedCap(0.1, 0.1))


def with_obstacle_ahead(follower: Any, step: int, turned: Any) -> None:
    if step == 20:
        follower.set_obstacles(turned((1.05, 0.0)), 0.0)


def with_person(follower: Any, step: int, turned: Any) -> None:
    place, velocity = turned([(1.6 - 0.03 * step, 0.0), (-0.6, 0.0)])
    follower.set_moving(np.array([(*place, *velocity, 0.3)]))


def with_nothing(follower: Any, step: int, turned: Any) -> None:
    pass


@pytest.mark.parametrize(
    ("each", "start"),
    [
        (with_limit, {}),
        (with_obstacle_ahead, {}),
        (with_person, {"steps": 20}),
        (with_nothing, {"speed": 0.5}),
        (with_nothing, {"speed": 0.5, "at_m": 2.95}),
        (with_nothing, {"steps": 200}),
    ],
)
def test_speeds_are_those_of_a_drive_forward(each: Any, start: dict[str, Any]) -> None:
    ahead = speeds(0.0, each, **start)
    assert len(ahead) > 1
    for heading in (math.pi / 2, -math.pi / 2):
        assert speeds(heading, each, **start) == pytest.approx(ahead, abs=1e-6)


def test_the_heading_is_reached_after_the_position() -> None:
    follower = make_follower(PARAMS)
    length = np.linspace(0.0, 1.0, 21)
    follower.set_path(np.column_stack([length, 0 * length, 0 * length + 1.5]))
    follower.set_obstacles(np.empty((0, 2)), 0.0)
    pose = Pose2(1.0, 0.002, 0.0)
    for _ in range(100):
        output = follower.step(FollowerInputs(pose, 0.0, 0.0), DT)
        if output.state is ControlState.REACHED:
            break
        pose = Pose2(pose.x, pose.y, pose.yaw + DT * output.command.turn_rate)
    assert output.state is ControlState.REACHED
    assert pose.yaw == pytest.approx(1.5, abs=0.1)
