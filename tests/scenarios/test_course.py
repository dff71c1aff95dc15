"""The reference world: ten hard runs, the seven-goal course, random drives."""

import math

import numpy as np
import pytest
from courses import HARD_RUNS, SEVEN_GOALS, Drive

from navette.geometry import Pose2
from navette.navigation.stack.simulation import Simulation

from .conftest import MakeSimulation

REACH_M = 0.6
CLEARANCE_M = 0.10

# Boxes (x, y, half edge) and cylinders (x, y, radius) of the reference world.
BOXES = ((7, -6, 1.5), (-8, 6, 1.5), (4, 9, 1.5), (9, 3, 1.0), (1, -10, 1.0))
CYLINDERS = ((0, 0, 3.0), (-7, -7, 2.0))
WALL = 14.75


def drive(simulate: MakeSimulation, run: Drive) -> Simulation:
    simulation = simulate(
        world="course", start=run.start, goals=run.goals, max_time_s=run.limit_s
    )
    simulation.run()
    return simulation


def assert_driven_well(simulation: Simulation, run: Drive) -> None:
    summary = simulation.summary()
    assert [goal.result for goal in summary.goals] == ["reached"] * len(run.goals)
    assert all(goal.distance_left_m <= REACH_M for goal in summary.goals)
    assert summary.contacts == 0
    assert summary.min_clearance_m is not None
    assert summary.min_clearance_m >= CLEARANCE_M


@pytest.mark.slow
@pytest.mark.parametrize("run", HARD_RUNS, ids=lambda run: run.name)
def test_hard_runs(simulate: MakeSimulation, run: Drive) -> None:
    assert_driven_well(drive(simulate, run), run)


@pytest.mark.slow
def test_seven_goals_from_the_spawn_pose(simulate: MakeSimulation) -> None:
    assert_driven_well(drive(simulate, SEVEN_GOALS), SEVEN_GOALS)


def random_drive(seed: int) -> Drive:
    """A start and a goal with room for the whole robot, anywhere in the world."""
    rng = np.random.default_rng(seed)

    def free_point() -> tuple[float, float]:
        while True:
            x, y = rng.uniform(-WALL, WALL, 2)
            if clearance_of(x, y) > 1.75:
                return float(x), float(y)

    start, goal = free_point(), free_point()
    yaw = float(rng.uniform(-math.pi, math.pi))
    return Drive(f"seed {seed}", Pose2(*start, yaw), (goal,), 90.0)


def clearance_of(x: float, y: float) -> float:
    to_boxes = [math.hypot(max(abs(x - bx) - h, 0), max(abs(y - by) - h, 0))
                for bx, by, h in BOXES]  # fmt: skip
    to_cylinders = [math.hypot(x - cx, y - cy) - r for cx, cy, r in CYLINDERS]
    return min(WALL - abs(x), WALL - abs(y), *to_boxes, *to_cylinders)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_random_drives(simulate: MakeSimulation, seed: int) -> None:
    run = random_drive(seed)
    assert_driven_well(drive(simulate, run), run)
