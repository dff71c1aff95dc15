"""Five minutes of driving on SLAM in an office of 40 m × 40 m with loops.

  python benchmarks/bench_office.py [--blocks 4] [--seconds 300] [--seed 0]

Prints the share of lethal cells within 0.10 m of a true obstacle, for the map that the
robot plans on and for SLAM's own, the error of the pose, and the time of SLAM. Exits
with 1 if a share is below 98 %.
"""

import argparse
import json
import math
import sys
import time

from navette.navigation.bench.cpu import CpuMeter
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.navigation.worlds.large_office import lethal_cells_near, make_large_office

WITHIN_M, SHARE = 0.10, 0.98
NOISE = {"wheel_noise_m": 0.01, "lidar_noise_m": 0.01}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--blocks", type=int, default=4)
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    office = make_large_office(given.blocks, given.seed)
    options = RunOptions(
        world="empty",
        robot="jackal",
        start=office.start,
        goals=office.tour,
        headless=True,
        speed=math.inf,
        seed=given.seed,
        methods={"localization": "slam"},
        parameters={"sim": NOISE},
        max_time_s=given.seconds,
    )
    simulation, began = Simulation(options, scene=office.scene), time.perf_counter()
    try:
        meter = CpuMeter()
        for node in simulation.context.nodes:
            meter.watch(node)
        simulation.run()
        summary, memory = simulation.summary(), simulation.stack.map_memory._memory
        slam = simulation.stack.localization[-1]._slam
        cells, spec = slam.occupancy()
        found = {
            "goals": [goal.result for goal in summary.goals],
            "contacts": summary.contacts,
            "seconds": summary.sim_time_s,
            "map": lethal_cells_near(office, memory.occupancy(), memory.spec, WITHIN_M),
            "slam_map": lethal_cells_near(office, cells, spec, WITHIN_M),
            "pose_error_m": vars(summary.pose_error_m),
            "key_scans": len(slam.graph),
            "loop_closures": slam.loop_closures,
            "cpu_share": {
                k: v / summary.sim_time_s for k, v in meter.seconds().items()
            },
            "wall_s": time.perf_counter() - began,
        }
    finally:
        simulation.close()
    print(json.dumps(found, indent=1))
    return int(min(found["map"], found["slam_map"]) < SHARE)


if __name__ == "__main__":
    sys.exit(main())
