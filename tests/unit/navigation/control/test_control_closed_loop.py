"""The follower drives a lagging, weakly turning robot along all kinds of paths."""

import math

import numpy as np
import pytest
from control_plant import Plant, Run, big_robot, drive_path, run, tangent_path

from navette.geometry import Pose2
from navette.navigation.control import (
    STOP,
    ControlParams,
    FollowerInputs,
    InputAges,
    PathFollower,
)
from navette.navigation.grids import body_distance

METHODS = ("pure_pursuit", "cross_track_pid")
_X = np.linspace(0, 12, 200)
PATHS = {
    "straight": np.array([[0, 0], [10, 0.0]]),
    "s_curve": np.stack((_X, 1.5 * np.sin(_X / 2)), axis=1),
    "corner_30": np.array([[0, 0], [5, 0], [10, 2.9]]),
    "corner_45": np.array([[0, 0], [5, 0], [10, 5.0]]),
    "corner_90": np.array([[0, 0], [5, 0], [5, 5.0]]),
    "zigzag": np.array([[0, 0], [2, 0], [4, 0.7], [6, 0], [8, 0.7], [10, 0.0]]),
}
# Seconds for the big robot forwards; 10 m at 1.5 m/s and 1 m/s² take 8.2 s.
TIMES = {
    "straight": 9.0,
    "s_curve": 17.5,
    "corner_30": 11.0,
    "corner_45": 12.0,
    "corner_90": 13.5,
    "zigzag": 15.5,
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", PATHS)
@pytest.mark.parametrize("reverse", [False, True])
def test_paths_are_followed_closely(method: str, name: str, reverse: bool) -> None:
    line = PATHS[name]
    result, plant = drive_path(
        tangent_path(line, reverse=reverse), big_robot(method=method)
    )
    assert result.final.state == "reached"
    assert result.off(line) < (0.09 if method == "pure_pursuit" else 0.12)
    assert math.dist((plant.pose.x, plant.pose.y), line[-1]) < 0.06
    assert plant.speed == pytest.approx(0.0, abs=0.05)
    if not reverse:
        assert result.time_s < TIMES[name]


@pytest.mark.parametrize("method", METHODS)
def test_speed_and_turn_rate_change_within_the_limits(method: str) -> None:
    result, _ = drive_path(tangent_path(PATHS["corner_90"]), big_robot(method=method))
    v = np.array([o.command.speed for o in result.outputs])
    omega = np.array([o.command.turn_rate for o in result.outputs])
    assert np.abs(np.diff(v)).max() <= 0.05 + 1e-9
    assert np.abs(np.diff(omega)).max() <= 0.1 + 1e-9
    assert np.abs(omega).max() <= 1.0


def test_the_robot_neither_overshoots_the_end_nor_creeps_to_it() -> None:
    result, _ = drive_path(tangent_path(PATHS["straight"]), big_robot())
    assert max(p.x for p in result.poses) < 10.01
    slow = [v for v in result.speeds if v < 0.1]
    assert len(slow) * result.dt < 0.7
    assert result.final.command == STOP


@pytest.mark.parametrize("turning", [0.75, 1.0])
@pytest.mark.parametrize("angle", [0.7, math.pi / 2, -2.5])
def test_a_turn_in_place_does_not_overshoot(turning: float, angle: float) -> None:
    follower = PathFollower(big_robot())
    follower.set_path(np.array([[0, 0, 0], [0, 0, angle]]))
    plant = Plant(Pose2(0, 0, 0), turning=turning)
    result = run(follower, plant, 20.0)
    assert result.states() == ["turning", "reached"]
    assert plant.pose.yaw == pytest.approx(angle, abs=0.05)
    furthest = max(p.yaw * math.copysign(1, angle) for p in result.poses)
    assert furthest < abs(angle) + 0.03
    assert result.time_s < abs(angle) / turning + 1.6


def test_a_turn_planned_in_the_longer_direction_keeps_it() -> None:
    follower = PathFollower(big_robot())
    yaws = np.linspace(0, -1.5 * math.pi, 10)
    follower.set_path(np.stack((0 * yaws, 0 * yaws, yaws), axis=1))
    plant = Plant(Pose2(0, 0, 0))
    result = run(follower, plant, 20.0)
    assert plant.pose.yaw == pytest.approx(math.pi / 2, abs=0.05)
    assert all(o.command.turn_rate <= 0 for o in result.outputs)


@pytest.mark.parametrize("method", METHODS)
def test_reverse_out_of_a_corner_then_turn_then_forward(method: str) -> None:
    yaw = -0.75 * math.pi
    back = tangent_path(np.array([[-13.2, -13.2], [-12, -12.0]]), reverse=True)
    turn = [(-12, -12, a) for a in np.linspace(yaw, -1.5 * math.pi, 6)]
    away = tangent_path(np.array([[-12, -12], [-12, -9.0]]))
    follower = PathFollower(big_robot(method=method))
    wall = np.arange(-14.75, 0, 0.1)
    level = np.full_like(wall, -14.75)
    walls = np.concatenate(
        (np.stack((wall, level), axis=1), np.stack((level, wall), axis=1))
    )
    follower.set_obstacles(walls, 0.05)
    follower.set_path(np.concatenate((back, turn, away)))
    plant = Plant(Pose2(-13.2, -13.2, yaw))
    result = run(follower, plant, 30.0)
    assert result.states() == ["following", "turning", "following", "reached"]
    assert result.time_s < 16.0
    assert closest(result, walls) > 0.0


def test_the_robot_stops_at_a_cusp_and_reverses() -> None:
    back = tangent_path(np.array([[0, 0], [-2, 0.0]]), reverse=True)
    ahead = tangent_path(np.array([[-2, 0], [1, 0.5]]))
    result, plant = drive_path(np.concatenate((back, ahead)), big_robot())
    assert result.final.state == "reached"
    assert -2.05 < min(p.x for p in result.poses) < -1.9
    assert plant.pose.x == pytest.approx(1.0, abs=0.05)


def test_a_path_that_crosses_itself_is_driven_completely() -> None:
    t = np.linspace(0, math.tau, 300)
    eight = np.stack((5 * np.sin(t), 3 * np.sin(2 * t)), axis=1)
    result, _ = drive_path(tangent_path(eight), big_robot())
    assert result.final.state == "reached"
    assert result.off(eight) < 0.09
    assert max(p.x for p in result.poses) > 4.9
    assert min(p.x for p in result.poses) < -4.9


@pytest.mark.parametrize("method", METHODS)
def test_a_new_path_while_driving_does_not_stop_the_robot(method: str) -> None:
    line = PATHS["s_curve"]
    poses = tangent_path(line)
    follower = PathFollower(big_robot(method=method))
    follower.set_path(poses)
    plant = Plant(Pose2(0, 0, float(poses[0, 2])))
    result = run(follower, plant, 4.0)
    assert result.final.state == "following"
    for _ in range(8):
        near = np.argmin(
            np.hypot(poses[:, 0] - plant.pose.x, poses[:, 1] - plant.pose.y)
        )
        follower.set_path(poses[near:])
        more = run(follower, plant, 0.5)
        assert min(more.speeds) > 0.6
        assert more.off(line) < 0.1


def test_a_new_path_in_the_opposite_direction_stops_and_turns_the_robot() -> None:
    follower = PathFollower(big_robot())
    follower.set_path(tangent_path(PATHS["straight"]))
    plant = Plant(Pose2(0, 0, 0))
    run(follower, plant, 3.0)
    assert plant.speed > 1.0
    x = plant.pose.x
    follower.set_path(tangent_path(np.array([[x, 0], [x - 5, 0.0]])))
    result = run(follower, plant, 20.0)
    assert result.states() == ["turning", "following", "reached"]
    assert max(p.x for p in result.poses) < x + 1.4


def seg(a: tuple[float, float], b: tuple[float, float]) -> np.ndarray:
    return np.linspace(a, b, int(math.dist(a, b) / 0.1) + 1)


def closest(result: Run, points: np.ndarray) -> float:
    outline = np.array(big_robot().footprint_m).reshape(-1, 2)
    return min(
        body_distance(points, outline, p.x, p.y, p.yaw, 1.7, 5.0) - 0.05
        for p in result.poses
    )


@pytest.mark.parametrize("cruise", [0.5, 1.5, 2.0])
def test_the_robot_stops_before_a_wall_across_its_path(cruise: float) -> None:
    wall = seg((6, -2), (6, 2))
    follower = PathFollower(big_robot(cruise_speed_mps=cruise))
    follower.set_path(tangent_path(PATHS["straight"]))
    plant = Plant(Pose2(0, 0, 0))
    run(follower, plant, 2.0)
    follower.set_obstacles(wall, 0.05)
    result = run(follower, plant, 10.0)
    assert result.final.state == "blocked"
    assert 0.03 < closest(result, wall) < 0.12
    assert abs(plant.speed) < 1e-3
    follower.set_obstacles(np.empty((0, 2)), 0.05)
    assert run(follower, plant, 20.0).final.state == "reached"


def test_a_turn_uses_the_free_direction() -> None:
    post = np.array([[1.0, 1.0]])
    follower = PathFollower(big_robot())
    follower.set_obstacles(post, 0.05)
    follower.set_path(tangent_path(np.array([[0, 0], [0, 5.0]])))
    plant = Plant(Pose2(0, 0, 0))
    result = run(follower, plant, 20.0)
    assert result.final.state == "reached"
    assert closest(result, post) > 0.2
    assert min(o.command.turn_rate for o in result.outputs) == pytest.approx(-1.0)


def test_a_turn_blocked_in_both_directions_is_reported() -> None:
    posts = np.array([[1.0, 1.0], [1.0, -1.0]])
    follower = PathFollower(big_robot())
    follower.set_obstacles(posts, 0.05)
    follower.set_path(tangent_path(np.array([[0, 0], [0, 5.0]])))
    plant = Plant(Pose2(0, 0, 0))
    result = run(follower, plant, 5.0)
    assert result.states() == ["blocked"]
    assert plant.pose == (0, 0, 0)


def test_a_small_turn_that_is_not_free_is_steered_instead() -> None:
    post = np.array([[1.4, 0.75]])
    follower = PathFollower(big_robot())
    follower.set_obstacles(post, 0.05)
    follower.set_path(tangent_path(np.array([[0, 0], [5, 4.2]])))
    plant = Plant(Pose2(0, 0, 0))
    result = run(follower, plant, 5.0)
    assert min(o.command.turn_rate for o in result.outputs) > -0.2
    assert closest(result, post) > 0.0


def test_obstacles_beside_the_path_do_not_slow_the_robot_down() -> None:
    walls = np.concatenate((seg((-3, 0.83), (14, 0.83)), seg((-3, -0.83), (14, -0.83))))
    follower = PathFollower(big_robot())
    follower.set_obstacles(walls, 0.05)
    follower.set_path(tangent_path(PATHS["straight"]))
    result = run(follower, Plant(Pose2(0, 0, 0)), 40.0)
    assert result.final.state == "reached"
    assert max(result.speeds) > 1.45
    assert "clearance" not in {output.limited_by for output in result.outputs}


def test_an_obstacle_on_the_path_is_approached_slowly() -> None:
    params = big_robot()
    follower = PathFollower(params)
    follower.set_obstacles(np.array([[8.0, 0.4]]), 0.05)
    follower.set_path(tangent_path(PATHS["straight"]))
    plant = Plant(Pose2(0, 0, 0))
    result = run(follower, plant, 20.0)
    assert result.final.state == "blocked"
    assert closest(result, np.array([[8.0, 0.4]])) > params.collision_margin_m
    limits = [output.limited_by for output in result.outputs]
    slow = limits.index("clearance")
    assert result.speeds[slow] > 1.0
    braking = np.diff(result.speeds[slow:])
    assert braking.min() > -0.08  # no sudden stop


@pytest.mark.parametrize(
    ("ages", "state"),
    [
        (InputAges(odometry_s=0.5), "stale_odometry"),
        (InputAges(costmap_s=0.5), "stale_costmap"),
        (InputAges(planner_s=3.0), "stale_path"),
    ],
)
def test_stale_inputs_stop_at_once_and_fresh_ones_continue(
    ages: InputAges, state: str
) -> None:
    follower = PathFollower(big_robot())
    follower.set_path(tangent_path(PATHS["straight"]))
    plant = Plant(Pose2(0, 0, 0))
    run(follower, plant, 2.0)
    output = follower.step(FollowerInputs(plant.pose, plant.speed, 0.0, ages), 0.05)
    assert output.command == STOP
    assert output.state == state
    assert run(follower, plant, 20.0).final.state == "reached"


def test_an_empty_path_and_a_reset_stop_at_once() -> None:
    follower = PathFollower(big_robot())
    for forget in (lambda: follower.set_path(np.empty((0, 3))), follower.reset):
        follower.set_path(tangent_path(PATHS["straight"]))
        plant = Plant(Pose2(0, 0, 0))
        assert run(follower, plant, 2.0).final.state == "following"
        forget()
        [output] = run(follower, plant, 0.5).outputs
        assert (output.command, output.state) == (STOP, "idle")


def test_far_from_its_path_the_robot_stops() -> None:
    follower = PathFollower(big_robot())
    follower.set_path(tangent_path(PATHS["straight"]))
    output = follower.step(FollowerInputs(Pose2(2.0, 3.0, 0.0), 0.0, 0.0), 0.05)
    assert (output.command, output.state) == (STOP, "off_path")


def test_a_goal_passed_at_a_distance_is_missed() -> None:
    follower = PathFollower(ControlParams())
    follower.set_path(tangent_path(PATHS["straight"]))
    for x in np.arange(0.0, 10.2, 0.2):
        output = follower.step(
            FollowerInputs(Pose2(float(x), 0.4, 0.0), 0.0, 0.0), 0.05
        )
    assert output.state == "missed_goal"


def test_the_same_run_twice_gives_the_same_commands() -> None:
    runs = [drive_path(tangent_path(PATHS["zigzag"]), big_robot())[0] for _ in range(2)]
    assert runs[0].outputs == runs[1].outputs
