"""Plans in a map of 200 m for which the grid's route does not do, and frontiers of it.

    python benchmarks/bench_hard_goals.py [--json]

A robot of 0.5 x 0.4 m on a free map of 4096² cells of 5 cm, a quarter of it unknown.
The goal is 12 m away: free, in an obstacle, in a closed room, behind a door, or the
robot stands in a dead end. The time must not depend on the size of the map.
"""

import numpy as np
from harness import Benchmark

from navette.geometry import Pose2
from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.missions.explore.frontiers import (
    FrontierParams,
    FrontierSearch,
)
from navette.navigation.planning import (
    Goal,
    NewMap,
    Planner,
    PlannerParams,
)

CELLS, EDGE_M = 4096, 0.05
CORNER_M = -CELLS * EDGE_M / 2
SPEC = GridSpec(EDGE_M, CELLS, CELLS, Pose2(CORNER_M, CORNER_M, 0.0))
PARAMS = PlannerParams(
    footprint_m=(-0.25, -0.2, 0.25, -0.2, 0.25, 0.2, -0.25, 0.2),
    clearance_margin_m=0.1,
)
START, GOAL = Pose2(0.0, 0.0, 0.0), Goal(12.0, 3.0)
Box = tuple[float, float, float, float]
"""Least and largest x, least and largest y, m."""


def walls(x: float, y: float, half: float) -> list[Box]:
    """Return the walls of a room, 10 cm thick."""
    low, high = -half, half - 0.1
    sides = ((low, half, low, low + 0.1), (low, half, high, half),
             (low, low + 0.1, low, half), (high, half, low, half))  # fmt: skip
    return [(x + a, x + b, y + c, y + d) for a, b, c, d in sides]


ROOM = walls(GOAL.x, GOAL.y, 2.0)
# Closed and then opened cells, and whether a path exists.
CASES: dict[str, tuple[list[Box], list[Box], bool]] = {
    "free": ([], [], True),
    "goal in an obstacle": ([(11.0, 13.0, 2.0, 4.0)], [], False),
    "goal in a closed room": (ROOM, [], False),
    "door of 0.6 m": (ROOM, [(9.9, 10.2, 2.7, 3.3)], True),
    "start in a closed room": (walls(0.0, 0.0, 2.0), [], False),
    "start in a dead end": (
        [(-1.5, 1.0, -0.45, -0.4), (-1.5, 1.0, 0.4, 0.45), (0.55, 0.6, -0.45, 0.45)],
        [],
        True,
    ),
}


def cells_with(closed: list[Box], opened: list[Box]) -> np.ndarray:
    """Return a map with boxes that are occupied, and then some that are free."""
    cells = np.zeros(SPEC.shape, np.int8)
    cells[:, : CELLS // 4] = -1
    for boxes, value in ((closed, 100), (opened, 0)):
        for box in boxes:
            left, right, low, high = (round((at - CORNER_M) / EDGE_M) for at in box)
            cells[low:high, left:right] = value
    return cells


def new(cells: np.ndarray) -> None:
    """Look for a frontier in a map that is whole and new."""
    FrontierSearch.of(cells, SPEC, FrontierParams()).explore((0.0, 0.0))


def changed(search: FrontierSearch, part: np.ndarray, window: CellWindow) -> None:
    """Look for a frontier in a map of which a part, near to the robot, changed."""
    search.update(part, window)
    assert search.explore((-48.0, 0.0)).best is not None


def main() -> None:
    bench = Benchmark("hard_goals", __doc__)
    for name, (closed, opened, has_path) in CASES.items():
        planner = Planner(PARAMS)
        planner.set_map(NewMap(cells_with(closed, opened), SPEC))
        found = planner.plan(START, GOAL).outcome
        assert found.has_path is has_path, f"{name}: {found}"
        bench.case(name, {"navette": lambda planner=planner: planner.plan(START, GOAL)})
    known = np.full(SPEC.shape, -1, np.int8)
    known[1748:2348, 1748:2348] = 0
    bench.case("frontiers of a new map, 30 m known", {"navette": lambda: new(known)})
    whole = cells_with([], [])
    search = FrontierSearch.of(whole, SPEC, FrontierParams())
    window = CellWindow(1800, 2200, 900, 1300)
    bench.case(
        "frontiers, 20 m of 200 m changed",
        {"navette": lambda: changed(search, whole[window.slices], window)},
    )
    whole[:, : CELLS // 4] = 100
    bench.case("frontiers of a new map, 200 m known", {"navette": lambda: new(whole)})
    bench.main()


if __name__ == "__main__":
    main()
