"""Localization on a known map in a whole run: outcomes of what goes wrong."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2, Transform3
from navette.geometry.map_files import OccupancyMap, write_occupancy_map
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.sim import Scene, World

pytestmark = pytest.mark.long

START, GOAL = Pose2(-4.0, -2.0, 0.0), (4.0, 2.0)
HALF_X, HALF_Y, WALL_M, CELL_M = 6.0, 4.0, 0.2, 0.05

#: Boxes of two rooms: centre x, y and size x, y.
BOXES = (
    (0.0, -HALF_Y, 2 * HALF_X, WALL_M),
    (0.0, HALF_Y, 2 * HALF_X, WALL_M),
    (-HALF_X, 0.0, WALL_M, 2 * HALF_Y),
    (HALF_X, 0.0, WALL_M, 2 * HALF_Y),
    (0.0, -2.6, WALL_M, 2.8),
    (0.0, 2.6, WALL_M, 2.8),
    (-3.0, 2.0, 1.0, 0.6),
    (3.5, -2.5, 0.6, 1.4),
    (5.0, 0.0, 0.8, 0.8),
)


def rooms() -> Scene:
    world = World("two rooms")
    for x, y, width, depth in BOXES:
        world = world.add_box((x, y), (width, depth))
    return world.scene()


def map_file(folder: Path) -> Path:
    shape = round(2 * (HALF_Y + 1) / CELL_M), round(2 * (HALF_X + 1) / CELL_M)
    cells = np.zeros(shape, np.int8)
    for x, y, width, depth in BOXES:
        low = np.array([y - depth / 2 + HALF_Y + 1, x - width / 2 + HALF_X + 1])
        high = np.array([y + depth / 2 + HALF_Y + 1, x + width / 2 + HALF_X + 1])
        (top, left), (bottom, right) = np.rint(np.array([low, high]) / CELL_M).astype(
            int
        )
        cells[top:bottom, left:right] = 100
    corner = Pose2(-HALF_X - 1, -HALF_Y - 1, 0.0)
    return write_occupancy_map(folder / "rooms", OccupancyMap(cells, CELL_M, corner))


@dataclass
class Drive:
    """What happened: result, states of localization and planner, errors."""

    result: str = ""
    contacts: int = 0
    worst_m: float = math.nan
    final_m: float = math.nan
    localization: list[str] = field(default_factory=list)
    planner: list[str] = field(default_factory=list)


def drive(
    folder: Path,
    change: Callable[[Simulation], None] | None = None,
    at_s: float = 4.0,
    localization: str = "amcl",
    **parameters: Any,
) -> Drive:
    """Drive to the goal; ``change`` disturbs the run at a time."""
    options = RunOptions(
        world="empty",
        robot="jackal",
        start=START,
        goals=(GOAL,),
        headless=True,
        speed=math.inf,
        known_map=map_file(folder) if localization == "amcl" else None,
        methods={"localization": localization, "controller": "pure_pursuit"},
        parameters={localization: parameters} if parameters else {},
        max_time_s=60.0,
    )
    simulation, found = Simulation(options, scene=rooms()), Drive()
    try:
        watch = simulation.monitor
        for topic, states in (
            ("/localization/status", found.localization),
            ("/planner/status", found.planner),
        ):

            def note(msg: DiagnosticStatus, states: list[str] = states) -> None:
                if states[-1:] != [msg.message]:
                    states.append(msg.message)

            watch.create_subscription(DiagnosticStatus, topic, note, 10)
        if change is not None:
            use = change

            def once() -> None:
                timer.cancel()
                use(simulation)

            timer = watch.create_timer(at_s, once)
        simulation.run()
        summary = simulation.summary()
        found.result, found.contacts = summary.goals[0].result, summary.contacts
        found.worst_m = summary.pose_error_m.worst or math.nan
        found.final_m = summary.pose_error_m.final or math.nan
        return found
    finally:
        simulation.close()


def test_a_known_start_is_followed(tmp_path: Path) -> None:
    found = drive(tmp_path)
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.worst_m < 0.15
    assert "lost" not in found.localization


def test_an_unknown_start_is_found_before_the_robot_drives(tmp_path: Path) -> None:
    found = drive(tmp_path, set_initial_pose=False)
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.localization[:2] == ["localizing", "localized"]
    assert "localizing" in found.planner
    assert found.final_m < 0.15


@pytest.mark.parametrize(
    "given", [(-1.5, 0.5, 1.0), (4.0, 3.0, 2.0), (-4.0, -2.0, 3.14)]
)
def test_a_wrong_initial_pose_is_corrected(
    tmp_path: Path, given: tuple[float, float, float]
) -> None:
    names = (f"initial_pose.{each}" for each in ("x", "y", "yaw"))
    found = drive(tmp_path, **dict(zip(names, given, strict=True)))
    assert (found.result, found.contacts) == ("reached", 0)
    assert "lost" in found.planner
    assert found.final_m < 0.15


def carry(pose: Pose2) -> Callable[[Simulation], None]:
    """Move the robot; its wheels do not turn."""

    def move(simulation: Simulation) -> None:
        simulation.sim.simulator.state.place(Transform3.from_pose2(pose, z=0.07))

    return move


@pytest.mark.parametrize(
    "pose", [Pose2(2.0, 2.5, -2.0), Pose2(4.5, -3.0, 1.0), Pose2(-5.0, 3.0, 0.0)]
)
def test_a_carried_robot_is_lost_and_found(tmp_path: Path, pose: Pose2) -> None:
    found = drive(tmp_path, carry(pose))
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.worst_m > 1.0
    assert {"lost", "localizing"} & set(found.localization[2:])
    assert {"lost", "localizing"} & set(found.planner[3:])
    assert found.final_m < 0.15


def jump(by: Pose2) -> Callable[[Simulation], None]:
    """Shift the odometry, as a fault of an encoder or a restarted filter does."""

    def shift(simulation: Simulation) -> None:
        (ekf,) = (node for node in simulation.context.nodes if node.get_name() == "ekf")
        pose = ekf._filter.ekf.estimate_at(ekf._filter.ekf.stamp_ns)
        x, y, yaw = pose.state[:3].tolist()
        ekf._filter.set_pose(Pose2(x, y, yaw) @ by, np.eye(3) * 1e-6)

    return shift


@pytest.mark.parametrize(
    "by", [Pose2(0.7, 0.3, 0.4), Pose2(2.0, 1.0, 1.5), Pose2(-3.0, 2.0, 3.0)]
)
def test_a_jump_of_the_odometry_does_not_move_the_estimate(
    tmp_path: Path, by: Pose2
) -> None:
    """The last one ends at the mirror image of the pose, which fits the map, too."""
    found = drive(tmp_path, jump(by))
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.worst_m < 0.15
    assert found.localization[-1] == "localized"


def blind(simulation: Simulation) -> None:
    """Suppress the scans for two seconds."""
    timers = [t for t, names in simulation.sim._sleepers if "/lidar" in names]
    for timer in timers:
        timer.cancel()

    def continue_scans() -> None:
        end.cancel()
        for timer in timers:
            timer.reset()

    end = simulation.monitor.create_timer(2.0, continue_scans)


def test_missing_scans_stop_the_robot_for_their_time(tmp_path: Path) -> None:
    found = drive(tmp_path, blind)
    assert (found.result, found.contacts) == ("reached", 0)
    assert found.worst_m < 0.2
