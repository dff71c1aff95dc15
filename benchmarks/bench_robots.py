"""Each robot with the whole stack: simulated seconds per second of CPU, one thread.

    python benchmarks/bench_robots.py [--json]

Each run is a process of its own, headless, with the parameters of the robot: the
course robot drives the seven goals of the course, the others five goals in the arena.
The factor is that of CPU time, which depends less on other load than that of wall time;
a first run in the same process loads the kernels.
"""

import json
import subprocess
import sys

from courses import SEVEN_GOALS
from factor import factor
from harness import Benchmark, Figure

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

TARGETS = {"jackal": 40.0, "course": 80.0}
ROBOTS = (*TARGETS, "husky", "turtlebot3_burger", "mecanum", "racecar")
GOALS = ((4.0, 2.0), (-4.0, 3.0), (4.0, -4.0), (-4.0, -4.0), (4.0, 4.0))
SPAN_S = 60.0


def options(robot: str, span_s: float) -> RunOptions:
    """Return the options of a drive of some length."""
    on_course = robot == "course"
    return RunOptions(
        world="course" if on_course else "arena",
        robot=robot,
        start=SEVEN_GOALS.start if on_course else None,
        goals=SEVEN_GOALS.goals if on_course else GOALS,
        headless=True,
        speed=float("inf"),
        max_time_s=span_s,
    )


def drive(robot: str, span_s: float) -> float:
    """Drive for some time; return the factor."""
    return factor(Simulation(options(robot, span_s)))


def measured(robot: str) -> float:
    """Run :func:`drive` in a process."""
    command = [sys.executable, __file__, "--drive", robot]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return float(done.stdout.splitlines()[-1])


def main() -> None:
    if sys.argv[1:2] == ["--drive"]:
        drive(sys.argv[2], 10.0)
        print(json.dumps(drive(sys.argv[2], SPAN_S)))
        return
    bench = Benchmark("robots", __doc__)
    for robot in ROBOTS:
        target = TARGETS.get(robot)
        figure = Figure(f"{robot}: factor", measured(robot), "×", target, True)
        bench.figure(lambda figure=figure: figure)
    bench.main()


if __name__ == "__main__":
    main()
