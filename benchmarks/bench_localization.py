"""Localization in worlds of 20 and 200 m: speed in CPU time, memory, search of the map.

    python benchmarks/bench_localization.py [--json]

A Jackal drives through a hall with boxes 10 m apart, located by the simulator (truth),
by SLAM, or by AMCL on the hall's map; odometry and IMU are fused by the filter. Each
run is a process of its own: the whole stack, headless, one thread. The factor is
simulated seconds per second of CPU; a first run in a small hall loads the kernels.
The search is that of the whole map for one scan, as of a robot that is lost.
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from factor import factor
from hall import ends, hall, write_map
from harness import Benchmark, Figure

from navette.geometry.map_files import read_occupancy_map
from navette.navigation.grids import GridSpec
from navette.navigation.localization.amcl import AmclParams, LikelihoodField
from navette.navigation.localization.amcl.global_search import search_map
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

SIZES_M = (20, 200)
METHODS = ("truth", "slam", "amcl")
SPAN_S = 60.0
LOADING_M, LOADING_S = 20, 10.0
SEARCHED_M = 200


def drive(method: str, size_m: int, span_s: float) -> float:
    """Drive for some time, at most to the goal; return the factor."""
    start, goal = ends(size_m)
    options = RunOptions(
        robot="jackal",
        start=start,
        goals=(goal,),
        headless=True,
        speed=float("inf"),
        max_time_s=span_s,
        methods={"localization": method},
    )
    with tempfile.TemporaryDirectory() as folder:
        if method == "amcl":
            options = replace(options, known_map=write_map(size_m, Path(folder)))
        simulation = Simulation(options, scene=hall(size_m))
    return factor(simulation)


def measured(method: str, size_m: int) -> tuple[float, float]:
    """Return the factor and the peak memory (MB) of a drive in a process."""
    command = [sys.executable, __file__, "--drive", method, str(size_m)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    speed, memory = json.loads(done.stdout.splitlines()[-1])
    return speed, memory


def search_s() -> float:
    """Return the time of a search of the map of a hall."""
    with tempfile.TemporaryDirectory() as folder:
        hall_map = read_occupancy_map(write_map(SEARCHED_M, Path(folder)))
    height, width = hall_map.cells.shape
    field = LikelihoodField.of(
        hall_map.cells,
        GridSpec(hall_map.resolution, width, height, hall_map.origin),
        sigma=AmclParams().sigma_hit,
        random=0.1,
        reach_m=AmclParams().laser_likelihood_max_dist,
    )
    start, _ = ends(SEARCHED_M)
    rows, columns = np.nonzero(hall_map.cells)
    seen = field.spec.centers_of(np.column_stack([rows, columns]))
    away = np.hypot(*(seen - (start.x, start.y)).T)
    points = start.inverse().apply(seen[away < 15.0][:: max(1, len(seen) // 2000)])
    search_map(field, points[:60])  # compiled
    began = time.perf_counter()
    best = search_map(field, points[:60]).poses[0]
    seconds = time.perf_counter() - began
    assert np.hypot(best[0] - start.x, best[1] - start.y) < 0.2, best
    return seconds


def main() -> None:
    if sys.argv[1:2] == ["--drive"]:
        drive(sys.argv[2], LOADING_M, LOADING_S)
        speed = drive(sys.argv[2], int(sys.argv[3]), SPAN_S)
        peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(json.dumps([speed, peak_mb]))
        return
    bench = Benchmark("localization", __doc__)
    for size in SIZES_M:
        for method in METHODS:
            speed, memory = measured(method, size)
            name = f"Jackal, {size} m, {method}"
            for figure in (
                Figure(f"{name}: factor", speed, "×"),
                Figure(f"{name}: memory", memory, "MB"),
            ):
                bench.figure(lambda figure=figure: figure)
    seconds = search_s()
    bench.figure(lambda: Figure(f"search of a map of {SEARCHED_M} m", seconds, "s"))
    bench.main()


if __name__ == "__main__":
    main()
