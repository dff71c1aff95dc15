"""Doors of a given width: every robot drives through walls at several angles.

``python benchmarks/bench_doors.py`` prints one line per robot, thickness and width.
"""

import argparse
import itertools
import math
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from itertools import islice
from multiprocessing import get_context

import numpy as np

from navette.geometry import Pose2
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.stack.simulation import Simulation
from navette.sim import Scene, World, footprint_of

ROBOTS = ("course", "jackal", "husky", "turtlebot3_burger", "racecar", "mecanum")
LIMIT_S = 90.0


@cache
def body_size_m(robot: str) -> tuple[float, float]:
    """Return length and width of a robot's body."""
    model = resolve_scene(RunOptions(world="empty", robot=robot)).scene.robot
    assert model is not None, "a resolved scene has a robot"
    length, width = np.ptp(footprint_of(model), axis=0)
    return float(length), float(width)


@dataclass(frozen=True)
class Door:
    """A wall across a room, with a door of ``width_m``.

    ``shift_m`` moves everything against the cells of the maps, ``angle`` (rad) turns
    it, and the start faces the wall's direction plus ``heading`` (rad).
    """

    robot: str
    width_m: float
    thickness_m: float
    angle: float = 0.0
    shift_m: float = 0.0
    heading: float = 0.0
    blocked_goal: bool = False

    @property
    def unit_m(self) -> float:
        """Length that the room is scaled with."""
        return max(body_size_m(self.robot)[0], 0.5)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return a point of the room in the map: x across the wall, y along it."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        shift = self.shift_m
        return c * x - s * y + shift, s * x + c * y + 0.7 * shift

    def scene(self) -> Scene:
        half = 4 * self.unit_m
        deep = half + self.thickness_m / 2
        world = World("door")
        side = half - self.width_m / 2
        offset = self.width_m / 2 + side / 2
        boxes = [
            (0.0, offset, self.thickness_m, side),
            (0.0, -offset, self.thickness_m, side),
            (0.0, half + 0.1, 2 * deep + 0.4, 0.2),
            (0.0, -half - 0.1, 2 * deep + 0.4, 0.2),
            (deep + 0.1, 0.0, 0.2, 2 * half),
            (-deep - 0.1, 0.0, 0.2, 2 * half),
        ]
        if self.blocked_goal:
            edge = 2.5 * self.unit_m
            boxes.append((deep - edge, 0.0, edge, edge))
        for x, y, wide, long in boxes:
            world.add_box(self.place(x, y), (wide, long), yaw=self.angle)
        return world.scene()

    def options(self, seed: int) -> RunOptions:
        deep = 4 * self.unit_m + self.thickness_m / 2
        start = self.place(-deep + 1.4 * self.unit_m, 0.5 * self.unit_m)
        return RunOptions(
            world="empty",
            robot=self.robot,
            start=Pose2(*start, self.angle + self.heading),
            goals=(self.place(deep - 2.5 * self.unit_m, 0.0),),
            headless=True,
            speed=math.inf,
            seed=seed,
            max_time_s=LIMIT_S,
        )


def drive(door: Door, seed: int = 1) -> tuple[str, int, float]:
    """Return the result, contacts and minimum clearance of a drive."""
    simulation = Simulation(door.options(seed), scene=door.scene())
    try:
        simulation.run()
        summary = simulation.summary()
    finally:
        simulation.close()
    clearance = summary.min_clearance_m
    return (
        summary.goals[0].result,
        summary.contacts,
        np.nan if clearance is None else clearance,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS))
    parser.add_argument(
        "--slacks", nargs="+", type=float, default=[-0.06, 0.12, 0.2, 0.3]
    )
    parser.add_argument("--thicknesses", nargs="+", type=float, default=[0.1, 2.0])
    parser.add_argument("--angles", nargs="+", type=float, default=[0, 7, 20, 45])
    parser.add_argument("--shifts", nargs="+", type=float, default=[0.0, 0.023])
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    cases = list(itertools.product(args.robots, args.thicknesses, args.slacks))
    variants = list(itertools.product(args.angles, args.shifts))
    doors = [
        Door(robot, body_size_m(robot)[1] + slack, thick, math.radians(angle), shift)
        for robot, thick, slack in cases
        for angle, shift in variants
    ]
    with ProcessPoolExecutor(args.jobs, get_context("forkserver")) as pool:
        results = pool.map(drive, doors)
        for robot, thick, slack in cases:
            report(robot, thick, slack, list(islice(results, len(variants))))


def report(
    robot: str, thick: float, slack: float, part: list[tuple[str, int, float]]
) -> None:
    """Print the results of one door at all angles and shifts."""
    counts = {name: [r[0] for r in part].count(name) for name, *_ in part}
    counted = ", ".join(f"{n} {name}" for name, n in sorted(counts.items()))
    print(
        f"{robot:18} wall {thick:.1f} m, door body {slack:+.2f} m: {counted}; "
        f"contacts {sum(r[1] for r in part)}, "
        f"clearance {min(r[2] for r in part):.3f} m",
        flush=True,
    )


if __name__ == "__main__":
    main()
