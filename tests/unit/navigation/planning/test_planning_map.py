"""The planner's map: windows of change, goals outside it, grids changed in place."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import NO_CELLS, UNKNOWN, CellWindow, GridSpec
from navette.navigation.planning import NewMap, PlannerParams, prepared_map
from navette.navigation.planning.planner import Goal, Planner
from navette.navigation.planning.planning_grid import (
    BodyShape,
    planning_grid,
    update_grid,
)
from navette.navigation.planning.planning_map import PlanningMap

SPEC = GridSpec(0.1, 90, 70, Pose2(-1.0, 2.0, 0.0))
PARAMS = PlannerParams()
BODY = BodyShape.of(Footprint.from_flat(PARAMS.footprint_m), 0.1)
Cells = NDArray[np.int8]


def random_map(rng: np.random.Generator) -> Cells:
    cells = rng.choice(np.array([0, 0, 0, 50], np.int8), SPEC.shape)
    cells[rng.random(SPEC.shape) < 0.01] = 100
    cells[:, 50:] = UNKNOWN
    return cells


def changed(rng: np.random.Generator, cells: Cells) -> tuple[Cells, CellWindow]:
    row, column = rng.integers(0, 60), rng.integers(0, 80)
    window = CellWindow(row, row + rng.integers(1, 10), column, column + 9).grown(
        0, SPEC.shape
    )
    after = cells.copy()
    values = np.array([0, 0, 20, 100, UNKNOWN], np.int8)
    after[window.slices] = rng.choice(values, window.shape)
    return after, window


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize(
    "params",
    [
        PARAMS,
        replace(PARAMS, map_cost_weight=2.0),
        replace(PARAMS, allow_unknown=False),
    ],
)
def test_a_grid_changed_in_place_equals_a_fresh_one(
    seed: int, params: PlannerParams
) -> None:
    rng = np.random.default_rng(seed)
    cells = random_map(rng)
    grid = planning_grid(cells, SPEC, BODY, params)
    for _ in range(5):
        before = grid.cost.copy()
        cells, window = changed(rng, cells)
        grid, fell = update_grid(grid, cells, window, params.lethal_cost, grid.hits)
        fresh = planning_grid(cells, SPEC, BODY, params)
        np.testing.assert_array_equal(grid.obstacles, fresh.obstacles)
        np.testing.assert_array_equal(grid.distances.level, fresh.distances.level)
        np.testing.assert_array_equal(grid.cost, fresh.cost)
        assert fell == bool((grid.cost < before).any())


@pytest.mark.parametrize("seed", range(10))
def test_maps_are_compared_where_nothing_is_known_about_the_change(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = random_map(rng)
    mine = PlanningMap(cells, SPEC)
    after, _ = changed(rng, cells)
    window = mine.receive(after, SPEC)
    rows, columns = np.nonzero(after != cells)
    assert window is not None
    if len(rows):
        assert window == (rows.min(), rows.max() + 1, columns.min(), columns.max() + 1)
    else:
        assert window == NO_CELLS
    np.testing.assert_array_equal(mine.cells, after)
    assert mine.receive(after.copy(), SPEC) == NO_CELLS


def test_a_map_that_holds_a_goal_follows_the_received_one_as_it_grows() -> None:
    rng = np.random.default_rng(1)
    cells = random_map(rng)
    mine = PlanningMap(cells, SPEC)
    assert not mine.hold(3.0, 5.0, 400.0)
    assert mine.hold(-50.0, 60.0, 400.0)
    assert mine.spec.contains(*mine.spec.cell_of(-50.0, 60.0))
    grown = np.pad(cells, ((30, 0), (20, 0)), constant_values=UNKNOWN)
    grown[5, 5] = 100
    spec = GridSpec(0.1, 110, 100, Pose2(-3.0, -1.0, 0.0))
    assert mine.receive(grown, spec) is None, "it has grown to the other side"
    assert mine.spec == spec
    assert mine.hold(-50.0, 60.0, 400.0)
    grown = grown.copy()
    grown[7, 9] = 100
    row, column = mine.spec.cell_of(*spec.center_of(7, 9))
    assert mine.receive(grown, spec) == (row, row + 1, column, column + 1)
    assert mine.cells[row, column] == 100


def test_a_smaller_map_leaves_nothing_of_the_one_before() -> None:
    """As after a clear of the map, or another map that is loaded."""
    cells = np.full(SPEC.shape, 100, np.int8)
    mine = PlanningMap(cells, SPEC)
    mine.hold(0.0, 60.0, 400.0)
    smaller = GridSpec(0.1, 40, 30, SPEC.origin)
    free = np.zeros(smaller.shape, np.int8)
    assert mine.receive(free, smaller) is None
    assert mine.spec == smaller
    assert not mine.cells.any()
    assert mine.hold(0.0, 60.0, 400.0)
    free = free.copy()
    free[3, 4] = 100
    row, column = mine.spec.cell_of(*smaller.center_of(3, 4))
    assert mine.receive(free, smaller) == (row, row + 1, column, column + 1)
    assert (cells == 100).all(), "the array of the first message"


def test_a_goal_beyond_the_largest_size_stays_outside() -> None:
    mine = PlanningMap(np.zeros(SPEC.shape, np.int8), SPEC)
    assert not mine.hold(0.0, 60.0, 50.0)
    assert mine.hold(0.0, 47.5, 50.0), "less room beyond it, but within the limit"
    assert mine.spec.contains(*mine.spec.cell_of(0.0, 47.5))


def test_a_goal_far_outside_the_map_gets_a_path() -> None:
    planner = Planner(PARAMS)
    planner.set_map(NewMap(np.zeros(SPEC.shape, np.int8), SPEC))
    plan = planner.plan(Pose2(2.0, 5.0, 0.0), Goal(150.0, 5.0))
    assert plan.outcome.has_path
    assert plan.poses[-1, :2] == pytest.approx((150.0, 5.0))


def test_copies_keep_their_map_when_another_detaches() -> None:
    rng = np.random.default_rng(2)
    cells = random_map(rng)
    planner = Planner(PARAMS)
    planner.set_map(NewMap(cells, SPEC))
    kept = planner.copy()
    before = kept.grid().cost.copy()
    planner.grid()
    planner = kept.copy()
    planner.map.detach()
    planner.set_map(NewMap(np.zeros(SPEC.shape, np.int8), SPEC))
    np.testing.assert_array_equal(kept.grid().cost, before)
    assert planner.grid().cost.max() == 0


@pytest.mark.parametrize("most", [0, 10**9])
def test_a_large_change_is_prepared_with_the_next_plan(
    monkeypatch: pytest.MonkeyPatch, most: int
) -> None:
    monkeypatch.setattr(prepared_map, "_MOST_UPDATED", most)
    rng = np.random.default_rng(4)
    planner = Planner(PARAMS)
    planner.set_map(NewMap(random_map(rng), SPEC))
    before = planner.grid()
    walled = np.zeros(SPEC.shape, np.int8)
    walled[:, 40:42] = 100
    planner.set_map(NewMap(walled, SPEC))
    assert planner.map.take_cost_fall()
    fresh = planning_grid(walled, SPEC, BODY, PARAMS)
    is_updated_already = bool((before.cost == fresh.cost).all())
    assert is_updated_already == (most > 0)
    np.testing.assert_array_equal(planner.grid().cost, fresh.cost)
