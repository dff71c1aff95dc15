"""A hall of any size with boxes 10 m apart, for the benchmarks of large worlds."""

import random

from navette.geometry import Pose2
from navette.sim import Scene, World


def hall(size_m: int) -> Scene:
    """Return a square hall; the same size has the same boxes."""
    half = size_m / 2
    rng = random.Random(1)
    world = World()
    for x, y, w, h in (
        (0, half, size_m, 0.3),
        (0, -half, size_m, 0.3),
        (half, 0, 0.3, size_m),
        (-half, 0, 0.3, size_m),
    ):
        world.add_box((x, y), (w, h))
    for i in range(1, size_m // 10):
        for j in range(1, size_m // 10):
            centre = (10 * i - half + rng.uniform(-2, 2),
                      10 * j - half + rng.uniform(-2, 2))  # fmt: skip
            world.add_box(centre, (rng.uniform(0.4, 2.5), rng.uniform(0.4, 2.5)))
    return world.scene()


def ends(size_m: int) -> tuple[Pose2, tuple[float, float]]:
    """Return a start in one corner, and a goal in the opposite one."""
    half = size_m / 2
    return Pose2(4 - half, 4 - half, 0.7), (half - 5, half - 5)
