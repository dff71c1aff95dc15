"""Planning from map, pose and goal: paths and named failures."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from planning_worlds import (
    COURSE_FOOTPRINT,
    HARD_RUNS,
    course_clearance,
    course_map,
    empty_map,
    fill,
)

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, exact_clearances, make_outline
from navette.navigation.planning import (
    Goal,
    NewMap,
    Outcome,
    Plan,
    Planner,
    PlannerParams,
    path_shape,
)

SMALL = PlannerParams(clearance_margin_m=0.1, comfort_m=0.1)
COURSE = PlannerParams(footprint_m=COURSE_FOOTPRINT)


def planner(
    occupancy: np.ndarray, spec: GridSpec, params: PlannerParams = SMALL
) -> Planner:
    made = Planner(params)
    made.set_map(NewMap(occupancy, spec))
    return made


@pytest.fixture(scope="module")
def course() -> Planner:
    return planner(*course_map(), COURSE)


def turn_total(plan: Plan) -> float:
    yaw = np.unwrap(plan.poses[:, 2])
    return float(np.abs(np.diff(yaw)).sum())


def test_a_path_runs_from_the_robot_to_the_exact_goal() -> None:
    plan = planner(*empty_map(6, 6)).plan(Pose2(1.03, 1.08, 0.6), Goal(4.97, 5.01))
    assert plan.outcome is Outcome.OK
    np.testing.assert_allclose(plan.poses[0, :2], (1.03, 1.08))
    # Cell corners taken for centres would end half a cell's diagonal away.
    np.testing.assert_allclose(plan.poses[-1, :2], (4.97, 5.01))
    assert path_shape.lengths(plan.poses).max() <= 0.1 + 1e-9
    assert plan.cost == pytest.approx(path_shape.lengths(plan.poses).sum())


@pytest.mark.parametrize("method", ["a_star", "dijkstra", "breadth_first"])
def test_every_method_plans_around_a_wall(method: str) -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4, 4.2), (0, 4.5))
    params = PlannerParams(method=method)
    plan = planner(occupancy, spec, params).plan(Pose2(1, 1, 0), Goal(7, 1))
    assert plan.outcome.has_path
    assert plan.poses[:, 1].max() > 4.7
    assert path_shape.lengths(plan.poses).sum() < 11.5


def test_a_path_in_free_space_does_not_zigzag() -> None:
    plan = planner(*empty_map(12, 12)).plan(Pose2(1, 1, 0.4), Goal(11, 5.3))
    assert turn_total(plan) < 0.01
    occupancy, spec = empty_map(12, 12)
    fill(occupancy, spec, (5, 7), (0, 6))
    around = planner(occupancy, spec).plan(Pose2(1, 1, 1.0), Goal(11, 1))
    assert turn_total(around) < 3.5, "one bend around the block"


def test_a_large_heading_error_starts_with_a_turn_in_place() -> None:
    plan = planner(*empty_map(6, 6)).plan(Pose2(3, 3, math.pi), Goal(5, 3))
    spun = path_shape.turns(plan.poses)
    assert spun.sum() == pytest.approx(math.pi)
    assert (np.flatnonzero(spun) == np.arange(np.count_nonzero(spun))).all()


def test_a_goal_heading_ends_with_a_turn_in_place() -> None:
    plan = planner(*empty_map(6, 6)).plan(Pose2(1, 3, 0), Goal(5, 3, math.pi / 2))
    assert plan.outcome is Outcome.OK
    np.testing.assert_allclose(plan.poses[-1], (5, 3, math.pi / 2))


def test_a_goal_in_an_obstacle_is_moved_to_the_nearest_free_pose() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (6, 6.4), (2.8, 3.2))
    params = PlannerParams(
        clearance_margin_m=0.05, tight_margin_m=0.05, goal_tolerance_m=0.8
    )
    plan = planner(occupancy, spec, params).plan(Pose2(1, 3, 0), Goal(6.1, 3.0))
    assert plan.outcome is Outcome.GOAL_SNAPPED
    assert 0.3 < math.dist(plan.poses[-1, :2], (6.1, 3.0)) <= 0.8


def test_goal_deep_in_an_obstacle_is_blocked() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4, 8), (1, 5))
    plan = planner(occupancy, spec).plan(Pose2(1, 3, 0), Goal(6, 3))
    assert plan.outcome is Outcome.GOAL_BLOCKED
    assert not len(plan.poses)


@pytest.mark.parametrize(
    ("seen_inside", "outcome"),
    [(False, Outcome.GOAL_BLOCKED), (True, Outcome.NO_PATH)],
)
def test_a_goal_in_a_box_is_blocked_unless_its_inside_was_seen(
    seen_inside: bool, outcome: Outcome
) -> None:
    """Only the faces of a box are in the map; the body would fit inside."""
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4, 7), (1.5, 4.5))
    fill(occupancy, spec, (4.1, 6.9), (1.6, 4.4), 0 if seen_inside else -1)
    plan = planner(occupancy, spec).plan(Pose2(1, 3, 0), Goal(5.5, 3))
    assert plan.outcome is outcome


def test_an_unseen_goal_outside_a_closed_room_has_no_path() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4, 4.1), (0, 6))
    fill(occupancy, spec, (4.1, 8), (0, 6), -1)
    plan = planner(occupancy, spec).plan(Pose2(1, 3, 0), Goal(6, 3))
    assert plan.outcome is Outcome.NO_PATH


def test_a_walled_off_goal_has_no_path() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4, 4.2), (0, 6))
    plan = planner(occupancy, spec).plan(Pose2(1, 3, 0), Goal(7, 3))
    assert plan.outcome is Outcome.NO_PATH


def test_a_walled_in_start_is_blocked() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (0.6, 1.4), (2.6, 3.4))
    fill(occupancy, spec, (0.7, 1.3), (2.7, 3.3), 0)
    plan = planner(occupancy, spec).plan(Pose2(1, 3, 0), Goal(7, 3))
    assert plan.outcome is Outcome.START_BLOCKED


@pytest.mark.parametrize(
    ("start", "goal", "outcome"),
    [
        (Pose2(1, 1, 0), Goal(601, 1), Outcome.GOAL_OUTSIDE_MAP),
        (Pose2(1, 1, 0), Goal(-595, 1), Outcome.GOAL_OUTSIDE_MAP),
        (Pose2(601, 1, 0), Goal(1, 1), Outcome.START_OUTSIDE_MAP),
        (Pose2(1, 1, 0), Goal(math.nan, 1), Outcome.GOAL_NOT_FINITE),
        (Pose2(1, 1, 0), Goal(1, math.inf), Outcome.GOAL_NOT_FINITE),
        (Pose2(1, 1, 0), Goal(1, 1, math.nan), Outcome.GOAL_NOT_FINITE),
    ],
)
def test_invalid_goals_and_starts_have_named_outcomes(
    start: Pose2, goal: Goal, outcome: Outcome
) -> None:
    assert planner(*empty_map(6, 6)).plan(start, goal).outcome is outcome


def test_a_robot_outside_the_first_map_gets_a_path() -> None:
    """Its first costmap, which makes the map larger, may arrive after the goal."""
    plan = planner(*empty_map(6, 6)).plan(Pose2(-90.0, -90.0, 0.0), Goal(-70.0, 90.0))
    assert plan.outcome is Outcome.OK
    assert plan.poses[0] == pytest.approx((-90.0, -90.0, 0.0), abs=1e-6)


def test_start_in_inflation_and_on_a_phantom_still_has_a_path() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (0, 0.7), (0, 6))
    plan = planner(occupancy, spec).plan(Pose2(1.0, 3, 0), Goal(6, 3))
    assert plan.outcome is Outcome.OK
    fill(occupancy, spec, (3.0, 3.2), (3, 3.2))
    plan = planner(occupancy, spec).plan(Pose2(3.1, 3, 0), Goal(6, 3))
    assert plan.outcome is Outcome.OK


def test_goals_in_unknown_space_are_allowed_unless_switched_off() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4, 8), (0, 6), -1)
    assert planner(occupancy, spec).plan(Pose2(1, 3, 0), Goal(7, 3)).outcome.has_path
    shy = planner(occupancy, spec, PlannerParams(allow_unknown=False))
    assert shy.plan(Pose2(1, 3, 0), Goal(7, 3)).outcome is Outcome.GOAL_BLOCKED


def test_a_gap_too_tight_for_the_margin_is_taken_with_the_tight_one() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4, 4.2), (0, 2.7))
    fill(occupancy, spec, (4, 4.2), (3.4, 6))  # 0.7 m for a body of 0.4 m
    wide = PlannerParams(clearance_margin_m=0.25, tight_margin_m=0.05)
    plan = planner(occupancy, spec, wide).plan(Pose2(1, 3, 0), Goal(7, 3))
    assert plan.outcome.has_path
    assert plan.margin_m == 0.05
    strict = PlannerParams(clearance_margin_m=0.25, tight_margin_m=0.25)
    plan = planner(occupancy, spec, strict).plan(Pose2(1, 3, 0), Goal(7, 3))
    assert plan.outcome is Outcome.NO_PATH


def test_the_tight_margin_is_weighed_against_a_long_detour() -> None:
    occupancy, spec = empty_map(30, 8)
    fill(occupancy, spec, (0, 26), (4, 4.2))
    fill(occupancy, spec, (3, 3.7), (4, 4.2), 0)
    params = PlannerParams(clearance_margin_m=0.25, tight_margin_m=0.05)
    made = planner(occupancy, spec, params)
    across = made.plan(Pose2(3.3, 2, math.pi / 2), Goal(3.3, 6))
    assert across.margin_m == 0.05
    assert across.poses[:, 0].max() < 5
    far = made.plan(Pose2(24, 2, math.pi / 2), Goal(24, 6))
    assert far.margin_m == 0.25


def test_the_course_robot_keeps_room_to_turn_where_there_is_room(
    course: Planner,
) -> None:
    plan = course.plan(Pose2(-6, 0, 0), Goal(6, -12))
    row, column = course.grid().to_cells(plan.poses[:, :2]).astype(int).T[::-1]
    needed = course.body.circumscribed_m + COURSE.clearance_margin_m
    assert (course.grid().distances.everywhere()[row, column] >= needed).all()


@pytest.mark.parametrize(("start", "goal"), HARD_RUNS)
def test_hard_runs_of_the_course_have_drivable_paths(
    course: Planner, start: tuple[float, ...], goal: tuple[float, float]
) -> None:
    x, y, degrees = start
    plan = course.plan(Pose2(x, y, math.radians(degrees)), Goal(*goal))
    assert plan.outcome.has_path
    assert plan.margin_m == COURSE.clearance_margin_m
    assert math.dist(plan.poses[-1, :2], goal) <= 0.4
    clearance = course_clearance(plan.poses)
    assert clearance.min() >= min(0.2, clearance[0] - 0.01)


def test_random_starts_and_goals_in_the_course_have_drivable_paths(
    course: Planner,
) -> None:
    rng = np.random.default_rng(11)
    drawn = 0
    while drawn < 25:
        x, y, yaw = rng.uniform((-14.5, -14.5, -3.1), (14.5, 14.5, 3.1))
        goal = tuple(rng.uniform(-14, 14, 2).tolist())
        headings = np.array([[*goal, a] for a in np.arange(0, 6.2, 0.4)])
        start = Pose2(float(x), float(y), float(yaw))
        room = course_clearance(np.array([start]))[0]
        if room < 0.1 or course_clearance(headings).max() < 0.2:
            continue
        drawn += 1
        plan = course.plan(start, Goal(*goal))
        assert plan.outcome.has_path, (start, goal)
        assert math.dist(plan.poses[-1, :2], goal) <= 0.41
        clearance = course_clearance(plan.poses).min()
        assert clearance >= min(0.15, room - 0.03), (start, goal)


def test_the_same_input_gives_the_same_plan() -> None:
    def asked() -> Callable[[], np.ndarray]:
        made = planner(*course_map(), COURSE)
        made.plan(Pose2(6, -12.8, 1.57), Goal(2.8, -6.5))
        return made.plan(Pose2(-3, 6, 3.1), Goal(-5.3, 6)).poses

    np.testing.assert_array_equal(asked(), asked())


def test_a_turn_of_180_degrees_uses_the_direction_with_more_room() -> None:
    outline = (0.9, 0.2, -0.2, 0.2, -0.2, -0.2, 0.9, -0.2)
    occupancy, spec = empty_map(10, 8)
    fill(occupancy, spec, (4.5, 5.5), (5.05, 5.25))  # a shelf on the left
    params = PlannerParams(footprint_m=outline, clearance_margin_m=0.05)
    made = planner(occupancy, spec, params)
    for goal_y in (3.9, 4.1):
        plan = made.plan(Pose2(5, 4, 0), Goal(1, goal_y))
        swept = plan.poses[np.hypot(*(plan.poses[:, :2] - (5, 4)).T) < 0.01, 2]
        assert np.sin(swept[1:-1]).max() < 0.1, "past the right, away from the shelf"


@pytest.mark.parametrize("yaw", [None, 2.0])
def test_a_robot_at_its_goal_turns_at_most(yaw: float | None) -> None:
    """Also if it plans again and again while it turns, as a behaviour tree does."""
    start = Pose2(3.01, 3.02, -1.0)
    plan = planner(*empty_map(6, 6)).plan(start, Goal(3.0, 3.0, yaw))
    assert plan.outcome is Outcome.OK
    assert np.ptp(plan.poses[:, :2], axis=0).max() == 0.0
    assert plan.poses[-1, 2] == pytest.approx(-1.0 if yaw is None else yaw)
    assert turn_total(plan) == pytest.approx(0.0 if yaw is None else 3.0)


def test_a_robot_at_its_goal_that_cannot_turn_there_drives() -> None:
    occupancy, spec = empty_map(6, 6)
    fill(occupancy, spec, (0.0, 6.0), (3.45, 3.6))
    fill(occupancy, spec, (0.0, 6.0), (2.4, 2.55))
    long = PlannerParams(
        footprint_m=(0.6, 0.2, -0.6, 0.2, -0.6, -0.2, 0.6, -0.2),
        clearance_margin_m=0.05,
        tight_margin_m=0.05,
        comfort_m=0.1,
    )
    plan = planner(occupancy, spec, long).plan(Pose2(3, 3, 0.0), Goal(3.0, 3.0, 1.57))
    assert not plan.outcome.has_path or np.ptp(plan.poses[:, 0]) > 0.3


def test_beside_the_end_of_a_wall_the_path_leaves_it_before_it_turns() -> None:
    husky = (
        *(0.495, 0.2, 0.421, 0.335, -0.421, 0.335, -0.495, 0.2),
        *(-0.495, -0.2, -0.421, -0.335, 0.421, -0.335, 0.495, -0.2),
    )
    wall = np.array(
        [(x, -5.2) for x in np.arange(-1.775, -1.67, 0.0125)]
        + [(x, y) for x in (-1.775, -1.675) for y in np.arange(-5.2, -4.0, 0.0125)]
    )
    spec = GridSpec(0.1, 60, 60, Pose2(-4.0, -8.0, 0.0))
    occupancy = np.zeros(spec.shape, np.int8)
    rows_columns = {spec.cell_of(x, y) for x, y in wall.tolist()}
    occupancy[tuple(np.array(sorted(rows_columns)).T)] = 100
    made = Planner(PlannerParams(footprint_m=husky))
    made.set_map(NewMap(occupancy, spec, wall))
    plan = made.plan(Pose2(-1.293, -5.312, -2.287), Goal(-3.2, -5.2))
    outline = make_outline(made.map.footprint)
    clearance = exact_clearances(made.grid().exact_obstacles, outline, plan.poses, 0.5)
    assert plan.outcome.has_path
    assert clearance[1:].min() > clearance[0] + 0.003


def test_a_car_before_a_wall_with_nothing_seen_behind_is_blocked_at_its_start() -> None:
    occupancy, spec = empty_map(8, 6)
    fill(occupancy, spec, (4.5, 4.7), (1, 5))
    occupancy[:, :38] = -1  # no beam has seen what is behind
    car = PlannerParams(
        drive="ackermann",
        min_turning_radius_m=0.8,
        footprint_m=(0.45, 0.14, -0.13, 0.14, -0.13, -0.14, 0.45, -0.14),
    )
    plan = planner(occupancy, spec, car).plan(Pose2(4.0, 3.0, 0.0), Goal(7.0, 3.0))
    assert plan.outcome is Outcome.START_BLOCKED
    occupancy[:, :38] = 0
    plan = planner(occupancy, spec, car).plan(Pose2(4.0, 3.0, 0.0), Goal(7.0, 3.0))
    assert plan.outcome.has_path


@pytest.mark.parametrize(("seed", "rough_cost_m"), [(27, 22.6), (34, 21.2)])
def test_between_posts_the_path_of_small_motions_is_replaced_by_a_smoother_one(
    seed: int, rough_cost_m: float
) -> None:
    occupancy, spec = empty_map(6, 4, 0.05)
    posts = np.random.default_rng(seed).uniform((1, 0), (5, 4), (42, 2))
    for x, y in posts:
        fill(occupancy, spec, (x, x + 0.1), (y, y + 0.1))
    for y in (0.0, 3.9):
        fill(occupancy, spec, (0, 6), (y, y + 0.1))
    # The budget is too small for a search that may leave the path.
    searcher = planner(occupancy, spec, replace(SMALL, max_expansions=400))
    plan = searcher.plan(Pose2(0.5, 2, 0), Goal(5.5, 2))
    assert plan.outcome.has_path
    assert plan.cost < 0.85 * rough_cost_m


def test_a_fault_in_the_search_for_a_better_path_is_logged(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    mine = tmp_path / "mine.py"
    mine.write_text("def search(cost, start, goal): raise ValueError('lost')\n")
    own = planner(*empty_map(8, 8), replace(SMALL, method=str(mine)))
    assert own.plan_on_grid(Pose2(1.0, 1.0, 0.0), Goal(6.0, 6.0)) is None
    assert "the present one is kept: planner" in caplog.text
    assert "lost" in caplog.text
