"""The shortest path of a disc through a world."""

import math

import numpy as np
import pytest

from navette.navigation.bench.suites import suite_trials
from navette.navigation.worlds.shortest import (
    filled_outlines,
    grid_between,
    shortest_around,
)
from navette.sim import load_world

WALL = np.array([(-0.1, -2.0), (0.1, -2.0), (0.1, 2.0), (-0.1, 2.0)])
SIDES = [
    np.array([(-4.0, y - 0.1), (4.0, y - 0.1), (4.0, y + 0.1), (-4.0, y + 0.1)])
    for y in (-4.0, 4.0)
]


def test_cells_inside_convex_outlines_are_filled() -> None:
    spec = grid_between((-1.0, -1.0), (1.0, 1.0))
    turn = np.linspace(0.0, math.tau, 64, endpoint=False)
    circle = 0.5 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    area = filled_outlines([circle, circle + 5.0], spec).sum() * spec.resolution**2
    assert area == pytest.approx(math.pi / 4, rel=0.02)


def test_a_disc_goes_round_a_wall_or_not_at_all() -> None:
    ends = [(-2.0, 0.0), (2.0, 0.0)]
    assert shortest_around([], ends, 0.2) == 4.0
    length = shortest_around([WALL, *SIDES], ends, 0.2)
    round_it = 2 * math.dist((-2.0, 0.0), (0.0, 2.2))
    assert round_it - 0.1 < length < 1.1 * round_it
    assert math.isnan(shortest_around([WALL, *SIDES], ends, 1.5)), "the gaps are 1.9 m"
    assert math.isnan(shortest_around([WALL, *SIDES], [(0.0, 0.0), ends[1]], 0.2))


@pytest.mark.slow
def test_the_course_has_paths_in_its_own_world() -> None:
    trials = suite_trials("course", data=None, worlds=(), robot=None)
    assert len(trials) == 11
    assert {trial.world for trial in trials} == {"course"}
    assert load_world("course").name == "course"
    for trial in trials:
        x, y = trial.goals[0]
        if trial.start is not None:
            direct = math.dist((trial.start.x, trial.start.y), (x, y))
            assert direct - 0.1 <= trial.shortest_m < 4 * direct
    assert 80 < trials[-1].shortest_m < 100
