"""A large office with many loops, a tour through it, and the error of a map of it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import LETHAL, GridSpec
from navette.sim import Scene, World

_BLOCK_M, _CORRIDOR_M, _WALL_M = 8.0, 2.0, 0.1
_PITCH_M = _BLOCK_M + _CORRIDOR_M
_DOOR_M = 1.1
_FURNITURE = 4


@dataclass(frozen=True, eq=False)
class LargeOffice:
    """Blocks of two rooms, separated by corridors.

    Attributes:
        scene: the world.
        boxes: (N, 4) x, y, size x, size y of all obstacles, m.
        start: pose in a corner, in the corridor.
        tour: goals (m) at crossings; the last one is the start, after several loops.
    """

    scene: Scene
    boxes: NDArray[np.float64]
    start: Pose2
    tour: tuple[tuple[float, float], ...]

    def distance(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return (N,) the distance of points (N, 2) to the nearest obstacle, m."""
        nearest = np.full(len(points), np.inf)
        for x, y, wide, deep in self.boxes:
            dx = np.maximum(np.abs(points[:, 0] - x) - wide / 2, 0.0)
            dy = np.maximum(np.abs(points[:, 1] - y) - deep / 2, 0.0)
            nearest = np.minimum(nearest, np.hypot(dx, dy))
        return nearest


def make_large_office(blocks: int, seed: int) -> LargeOffice:
    """Return an office of ``blocks`` × ``blocks`` blocks of 10 m with a corridor."""
    rng = np.random.default_rng([seed, blocks])
    edge = blocks * _PITCH_M
    # The middle of the first corridor is at (0, 0).
    low, high = -_CORRIDOR_M / 2, edge - _CORRIDOR_M / 2
    middle, length = (low + high) / 2, edge + _CORRIDOR_M
    ends = (low - _WALL_M / 2, high + _CORRIDOR_M + _WALL_M / 2)
    middle = (ends[0] + ends[1]) / 2
    boxes = [(middle, end, length, _WALL_M) for end in ends]
    boxes += [(end, middle, _WALL_M, length) for end in ends]
    for row in range(blocks):
        for column in range(blocks):
            x, y = _CORRIDOR_M / 2 + _PITCH_M * np.array([column, row])
            boxes += _block(float(x), float(y), rng)
    world = World(f"large office {blocks}-{seed}")
    for x, y, wide, deep in boxes:
        world.add_box((x, y), (wide, deep))
    tour = tuple((_PITCH_M * x, _PITCH_M * y) for x, y in _tour(blocks))
    return LargeOffice(world.scene(), np.array(boxes), Pose2(0.0, 0.0, 0.0), tour)


def lethal_cells_near(
    office: LargeOffice, cells: NDArray[np.int8], spec: GridSpec, within_m: float
) -> float:
    """Return the share of a map's lethal cells (H, W) near a true obstacle."""
    lethal = np.argwhere(cells >= LETHAL)
    return float((office.distance(spec.centers_of(lethal)) <= within_m).mean())


def _tour(blocks: int) -> list[tuple[int, int]]:
    """Return crossings: the outer loop, then each inner corridor, then home."""
    n = blocks
    found = [(n, 0), (n, n), (0, n), (0, 0)]
    for k in range(1, n):
        found += [(k, 0), (k, n), (0, n), (0, k), (n, k), (n, 0)]
    return [*found, (0, 0)]


def _block(
    x: float, y: float, rng: np.random.Generator
) -> list[tuple[float, float, float, float]]:
    """Return the walls and the furniture of two rooms; (x, y) is the lower corner."""
    split = float(rng.uniform(3.0, 5.0))
    boxes = [(x + split, y + _BLOCK_M / 2, _WALL_M, _BLOCK_M)]
    for side in (0.0, _BLOCK_M):
        boxes.append((x + side, y + _BLOCK_M / 2, _WALL_M, _BLOCK_M))
        for low, high in ((0.0, split), (split, _BLOCK_M)):
            door = float(rng.uniform(low + 0.3, high - 0.3 - _DOOR_M))
            for begin, end in ((low, door), (door + _DOOR_M, high)):
                centre = x + (begin + end) / 2
                boxes.append((centre, y + side, end - begin, _WALL_M))
    for _ in range(_FURNITURE):
        at = rng.uniform(1.2, _BLOCK_M - 1.2, 2)
        size = rng.uniform(0.4, 1.2, 2)
        wide, deep = (float(edge) for edge in size)
        boxes.append((x + float(at[0]), y + float(at[1]), wide, deep))
    return boxes
