"""Lines are centred in tight places."""

import numpy as np
import pytest
from planning_worlds import empty_map, fill

from navette.geometry import Footprint
from navette.navigation.grids import exact_clearances, make_outline
from navette.navigation.planning import NewMap, Planner, PlannerParams
from navette.navigation.planning.centring import centred
from navette.navigation.planning.path_shape import headed
from navette.navigation.planning.planning_grid import (
    BodyShape,
    PlanningGrid,
    planning_grid,
)

SQUARE = (0.3, 0.3, -0.3, 0.3, -0.3, -0.3, 0.3, -0.3)
CORNERS = (0.3, 0.25, -0.3, 0.25, -0.3, -0.25, 0.3, -0.25)
FOOTPRINT = Footprint.from_flat(CORNERS)
BODY = BodyShape.of(FOOTPRINT, 0.1)
MIDDLE_M = 4.0


def door(width_m: float) -> PlanningGrid:
    """Return a wall of 1 m thickness with a door whose middle is at y = 4 m."""
    occupancy, spec = empty_map(8, 8)
    fill(occupancy, spec, (3.5, 4.5), (0.0, MIDDLE_M - width_m / 2))
    fill(occupancy, spec, (3.5, 4.5), (MIDDLE_M + width_m / 2, 8.0))
    params = PlannerParams(footprint_m=CORNERS, clearance_margin_m=0.05)
    return planning_grid(occupancy, spec, BODY, params)


def straight(y: float, bow_m: float = 0.0) -> np.ndarray:
    x = np.linspace(2.0, 6.0, 41)
    return np.column_stack([x, y + bow_m * np.sin(np.pi * (x - 2.0) / 4.0)])


def least_m(line: np.ndarray, grid: PlanningGrid) -> float:
    outline = make_outline(FOOTPRINT)
    return float(
        exact_clearances(grid.exact_obstacles, outline, headed(line), 1.0).min()
    )


@pytest.mark.parametrize("bow_m", [0.09, -0.09])
def test_a_line_off_the_middle_of_a_door_gets_there(bow_m: float) -> None:
    grid = door(0.8)
    line = straight(MIDDLE_M, bow_m)
    found = centred(line, grid, BODY)
    assert least_m(found, grid) > least_m(line, grid) + 0.02
    within = (found[:, 0] > 3.5) & (found[:, 0] < 4.5)
    assert np.abs(found[within, 1] - MIDDLE_M).max() < 0.06


def test_the_ends_stay_and_the_given_line_is_not_changed() -> None:
    line = straight(MIDDLE_M, 0.09)
    given = line.copy()
    found = centred(line, door(0.8), BODY)
    np.testing.assert_array_equal(line, given)
    np.testing.assert_array_equal(found[[0, -1]], line[[0, -1]])


def test_a_line_with_space_enough_stays() -> None:
    line = straight(MIDDLE_M, 0.09)
    np.testing.assert_array_equal(centred(line, door(2.0), BODY), line)


def test_a_door_that_is_too_narrow_gets_the_best_there_is() -> None:
    """Whether the body fits is for the check that follows."""
    grid = door(0.4)
    line = straight(MIDDLE_M, 0.09)
    found = centred(line, grid, BODY)
    assert np.isfinite(found).all()
    assert least_m(found, grid) >= least_m(line, grid)


@pytest.mark.parametrize("count", [2, 3, 4, 5, 30])
def test_lines_of_any_number_of_points_move_to_the_middle(count: int) -> None:
    occupancy, spec = empty_map(6, 4)
    fill(occupancy, spec, (1, 5), (0, 1.6))
    fill(occupancy, spec, (1, 5), (2.4, 4))
    planner = Planner(PlannerParams(footprint_m=SQUARE, clearance_margin_m=0.03))
    planner.set_map(NewMap(occupancy, spec))
    line = np.column_stack([np.linspace(2, 4, count), np.full(count, 2.05)])
    line[[0, -1], 1] = 2.0
    moved = centred(line, planner.grid(), planner.body)
    assert moved[[0, -1]] == pytest.approx(line[[0, -1]])
    assert np.abs(moved[:, 1] - 2.0).max() <= np.abs(line[:, 1] - 2.0).max()
    if count == 30:
        assert np.abs(moved[5:-5, 1] - 2.0).max() < 0.04
