"""Invalid goals: named within a second, robot stopped, program running."""

import math

import pytest

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.nav2_msgs.action import NavigateToPose
from navette.navigation.stack.simulation import Simulation
from navette.runtime.action import ActionClient
from navette.sim import World

from .conftest import MakeSimulation

SECOND = 1_000_000_000


def send_goal(simulation: Simulation, x: float, y: float, frame: str) -> None:
    node = simulation.monitor
    publisher = node.create_publisher(PointStamped, "/goal_point", 10)
    goal = PointStamped()
    goal.header.frame_id = frame
    goal.point.x, goal.point.y = x, y
    publisher.publish(goal)
    node.destroy_publisher(publisher)


def speed(simulation: Simulation) -> float:
    motion = simulation.sim.simulator.motion()
    return math.hypot(*motion.linear) + abs(motion.angular[2])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("x", "y", "frame", "result"),
    [
        (-14.8, 0.0, "sim_world", "goal_blocked"),  # in a wall
        (-14.7, 5.0, "sim_world", "goal_blocked"),  # too near to a wall
        (1e4, 0.0, "sim_world", "goal_outside_map"),
        (math.nan, 0.0, "sim_world", "goal_not_finite"),
        (1.0, math.inf, "sim_world", "goal_not_finite"),
        (1.0, 1.0, "nowhere", "unknown_frame"),
    ],
)
def test_an_invalid_goal_is_named_and_the_next_one_driven(
    simulate: MakeSimulation, x: float, y: float, frame: str, result: str
) -> None:
    simulation = simulate(world="course")
    simulation.executor.spin_until(3 * SECOND)
    send_goal(simulation, x, y, frame)
    simulation.executor.spin_for(SECOND)
    assert simulation.progress().state == result
    assert simulation.progress().failed
    assert speed(simulation) < 0.01

    send_goal(simulation, -6.0, -2.0, "sim_world")
    simulation.executor.spin_until_complete(
        lambda: simulation.progress().state == "reached", 30 * SECOND
    )
    assert simulation.progress().state == "reached"


@pytest.mark.slow
def test_a_robot_with_a_slow_scanner_starts_anywhere(simulate: MakeSimulation) -> None:
    """The goal arrives before the first scan makes the map hold the robot."""
    simulation = simulate(
        world="empty",
        robot="turtlebot3_burger",
        start=Pose2(-60.0, 80.0, 0.0),
        goals=((-59.0, 80.0),),
        max_time_s=30.0,
    )
    simulation.run()
    assert [each.result for each in simulation.summary().goals] == ["reached"]


@pytest.mark.slow
def test_a_goal_beyond_closed_walls_has_no_path(simulate: MakeSimulation) -> None:
    room = World("room").add_walls((10.0, 10.0)).scene()
    simulation = simulate(
        scene=room, robot="course", goals=((8.0, 0.0),), max_time_s=20.0
    )
    simulation.run()
    (outcome,) = simulation.summary().goals
    assert outcome.result in {"no_path", "goal_blocked", "goal_outside_map"}
    assert outcome.time_s <= 1.0
    assert simulation.summary().contacts == 0


@pytest.mark.slow
def test_an_invalid_goal_while_driving_stops_the_robot(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate(world="course")
    simulation.executor.spin_until(2 * SECOND)
    send_goal(simulation, 6.0, -12.0, "sim_world")
    simulation.executor.spin_for(5 * SECOND)
    assert speed(simulation) > 0.3
    send_goal(simulation, math.nan, 0.0, "sim_world")
    simulation.executor.spin_for(2 * SECOND)
    assert speed(simulation) < 0.01


@pytest.mark.slow
def test_an_invalid_goal_of_an_action_is_refused_in_one_line(
    simulate: MakeSimulation, capfd: pytest.CaptureFixture[str]
) -> None:
    simulation = simulate(world="course")
    client = ActionClient(simulation.monitor, NavigateToPose, "navigate_to_pose")
    simulation.executor.spin_until(2 * SECOND)
    goal = NavigateToPose.Goal()
    goal.pose.header.frame_id = "map"
    goal.pose.pose.position.x = math.nan
    goal.pose.pose.orientation.w = 1.0
    client.send_goal_async(goal)
    simulation.executor.spin_for(SECOND)
    assert simulation.progress().state == "goal_not_finite"
    lines = [line for line in capfd.readouterr().err.splitlines() if "nan" in line]
    assert len(lines) == 1
    assert "refused /planner/goal_pose: not_finite" in lines[0]
