"""Node turtlesim: what ROS 2's first tutorials call."""

import math
from collections.abc import Iterator

import pytest

from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.geometry_msgs.msg import Twist, Vector3
from navette.msgs.std_srvs.srv import Empty
from navette.msgs.turtlesim.action import RotateAbsolute
from navette.msgs.turtlesim.msg import Color
from navette.msgs.turtlesim.msg import Pose as TurtlePose
from navette.msgs.turtlesim.srv import (
    Kill,
    SetPen,
    Spawn,
    TeleportAbsolute,
    TeleportRelative,
)
from navette.msgs.visualization_msgs.msg import Marker, MarkerArray
from navette.ros2.turtlesim.node import TurtleSimNode
from navette.runtime.testing import GraphHarness


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        harness.add(TurtleSimNode(context=harness.context))
        yield harness


def test_the_first_turtle_is_in_the_middle_and_obeys(graph: GraphHarness) -> None:
    poses = graph.collect("/turtle1/pose", TurtlePose)
    graph.run_for(0.1)
    assert (poses.last.x, poses.last.y) == pytest.approx((5.544445, 5.544445))
    graph.publish("/turtle1/cmd_vel", Twist(linear=Vector3(x=1.0)))
    graph.run_for(0.5)
    assert poses.last.linear_velocity == 1.0
    graph.run_for(1.5)
    assert poses.last.x == pytest.approx(6.544, abs=0.04)
    assert poses.last.linear_velocity == 0.0


def test_turtles_come_and_go(graph: GraphHarness) -> None:
    spawned = graph.call(Spawn, "/spawn", Spawn.Request(x=2.0, y=3.0, theta=0.5))
    assert spawned.name == "turtle2"
    named = Spawn.Request(x=1.0, y=1.0, name="leo")
    assert graph.call(Spawn, "/spawn", named).name == "leo"
    assert graph.call(Spawn, "/spawn", named).name == ""
    poses = graph.collect("/leo/pose", TurtlePose)
    graph.run_for(0.1)
    assert poses.count > 3
    graph.call(Kill, "/kill", Kill.Request(name="leo"))
    poses.clear()
    graph.run_for(0.1)
    assert poses.count == 0
    graph.call(Empty, "/reset", Empty.Request())
    again = graph.call(Spawn, "/spawn", Spawn.Request(x=1.0, y=1.0))
    assert again.name == "turtle2"


def test_teleports_pens_and_colours(graph: GraphHarness) -> None:
    poses = graph.collect("/turtle1/pose", TurtlePose)
    colours = graph.collect("/turtle1/color_sensor", Color)
    canvas = graph.collect("/turtlesim/canvas", MarkerArray)
    graph.run_for(0.1)
    assert (colours.last.r, colours.last.g, colours.last.b) == (255, 255, 255)
    graph.call(SetPen, "/turtle1/set_pen", SetPen.Request(r=255, width=5))
    to = TeleportAbsolute.Request(x=1.0, y=1.0, theta=math.pi / 2)
    graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", to)
    by = TeleportRelative.Request(linear=2.0, angular=-math.pi / 2)
    graph.call(TeleportRelative, "/turtle1/teleport_relative", by)
    graph.run_for(0.3)
    assert (poses.last.x, poses.last.y) == pytest.approx((3.0, 1.0))
    assert (colours.last.r, colours.last.g, colours.last.b) == (255, 0, 0)
    lines = [m for m in canvas.last.markers if m.type == Marker.LINE_STRIP]
    assert len(lines) == 1
    assert len(lines[0].points) == 3
    assert lines[0].color.r == 1.0
    graph.call(Empty, "/clear", Empty.Request())
    graph.run_for(0.3)
    assert all(m.type != Marker.LINE_STRIP for m in canvas.last.markers)


def test_rotations_succeed_end_by_commands_and_are_cancelled(
    graph: GraphHarness,
) -> None:
    name = "/turtle1/rotate_absolute"
    done = graph.send_goal(RotateAbsolute, name, RotateAbsolute.Goal(theta=1.57))
    graph.run_for(2.0)
    assert done.status == GoalStatus.STATUS_SUCCEEDED
    assert done.result.delta == pytest.approx(-1.57, abs=0.03)
    assert done.feedback[0].remaining == pytest.approx(1.57, abs=0.01)
    ended = graph.send_goal(RotateAbsolute, name, RotateAbsolute.Goal(theta=-1.57))
    graph.run_for(0.3)
    graph.publish("/turtle1/cmd_vel", Twist(linear=Vector3(x=0.5)))
    graph.run_for(0.3)
    assert ended.status == GoalStatus.STATUS_ABORTED
    cancelled = graph.send_goal(RotateAbsolute, name, RotateAbsolute.Goal(theta=0.0))
    graph.run_for(0.1)
    cancelled.cancel()
    graph.run_for(0.2)
    assert cancelled.status == GoalStatus.STATUS_CANCELED
    poses = graph.collect("/turtle1/pose", TurtlePose)
    graph.run_for(0.1)
    assert poses.last.angular_velocity == 0.0
