"""The planning grid, and the shape of paths on it."""

import math

import numpy as np
import pytest
from planning_worlds import COURSE_FOOTPRINT, empty_map, fill

from navette.errors import InvalidValueError, ParameterError
from navette.geometry import Footprint, Pose2
from navette.navigation.grids import UNKNOWN, CellWindow, GridSpec, distance_levels
from navette.navigation.grids.distance_levels import all_parts
from navette.navigation.planning import path_shape
from navette.navigation.planning.cheap_tiles import CheapTiles
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.planning_grid import (
    NO_HITS,
    BodyShape,
    open_at,
    planning_grid,
    update_grid,
    without_obstacles_in,
)
from navette.navigation.planning.traversal import LETHAL

PARAMS = PlannerParams(footprint_m=COURSE_FOOTPRINT, comfort_m=0.2)
BODY = BodyShape.of(Footprint.from_flat(COURSE_FOOTPRINT), 0.1)


def walled(**changes: object):
    occupancy, spec = empty_map(12, 8)
    fill(occupancy, spec, (0, 0.3), (0, 8))
    params = PlannerParams(footprint_m=COURSE_FOOTPRINT, comfort_m=0.2, **changes)
    return occupancy, planning_grid(occupancy, spec, BODY, params), params


def test_cost_is_closed_near_falls_with_distance_and_ends() -> None:
    _, grid, params = walled()
    row = grid.cost[40]
    distance = grid.distances.everywhere()[40]
    closed = distance < BODY.inscribed_m + params.clearance_margin_m - 0.01
    assert (row[closed] == LETHAL).all()
    free = distance > BODY.circumscribed_m + params.clearance_margin_m + 0.21
    assert (row[free] == 0).all()
    between = row[~closed & ~free].astype(int)
    assert (np.diff(between) <= 0).all()
    assert between[0] > 230
    assert between[between > 0][-1] > 40, "a step: paths stay where turning is free"


def test_inflation_in_the_map_is_not_an_obstacle() -> None:
    occupancy, spec = empty_map(12, 8)
    fill(occupancy, spec, (3, 6), (2, 5), 99)
    assert planning_grid(occupancy, spec, BODY, PARAMS).cost.max() == 0
    softer = PlannerParams(footprint_m=COURSE_FOOTPRINT, map_cost_weight=2.0)
    cost = planning_grid(occupancy, spec, BODY, softer).cost
    assert 0 < cost.max() < LETHAL
    stricter = PlannerParams(footprint_m=COURSE_FOOTPRINT, lethal_cost=99)
    assert planning_grid(occupancy, spec, BODY, stricter).cost.max() == LETHAL


def test_unknown_cells_cost_more_or_are_closed() -> None:
    occupancy, spec = empty_map(12, 8)
    fill(occupancy, spec, (3, 6), (2, 5), -1)
    cost = planning_grid(occupancy, spec, BODY, PARAMS).cost
    assert 0 < cost[30, 40] < 30
    shy = PlannerParams(footprint_m=COURSE_FOOTPRINT, allow_unknown=False)
    assert planning_grid(occupancy, spec, BODY, shy).cost[30, 40] == LETHAL


def test_obstacles_inside_the_body_are_ignored() -> None:
    occupancy, grid, params = walled()
    spec = grid.spec
    fill(occupancy, spec, (6.3, 6.5), (4, 4.2))
    grid = planning_grid(occupancy, spec, BODY, params)
    start = Pose2(6, 4, 0.4)
    cleared = without_obstacles_in(grid, occupancy, start, BODY)
    assert grid.obstacles.sum() - cleared.obstacles.sum() == 4
    assert cleared.cost[spec.cell_of(6, 4)] != LETHAL
    elsewhere = Pose2(9, 4, 0.0)
    assert without_obstacles_in(grid, occupancy, elsewhere, BODY) is grid


def test_a_start_inside_inflation_is_opened_away_from_the_obstacle_only() -> None:
    _, grid, _ = walled()
    start = grid.spec.cell_of(0.7, 4.05)
    assert grid.cost[start] == LETHAL
    opened = open_at(grid, start, BODY)
    row, column = start
    assert opened.cost[row, column] != LETHAL
    assert (opened.cost[row, column:] != LETHAL).all(), "a path out"
    assert (opened.cost[row, : column - 1] == LETHAL).all(), (
        "no path towards the obstacle"
    )
    free = grid.spec.cell_of(6, 4)
    assert open_at(grid, free, BODY) is grid


def test_cells_and_metres_agree_on_a_turned_grid() -> None:
    spec = GridSpec(0.2, 30, 20, Pose2(1.0, -2.0, 0.6))
    grid = planning_grid(np.zeros(spec.shape, np.int8), spec, BODY, PARAMS)
    points = np.array([[2.0, 0.5], [3.5, 1.0]])
    np.testing.assert_allclose(grid.to_metres(grid.to_cells(points)), points)
    u, v = grid.to_cells(points)[0]
    assert grid.cell_of(2.0, 0.5) == (int(v), int(u))
    assert grid.cell_of(50.0, 0.0) is None


def test_a_map_of_another_size_is_refused() -> None:
    spec = GridSpec(0.1, 5, 5)
    with pytest.raises(InvalidValueError, match=r"\(3, 4\)"):
        planning_grid(np.zeros((3, 4), np.int8), spec, BODY, PARAMS)


def test_end_tolerance_above_goal_tolerance_is_refused() -> None:
    with pytest.raises(ParameterError, match="path_end_tolerance_m"):
        PlannerParams(goal_tolerance_m=0.2, path_end_tolerance_m=0.3)


def test_resampled_points_lie_on_the_line_no_further_apart() -> None:
    line = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.55]])
    points = path_shape.resample(line, 0.1)
    steps = np.hypot(*np.diff(points, axis=0).T)
    assert steps.max() <= 0.1 + 1e-9
    np.testing.assert_allclose(points[[0, -1]], line[[0, -1]])
    assert ((points[:, 1] == 0) | np.isclose(points[:, 0], 1.0)).sum() > len(points) - 2


def test_corners_are_rounded_where_there_is_room_and_kept_where_not() -> None:
    occupancy, grid, params = walled()
    corner = path_shape.resample(np.array([[3.0, 2], [7, 2], [7, 6]]), 0.1)
    rounded = path_shape.smooth(corner, grid, keep_m=0.5)
    np.testing.assert_allclose(rounded[[0, -1]], corner[[0, -1]])
    bend = np.abs(np.diff(path_shape.headed(rounded)[:, 2])).max()
    assert bend < 0.2 < np.abs(np.diff(path_shape.headed(corner)[:, 2])).max()
    fill(occupancy, grid.spec, (6.2, 6.5), (2.5, 2.8))  # a post inside the bend
    narrow = planning_grid(occupancy, grid.spec, BODY, params)
    kept = path_shape.smooth(corner, narrow, keep_m=5.0)
    post = (6.35, 2.65)
    nearest = np.hypot(*(corner - post).T).min()
    assert np.hypot(*(kept - post).T).min() >= nearest - 0.05


def test_directions_are_forward_reverse_or_turn() -> None:
    poses = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1.0], [0.5, -0.8, 1.0]])
    assert path_shape.directions(poses).tolist() == [1, 0, -1]
    assert path_shape.turns(poses).tolist() == [0, 1.0, 0]


def test_a_turn_uses_the_shorter_direction_in_small_steps() -> None:
    poses = path_shape.turn_in_place(1.0, 2.0, 3.0, -3.0)
    assert len(poses) == 3
    np.testing.assert_allclose(poses[[0, -1], 2], [3.0, -3.0])
    assert abs(poses[1, 2]) == pytest.approx(math.pi)


def test_path_cost_includes_length_turns_reverse_and_cell_cost() -> None:
    _, grid, _ = walled()
    out = np.array([[6.0, 4, 0], [7, 4, 0], [7, 4, math.pi], [6.5, 4, math.pi]])
    rates = {"turn_cost_m_per_rad": 0.5, "reverse_factor": 2.0}
    cost = path_shape.path_cost(out, grid, **rates)
    assert cost == pytest.approx(1 + 0.5 * math.pi + 0.5)
    back = np.array([[6.0, 4, 0], [5.5, 4, 0]])
    assert path_shape.path_cost(back, grid, **rates) == pytest.approx(1.0)
    tight = np.array([[1.2, 4, 1.57], [1.2, 5, 1.57]])
    assert path_shape.path_cost(tight, grid, **rates) > 2.0


def test_a_path_is_bad_from_its_first_pose_without_margin() -> None:
    _, grid, params = walled()
    x = np.arange(5.0, 1.0, -0.1)
    poses = np.column_stack([x, np.full_like(x, 4.0), np.full_like(x, math.pi)])
    check = check_path(poses, grid, BODY)
    assert not check.fits
    nose = poses[check.first_bad, 0] - 1.5
    assert nose - 0.3 == pytest.approx(params.clearance_margin_m, abs=0.15)


def test_from_a_start_without_margin_the_clearance_must_not_decrease() -> None:
    _, grid, _ = walled()
    out = np.array([[1.9 + 0.1 * i, 4.0, math.pi] for i in range(20)])
    assert check_path(out, grid, BODY).clearance_m[0] < grid.margin_m
    assert check_path(out, grid, BODY).fits
    closer = out - (0.1, 0, 0)
    assert check_path(np.concatenate([out[:1], closer]), grid, BODY).first_bad == 1
    back_in = np.concatenate([out, out[::-1]])
    assert not check_path(back_in, grid, BODY).fits, "once out, the margin holds"


def test_a_path_is_bad_where_the_body_would_hit_a_post_between_two_poses() -> None:
    occupancy, spec = empty_map(12, 8)
    fill(occupancy, spec, (6.0, 6.1), (4.0, 4.1))
    body = BodyShape.of(
        Footprint.from_flat((0.3, 0.2, -0.3, 0.2, -0.3, -0.2, 0.3, -0.2)), 0.1
    )
    grid = planning_grid(occupancy, spec, body, PlannerParams(clearance_margin_m=0.05))
    past = np.array([[5.0, 4.05, 0.0], [5.5, 4.05, 0.0], [6.6, 4.05, 0.0]])
    assert check_path(past[[0, 1, 1]], grid, body).fits
    assert check_path(past, grid, body).first_bad == 2
    # Turning from side to side of the post, no pose touches it.
    turned = np.array([[5.7, 4.05, -0.9], [5.7, 4.05, 0.9]])
    assert check_path(turned[:1], grid, body).fits
    assert check_path(turned[1:], grid, body).fits
    assert check_path(turned, grid, body).first_bad == 1


def random_params(rng: np.random.Generator) -> PlannerParams:
    return PlannerParams(
        footprint_m=COURSE_FOOTPRINT,
        unknown_cost=float(rng.choice([0.0, 0.25, 3.0])),
        map_cost_weight=float(rng.choice([0.0, 2.0])),
        allow_unknown=bool(rng.random() < 0.7),
    )


@pytest.mark.parametrize("seed", range(12))
def test_a_map_that_is_known_in_part_gives_the_grid_of_all_its_cells(seed: int) -> None:
    rng = np.random.default_rng(seed)
    occupancy, spec = empty_map(12, 8)
    rows, columns = spec.shape
    first = rng.integers(0, (rows, columns))
    last = np.minimum(first + rng.integers(0, 60, 2), (rows, columns))  # may be empty
    part = slice(first[0], last[0]), slice(first[1], last[1])
    known = rng.choice(np.array([UNKNOWN, 0, 40, 100], np.int8), spec.shape)
    occupancy[:] = UNKNOWN
    occupancy[part] = known[part]
    params = random_params(rng)
    grid = planning_grid(occupancy, spec, BODY, params)
    level = distance_levels(grid.obstacles, grid.distances.metres)
    cost = np.zeros(spec.shape, np.uint8)
    whole = CellWindow.whole(spec.shape)
    grid.costs.fill(occupancy, level, cost, whole, all_parts(spec.shape))
    assert (grid.distances.level == level).all()
    assert (grid.cost == cost).all()
    if grid.cheap is not None:
        every = CheapTiles(cost, int(grid.costs.unknown), whole)
        assert (grid.cheap.distances() == every.distances()).all()


@pytest.mark.parametrize("seed", range(12))
def test_a_changed_map_gives_the_grid_of_a_new_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    occupancy, spec = empty_map(12, 8)
    params = random_params(rng)
    grid = planning_grid(occupancy, spec, BODY, params)
    values = np.array([UNKNOWN, 0, 40, 100], np.int8)
    for _ in range(8):
        window = CellWindow(0, 30, 0, 40).shifted(*rng.integers(0, 50, 2))
        window = window.grown(0, spec.shape)
        part = occupancy[window.slices]
        changed = rng.random(part.shape) < rng.choice([0.0, 0.002, 0.3])
        part[changed] = rng.choice(values, part.shape, p=[0.3, 0.3, 0.3, 0.1])[changed]
        before = grid.cost.copy()
        grid, fell = update_grid(grid, occupancy, window, params.lethal_cost, NO_HITS)
        new = planning_grid(occupancy, spec, BODY, params)
        assert (grid.obstacles == new.obstacles).all()
        assert (grid.distances.level == new.distances.level).all()
        assert (grid.cost == new.cost).all()
        assert fell == (grid.cost < before).any()
