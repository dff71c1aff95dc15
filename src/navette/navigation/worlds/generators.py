"""Worlds generated from a seed, with a start, a goal and the shortest path's length.

Every world has a path for a disc of :data:`CORRIDOR_M`; without one it is drawn again.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from navette.errors import UnknownNameError
from navette.geometry import Pose2, Transform3
from navette.navigation.grids import GridSpec
from navette.navigation.worlds.shortest import grid_between, shortest_length
from navette.sim import Scene, World

CORRIDOR_M = 0.75
"""Width of the narrowest passage of the path; a Jackal is 0.43 m wide."""

_CELL_M = 0.15
_POST_M = 0.075
_ATTEMPTS = 200

Filled = NDArray[np.bool_]


@dataclass(frozen=True)
class GeneratedWorld:
    """A world with one drive; lengths in metres, poses in the map frame."""

    scene: Scene
    start: Pose2
    goal: tuple[float, float]
    shortest_m: float


def generate(kind: str, seed: int) -> GeneratedWorld:
    """Return the world of a kind and a seed; equal arguments give equal worlds.

    Raises:
        UnknownNameError: unknown kind; the text lists the known ones.
    """
    if kind not in GENERATORS:
        raise UnknownNameError.of("kind of world", kind, list(GENERATORS))
    rng = np.random.default_rng([seed, sorted(GENERATORS).index(kind)])
    for _ in range(_ATTEMPTS):
        plot = GENERATORS[kind](rng)
        shortest_m = plot.shortest()
        if shortest_m is not None:
            scene = plot.scene(f"{kind}-{seed}")
            return GeneratedWorld(scene, plot.start, plot.goal, shortest_m)
    raise AssertionError(f"no passable world of kind {kind} for seed {seed}")


@dataclass(frozen=True)
class _Plot:
    """Posts (N, 2) and boxes (M, 4: x, y, size x, size y) within a rectangle, m."""

    posts: NDArray[np.float64]
    boxes: NDArray[np.float64]
    start: Pose2
    goal: tuple[float, float]
    low: tuple[float, float]
    high: tuple[float, float]
    post_m: float = _POST_M

    def scene(self, name: str) -> Scene:
        world = World(name)
        for x, y in self.posts.tolist():
            world.add_cylinder((x, y), self.post_m)
        for x, y, wide, deep in self.boxes.tolist():
            world.add_box((x, y), (wide, deep))
        return replace(world.scene(), start=Transform3.from_pose2(self.start))

    def shortest(self) -> float | None:
        """Return the length of the shortest path of a disc, or None."""
        spec = grid_between(self.low, self.high)
        points = ((self.start.x, self.start.y), self.goal)
        return shortest_length(self._lethal(spec), spec, points, CORRIDOR_M / 2)

    def _lethal(self, spec: GridSpec) -> NDArray[np.uint8]:
        columns, rows = np.arange(spec.width), np.arange(spec.height)
        xs = spec.centers_of(np.stack([0 * columns, columns], axis=1))[:, 0]
        ys = spec.centers_of(np.stack([rows, 0 * rows], axis=1))[:, 1]
        lethal = np.zeros(spec.shape, np.uint8)
        for x, y in self.posts:
            across, along = np.abs(xs - x) <= self.post_m, np.abs(ys - y) <= self.post_m
            away = np.hypot(xs[across] - x, ys[along, None] - y)
            lethal[np.ix_(along, across)] |= away <= self.post_m
        for x, y, wide, deep in self.boxes:
            across, along = np.abs(xs - x) <= wide / 2, np.abs(ys - y) <= deep / 2
            lethal[np.ix_(along, across)] = 1
        return lethal


def _automaton(rng: np.random.Generator, share: float, rounds: int) -> Filled:
    """Return (30, 30) cells of a cellular automaton.

    Perille et al., "Benchmarking Metric Ground Navigation" (2020), section III: random
    fill, then a cell with five filled neighbours fills, one with at most one clears.
    """
    filled = rng.random((30, 30)) < share
    for _ in range(rounds):
        padded = np.pad(filled, 1).astype(int)
        near = sum(
            padded[1 + dr : 31 + dr, 1 + dc : 31 + dc]
            for dr in (-1, 0, 1)
            for dc in (-1, 0, 1)
            if dr or dc
        )
        filled = (near >= 5) | (filled & (near > 1))
    return filled


def _barn_like(rng: np.random.Generator) -> _Plot:
    """A field of posts between two walls of posts, as the worlds of BARN."""
    filled = _automaton(rng, rng.uniform(0.15, 0.3), int(rng.integers(2, 5)))
    rows, columns = np.nonzero(filled)
    field = np.stack([-4.425 + _CELL_M * columns, 5.075 + _CELL_M * rows], axis=1)
    along = np.arange(0.075, 9.6, _CELL_M)
    walls = [(x, y) for x in (-4.425, -0.075) for y in along]
    back = [(x, 0.075) for x in np.arange(-4.275, -0.2, _CELL_M)]
    posts = np.concatenate([field, np.array(walls + back)])
    return _Plot(
        posts, np.empty((0, 4)), Pose2(-2.25, 3.0, np.pi / 2), (-2.25, 13.0),
        (-4.5, 0.0), (0.0, 14.0),
    )  # fmt: skip


def _forest(rng: np.random.Generator) -> _Plot:
    """Trunks scattered over 20 m × 20 m, with a wall around."""
    count = int(rng.integers(60, 160))
    trunks = rng.uniform(-9.5, 9.5, (count, 2))
    start, goal = Pose2(-8.5, -8.5, np.pi / 4), (8.5, 8.5)
    clear = [np.hypot(*(trunks - at).T) > 1.2 for at in ((start.x, start.y), goal)]
    trunks = trunks[clear[0] & clear[1]]
    return _Plot(trunks, _walls(20.0), start, goal, (-10, -10), (10, 10), 0.15)


def _rooms(rng: np.random.Generator) -> _Plot:
    """A 3 × 3 grid of rooms with one door in each wall, most of them open."""
    boxes = [*_walls(18.0)]
    for line in (-3.0, 3.0):
        for low in (-9.0, -3.0, 3.0):
            width = rng.uniform(0.9, 1.6)
            door = rng.uniform(low + 1.0, low + 5.0 - width)
            if rng.random() < 0.15:
                width = 0.0
            for begin, end in ((low, door), (door + width, low + 6.0)):
                centre, size = (begin + end) / 2, end - begin
                boxes.append((centre, line, size, 0.1))
                boxes.append((line, -centre, 0.1, size))
    boxes += [
        (*rng.uniform(-8.0, 8.0, 2), *rng.uniform(0.3, 1.2, 2)) for _ in range(12)
    ]
    return _Plot(
        np.empty((0, 2)), np.array(boxes), Pose2(-7.5, -7.5, 0.0), (7.5, 7.5),
        (-9, -9), (9, 9),
    )  # fmt: skip


def _office(rng: np.random.Generator) -> _Plot:
    """A corridor with rooms on both sides, desks in the rooms."""
    boxes = [*_walls(24.0)]
    for side in (-1, 1):
        wall_y = side * 1.2
        for room in range(6):
            low = -12.0 + 4.0 * room
            width = rng.uniform(0.9, 1.2)
            door = rng.uniform(low + 0.5, low + 3.5 - width)
            for begin, end in ((low, door), (door + width, low + 4.0)):
                boxes.append(((begin + end) / 2, wall_y, end - begin, 0.1))
            if room:
                boxes.append((low, side * 6.6, 0.1, 10.8))
            for _ in range(3):
                x, y = rng.uniform(low + 0.8, low + 3.2), rng.uniform(2.6, 10.5)
                boxes.append((x, side * y, 1.4, 0.7))
    start = Pose2(-10.0 + 4.0 * int(rng.integers(0, 3)), -2.0, 0.0)
    goal = (2.0 + 4.0 * int(rng.integers(0, 3)), 2.0)
    return _Plot(np.empty((0, 2)), np.array(boxes), start, goal, (-12, -12), (12, 12))


def _maze(rng: np.random.Generator) -> _Plot:
    """A perfect maze of 8 × 8 cells by depth-first search; passages of 1.4 m."""
    cells, pitch = 8, 1.5
    joined: set[tuple[tuple[int, int], tuple[int, int]]] = set()
    seen, trail = {(0, 0)}, [(0, 0)]
    while trail:
        row, column = trail[-1]
        free = [
            (r, c)
            for r, c in (
                (row + 1, column), (row - 1, column), (row, column + 1),
                (row, column - 1),
            )
            if 0 <= r < cells and 0 <= c < cells and (r, c) not in seen
        ]  # fmt: skip
        if not free:
            trail.pop()
            continue
        after = free[int(rng.integers(len(free)))]
        joined |= {((row, column), after), (after, (row, column))}
        seen.add(after)
        trail.append(after)
    half = cells * pitch / 2
    boxes = [*_walls(2 * half)]
    for row in range(cells):
        for column in range(cells):
            x, y = (column + 0.5) * pitch - half, (row + 0.5) * pitch - half
            if row + 1 < cells and ((row, column), (row + 1, column)) not in joined:
                boxes.append((x, y + pitch / 2, pitch + 0.1, 0.1))
            if column + 1 < cells and ((row, column), (row, column + 1)) not in joined:
                boxes.append((x + pitch / 2, y, 0.1, pitch + 0.1))
    corner = half - pitch / 2
    return _Plot(
        np.empty((0, 2)), np.array(boxes), Pose2(-corner, -corner, 0.0),
        (corner, corner), (-half, -half), (half, half),
    )  # fmt: skip


def _walls(edge: float) -> NDArray[np.float64]:
    """Return four boxes around a square of this edge about the origin."""
    at = edge / 2 + 0.05
    return np.array(
        [
            (0, at, edge + 0.2, 0.1),
            (0, -at, edge + 0.2, 0.1),
            (at, 0, 0.1, edge),
            (-at, 0, 0.1, edge),
        ]
    )


GENERATORS: dict[str, Callable[[np.random.Generator], _Plot]] = {
    "barn-like": _barn_like,
    "forest": _forest,
    "rooms": _rooms,
    "office": _office,
    "maze": _maze,
}
