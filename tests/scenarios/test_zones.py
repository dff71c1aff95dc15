"""Keep-out zones: the robot drives around what no sensor sees."""

import math
from pathlib import Path

import numpy as np
import pytest

from navette.geometry import Footprint, Pose2
from navette.geometry.map_files import OccupancyMap, write_occupancy_map
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation


def drive(tmp_path: Path, goal: tuple[float, float]) -> tuple[str, float]:
    """Return the result and the least distance of the body from the zone, m."""
    cells = np.zeros((100, 100), np.int8)
    cells[40:60, 30:70] = 100  # x from -2 to 2, y from -1 to 1
    mask = OccupancyMap(cells, 0.1, Pose2(-5.0, -5.0, 0.0))
    options = RunOptions(
        world="empty",
        robot="jackal",
        start=Pose2(0.0, -3.5, math.pi / 2),
        goals=(goal,),
        headless=True,
        speed=math.inf,
        methods={"controller": "pure_pursuit"},
        keepout=write_occupancy_map(tmp_path / "keepout", mask),
        max_time_s=40.0,
    )
    simulation = Simulation(options)
    try:
        footprint = Footprint.from_flat(simulation.stack.planner.params.footprint_m)
        corners = np.array(footprint.vertices)
        least = [math.inf]

        def measure() -> None:
            pose = simulation.sim.simulator.pose().to_pose2()
            x, y = np.abs(pose.apply(corners)).T
            away = np.maximum(np.maximum(x - 2.0, y - 1.0), 0.0)
            least[0] = min(least[0], float(away.min()))

        simulation.monitor.create_timer(0.1, measure)
        simulation.run()
        return simulation.summary().goals[0].result, least[0]
    finally:
        simulation.close()


@pytest.mark.slow
def test_the_robot_drives_around_a_keep_out_zone(tmp_path: Path) -> None:
    result, least_m = drive(tmp_path, (0.0, 3.0))
    assert result == "reached"
    assert least_m > 0.02


@pytest.mark.slow
def test_a_goal_in_a_keep_out_zone_is_refused(tmp_path: Path) -> None:
    result, least_m = drive(tmp_path, (0.0, 0.0))
    assert result == "goal_blocked"
    assert least_m > 0.02
