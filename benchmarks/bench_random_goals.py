"""Random worlds with any start and any goal: is every end of a drive the right one?

``python benchmarks/bench_random_goals.py --seeds 0-49`` drives all robots and prints a
table of the ends against what exact geometry gives for the goal. Exit code 1: a
contact, or a wrong end.

A goal must be reached if a path exists on which the body keeps 6 cm to every obstacle:
along its heading and with turns in place, sideways too if the base can, and for a car
forward only. A car's lidar does not cover its rear, so that it backs up at most
``blind_reverse_m`` into space that no beam has measured, by design: whether a path in
reverse may be driven depends on what was measured before, which geometry does not give.
Such a goal counts as unsure: reaching it is right, and so is a reason why not.
"""

import argparse
import collections
import itertools
import math
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

from random_goals import ROBOTS, RandomGoal, random_goal
from reachability import Reach, goal_reach

from navette.navigation.planning import PlannerParams
from navette.navigation.planning.node import PlannerNode
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation

LIMIT_S = 600.0
RIGHT = {
    Reach.SURE: {"reached"},
    # Exact geometry on a grid is not decisive within a few centimetres.
    Reach.UNSURE: {"reached", "no_path", "goal_blocked", "start_blocked"},
    # What surfaces enclose and no beam has measured counts as a part of the obstacle.
    Reach.ENCLOSED: {"no_path", "goal_blocked", "start_blocked"},
    Reach.BLOCKED: {"goal_blocked", "start_blocked"},
}


@dataclass(frozen=True)
class End:
    """How one drive ended, and the truth about its goal."""

    robot: str
    seed: int
    drive: RandomGoal
    result: str
    contacts: int
    truth: Reach

    @property
    def is_right(self) -> bool:
        return self.contacts == 0 and self.result in RIGHT[self.truth]


def run(case: tuple[str, int]) -> End:
    """Drive one case and compute its truth."""
    robot, seed = case
    drive = random_goal(robot, seed)
    options = RunOptions(
        world="empty",
        robot=robot,
        start=drive.start,
        goals=(drive.goal,),
        headless=True,
        speed=math.inf,
        seed=seed,
        max_time_s=LIMIT_S,
    )
    simulation = Simulation(options, scene=drive.scene)
    try:
        simulation.run()
        summary = simulation.summary()
        params = _planner_params(simulation)
    finally:
        simulation.close()
    truth = goal_reach(
        drive.obstacles, drive.body, drive.start, drive.goal,
        drive=params.drive, tolerance_m=params.goal_tolerance_m,
        turning_radius_m=params.min_turning_radius_m,
    )  # fmt: skip
    return End(robot, seed, drive, summary.goals[0].result, summary.contacts, truth)


def _planner_params(simulation: Simulation) -> PlannerParams:
    nodes = simulation.context.nodes
    return next(node.params for node in nodes if isinstance(node, PlannerNode))


def _ends(cases: list[tuple[str, int]], jobs: int) -> Iterator[End]:
    if jobs == 1:
        yield from map(run, cases)
        return
    with ProcessPoolExecutor(jobs, get_context("forkserver")) as pool:
        yield from pool.map(run, cases)


def main() -> int:
    """Drive all cases; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", default="0-9", help="first-last")
    parser.add_argument("--robots", nargs="+", default=list(ROBOTS), choices=ROBOTS)
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    first, _, last = args.seeds.partition("-")
    seeds = range(int(first), int(last or first) + 1)
    cases = [(robot, seed) for seed, robot in itertools.product(seeds, args.robots)]
    ends: list[End] = []
    for end in _ends(cases, args.jobs):
        ends.append(end)
        if not end.is_right:
            print(
                f"wrong: {end.robot} seed {end.seed} ({', '.join(end.drive.kinds)}): "
                f"{end.result}, goal {end.truth.value}, {end.contacts} contacts",
                flush=True,
            )
    _print_table(ends)
    return int(not all(end.is_right for end in ends))


def _print_table(ends: list[End]) -> None:
    """Print how often each end came with each truth, and the figures of each robot."""
    counts = collections.Counter((end.truth.value, end.result) for end in ends)
    for (truth, result), count in sorted(counts.items()):
        print(f"goal {truth:12} {result:15} {count}")
    for robot in (*dict.fromkeys(end.robot for end in ends), "all"):
        mine = [end for end in ends if robot in (end.robot, "all")]
        reached = sum(end.result == "reached" for end in mine)
        contacts = sum(end.contacts for end in mine)
        wrong = sum(not end.is_right for end in mine)
        print(
            f"{robot:18} {len(mine)} drives, {reached} reached, {contacts} contacts, "
            f"{wrong} wrong"
        )


if __name__ == "__main__":
    sys.exit(main())
