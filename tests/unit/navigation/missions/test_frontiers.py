"""Frontiers of small maps drawn as text."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.missions.explore.frontiers import (
    Exploration,
    Frontier,
    FrontierParams,
    FrontierSearch,
)

# One cell is 0.5 m. "#" occupied, "." free, " " unknown; the first line is the top.
CELLS = {"#": 100, ".": 0, " ": -1, "o": 40}
PARAMS = FrontierParams(clearance_m=0.4, min_length_m=0.9, viewpoint_m=1.5)


def grid(*lines: str) -> tuple[NDArray[np.int8], GridSpec]:
    rows = [[CELLS[sign] for sign in line] for line in reversed(lines)]
    cells = np.array(rows, np.int8)
    spec = GridSpec(0.5, cells.shape[1], cells.shape[0], Pose2(0.0, 0.0, 0.0))
    return cells, spec


def explore(
    cells: NDArray[np.int8],
    spec: GridSpec,
    robot: tuple[float, float],
    params: FrontierParams,
    **avoided: Sequence[Frontier],
) -> Exploration:
    return FrontierSearch.of(cells, spec, params).explore(robot, **avoided)


def in_turn(
    cells: NDArray[np.int8],
    spec: GridSpec,
    robot: tuple[float, float],
    params: FrontierParams,
) -> list[Frontier]:
    """Return all frontiers that can be reached, the best first."""
    search = FrontierSearch.of(cells, spec, params)
    found: list[Frontier] = []
    while (best := search.explore(robot, failed=found).best) is not None:
        found.append(best)
    return found


def test_a_closed_room_has_no_frontier() -> None:
    cells, spec = grid("######", "#....#", "#....#", "#....#", "######")
    found = explore(cells, spec, (1.25, 1.25), PARAMS)
    assert (found.best, found.count, found.open_share) == (None, 0, 0.0)
    assert found.free_m2 == pytest.approx(12 * 0.25)
    assert found.known_m2 == pytest.approx(30 * 0.25)


def test_an_opening_is_a_frontier_with_a_goal_in_front_of_it() -> None:
    cells, spec = grid(
        "##########",
        "#........ ",
        "#........ ",
        "#........ ",
        "##########",
    )
    search = FrontierSearch.of(cells, spec, PARAMS)
    found = search.explore((1.25, 1.25))
    frontier = found.best
    assert frontier is not None
    assert found.count == 1
    assert frontier.middle == pytest.approx((4.25, 1.25))
    assert frontier.length_m == pytest.approx(1.5)
    x, y = frontier.goal
    assert math.dist(frontier.goal, frontier.middle) <= 1.5
    assert 0.9 <= y <= 1.6
    assert frontier.way_m == pytest.approx(x - 1.25)
    assert 0.0 < found.open_share < 0.5
    assert search.is_open(frontier)
    search.update(np.zeros((3, 1), np.int8), CellWindow(1, 4, 9, 10))
    assert not search.is_open(frontier)


def test_the_way_leads_around_walls_and_the_nearer_frontier_is_first() -> None:
    cells, spec = grid(
        "                ",
        "#..............#",
        "#..............#",
        "#..............#",
        "#######...#....#",
        "#.....#...#....#",
        "#.....#...#....#",
        "#.....#...#....#",
        "#         #    #",
    )
    params = FrontierParams(0.4, 100, 0.9, 1.5, 0.0, 10.0)
    frontiers = in_turn(cells, spec, (4.25, 2.25), params)
    ways = [each.way_m for each in frontiers]
    assert ways == sorted(ways)
    # The room on the left is behind walls.
    assert len(frontiers) == 3
    assert explore(cells, spec, (4.25, 2.25), params).count == 4
    right = next(each for each in frontiers if each.middle[0] > 5.0
                 and each.middle[1] < 2.0)  # fmt: skip
    assert right.way_m > math.dist((4.25, 2.25), right.goal) + 0.8


def test_longer_frontiers_are_worth_a_longer_way() -> None:
    lines = ["#" + "." * 20 + "#"] * 3
    cells, spec = grid("#" * 22, *lines, "#" + "." * 3 + "#" * 18)
    cells[1:4, 0] = -1  # three cells wide, near
    cells[4, 12:21] = -1  # nine cells wide, far
    near = explore(
        cells, spec, (1.75, 1.25), FrontierParams(0.4, 100, 0.9, 1.5, 0.0, 10.0)
    )
    long = explore(
        cells, spec, (1.75, 1.25), FrontierParams(0.4, 100, 0.9, 1.5, 3.0, 10.0)
    )
    assert near.best is not None
    assert long.best is not None
    assert near.best.length_m < long.best.length_m


def test_frontiers_that_failed_are_avoided() -> None:
    cells, spec = grid("########", "#...... ", "#...... ", "#...... ", "########")
    (frontier,) = in_turn(cells, spec, (1.25, 1.25), PARAMS)
    found = explore(cells, spec, (1.25, 1.25), PARAMS, failed=[frontier])
    assert (found.best, found.count) == (None, 1)


def test_a_visited_frontier_is_seen_from_another_place_only() -> None:
    cells, spec = grid("########", "#...... ", "#...... ", "#...... ", "########")
    (frontier,) = in_turn(cells, spec, (1.25, 1.25), PARAMS)
    found = explore(cells, spec, (1.25, 1.25), PARAMS, visited=[frontier])
    assert (found.best, found.count) == (None, 1)
    elsewhere = replace(frontier, goal=(frontier.goal[0] - 1.0, frontier.goal[1]))
    again = explore(cells, spec, (1.25, 1.25), PARAMS, visited=[elsewhere])
    assert again.best == frontier


def test_a_robot_beside_a_wall_leaves_and_one_outside_reaches_nothing() -> None:
    cells, spec = grid("########", "#...... ", "#...... ", "#...... ", "########")
    assert explore(cells, spec, (0.75, 0.75), PARAMS).best is not None
    outside = explore(cells, spec, (-50.0, 0.75), PARAMS)
    assert (outside.best, outside.count) == (None, 1)


def test_a_frontier_is_seen_from_its_own_side_of_a_wall() -> None:
    """The nearest free cell in a straight line may be behind the wall."""
    cells, spec = grid(
        "################",
        "#.............##",
        "#.............##",
        "#.............##",
        "##########....##",
        "          .....#",
        "          .....#",
        "          .....#",
        "################",
    )
    frontiers = in_turn(cells, spec, (1.25, 2.75), PARAMS)
    frontier = min(frontiers, key=lambda each: each.middle[1])
    assert frontier.goal[0] > 5.0
    assert frontier.goal[1] < 2.0


def test_a_long_frontier_is_divided() -> None:
    lines = ["#" + "." * 30 + "#"] * 3
    cells, spec = grid("#" * 32, *lines, " " * 32)
    params = FrontierParams(0.4, 100, 0.9, 1.5, 0.0)
    frontiers = in_turn(cells, spec, (1.25, 1.25), params)
    assert len(frontiers) == 4
    assert sum(each.length_m for each in frontiers) == pytest.approx(15.0)
    assert all(abs(each.goal[0] - each.middle[0]) < 1.1 for each in frontiers)


@pytest.mark.parametrize(("passage_m", "reached"), [(0.4, True), (0.9, False)])
def test_a_frontier_behind_a_door_is_reached_if_the_robot_fits(
    passage_m: float, reached: bool
) -> None:
    """The door is too narrow to look from, but not to pass."""
    room = ["#" + "." * 23 + "#"] * 5
    cells, spec = grid("#" * 25, *room, "#" * 12 + "." + "#" * 12, *room, "#" * 25)
    cells[1:6, 24] = -1  # the frontier, in the lower room
    params = FrontierParams(0.9, 100, 0.9, 1.5, 0.0, 10.0, passage_m)
    found = explore(cells, spec, (3.25, 5.25), params)
    assert (found.best is not None) is reached


def test_unknown_cells_around_the_map_change_nothing() -> None:
    cells, spec = grid(
        "##########",
        "#........ ",
        "#....#... ",
        "#.   #....",
        "#.   ###..",
    )
    cells, corner = np.pad(cells, 1, constant_values=-1), Pose2(-0.5, -0.5, 0.0)
    spec = GridSpec(0.5, cells.shape[1], cells.shape[0], corner)
    larger = np.pad(cells, ((4, 30), (7, 20)), constant_values=-1)
    shift = Pose2(-7 * 0.5, -4 * 0.5, 0.0)
    larger_spec = GridSpec(0.5, larger.shape[1], larger.shape[0], corner @ shift)
    found = explore(cells, spec, (1.25, 1.25), PARAMS)
    assert found.count == 2
    assert explore(larger, larger_spec, (1.25, 1.25), PARAMS) == found


def test_a_goal_lies_before_the_middle_of_its_frontier_not_at_its_near_end() -> None:
    cells = np.full((40, 80), -1, np.int8)
    cells[:30, :] = 100
    cells[1:29, 1:79] = 0
    cells[29, 30:68] = 0  # an opening of 3.8 m
    spec = GridSpec(0.1, 80, 40, Pose2(0.0, 0.0, 0.0))
    params = FrontierParams(clearance_m=0.3, viewpoint_m=0.6, passage_m=0.2)
    best = explore(cells, spec, (0.75, 0.75), params).best
    assert best is not None
    assert abs(best.goal[0] - best.middle[0]) < 0.3
