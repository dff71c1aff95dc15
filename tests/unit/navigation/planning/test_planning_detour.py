"""Headings of the search for detours."""

import math
from dataclasses import replace

import numpy as np
import pytest
from planning_worlds import empty_map, fill

from navette.geometry import Pose2
from navette.navigation.planning import (
    Goal,
    NewMap,
    Outcome,
    Planner,
    PlannerParams,
)
from navette.navigation.planning.detour import DetourPlanner, Target
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.path_shape import bend, lengths
from navette.navigation.planning.route import GridRouter

FOOTPRINT = (-0.25, -0.2, 0.25, -0.2, 0.25, 0.2, -0.25, 0.2)
PARAMS = PlannerParams(clearance_margin_m=0.1, comfort_m=0.1)


def detour_planner(*, centres: bool, params: PlannerParams = PARAMS) -> DetourPlanner:
    planner = Planner(params)
    occupancy, spec = empty_map(6, 6)
    planner.set_map(NewMap(occupancy, spec))
    router = GridRouter(params, centres=centres)
    unseen = np.zeros(spec.shape, np.uint8)
    return DetourPlanner(planner.grid(), planner.body, params, router, unseen)


@pytest.mark.parametrize("yaw", [-0.14, -0.05, 0.03, 0.1, 1.7])
def test_a_passage_is_among_the_headings_of_the_search(yaw: float) -> None:
    """The robot turns by less than half the angle between two headings before it."""
    detour = detour_planner(centres=True)
    route = np.column_stack([np.linspace(1, 5, 40), np.full(40, 3.0), np.zeros(40)])
    start = np.array([[1.0, 3.0, yaw]])
    aligned = detour._aligned(start, route)
    step = detour.motions.heading_step
    assert math.remainder(aligned[-1, 2], step) == pytest.approx(0.0, abs=0.011)
    assert abs(aligned[-1, 2] - yaw) <= step / 2 + 1e-9
    np.testing.assert_array_equal(
        aligned[:, :2], np.tile(start[0, :2], (len(aligned), 1))
    )


@pytest.mark.parametrize(("radius_m", "fits"), [(0.8, True), (20.0, False)])
def test_a_car_bends_to_the_heading_of_a_passage_within_the_map(
    radius_m: float, fits: bool
) -> None:
    params = replace(PARAMS, drive="ackermann", min_turning_radius_m=radius_m)
    detour = detour_planner(centres=True, params=params)
    route = np.column_stack([np.linspace(1, 5, 40), np.full(40, 3.0), np.zeros(40)])
    found = detour.plan(Pose2(1.0, 3.0, 0.1), Target(5.0, 3.0, None, 0.5), route)
    assert (found.poses is not None) == fits


def test_the_poses_of_a_wide_bend_are_close_to_each_other() -> None:
    assert lengths(bend(Pose2(0.0, 0.0, 0.0), 0.3, 6.0)).max() <= 0.2


def test_where_there_is_room_the_search_begins_with_the_robots_heading() -> None:
    detour = detour_planner(centres=False)
    route = detour.router.route(detour.grid, detour.body, Pose2(1, 3, 0), (5, 3))
    start = np.array([[1.0, 3.0, -0.14]])
    assert detour._aligned(start, route) is start


def test_far_from_the_goal_a_detour_leads_back_to_the_route(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It costs no more than the way of a search up to the goal."""
    occupancy, spec = empty_map(60, 20, 0.05)
    # A dead end behind the robot's back, too narrow to turn in.
    fill(occupancy, spec, (2.5, 5.0), (9.55, 9.6))
    fill(occupancy, spec, (2.5, 5.0), (10.4, 10.45))
    fill(occupancy, spec, (4.55, 4.6), (9.55, 10.45))
    planner = Planner(replace(PARAMS, footprint_m=FOOTPRINT))
    planner.set_map(NewMap(occupancy, spec))
    start, goal = Pose2(4.0, 10.0, 0.0), Goal(56.0, 10.0)
    near = planner.plan(start, goal)
    monkeypatch.setattr(DetourPlanner, "_plan_back", lambda *_: None)
    whole = planner.plan(start, goal)
    assert near.outcome is whole.outcome is Outcome.OK
    assert near.cost <= whole.cost
    assert not np.array_equal(near.poses, whole.poses)
    assert lengths(near.poses).max() < 0.2
    assert check_path(near.poses, planner.grid(), planner.body).fits
    assert math.dist(near.poses[-1, :2], (goal.x, goal.y)) < 0.1
