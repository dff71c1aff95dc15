"""The predictive controller drives a lagging robot along paths and around obstacles."""

import math

import numpy as np
import pytest
from control_plant import Plant, big_robot, run, tangent_path
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.errors import InvalidValueError
from navette.geometry import Footprint, Pose2, advanced
from navette.navigation.control import ControlParams
from navette.navigation.control.follower import nearest_index
from navette.navigation.control.limits import STOP, SpeedCap
from navette.navigation.control.predictive_follower import (
    PredictiveFollower,
    _nearest_index,
    _window,
)
from navette.navigation.control.rollouts import METRES_PER_RADIAN

PATHS = {
    "straight": np.array([[0, 0], [10, 0.0]]),
    "corner_45": np.array([[0, 0], [5, 0], [10, 5.0]]),
    "zigzag": np.array([[0, 0], [2, 0], [4, 0.7], [6, 0], [8, 0.7], [10, 0.0]]),
}

BIG = big_robot(method="mppi")


def follower(**values: object) -> PredictiveFollower:
    return PredictiveFollower(big_robot(method="mppi", **values))


@pytest.mark.parametrize("name", PATHS)
def test_a_path_is_followed_to_its_end(name: str) -> None:
    line = PATHS[name]
    path = tangent_path(line)
    robot, plant = follower(), Plant(Pose2(*path[0]))
    robot.set_path(path)
    result = run(robot, plant, 40.0)
    assert result.final.state == "reached"
    assert result.off(line) < 0.6, "free corners are cut, by less than the body"
    assert math.dist((plant.pose.x, plant.pose.y), line[-1]) < 0.15
    v = np.array([o.command.speed for o in result.outputs])
    omega = np.array([o.command.turn_rate for o in result.outputs])
    assert np.abs(np.diff(omega)).max() <= 0.1 + 1e-9
    assert np.diff(v).max() <= 0.05 + 1e-9
    assert result.final.command == STOP


def test_a_path_in_reverse_is_driven_in_reverse() -> None:
    path = tangent_path(np.array([[0, 0], [3, 0.0]]), reverse=True)
    robot, plant = follower(), Plant(Pose2(*path[0]))
    robot.set_path(path)
    result = run(robot, plant, 40.0)
    assert result.final.state == "reached"
    assert max(o.command.speed for o in result.outputs) < 0.05


def test_a_turn_in_place_is_driven() -> None:
    robot, plant = follower(), Plant(Pose2(0, 0, 0))
    yaws = np.linspace(0, 2.5, 14)
    robot.set_path(np.stack((0 * yaws, 0 * yaws, yaws), axis=1))
    run(robot, plant, 30.0)
    assert plant.pose.yaw == pytest.approx(2.5, abs=0.1)
    assert math.hypot(plant.pose.x, plant.pose.y) < 0.3


def test_an_obstacle_beside_the_path_is_given_room() -> None:
    """The path passes 0.8 m beside a post; half of the body is 0.7 m wide."""
    path = tangent_path(np.array([[0, 0], [10, 0.0]]))
    post = np.array([[5.0, 0.8], [5.0, 0.9], [5.1, 0.8]])
    robot, plant = follower(), Plant(Pose2(*path[0]))
    robot.set_obstacles(post, 0.05)
    robot.set_path(path)
    result = run(robot, plant, 40.0)
    assert result.final.state == "reached"
    abeam = [p.y for p in result.poses if 4.5 < p.x < 5.5]
    assert max(abeam) < -0.02, "the robot moves away from the post"


def test_a_wall_across_the_path_stops_the_robot() -> None:
    path = tangent_path(np.array([[0, 0], [10, 0.0]]))
    wall = np.stack((np.full(120, 6.0), np.arange(-6, 6, 0.1)), axis=1)
    robot, plant = follower(), Plant(Pose2(*path[0]))
    robot.set_obstacles(wall, 0.05)
    robot.set_path(path)
    result = run(robot, plant, 20.0)
    front = 1.5  # the body's front edge ahead of the axle
    assert max(p.x for p in result.poses) + front < 5.95 - 0.02
    assert abs(plant.speed) < 0.1
    assert result.final.state == "blocked", "the planner may know another path"


def test_the_same_inputs_give_the_same_commands() -> None:
    def drive() -> list[tuple[float, float]]:
        path = tangent_path(PATHS["zigzag"])
        robot, plant = follower(), Plant(Pose2(*path[0]))
        robot.set_path(path)
        return [tuple(o.command) for o in run(robot, plant, 5.0).outputs]

    assert drive() == drive()


def test_a_speed_limit_holds() -> None:
    path = tangent_path(PATHS["straight"])
    robot, plant = follower(), Plant(Pose2(*path[0]))
    robot.limit_speed(SpeedCap(0.4, 0.4))
    robot.set_path(path)
    result = run(robot, plant, 10.0)
    assert 0.3 < max(o.command.speed for o in result.outputs) <= 0.4 + 1e-9


@pytest.mark.parametrize(
    "path",
    [np.zeros((3, 2)), np.array([[0, 0, math.nan]]), np.array([[1e12, 0, 0.0]])],
)
def test_an_invalid_path_is_refused_and_the_old_one_dropped(path: np.ndarray) -> None:
    robot = follower()
    robot.set_path(tangent_path(PATHS["straight"]))
    with pytest.raises(InvalidValueError, match="path"):
        robot.set_path(path)
    assert not robot.has_path


def test_a_narrow_passage_is_driven_through() -> None:
    """Walls 4 m long leave 8 cm beside the body: no reason to wait before them."""
    path = tangent_path(np.array([[0, 0], [12, 0.0]]))
    robot, plant = follower(), Plant(Pose2(*path[0]))
    half_width = max(y for _, y in Footprint.from_flat(BIG.footprint_m).vertices)
    x = np.arange(4, 8, 0.05)
    side = np.full(len(x), half_width + 0.08)
    walls = [np.column_stack([x, side]), np.column_stack([x, -side])]
    robot.set_obstacles(np.concatenate(walls), 0.0)
    robot.set_path(path)
    result = run(robot, plant, 45.0)
    assert result.final.state == "reached"
    assert min(o.clearance_m for o in result.outputs) > 0.01


JACKAL = ControlParams(
    method="mppi",
    cruise_speed_mps=2.0,
    reverse_speed_mps=0.4,
    max_speed_mps=2.0,
    max_turn_rate_radps=1.5,
    acceleration_mps2=2.0,
    deceleration_mps2=2.0,
    turn_acceleration_radps2=4.0,
    goal_tolerance_m=0.1,
    footprint_m=(0.25, 0.215, -0.25, 0.215, -0.25, -0.215, 0.25, -0.215),
)


def test_the_last_centimetres_in_a_narrow_place_are_driven() -> None:
    """4 cm beside the body and a wall ahead: nearly all noise collides."""
    robot, plant = PredictiveFollower(JACKAL), Plant(Pose2(0.0, 0.0, 0.0))
    along, across = np.arange(-1.0, 0.6, 0.01), np.arange(-0.3, 0.3, 0.01)
    walls = [np.column_stack([along, 0 * along + y]) for y in (0.26, -0.26)]
    walls.append(np.column_stack([0 * across + 0.56, across]))
    robot.set_obstacles(np.concatenate(walls), 0.0)
    robot.set_path(tangent_path(np.array([[0, 0], [0.25, 0.0]])))
    result = run(robot, plant, 20.0)
    assert result.final.state == "reached"
    assert min(o.clearance_m for o in result.outputs) > 0.02


CAR = ControlParams(
    drive="ackermann",
    method="mppi",
    min_turning_radius_m=0.77,
    steering_time_s=0.15,
    cruise_speed_mps=1.5,
    reverse_speed_mps=0.6,
    max_turn_rate_radps=3.0,
    acceleration_mps2=1.5,
    deceleration_mps2=2.0,
    turn_acceleration_radps2=12.0,
    lateral_acceleration_mps2=2.5,
    mppi_clearance_m=0.15,
    mppi_align_weight=12.0,
    mppi_heading_weight=2.0,
    mppi_reverse_weight=2.0,
    footprint_m=(0.46, 0.16, -0.12, 0.16, -0.12, -0.16, 0.46, -0.16),
)


def three_point_turn(spacing: float = 0.07) -> tuple[np.ndarray, int]:
    """Return a path that turns left, in reverse and then forward, and its cusp."""
    pose, poses, bend = Pose2(0, 0, 0), [], 1 / 0.85
    for direction, count, curvature in ((-1, 18, bend), (1, 25, bend), (1, 40, 0.0)):
        for _ in range(count):
            poses.append(tuple(pose))
            pose = advanced(pose, direction * spacing, curvature * spacing, 1.0)
    return np.array([*poses, tuple(pose)]), 18


@pytest.mark.parametrize("before", range(5))
def test_a_car_that_turns_round_before_a_cusp_drives_on(before: int) -> None:
    path, cusp = three_point_turn()
    plant = Plant(Pose2(*path[cusp - before]), lag_s=0.05, turning=1.0)
    car = PredictiveFollower(CAR)
    car.set_path(path)
    assert run(car, plant, 8.0).final.state == "reached"


def test_a_path_that_is_published_again_is_followed_from_the_robot() -> None:
    """A planner may repeat its path: the robot is then far from its start."""
    path = tangent_path(np.array([[0, 0], [30, 0.0]]))
    robot, plant = follower(), Plant(Pose2(25.0, 0.0, 0.0))
    speeds = []
    for _ in range(20):
        robot.set_path(path)
        (output,) = run(robot, plant, 0.05).outputs
        assert output.state == "following"
        assert output.distance_left_m < 5.1
        speeds.append(output.command.speed)
    assert speeds[-1] > 0.3


@pytest.mark.parametrize(
    ("beside_m", "ahead", "path_y", "bend_rad"),
    [
        (-0.04, (0.39, -0.4), 0.09, 0.2),
        (-0.05, (0.58, -0.31), 0.14, 0.1),
        (-0.05, (0.66, -0.3), 0.05, 0.4),
    ],
)
def test_a_robot_at_rest_close_to_a_post_drives_on(
    beside_m: float, ahead: tuple[float, float], path_y: float, bend_rad: float
) -> None:
    """A post beside the body leaves 2 mm more than the margin, the next one a bend.

    The mean of the candidates turns towards the post and is refused at every step.
    """
    half_width, radius = 0.2, 0.075
    body = (0.25, half_width, -0.25, half_width, -0.25, -half_width, 0.25, -half_width)
    robot = follower(
        footprint_m=body,
        cruise_speed_mps=2.0,
        acceleration_mps2=1.5,
        turn_acceleration_radps2=4.0,
    )
    beside = (beside_m, -half_width - radius - BIG.collision_margin_m - 0.002)
    around = radius * np.exp(1j * np.arange(0, math.tau, 0.1))
    ring = np.column_stack([around.real, around.imag])
    robot.set_obstacles(np.concatenate([ring + beside, ring + ahead]), 0.0)
    end = (0.4 + 2 * math.cos(bend_rad), path_y + 2 * math.sin(bend_rad))
    robot.set_path(tangent_path(np.array([[0, path_y], [0.4, path_y], end])))
    result = run(robot, Plant(Pose2(0.0, 0.0, 0.0)), 12.0)
    assert result.final.state == "reached"
    assert min(o.clearance_m for o in result.outputs) > 0.02


def test_rollouts_begin_at_the_robot_and_the_cheapest_follows_the_path() -> None:
    path = tangent_path(PATHS["straight"])
    robot, plant = follower(), Plant(Pose2(*path[0]))
    assert robot.rollouts(10) is None, "no step yet"
    robot.set_path(path)
    run(robot, plant, 3.0)
    found = robot.rollouts(12)
    assert found is not None
    assert len(found.costs) == 12
    assert (np.diff(found.costs) >= 0).all()
    begin = found.positions[:, 0]
    assert np.hypot(begin[:, 0] - plant.pose.x, begin[:, 1] - plant.pose.y).max() < 0.3
    lengths = np.hypot(*np.diff(found.positions, axis=1).T).sum(axis=0)
    params = big_robot(method="mppi")
    horizon_s = params.mppi_steps * params.mppi_step_s
    assert lengths.max() <= params.cruise_speed_mps * horizon_s + 1e-6
    best = found.positions[0]
    assert best[-1, 0] > best[0, 0] + 0.5
    assert np.abs(best[:, 1]).max() < 0.3


def test_without_a_path_there_are_no_rollouts() -> None:
    path = tangent_path(PATHS["straight"])
    robot, plant = follower(), Plant(Pose2(*path[0]))
    robot.set_path(path)
    run(robot, plant, 1.0)
    robot.set_path(np.empty((0, 3)))
    run(robot, plant, 0.2)
    assert robot.rollouts(5) is None


@settings(max_examples=200, deadline=None)
@given(seed=st.integers(0, 100_000))
def test_the_nearest_pose_is_that_of_other_followers(seed: int) -> None:
    rng = np.random.default_rng(seed)
    poses = np.cumsum(rng.normal(0, 0.1, (int(rng.integers(1, 60)), 3)), axis=0)
    if rng.random() < 0.3:
        poses[len(poses) // 2 :, :2] = poses[len(poses) // 2, :2]  # turn in place
    path = _window(poses)
    x, y, yaw = rng.normal(0, 0.5, 3).tolist()
    c, s = math.cos(yaw), math.sin(yaw)
    at, ahead_m = int(rng.integers(0, len(poses))), float(rng.choice([0.1, 0.5, 2.0]))

    def distances(near: slice) -> np.ndarray:
        away = np.hypot(x - path.x[near], y - path.y[near])
        cosine = np.clip(c * path.cos[near] + s * path.sin[near], -1, 1)
        return np.asarray(away + METRES_PER_RADIAN * np.arccos(cosine))

    plain = nearest_index(path.measure, at, ahead_m, distances)
    assert _nearest_index(path, at, ahead_m, (x, y, c, s)) == plain
