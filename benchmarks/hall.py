"""A hall of any size with boxes 10 m apart, for the benchmarks of large worlds."""

import random
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from navette.geometry import Pose2
from navette.geometry.map_files import OccupancyMap, write_occupancy_map
from navette.sim import Scene, World

RESOLUTION_M = 0.05
_BORDER_M = 2.0  # of the map around the walls

Pair = tuple[float, float]


def boxes(size_m: int) -> Iterator[tuple[Pair, Pair]]:
    """Yield centre and edges of walls and boxes; the same size has the same boxes."""
    half = size_m / 2
    rng = random.Random(1)
    yield (0, half), (size_m, 0.3)
    yield (0, -half), (size_m, 0.3)
    yield (half, 0), (0.3, size_m)
    yield (-half, 0), (0.3, size_m)
    for i in range(1, size_m // 10):
        for j in range(1, size_m // 10):
            centre = (10 * i - half + rng.uniform(-2, 2),
                      10 * j - half + rng.uniform(-2, 2))  # fmt: skip
            yield centre, (rng.uniform(0.4, 2.5), rng.uniform(0.4, 2.5))


def hall(size_m: int) -> Scene:
    """Return a square hall."""
    world = World()
    for centre, edges in boxes(size_m):
        world.add_box(centre, edges)
    return world.scene()


def write_map(size_m: int, folder: Path) -> Path:
    """Write the map of the hall and return its description."""
    corner = -size_m / 2 - _BORDER_M
    count = round(-2 * corner / RESOLUTION_M)
    cells = np.zeros((count, count), np.int8)
    for (x, y), (width, height) in boxes(size_m):
        rows, columns = (
            slice(*np.round((at + np.array([-0.5, 0.5]) * edge - corner)
                            / RESOLUTION_M).astype(int))
            for at, edge in ((y, height), (x, width))
        )  # fmt: skip
        cells[rows, columns] = 100
    drawn = OccupancyMap(cells, RESOLUTION_M, Pose2(corner, corner, 0.0))
    return write_occupancy_map(folder / "hall", drawn)


def ends(size_m: int) -> tuple[Pose2, Pair]:
    """Return a start in one corner, and a goal in the opposite one."""
    half = size_m / 2
    return Pose2(4 - half, 4 - half, 0.7), (half - 5, half - 5)
