"""The localizer: /amcl_pose after motion and after each initial pose."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped
from navette.msgs.lifecycle_msgs.srv import GetState
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.rcl_interfaces.msg import Log
from navette.navigation.localization.localizer.node import LocalizerNode
from navette.runtime.stage.path_messages import pose_message, pose_of
from navette.runtime.testing import GraphHarness, Probe
from navette.runtime.time import ns_to_stamp


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        harness.add(LocalizerNode(context=harness.context))
        yield harness


def poses(graph: GraphHarness) -> Probe:
    return graph.collect("/amcl_pose", PoseWithCovarianceStamped, latched=True)


def move_to(graph: GraphHarness, x: float, yaw: float = 0.0) -> None:
    msg = Odometry(child_frame_id="base_link")
    msg.header.frame_id = "map"
    msg.header.stamp = ns_to_stamp(graph.now_ns)
    msg.pose.pose = pose_message(Pose2(x, 1.0, yaw))
    msg.pose.covariance = (np.eye(6) * 0.01).ravel()
    graph.publish("/odom/filtered", msg)
    graph.run_for(0.1)


def initial_pose(x: float, frame: str = "map") -> PoseWithCovarianceStamped:
    msg = PoseWithCovarianceStamped()
    msg.header.frame_id = frame
    msg.pose.pose = pose_message(Pose2(x, 1.0, 0.0))
    return msg


def test_the_pose_is_published_after_motion(graph: GraphHarness) -> None:
    found = poses(graph)
    for x in (0.0, 0.1, 0.2, 0.3, 0.4):
        move_to(graph, x)
    assert [round(m.pose.pose.position.x, 6) for m in found.messages] == [0.0, 0.3]
    move_to(graph, 0.4, yaw=0.5)
    assert pose_of(found.last.pose.pose) == pytest.approx((0.4, 1.0, 0.5))
    assert found.last.header.frame_id == "map"
    assert found.last.pose.covariance[0] == pytest.approx(0.01)


def test_an_initial_pose_is_answered_at_once(graph: GraphHarness) -> None:
    found, logs = poses(graph), graph.collect("/rosout", Log)
    graph.publish("/initialpose", initial_pose(0.0))
    graph.run_for(0.1)
    assert found.count == 0
    move_to(graph, 2.0)
    assert found.count == 1
    graph.publish("/initialpose", initial_pose(2.1))
    graph.run_for(0.1)
    assert found.count == 2
    assert warnings(logs) == ["initial pose received before any odometry"]
    graph.publish("/initialpose", initial_pose(5.0))
    graph.run_for(0.1)
    assert pose_of(found.last.pose.pose).x == pytest.approx(2.0)
    assert "3.00 m and 0 degrees from the estimate (2.00, 1.00)" in warnings(logs)[-1]
    graph.publish("/initialpose", initial_pose(0.0, "moon"))
    graph.run_for(0.1)
    assert "'moon'" in warnings(logs)[-1]
    assert math.isfinite(found.last.pose.pose.position.x)


def warnings(logs: Probe) -> list[str]:
    return [m.msg for m in logs.messages if m.level >= 30 and m.name == "localizer"]


def test_programs_find_an_active_amcl(graph: GraphHarness) -> None:
    state: Any = graph.call(GetState, "amcl/get_state", GetState.Request())
    assert state.current_state.label == "active"
