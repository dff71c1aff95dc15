"""Paths avoid where moving obstacles will be, and remain possible."""

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import NO_DISCS, GridSpec
from navette.navigation.planning import NewMap
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.planner import Goal, Planner
from navette.navigation.planning.traversal import LETHAL

SPEC = GridSpec(0.1, 100, 60, Pose2(0.0, -3.0, 0.0))


def _planner(occupancy: np.ndarray | None = None) -> Planner:
    planner = Planner(PlannerParams())
    cells = np.zeros(SPEC.shape, np.int8) if occupancy is None else occupancy
    planner.set_map(NewMap(cells, SPEC))
    return planner


def test_path_goes_around_where_a_mover_will_be() -> None:
    planner = _planner()
    start, goal = Pose2(1.0, 0.0, 0.0), Goal(9.0, 0.0)
    straight = planner.plan(start, goal).poses
    assert np.abs(straight[:, 1]).max() < 0.05
    planner.map.set_moving(np.array([[5.0, -1.0, 0.0, 0.5, 0.5]]))
    around = planner.plan(start, goal)
    assert around.outcome.has_path
    nearest = np.hypot(around.poses[:, 0] - 5.0, around.poses[:, 1]).min()
    assert nearest > 0.6
    planner.map.set_moving(NO_DISCS)
    assert np.abs(planner.plan(start, goal).poses - straight).max() == 0.0


def test_a_mover_closes_neither_a_door_nor_the_goal() -> None:
    occupancy = np.zeros(SPEC.shape, np.int8)
    occupancy[:, 50] = 100
    occupancy[25:36, 50] = 0  # a door at x = 5, y = 0
    planner = _planner(occupancy)
    planner.map.set_moving(
        np.array([[5.0, 0.0, 0.0, 0.0, 0.5], [9.0, 0.0, 0.1, 0.0, 0.5]])
    )
    plan = planner.plan(Pose2(1.0, 0.0, 0.0), Goal(9.0, 0.0))
    assert plan.outcome.has_path
    assert plan.poses[-1, :2] == pytest.approx((9.0, 0.0), abs=0.1)
    assert planner.grid().cost[30, 50] < LETHAL
