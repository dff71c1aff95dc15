"""The environment follows Gymnasium's API, is repeatable, and means what it states."""

import math
import subprocess
import sys
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import navette.navigation.gym
from navette.errors import InvalidValueError, ParameterError, UnknownNameError
from navette.geometry import Pose2
from navette.navigation.gym import NavigationEnv
from navette.sim import World, load_robot

ID = "navette/Navigation-v0"
FORWARD = np.array([1.0, 0.0], np.float32)
STAND = np.zeros(2, np.float32)


def make(world: Any = "empty", **values: Any) -> NavigationEnv:
    values.setdefault("robot", "turtlebot3_burger")
    env = gymnasium.make(ID, world=world, **values).unwrapped
    assert isinstance(env, NavigationEnv)
    return env


def drive(env: NavigationEnv, seed: int, steps: int = 20) -> list[Any]:
    observation, info = env.reset(seed=seed)
    rows: list[Any] = [(observation, info["pose"])]
    actions = np.random.default_rng(seed).uniform(-1, 1, (steps, 2))
    for action in actions.astype(np.float32):
        observation, reward, terminated, truncated, info = env.step(action)
        rows.append((observation, info["pose"], reward))
        if terminated or truncated:
            break
    return rows


def flat(rows: list[Any]) -> np.ndarray[Any, Any]:
    parts = [[*row[0].values(), *map(np.atleast_1d, row[1:])] for row in rows]
    return np.concatenate([np.ravel(each) for part in parts for each in part])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("world", "robot"),
    [("barn-like:3", "jackal"), ("arena", None), ("maze", "husky")],
)
def test_gymnasiums_checker_has_no_complaint(world: str, robot: str | None) -> None:
    env = gymnasium.make(ID, world=world, robot=robot, render_mode="rgb_array")
    check_env(env.unwrapped)  # warnings are errors


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["sync", "async"])
def test_a_vector_of_environments_equals_single_ones(mode: str) -> None:
    actions = np.random.default_rng(0).uniform(-1, 1, (5, 2, 2)).astype(np.float32)
    values: dict[str, Any] = {"world": "arena", "robot": "jackal", "beams": 16}
    many = gymnasium.make_vec(ID, num_envs=2, vectorization_mode=mode, **values)
    many.reset(seed=[4, 5])
    single = gymnasium.make(ID, **values)
    single.reset(seed=5)
    for action in actions:
        observations, rewards, *_ = many.step(action)
        observation, reward, *_ = single.step(action[1])
        assert rewards[1] == reward
        for name, value in observation.items():
            np.testing.assert_array_equal(observations[name][1], value)
    many.close()


@pytest.mark.parametrize("world", ["arena", "rooms"])
def test_a_seed_gives_one_trajectory(world: str) -> None:
    noisy = {"sim": {"lidar_noise_m": 0.02, "lidar_dropout": 0.05}}
    env = make(world, parameters=noisy, worlds=2)
    first, again, other = drive(env, 1), drive(env, 1), drive(env, 2)
    np.testing.assert_array_equal(flat(first), flat(again))
    fresh = make(world, parameters=noisy, worlds=2)
    np.testing.assert_array_equal(flat(first), flat(drive(fresh, 1)))
    assert not np.array_equal(flat(first)[:400], flat(other)[:400])


def test_without_a_seed_episodes_differ() -> None:
    env = make("arena")
    _, first = env.reset(seed=0)
    _, second = env.reset()
    assert not np.array_equal(first["pose"], second["pose"])


def test_the_goal_is_observed_in_the_robots_frame() -> None:
    env = make()
    observation, info = env.reset(
        options={"start": (1.0, 2.0, math.pi / 2), "goal": (0.0, 4.0)}
    )
    np.testing.assert_allclose(observation["goal"], (2.0, 1.0), atol=0.01)
    assert info["distance_m"] == pytest.approx(math.hypot(1, 2), rel=0.09)


def test_ranges_are_those_of_the_lidar() -> None:
    world = World("wall").add_box((2.0, 0.0), (0.2, 8.0)).scene()
    env = make(world, beams=4, start=(0.0, 0.0, 0.0), goal=(-1.5, 0.0))
    ranges = env.reset(seed=0)[0]["ranges"]
    # sectors begin ahead and turn left; the wall's face is 1.9 m from the base
    sensor_x_m = -0.032
    assert ranges[0] == pytest.approx(1.9 - sensor_x_m, abs=0.05)
    assert ranges[1] == ranges[2] == np.float32(env.observer.range_max_m)


@pytest.mark.parametrize("robot", ["jackal", "turtlebot3_burger"])
def test_ranges_to_obstacle_points_are_about_those_of_the_lidar(robot: str) -> None:
    env = make("forest:5", robot=robot, beams=24)
    observation, info = env.reset(seed=0)
    space = env._world.space
    cells = np.argwhere((space.occupied > 0) & (space.room_m < space.spec.resolution))
    points = space.spec.centers_of(cells)
    ranges = env.observer.ranges_to(points, Pose2(*info["pose"]))
    from_points = env.observer.observe(ranges, Pose2(*info["pose"]), (0, 0), (0, 0))
    near = observation["ranges"] < 5.0
    assert near.sum() >= 3
    gap = np.abs(from_points["ranges"] - observation["ranges"])[near]
    assert np.median(gap) < 0.1


def test_full_action_is_the_largest_speed() -> None:
    env = make(limit_s=1000.0)
    env.reset(seed=0, options={"start": (0, 0, 0), "goal": (9, 9)})
    for _ in range(20):
        observation, *_ = env.step(FORWARD)
    limits = env._world.simulator.params
    assert observation["velocity"][0] == pytest.approx(limits.max_speed_mps, rel=0.05)
    for _ in range(20):
        observation, *_ = env.step(-FORWARD)
    reverse = -limits.max_reverse_speed_mps
    assert observation["velocity"][0] == pytest.approx(reverse, rel=0.05)


def test_reaching_the_goal_ends_the_episode_with_its_reward() -> None:
    env = make("empty", robot="jackal", time_penalty=0.2)
    env.reset(options={"start": (0.0, 0.0, 0.0), "goal": (3.0, 0.0)})
    rewards: list[float] = []
    terminated = False
    while not terminated:
        _, reward, terminated, truncated, info = env.step(FORWARD)
        rewards.append(reward)
        assert not truncated
    assert info["outcome"] == "reached"
    assert info["distance_m"] < 0.6
    expected = 10.0 + (3.0 - info["distance_m"]) - 0.2 * 0.1 * len(rewards)
    assert sum(rewards) == pytest.approx(expected, abs=0.06)


def test_a_contact_ends_the_episode_and_is_named() -> None:
    world = World("wall").add_box((2.0, 0.0), (0.2, 8.0)).scene()
    env = make(world, robot="jackal", start=(0, 0, 0), goal=(3.5, 5.0))
    env.reset(seed=0)
    for _ in range(60):
        _, reward, terminated, _, info = env.step(FORWARD)
        if terminated:
            break
    assert info["outcome"] == "contact"
    assert info["contact_with"].startswith("box")
    assert reward < -9


def test_time_truncates() -> None:
    env = make(limit_s=0.5)
    env.reset(seed=0)
    ends = [env.step(STAND)[2:4] for _ in range(5)]
    assert ends == [(False, False)] * 4 + [(False, True)]


def test_options_choose_start_goal_and_world() -> None:
    env = make("forest", robot="jackal")
    _, first = env.reset(seed=0, options={"world_seed": 7})
    assert first["world_seed"] == 7
    _, second = env.reset(options={"world_seed": 7, "goal": (8.0, 8.0)})
    assert np.array_equal(first["pose"], second["pose"])
    assert second["distance_m"] != first["distance_m"]
    _, drawn = env.reset()
    assert drawn["world_seed"] >= env.params.first_world


def test_a_lookahead_leads_round_the_obstacle() -> None:
    world = World("wall").add_box((0.0, -2.0), (0.2, 6.0)).scene()
    ends: dict[str, Any] = {"start": (-1.5, 0.0, 0.0), "goal": (1.5, 0.0)}
    straight = make(world, **ends).reset(seed=0)[0]["goal"]
    ahead, info = make(world, lookahead_m=1.0, **ends).reset(seed=0)
    np.testing.assert_allclose(straight, (3.0, 0.0), atol=0.01)
    assert np.hypot(*ahead["goal"]) == pytest.approx(1.0, abs=0.1)
    assert ahead["goal"][1] > 0.3  # up, round the wall's end
    assert info["distance_m"] > 3.3


def test_wheel_odometry_is_observed_if_the_robot_has_it() -> None:
    noisy = {"sim": {"localization": "odometry", "wheel_noise_m": 0.3}}
    env = make(robot="jackal", parameters=noisy, limit_s=1000.0)
    env.reset(seed=1, options={"start": (-8, 0, 0), "goal": (9, 9)})
    for _ in range(40):
        observation, *_, info = env.step(FORWARD * 0.5)
    x, y, yaw = info["pose"]
    c, s = math.cos(yaw), math.sin(yaw)
    true = (c * (9 - x) + s * (9 - y), c * (9 - y) - s * (9 - x))
    assert math.dist(observation["goal"], true) > 0.02


def test_moving_obstacles_are_sensed_but_block_no_path() -> None:
    env = make("dynabarn-like", robot="jackal", worlds=1, render_mode="rgb_array")
    first, info = env.reset(seed=0)
    assert len(env._world.simulator.outlines(actors=True)) >= 8
    assert info["distance_m"] == pytest.approx(20.0, rel=0.1)
    before = env.render()
    for _ in range(10):
        later, _, terminated, *_ = env.step(STAND)
        assert not terminated
    moved = np.abs(later["ranges"] - first["ranges"]) > 0.1
    assert moved.sum() > 20
    assert not np.array_equal(before, env.render())


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["racecar", "mecanum"])
def test_other_drives_reach_a_goal_ahead(robot: str) -> None:
    env = make("empty", robot=robot, tolerance_m=0.3)
    env.reset(options={"start": (0.0, 0.0, 0.0), "goal": (3.0, 0.0)})
    ended: list[bool] = [False]
    while not any(ended):
        action = np.zeros(env.observer.size, np.float32)
        action[0] = 0.5
        _, _, *ended, info = env.step(action)
    assert info["outcome"] == "reached"


def test_a_drive_that_moves_sideways_has_a_third_component() -> None:
    env = make("empty", robot="mecanum")
    env.reset(options={"start": (0, 0, 0.0), "goal": (0, 5)})
    for _ in range(10):
        observation, *_, info = env.step(np.array([0.0, 0.0, 1.0], np.float32))
    assert observation["velocity"].shape == (3,)
    assert observation["velocity"][2] > 0.3
    assert observation in env.observation_space
    assert info["pose"][1] > 0.2
    assert abs(info["pose"][0]) < 0.1


def test_pictures_show_the_episode() -> None:
    env = make("arena", render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    assert first is not None
    assert first.shape == (600, 600, 3)
    assert len(np.unique(first.reshape(-1, 3), axis=0)) >= 5
    for _ in range(10):
        env.step(FORWARD)
    assert not np.array_equal(first, env.render())
    assert make().render() is None


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"beams": 1000}, "the lidar has 360"),
        ({"step_s": 0.0123}, "whole number of physics steps"),
        ({"step_s": 0.6}, "the robot stops 0.5 s after a command"),
        ({"speed": 1.0}, "unknown parameter 'speed'"),
        ({"tolerance_m": 0.0}, "must be > 0"),
        ({"render_mode": "human"}, "expected rgb_array or None"),
        ({"start": (1.0,)}, "expected (x, y) or (x, y, yaw)"),
        ({"goal": (math.nan, 1.0)}, "finite numbers"),
        ({"world": "maze:x"}, "SEED a whole number"),
    ],
)
def test_wrong_values_are_named(values: dict[str, Any], text: str) -> None:
    with pytest.raises((ParameterError, InvalidValueError)) as caught:
        NavigationEnv(**{"world": "empty", "robot": "burger", **values})
    assert text in str(caught.value)


def test_unknown_worlds_are_named() -> None:
    with pytest.raises(UnknownNameError, match="arena"):
        NavigationEnv(world="atlantis")


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"begin": (0, 0)}, "unknown reset option 'begin'; known: start, goal"),
        ({"world_seed": 1}, "only generated worlds have one"),
        ({"goal": (50.0, 0.0)}, "outside the world"),
        ({"start": (0.0, 0.0), "goal": (2.0, 0.0)}, "no path between them"),
    ],
)
def test_impossible_options_are_named(options: dict[str, Any], text: str) -> None:
    world = World("box").add_box((2.0, 0.0), (1.0, 1.0)).scene()
    env = make(world)
    with pytest.raises(InvalidValueError) as caught:
        env.reset(seed=0, options=options)
    assert text in str(caught.value)


def test_an_action_of_another_shape_is_named() -> None:
    env = make()
    env.reset(seed=0)
    with pytest.raises(InvalidValueError, match="2 finite numbers"):
        env.step(np.array([np.nan, 0.0], np.float32))


def test_a_robot_without_a_scanner_is_named() -> None:
    model = load_robot("jackal").model
    blind = replace(
        model, links=tuple(replace(each, sensors=()) for each in model.links)
    )
    with pytest.raises(InvalidValueError, match="no laser scanner"):
        NavigationEnv(world=World("w").add_robot(blind).scene())


def test_the_package_registers_the_id() -> None:
    assert ID in gymnasium.registry
    assert set(navette.navigation.gym.__all__) <= set(dir(navette.navigation.gym))


@pytest.mark.parametrize(
    ("imports", "name"),
    [
        ("import gymnasium, navette", ID),
        ("import navette, gymnasium, navette.navigation.gym", ID),
        ("import gymnasium", f"navette:{ID}"),
        ("import gymnasium", f"navette.navigation.gym:{ID}"),
    ],
)
def test_a_new_program_makes_the_environment(imports: str, name: str) -> None:
    program = f"{imports}; print(gymnasium.make({name!r}, world='arena').spec.id)"
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert ended.stdout.strip() == ID


def test_navette_alone_does_not_import_gymnasium() -> None:
    program = "import sys, navette; print('gymnasium' in sys.modules)"
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert ended.stdout.strip() == "False"
