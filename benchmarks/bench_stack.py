"""The whole stack, headless, in the reference world: time, clearance, speed.

    python benchmarks/bench_stack.py [WORLD] [--json]

WORLD is the built-in course unless given. Prints one row a drive.
"""

import argparse
import dataclasses
import json

from courses import HARD_RUNS, SEVEN_GOALS, Drive

from navette.launch import RunOptions
from navette.launch.simulation import Simulation

REACH_M = 0.6
CLEARANCE_M = 0.10


def measure(world: str, drive: Drive) -> dict[str, object]:
    """One drive, as a row."""
    simulation = Simulation(
        RunOptions(
            world=world,
            start=drive.start,
            goals=drive.goals,
            headless=True,
            speed=float("inf"),
            max_time_s=drive.limit_s,
        )
    )
    try:
        simulation.run()
        summary = simulation.summary()
    finally:
        simulation.close()
    left = max((g.distance_left_m for g in summary.goals), default=float("inf"))
    clearance = summary.min_clearance_m or 0.0
    return {
        "drive": drive.name,
        "passed": summary.succeeded
        and len(summary.goals) == len(drive.goals)
        and left <= REACH_M
        and clearance >= CLEARANCE_M,
        "results": ",".join(goal.result for goal in summary.goals),
        "time_s": round(summary.sim_time_s, 1),
        "left_m": round(left, 2),
        "clearance_m": round(clearance, 2),
        "contacts": summary.contacts,
        "real_time_factor": round(summary.real_time_factor, 1),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("world", nargs="?", default="course")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--only", default="", help="drives whose name contains this")
    options = parser.parse_args()
    rows = [
        measure(options.world, dataclasses.replace(drive))
        for drive in (*HARD_RUNS, SEVEN_GOALS)
        if options.only in drive.name
    ]
    if options.json:
        print(json.dumps(rows))
        return
    for row in rows:
        print("  ".join(f"{key}={value}" for key, value in row.items()))
    print(f"{sum(bool(row['passed']) for row in rows)} of {len(rows)} passed")


if __name__ == "__main__":
    main()
