"""Worlds of 20 to 300 m at 0.05 m: speed in CPU time, and memory.

    python benchmarks/bench_worlds.py [--json]

Each run is a process of its own: the whole stack, headless, one thread, pure pursuit.
A hall of SIZE m with boxes 10 m apart, and a goal in the opposite corner; the
parameters are the robot's own. The factor is simulated seconds per second of CPU, which
depends less on other load than that of wall time; a first run in the same process, in a
small hall, loads the kernels.
"""

import json
import resource
import subprocess
import sys
import time

from harness import Benchmark, Figure

SIZES_M = (20, 100, 200, 300)
SPAN_S = 20.0
LOADING_M, LOADING_S = 20, 5.0
FACTORS = {200: 15.0, 300: 10.0}
MEMORY_MB = {200: 450.0}


def drive(robot: str, size_m: int, span_s: float) -> dict[str, float]:
    """Drive for some time; return the factor and the peak memory."""
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
    began = time.process_time()
    simulation.run()
    seconds = time.process_time() - began
    simulated = simulation.summary().sim_time_s
    simulation.close()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {"factor": simulated / seconds, "peak_mb": peak}


def measured(robot: str, size_m: int) -> dict[str, float]:
    """Run :func:`drive` in a process."""
    command = [sys.executable, __file__, "--drive", robot, str(size_m)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return found


def main() -> None:
    if sys.argv[1:2] == ["--drive"]:
        drive(sys.argv[2], LOADING_M, LOADING_S)
        print(json.dumps(drive(sys.argv[2], int(sys.argv[3]), SPAN_S)))
        return
    bench = Benchmark("worlds", __doc__)
    for size in SIZES_M:
        found = measured("jackal", size)
        factor = Figure(
            f"Jackal, {size} m: factor", found["factor"], "×", FACTORS.get(size), True
        )
        memory = Figure(
            f"Jackal, {size} m: memory", found["peak_mb"], "MB", MEMORY_MB.get(size)
        )
        bench.figure(lambda figure=factor: figure)
        bench.figure(lambda figure=memory: figure)
    bench.main()


if __name__ == "__main__":
    main()
