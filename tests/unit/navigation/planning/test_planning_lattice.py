"""The search with headings, in tight places."""

import math

import numpy as np
import pytest
from planning_worlds import (
    COURSE_FOOTPRINT,
    course_clearance,
    course_map,
    distance_to_cells,
    empty_map,
    fill,
)

from navette.errors import InvalidValueError
from navette.geometry import Footprint, Pose2
from navette.navigation.grids import GridSpec, make_obstacles, make_outline
from navette.navigation.planning.dijkstra import guide_to
from navette.navigation.planning.lattice import (
    LatticeGoal,
    LatticeResult,
    LatticeWorld,
    search,
)
from navette.navigation.planning.lattice_motions import Motions
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import directions, lengths, turns
from navette.navigation.planning.planning_grid import BodyShape, open_at, planning_grid
from navette.navigation.planning.traversal import EdgeTable

COURSE = Footprint.from_flat(COURSE_FOOTPRINT)
MOTIONS = Motions(step_m=0.3, reach_m=COURSE.circumscribed_radius)
MARGIN = 0.15
EVERYWHERE = 1 << 50  # units


def plan(
    occupancy: np.ndarray,
    spec: GridSpec,
    start: Pose2,
    goal: LatticeGoal,
    *,
    max_expansions: int = 40_000,
) -> LatticeResult:
    body = BodyShape.of(COURSE, spec.resolution)
    params = PlannerParams(footprint_m=COURSE_FOOTPRINT, clearance_margin_m=MARGIN)
    grid = planning_grid(occupancy, spec, body, params)
    grid = open_at(grid, spec.cell_of(start.x, start.y), body)
    world = LatticeWorld(
        distances=grid.distances,
        factors=grid.factors(),
        guide=guide_to(
            grid.cost,
            [(spec.cell_of(goal.x, goal.y), 0)],
            table=grid.table,
            start=spec.cell_of(start.x, start.y),
            beyond=EVERYWHERE,
        ),
        spec=spec,
        body=body.points,
        margin_m=MARGIN,
        comfort_m=0.4,
        outside_m=grid.outside_m,
        obstacles=make_obstacles(grid.obstacles, grid.spec),
        outline=make_outline(COURSE),
        unseen=np.zeros(spec.shape, np.uint8),
    )
    return search(world, start, goal, MOTIONS, max_expansions=max_expansions)


def test_in_free_space_the_path_is_straight_and_forward() -> None:
    found = plan(
        *empty_map(12, 6), Pose2(2, 3, 0), LatticeGoal(9.5, 3, tolerance_m=0.4)
    )
    assert (directions(found.poses) >= 0).all()
    assert turns(found.poses).sum() < 0.5
    assert lengths(found.poses).sum() < 7.7
    assert math.dist(found.poses[-1, :2], (9.5, 3)) < 0.15
    np.testing.assert_allclose(found.poses[0], (2, 3, 0))
    assert lengths(found.poses).max() <= 0.1 + 1e-9


def test_a_body_nose_first_in_a_corner_backs_out_before_it_turns() -> None:
    start = Pose2(-13.2, -13.2, math.radians(-135))
    found = plan(*course_map(), start, LatticeGoal(-12, -9, tolerance_m=0.4))
    assert directions(found.poses)[0] == -1
    clearance = course_clearance(found.poses)
    assert clearance.min() > clearance[0] - 0.01, "never closer than it stood"
    outside = int(np.argmax(clearance > 0.3))
    assert clearance[outside:].min() > MARGIN


def test_the_body_keeps_its_margin_in_a_slalom() -> None:
    occupancy, spec = empty_map(14, 8)
    fill(occupancy, spec, (4.5, 4.7), (0, 4.6))
    fill(occupancy, spec, (9.0, 9.2), (3.2, 8))
    goal = LatticeGoal(12, 5, tolerance_m=0.3)
    found = plan(occupancy, spec, Pose2(2, 2, 1.0), goal)
    assert len(found.poses)
    for pose in found.poses.tolist():
        assert distance_to_cells(COURSE, Pose2(*pose), occupancy, spec) >= MARGIN


def test_a_goal_heading_is_reached() -> None:
    goal = LatticeGoal(7, 3, tolerance_m=0.3, yaw=math.pi / 2, yaw_tolerance=0.15)
    found = plan(*empty_map(12, 8), Pose2(2, 3, 0), goal)
    assert abs(found.poses[-1, 2] - math.pi / 2) <= 0.15


def test_no_path_and_an_exhausted_budget_are_distinguished() -> None:
    occupancy, spec = empty_map(12, 6)
    fill(occupancy, spec, (6, 6.3), (0, 6))
    walled = plan(occupancy, spec, Pose2(2, 3, 0), LatticeGoal(10, 3, tolerance_m=0.3))
    assert not len(walled.poses)
    assert not walled.exhausted
    hasty = plan(
        *empty_map(12, 6),
        Pose2(2, 3, math.pi),
        LatticeGoal(10, 3, tolerance_m=0.3),
        max_expansions=3,
    )
    assert not len(hasty.poses)
    assert hasty.exhausted
    assert hasty.expansions == 3


def test_the_same_input_gives_the_same_result() -> None:
    start, goal = Pose2(-3, 6, math.pi), LatticeGoal(-5.3, 6, tolerance_m=0.4)
    first, again = (plan(*course_map(), start, goal) for _ in range(2))
    np.testing.assert_array_equal(first.poses, again.poses)


def test_start_outside_is_refused() -> None:
    spec = empty_map(4, 4)[1]
    nothing = np.zeros(spec.shape, np.float32)
    cost = np.zeros(spec.shape, np.uint8)
    guide = guide_to(cost, [((0, 0), 0)], table=EdgeTable(), start=(0, 0), beyond=0)
    world = LatticeWorld(
        nothing,
        np.ones(256, np.float32),
        guide,
        spec,
        np.zeros((1, 3)),
        MARGIN,
        0.4,
        0.0,
        make_obstacles(np.zeros(spec.shape, np.uint8), spec),
        make_outline(COURSE),
        np.zeros(spec.shape, np.uint8),
    )
    with pytest.raises(InvalidValueError, match="outside the grid"):
        search(world, Pose2(9, 9, 0), LatticeGoal(2, 2, 0.3), MOTIONS)


def test_arcs_end_on_their_circle() -> None:
    radius = MOTIONS.step_m / MOTIONS.heading_step
    for m, (direction, _, turn) in enumerate(MOTIONS.moves):
        end = MOTIONS.offsets[m, MOTIONS.sample_counts[m] - 1]
        assert end[2] == pytest.approx(turn * MOTIONS.heading_step)
        if direction and turn:
            angle = direction * MOTIONS.heading_step
            expected = (
                radius * math.sin(angle),
                turn * direction * radius * (1 - math.cos(angle)),
            )
            assert end[:2] == pytest.approx(expected)
        elif direction:
            assert end[:2] == pytest.approx((direction * MOTIONS.step_m, 0))
        else:
            assert end[:2] == pytest.approx((0, 0))


def test_turns_are_sampled_as_finely_as_the_body_sweeps() -> None:
    found = plan(
        *empty_map(12, 8), Pose2(6, 4, math.pi), LatticeGoal(10, 4, tolerance_m=0.3)
    )
    spun = turns(found.poses)
    assert (spun * COURSE.circumscribed_radius).max() <= 0.2
