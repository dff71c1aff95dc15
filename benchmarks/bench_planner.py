"""Grid search compared with pyastar2d and scikit-image.

Each run answers the next of a dozen queries across the map; the median is per query.
Navette's costs are checked against SciPy's Dijkstra on the same graph (diagonal moves
need both orthogonals free). The peers solve an easier problem: pyastar2d charges
diagonals like straight moves, both cut corners.

With ``--movingai DIR`` the scenarios of MovingAI maps in that folder are checked as
well: every length must be exact.
"""

import argparse
import itertools
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyastar2d
from harness import Benchmark
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra as scipy_dijkstra
from skimage.graph import MCP_Geometric

from navette.geometry import Pose2
from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.grids.received_map import MapPart, ReceivedMap
from navette.navigation.planning import Goal, NewMap, Planner, PlannerParams, dijkstra
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.navigator import Navigator
from navette.navigation.planning.reports import RobotMotion
from navette.navigation.planning.string_pulling import centers, pull
from navette.navigation.planning.traversal import (
    LETHAL,
    Cell,
    EdgeTable,
    steps_cost,
)

Query = tuple[Cell, Cell]


def obstacle_map(size: int, seed: int = 1) -> np.ndarray:
    """Rectangles over 18 % of the map (uint8, lethal or free)."""
    rng = np.random.default_rng(seed)
    cost = np.zeros((size, size), np.uint8)
    while (cost > 0).mean() < 0.18:
        row, column = rng.integers(0, size, 2)
        height, width = rng.integers(size // 64, size // 12, 2)
        cost[row : row + height, column : column + width] = LETHAL
    return cost


def cost_field(obstacles: np.ndarray) -> np.ndarray:
    """Costs that decrease with the distance to obstacles."""
    distance = distance_transform_edt(obstacles == 0)
    falling = np.clip(252 * np.exp(-distance / 10), 0, 252)
    return np.where(obstacles > 0, LETHAL, falling).astype(np.uint8)


def maze(size: int, room: int = 16, wall: int = 4, seed: int = 3) -> np.ndarray:
    """Rooms that random walks join to a tree (Wilson 1996): one path to each."""
    rng = np.random.default_rng(seed)
    cost = np.full((size, size), LETHAL, np.uint8)
    count = (size - wall) // room

    def open_between(a: Cell, b: Cell) -> None:
        (top, left), (bottom, right) = np.sort([a, b], axis=0).tolist()
        rows = slice(top * room + wall, (bottom + 1) * room)
        cost[rows, left * room + wall : (right + 1) * room] = 0

    joined = {(0, 0)}
    for start in np.ndindex(count, count):
        step: dict[Cell, Cell] = {}
        at: Cell = start
        while at not in joined:
            move = ((0, 1), (1, 0), (0, -1), (-1, 0))[rng.integers(4)]
            after = at[0] + move[0], at[1] + move[1]
            if min(after) >= 0 and max(after) < count:
                step[at], at = after, after
        at = start
        while at not in joined:
            joined.add(at)
            open_between(at, step[at])
            at = step[at]
    return cost


def clutter(size: int, seed: int = 4) -> np.ndarray:
    """Lethal blocks of one to four cells a side, all over the map."""
    rng = np.random.default_rng(seed)
    cost = np.zeros((size, size), np.uint8)
    for row, column in rng.integers(1, size - 4, (size * size // 40, 2)).tolist():
        height, width = rng.integers(1, 5, 2)
        cost[row : row + height, column : column + width] = LETHAL
    return cost


def far_queries(cost: np.ndarray, count: int = 12, seed: int = 2) -> list[Query]:
    """Return distant, connected free cells."""
    rng = np.random.default_rng(seed)
    free = np.argwhere(cost < LETHAL)
    search = AStar().search
    queries: list[Query] = []
    while len(queries) < count:
        a, b = (tuple(c) for c in free[rng.integers(0, len(free), 2)].tolist())
        if math.dist(a, b) > 0.6 * len(cost) and search(cost, a, b) is not None:
            queries.append((a, b))
    return queries


def each_in_turn(
    queries: list[Query], run: Callable[[Cell, Cell], object]
) -> Callable[[], object]:
    """A contender that answers one query per call."""
    turn = itertools.cycle(queries)
    return lambda: run(*next(turn))


_MOVES = [move for move in itertools.product((-1, 0, 1), repeat=2) if any(move)]


def graph_of(cost: np.ndarray, table: EdgeTable) -> coo_matrix:
    """Return the grid as a SciPy graph: one edge per legal move."""
    index = np.arange(cost.size).reshape(cost.shape)
    free = table.straight[cost] > 0
    rows, columns, weights = [], [], []
    for dr, dc in _MOVES:
        here = _shifted(-dr, -dc, cost.shape)
        there = _shifted(dr, dc, cost.shape)
        legal = free[here] & free[there]
        if dr and dc:
            legal &= free[_mixed(here, there)] & free[_mixed(there, here)]
        units = (table.diagonal if dr and dc else table.straight)[cost[there]]
        rows.append(index[here][legal])
        columns.append(index[there][legal])
        weights.append(units[legal])
    data = np.concatenate(weights).astype(np.float64)
    at = np.concatenate(rows), np.concatenate(columns)
    return coo_matrix((data, at), shape=(cost.size, cost.size)).tocsr()


def _shifted(dr: int, dc: int, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return the part of a grid with a neighbour at (−dr, −dc)."""
    return (
        slice(max(0, dr), shape[0] + min(0, dr)),
        slice(max(0, dc), shape[1] + min(0, dc)),
    )


def _mixed(a: tuple[slice, slice], b: tuple[slice, slice]) -> tuple[slice, slice]:
    return a[0], b[1]


def check_exact(cost: np.ndarray, table: EdgeTable, query: Query) -> None:
    """Check the cost against SciPy's Dijkstra and against the sum over the cells."""
    start, goal = (int(np.ravel_multi_index(c, cost.shape)) for c in query)
    expected = scipy_dijkstra(graph_of(cost, table), indices=start)[goal]
    for search in (AStar().search, dijkstra.search):
        found = search(cost, *query, table=table)
        assert found is not None
        assert found[1] == expected == steps_cost(found[0], cost, table)


def add_searches(
    bench: Benchmark, name: str, cost: np.ndarray, weight: float, target_ms: float
) -> None:
    table, astar = EdgeTable(weight=weight), AStar()
    queries = far_queries(cost)
    check_exact(cost, table, queries[0])
    price = 1 + weight * cost.astype(np.float32) / 252
    weights = np.where(cost == LETHAL, np.float32(np.inf), price).astype(np.float32)
    prices = np.where(cost == LETHAL, -1.0, price)
    contenders = {
        "navette": each_in_turn(
            queries, lambda s, g: astar.search(cost, s, g, table=table)
        ),
        "pyastar2d": each_in_turn(
            queries,
            lambda s, g: pyastar2d.astar_path(weights, s, g, allow_diagonal=True),
        ),
        "skimage MCP": each_in_turn(
            queries, lambda s, g: MCP_Geometric(prices).find_costs([s], [g])
        ),
        "navette dijkstra": each_in_turn(
            queries, lambda s, g: dijkstra.search(cost, s, g, table=table)
        ),
    }
    bench.case(
        name,
        contenders,
        "path costs equal SciPy's Dijkstra",
        target_ms=target_ms,
        least_rounds=len(queries),
    )


def add_string_pulling(bench: Benchmark, cost: np.ndarray) -> None:
    table, search = EdgeTable(), AStar().search
    lines = [centers(search(cost, s, g)[0]) for s, g in far_queries(cost)]  # type: ignore[index]
    turn = itertools.cycle(lines)
    bench.case(
        f"string pulling {len(cost)}²",
        {"navette": lambda: pull(cost, next(turn), table=table)},
        target_ms=0.1,
    )


def add_whole_plans(bench: Benchmark) -> None:
    """The course robot in an arena: map, route, tight corner."""
    outline = (1.5, 0.7, -0.5, 0.7, -0.5, -0.7, 1.5, -0.7)
    spec = GridSpec(0.1, 300, 300, Pose2(-15.0, -15.0, 0.0))
    occupancy = np.zeros(spec.shape, np.int8)
    occupancy[:3] = occupancy[-3:] = occupancy[:, :3] = occupancy[:, -3:] = 100
    for row, column in ((80, 90), (140, 140), (210, 70), (230, 190), (120, 230)):
        occupancy[row : row + 25, column : column + 25] = 100
    planner = Planner(PlannerParams(footprint_m=outline))
    planner.set_map(NewMap(occupancy, spec))
    easy = Pose2(-12.0, -12.0, 0.8), Goal(12.0, 11.0)
    tight = Pose2(-13.1, -13.1, math.radians(-135)), Goal(-5.0, -12.0)
    for ask in (easy, tight):
        assert planner.plan(*ask).outcome.has_path

    def prepare() -> object:
        planner.set_map(NewMap(occupancy, spec))
        return planner.grid()

    bench.case("prepare a 300² map", {"navette": prepare})
    bench.case("plan across it, 34 m", {"navette": lambda: planner.plan(*easy)})
    bench.case("plan out of a corner", {"navette": lambda: planner.plan(*tight)})


def add_map_updates(bench: Benchmark, size: int, target_ms: float) -> None:
    """A part of 354² cells around a driving robot changes; its path is looked after."""
    rng = np.random.default_rng(1)
    spec = GridSpec(0.05, size, size, Pose2(0.0, 0.0, 0.0))
    cells = np.zeros(spec.shape, np.int8)
    for row, column in rng.integers(50, size - 50, (size // 8, 2)).tolist():
        cells[row : row + 20, column : column + 20] = 100
    received, navigator = ReceivedMap(cells, spec), Navigator(PlannerParams())
    navigator.set_map(NewMap(cells, spec))
    navigator.set_goal(Goal(*(size * spec.resolution - 1.0,) * 2), 0)
    clock = itertools.count(0, 1_000_000)  # a robot at rest would be stuck

    def step(pose: Pose2) -> None:
        robot = RobotMotion(pose, 0.5, 0.0)
        navigator.step(robot, next(clock), stale=False)

    step(Pose2(1.0, 1.0, 0.7))
    path = navigator.take_path()
    assert path is not None
    for pose in path[:60]:  # once it has set out, it keeps its path
        step(Pose2(*pose))
    here = Pose2(*path[59])
    window = CellWindow.around(spec, np.array([(here.x, here.y)]), 177)

    before = cells[window.slices].copy()

    def change() -> None:
        part = before.copy()  # a box of 0.4 m, each time elsewhere
        row, column = rng.integers(0, np.array(part.shape) - 8).tolist()
        part[row : row + 8, column : column + 8] = 100
        changed = received.update(MapPart(part, window))
        navigator.set_map(NewMap(received.cells, spec, changed=changed))
        step(here)

    bench.case(
        f"map update, {size}²",
        {"navette": change},
        "a box moves; where it blocks the path, that is planned again",
        target_ms=target_ms,
        least_rounds=50,
    )


def check_movingai(folder: Path) -> None:
    """Print, map by map, how many scenario lengths are exact."""
    exact = total = 0
    for path in sorted(folder.glob("*.map")):
        good, count = _check_map(path)
        print(f"  {path.name:<28} {good} of {count} lengths exact")
        exact, total = exact + good, total + count
    print(f"  {'all':<28} {exact} of {total}")
    if exact != total or not total:
        raise SystemExit(f"MovingAI: {exact} of {total} lengths exact")


def _check_map(path: Path) -> tuple[int, int]:
    lines = path.read_text().splitlines()
    height = int(lines[1].split()[1])
    free = [[0 if c in ".GS" else LETHAL for c in line] for line in lines[4:][:height]]
    cost, search = np.array(free, np.uint8), AStar().search
    good = count = 0
    for line in Path(f"{path}.scen").read_text().splitlines()[1:]:
        column, row, goal_column, goal_row, text = line.split()[4:9]
        found = search(cost, (int(row), int(column)), (int(goal_row), int(goal_column)))
        assert found is not None, line
        diagonal = np.abs(np.diff(found[0], axis=0)).sum(axis=1) == 2
        length = (~diagonal).sum() + math.sqrt(2) * diagonal.sum()
        # Some files have six significant digits, some two decimals.
        digits = len(text.partition(".")[2])
        tolerance = max(0.51 * 10.0**-digits, float(text) * 5e-6)
        good, count = good + (abs(length - float(text)) <= tolerance), count + 1
    return good, count


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, add_help=False)
    parser.add_argument("--movingai", type=Path)
    known, rest = parser.parse_known_args()
    if known.movingai is not None:
        check_movingai(known.movingai)
    bench = Benchmark("planner", __doc__)
    for size, target_ms in ((512, 0.9), (1024, 3.4)):
        add_searches(bench, f"uniform {size}²", obstacle_map(size), 0.0, target_ms)
    for size, target_ms in ((1024, 12.0), (2048, 38.0)):
        field = cost_field(obstacle_map(size))
        add_searches(bench, f"cost field {size}²", field, 3.0, target_ms)
    add_searches(bench, "maze 1024²", maze(1024), 0.0, 16.0)
    add_searches(bench, "clutter 1024²", clutter(1024), 0.0, 1.6)
    add_string_pulling(bench, obstacle_map(1024))
    add_whole_plans(bench)
    for size, target_ms in ((1024, 1.0), (4096, 3.0)):
        add_map_updates(bench, size, target_ms)
    bench.main(rest)


if __name__ == "__main__":
    main()
