"""The collision check holds for whatever a user's controller commands."""

from typing import Any

import numpy as np
import pytest
from control_plant import Plant

from navette.geometry import Footprint, Pose2
from navette.navigation.control import ControlParams, FollowerInputs
from navette.navigation.control.command_follower import CommandFollower
from navette.navigation.grids import CollisionCheck, MovingBody

FOOTPRINT = (0.254, 0.215, -0.254, 0.215, -0.254, -0.215, 0.254, -0.215)
PARAMS = ControlParams(
    footprint_m=FOOTPRINT,
    cruise_speed_mps=2.0,
    reverse_speed_mps=0.4,
    max_turn_rate_radps=1.5,
    acceleration_mps2=1.5,
    deceleration_mps2=1.5,
    turn_acceleration_radps2=4.0,
    max_deviation_m=100.0,
)
DT = 0.05


class Flip:
    """Full speed in a bend to the left, and suddenly in one to the right."""

    def __init__(self, after_s: float) -> None:
        self.left_s = after_s

    def command(self, state: Any, path: Any, obstacles: Any) -> tuple[float, float]:
        self.left_s -= state.dt
        return 2.0, 1.5 if self.left_s > 0 else -1.5


class Wild:
    """Random commands, each for a random time."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.left_s, self.last = 0.0, (0.0, 0.0)

    def command(self, state: Any, path: Any, obstacles: Any) -> tuple[float, float]:
        self.left_s -= state.dt
        if self.left_s <= 0:
            self.left_s = self.rng.choice([0.05, 0.1, 0.3, 1.0])
            self.last = (
                float(self.rng.choice([2.0, 1.0, 0.3, -0.4])),
                float(self.rng.uniform(-1.5, 1.5)),
            )
        return self.last


def least_clearance(method: Any, points: np.ndarray, plant: Plant, steps: int) -> float:
    follower = CommandFollower(PARAMS, method, "own")
    follower.set_path(np.array([[0.0, 0, 0], [100, 0, 0]]))
    follower.set_obstacles(points, 0.0)
    body = Footprint.from_flat(FOOTPRINT)
    exact = CollisionCheck(
        MovingBody(
            footprint=body,
            margin_m=0.0,
            horizon_m=0.5,
            reaction_s=0.2,
            deceleration_mps2=1.5,
            turn_acceleration_radps2=4.0,
        )
    )
    exact.set_obstacles(points, 0.0)
    least = np.inf
    for _ in range(steps):
        inputs = FollowerInputs(plant.pose, plant.speed, plant.turn_rate)
        command = follower.step(inputs, DT).command
        plant.drive(command.speed, command.turn_rate, DT)
        least = min(least, exact.clearance(plant.pose))
    return least


@pytest.mark.parametrize("after_s", np.arange(0.3, 1.0, 0.1).round(1).tolist())
def test_a_sudden_bend_towards_a_wall_does_not_reach_it(after_s: float) -> None:
    """The robot brakes on the bend that clears the wall: it cannot stop at once."""
    y = np.arange(-3.0, 3.0, 0.02)
    wall = np.column_stack([np.full(len(y), 2.2), y])
    plant = Plant(Pose2(0, 0, 0), lag_s=0.16, turning=1.0, speed=1.4, turn_rate=0.3)
    assert least_clearance(Flip(after_s), wall, plant, 80) > 0.005


@pytest.mark.parametrize("seed", range(4))
def test_random_commands_among_posts_touch_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    posts = rng.uniform(-3, 3, (14, 2))
    posts = posts[np.hypot(*posts.T) > 0.6]
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    ring = 0.075 * np.column_stack([np.cos(angle), np.sin(angle)])
    side = np.arange(-3, 3, 0.05)
    edges = [np.column_stack([side, np.full_like(side, at)]) for at in (-3.0, 3.0)]
    points = np.concatenate(
        [(posts[:, None] + ring).reshape(-1, 2), *edges, *(e[:, ::-1] for e in edges)]
    )
    plant = Plant(Pose2(0, 0, 0))
    assert least_clearance(Wild(seed), points, plant, 800) > 0.005
