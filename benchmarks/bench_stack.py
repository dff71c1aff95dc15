"""The whole stack, headless, in the reference world: real-time factor and results.

    python benchmarks/bench_stack.py [WORLD] [--only TEXT] [--json]

Each drive is run once, as fast as it goes: simulator, sensors and every node in one
process and one thread. WORLD is the built-in course unless given.
"""

import argparse
import json
import statistics

from courses import HARD_RUNS, SEVEN_GOALS, Drive
from harness import Benchmark, Figure

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

REACH_M = 0.6
CLEARANCE_M = 0.10
REAL_TIME_FACTOR = 50.0

Row = dict[str, object]


def measure(world: str, drive: Drive) -> Row:
    """Run one drive; return its row."""
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
        "limit_s": drive.limit_s,
        "left_m": round(left, 2),
        "clearance_m": round(clearance, 2),
        "contacts": summary.contacts,
        "real_time_factor": round(summary.real_time_factor, 1),
    }


def figures(rows: list[Row]) -> list[Figure]:
    """Summarise the drives; the real-time factor is that of the longest."""
    factors = [float(str(row["real_time_factor"])) for row in rows]
    passed = sum(bool(row["passed"]) for row in rows)
    found = [
        Figure("drives passed", passed, "", len(rows), True),
        Figure("real-time factor, median drive", statistics.median(factors), "×"),
    ]
    whole = [r for r in rows if r["drive"] == SEVEN_GOALS.name]
    for row in whole:
        factor = float(str(row["real_time_factor"]))
        seconds = float(str(row["time_s"]))
        found += [
            Figure(
                "real-time factor, seven goals", factor, "×", REAL_TIME_FACTOR, True
            ),
            Figure("seven goals, simulated", seconds, "s", SEVEN_GOALS.limit_s),
        ]
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("world", nargs="?", default="course")
    parser.add_argument("--only", default="", help="drives whose name contains this")
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object instead"
    )
    options = parser.parse_args()
    drives = [d for d in (*HARD_RUNS, SEVEN_GOALS) if options.only in d.name]
    measure(options.world, HARD_RUNS[3])  # the first run in a process loads kernels
    rows = [measure(options.world, drive) for drive in drives]
    bench = Benchmark("whole stack", __doc__)
    for found in figures(rows):
        bench.figure(lambda found=found: found)
    bench.run()
    if options.json:
        print(json.dumps({**bench.as_dict(), "drives": rows}))
        return
    for row in rows:
        print("  ".join(f"{key}={value}" for key, value in row.items()))
    print(bench.table())


if __name__ == "__main__":
    main()
