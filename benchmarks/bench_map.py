"""What the map keeps: thin posts, which must stay, and trails, which must not.

    python benchmarks/bench_map.py [--robots …] [--seeds N] [--noise M] [--jobs N]

Every robot drives with the whole stack through a room of posts of 2 to 5 cm radius, and
through a room in which cylinders walk, stand for a while and walk on. A post is lost if
the map had a lethal cell at it and a later map has none. A trail is a lethal cell that
is further than 0.3 m from everything that stands or walks there at the time.
"""

import argparse
import itertools
import math
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any, NamedTuple

import numpy as np
from bench_doors import ROBOTS, body_size_m
from numpy.typing import NDArray

from navette.msgs import topics
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.navigation.grids import grid_from_message
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.runtime import Context, Node
from navette.sim import Scene, World

Points = NDArray[np.float64]

LIMIT_S = 90.0
WALKED_S = 45.0  # walkers stand from then on
FAR_M = 0.3
POSTS = 48


class Room(NamedTuple):
    """A walled room with posts or walkers.

    ``half_m`` is half of its edge, ``posts`` are (N, 3) x, y, radius, and ``walkers``
    the keyframes (time, x, y) of each.
    """

    half_m: float
    posts: Points
    walkers: list[list[tuple[float, float, float]]]
    goals: list[tuple[float, float]]

    def scene(self) -> Scene:
        """Return the room with its walls."""
        world, half = World("room"), self.half_m
        for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            size = (0.2 + 2 * half * abs(y), 0.2 + 2 * half * abs(x))
            world.add_box((x * half, y * half), size)
        for px, py, radius in self.posts.tolist():
            world.add_cylinder((px, py), radius)
        for keyframes in self.walkers:
            world.add_actor(keyframes, 0.25, loop=False)
        return world.scene()


def room_of(robot: str, seed: int, *, with_posts: bool) -> Room:
    """Return the room of a seed, scaled with the robot."""
    rng = np.random.default_rng([seed, int(with_posts)])
    length, width = body_size_m(robot)
    slow = robot == "turtlebot3_burger"
    half = 4.0 if slow else 8.0
    clear = 1.2 * max(length, width) + 0.3
    posts: list[tuple[float, float, float]] = []
    while with_posts and len(posts) < (POSTS if not slow else POSTS // 2):
        x, y = rng.uniform(-half + 0.4, half - 0.4, 2).tolist()
        if math.hypot(x, y) < clear + 0.3:
            continue
        if any(math.dist((x, y), post[:2]) < 0.3 for post in posts):
            continue
        # Posts of a robot that would not fit between them stand along the walls.
        if min(half - abs(x), half - abs(y)) > 1.2 and any(
            math.dist((x, y), post[:2]) < 2 * clear for post in posts
        ):
            continue
        posts.append((x, y, float(rng.uniform(0.02, 0.05))))
    goals: list[tuple[float, float]] = []
    reach = half - clear - 0.8
    while len(goals) < 6:
        x, y = rng.uniform(-reach, reach, 2).tolist()
        if all(math.dist((x, y), post[:2]) > clear for post in posts):
            goals.append((x, y))
    walkers = []
    for side in (-1, 1, -1, 1):
        if with_posts:
            break
        walkers.append(_walk(rng, half, side))
    return Room(half, np.array(posts).reshape(-1, 3), walkers, goals)


def _walk(
    rng: np.random.Generator, half: float, side: int
) -> list[tuple[float, float, float]]:
    """Return keyframes beside the middle of the room, with pauses of 3 s."""
    at = side * rng.uniform(0.5, 0.85) * half, rng.uniform(-0.8, 0.8) * half
    time_s, frames = 0.0, [(0.0, *at)]
    while time_s < WALKED_S:
        to = side * rng.uniform(0.45, 0.85) * half, rng.uniform(-0.8, 0.8) * half
        time_s += max(0.5, math.dist(at, to) / rng.uniform(0.6, 1.5))
        frames.append((time_s, *to))
        if rng.random() < 0.5:
            time_s += 3.0
            frames.append((time_s, *to))
        at = to
    return frames


class MapProbe(Node):
    """Keep what each map has at the posts, and its lethal cells."""

    def __init__(self, room: Room, simulation: Simulation, context: Context) -> None:
        super().__init__("map_probe", context=context)
        self._room, self._simulation = room, simulation
        self.seen: set[int] = set()
        self.lost: dict[int, float] = {}
        self.trails: list[tuple[float, int]] = []
        self.create_subscription(
            OccupancyGrid, topics.MAP.name, self._on_map, 1, shared=True
        )

    def _on_map(self, msg: OccupancyGrid) -> None:
        now_s = self.get_clock().now().nanoseconds / 1e9
        cells, spec = grid_from_message(msg)
        lethal = spec.centers_of(np.argwhere(cells >= 100))
        near = 0.71 * spec.resolution
        found = set()
        for index, (x, y, radius) in enumerate(self._room.posts.tolist()):
            if (np.hypot(*(lethal - (x, y)).T) <= radius + near + 0.02).any():
                found.add(index)
        for index in self.seen - found:
            self.lost.setdefault(index, now_s)
        self.seen |= found
        if self._room.walkers:
            self.trails.append((now_s, self._trail(lethal)))

    def _trail(self, lethal: Points) -> int:
        half = self._room.half_m - 0.1
        away = np.abs(lethal).max(axis=1) < half - FAR_M
        for outline in self._simulation.sim.simulator.outlines(actors=True):
            middle = outline.mean(axis=0)
            away &= np.hypot(*(lethal - middle).T) > 0.25 + FAR_M
        return int(away.sum())


def drive(case: tuple[str, int, bool, float]) -> tuple[Any, ...]:
    """Return seen, lost posts, trail cells (largest, last, last after walking)."""
    robot, seed, with_posts, noise_m = case
    room = room_of(robot, seed, with_posts=with_posts)
    options = RunOptions(
        world="empty",
        robot=robot,
        goals=tuple(room.goals) * 2,
        headless=True,
        speed=math.inf,
        seed=seed,
        max_time_s=LIMIT_S,
        parameters={
            "map_memory": {"always_send_full_map": True},
            "sim": {"lidar_noise_m": noise_m},
        },
    )
    simulation = Simulation(options, scene=room.scene())
    try:
        probe = MapProbe(room, simulation, simulation.context)
        simulation.executor.add_node(probe)
        simulation.run()
        summary = simulation.summary()
    finally:
        simulation.close()
    most = max((count for _, count in probe.trails), default=0)
    last = probe.trails[-1][1] if probe.trails else 0
    reached = sum(goal.result == "reached" for goal in summary.goals)
    return len(probe.seen), probe.lost, most, last, reached, summary.sim_time_s


def cases(args: argparse.Namespace) -> Iterator[tuple[str, int, bool, float]]:
    seeds, kinds = range(args.seeds), (True, False)
    for robot, with_posts, seed in itertools.product(args.robots, kinds, seeds):
        yield robot, seed, with_posts, args.noise


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--noise", type=float, default=0.001)
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    run = list(cases(args))
    with ProcessPoolExecutor(args.jobs, get_context("forkserver")) as pool:
        for (robot, seed, with_posts, _), result in zip(
            run, pool.map(drive, run), strict=True
        ):
            seen, lost, most, last, reached, time_s = result
            what = (
                f"{seen} posts seen, {len(lost)} lost"
                if with_posts
                else f"trail cells: at most {most}, at the end {last}"
            )
            print(
                f"{robot:18} seed {seed}: {what}  ({reached} goals, {time_s:.0f} s)",
                flush=True,
            )


if __name__ == "__main__":
    main()
