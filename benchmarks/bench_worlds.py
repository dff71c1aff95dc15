"""Worlds of 20 to 300 m at 0.05 m: speed in CPU time, and memory.

    python benchmarks/bench_worlds.py [--json]

Each run is a process of its own: the whole stack, headless, one thread, pure pursuit.
A hall of SIZE m with boxes 10 m apart, and a goal in the opposite corner; the
parameters are the robot's own. The factor is simulated seconds per second of CPU, which
depends less on other load than that of wall time; a first run in the same process, in a
small hall, loads the kernels. The peak memory is that of a whole drive to the goal.
"""

import json
import resource
import subprocess
import sys

from harness import Benchmark, Figure

SIZES_M = (20, 100, 200, 300)
SPAN_S = 20.0
LOADING_M, LOADING_S = 20, 5.0
WHOLE_S = 600.0
FACTORS = {200: 15.0, 300: 10.0}
MEMORY_MB = {200: 450.0}


def drive(robot: str, size_m: int, span_s: float) -> float:
    """Drive for some time, at most to the goal; return the factor."""
    from factor import factor as cpu_factor
    from hall import ends, hall

    from navette.navigation.stack import RunOptions
    from navette.navigation.stack.simulation import Simulation

    start, goal = ends(size_m)
    options = RunOptions(
        robot=robot,
        start=start,
        goals=(goal,),
        headless=True,
        speed=float("inf"),
        max_time_s=span_s,
    )
    parameters = {"control": {"method": "pure_pursuit"}}
    simulation = Simulation(options, scene=hall(size_m), parameters=parameters)
    return cpu_factor(simulation)


def factor(robot: str, size_m: int) -> float:
    """Return the factor of the first part of a drive, with the kernels loaded."""
    drive(robot, LOADING_M, LOADING_S)
    return drive(robot, size_m, SPAN_S)


def peak_mb(robot: str, size_m: int) -> float:
    """Return the peak memory of a drive to the goal."""
    drive(robot, size_m, WHOLE_S)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


MEASURES = {"factor": factor, "memory": peak_mb}


def measured(what: str, robot: str, size_m: int) -> float:
    """Run one of :data:`MEASURES` in a process."""
    command = [sys.executable, __file__, f"--{what}", robot, str(size_m)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return float(json.loads(done.stdout.splitlines()[-1]))


def main() -> None:
    what = sys.argv[1].removeprefix("--") if len(sys.argv) > 3 else ""
    if what in MEASURES:
        print(json.dumps(MEASURES[what](sys.argv[2], int(sys.argv[3]))))
        return
    bench = Benchmark("worlds", __doc__)
    for size in SIZES_M:
        name = f"Jackal, {size} m"
        speed = measured("factor", "jackal", size)
        memory = measured("memory", "jackal", size)
        figures = (
            Figure(f"{name}: factor", speed, "×", FACTORS.get(size), True),
            Figure(f"{name}: memory", memory, "MB", MEMORY_MB.get(size)),
        )
        for figure in figures:
            bench.figure(lambda figure=figure: figure)
    bench.main()


if __name__ == "__main__":
    main()
