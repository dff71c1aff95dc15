"""A planner of the user instead of Navette's: it works, or the log explains why not."""

import numpy as np
import pytest

from navette.geometry import Pose2, yaw_of
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.nav_msgs.msg import Odometry, Path
from navette.msgs.rcl_interfaces.msg import Log
from navette.navigation.stack.simulation import Simulation
from navette.runtime import Node
from navette.runtime.stage.path_messages import path_message

from .conftest import MakeSimulation

FRAME = "sim_world"


class OwnPlanner(Node):
    """As students write it: a straight line from the odometry's pose to the goal."""

    def __init__(self, simulation: Simulation, ahead_m: float) -> None:
        super().__init__("my_planner", context=simulation.context)
        self._ahead_m = ahead_m
        self._pose: Pose2 | None = None
        self.goals: list[tuple[float, float]] = []
        self._path = self.create_publisher(Path, "/path", 10)
        self.create_subscription(Odometry, "/odom/filtered", self._on_odometry, 10)
        self.create_subscription(PointStamped, "/goal_point", self._on_goal, 10)
        self.create_timer(0.5, self._plan)
        simulation.executor.add_node(self)

    def _on_odometry(self, msg: Odometry) -> None:
        p, q = msg.pose.pose.position, msg.pose.pose.orientation
        self._pose = Pose2(p.x, p.y, yaw_of((q.x, q.y, q.z, q.w)))

    def _on_goal(self, msg: PointStamped) -> None:
        self.goals.append((msg.point.x, msg.point.y))
        self._plan()

    def _plan(self) -> None:
        if self._pose is None or not self.goals:
            return
        start = self._pose @ Pose2(self._ahead_m, 0.0, 0.0)
        goal = np.array(self.goals[-1])
        way = np.linspace((start.x, start.y), goal, 40)
        yaw = np.arctan2(goal[1] - start.y, goal[0] - start.x)
        poses = np.column_stack([way, np.full(len(way), yaw)])
        now_ns = self.get_clock().now().nanoseconds
        self._path.publish(path_message(poses, FRAME, now_ns))


def replaced(simulation: Simulation, ahead_m: float) -> tuple[OwnPlanner, list[str]]:
    simulation.stack.planner.destroy_node()
    texts: list[str] = []
    simulation.monitor.create_subscription(
        Log, "/rosout", lambda msg: texts.append(f"{msg.name}: {msg.msg}"), 100
    )
    return OwnPlanner(simulation, ahead_m), texts


@pytest.mark.slow
def test_missions_send_goals_to_a_planner_without_status(
    simulate: MakeSimulation,
) -> None:
    """The odometry is that of the lidar; a planner that uses the axle arrives."""
    simulation = simulate(world="course", goals=((-6.0, -4.0),), max_time_s=60.0)
    planner, _ = replaced(simulation, ahead_m=-1.3)
    simulation.run()
    assert planner.goals == [(-6.0, -4.0)]
    (outcome,) = simulation.summary().goals
    assert outcome.result == "reached"
    assert outcome.distance_left_m < 0.5


@pytest.mark.slow
def test_a_path_from_the_lidars_pose_is_explained(simulate: MakeSimulation) -> None:
    simulation = simulate(world="course", goals=((-6.0, -4.0),), max_time_s=20.0)
    _, texts = replaced(simulation, ahead_m=0.05)
    simulation.run()
    (text,) = [each for each in texts if "off_path" in each]
    assert "the path starts 1.35 m from the robot" in text
    assert "'robot'" in text
    assert "max_deviation_m, 1 m" in text
    assert "robot/chassis/lidar" in text
    assert "1.30 m" in text
    assert simulation.summary().goals[0].result in ("unfinished", "timed_out")
