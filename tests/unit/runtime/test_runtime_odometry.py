"""Poses of the base in the map frame from odometry of several frames."""

import math
from typing import Any

import pytest

from navette.geometry import Pose2, Transform3, quaternion_from_yaw
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Quaternion
from navette.msgs.nav_msgs.msg import Odometry
from navette.runtime import DurabilityPolicy, Node, QoSProfile, ns_to_stamp
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.stage_node import Input, StageNode
from navette.runtime.testing import GraphHarness
from navette.runtime.tf import StaticTransformBroadcaster, TransformBroadcaster
from navette.runtime.tf.conversions import transform_stamped

S = 1_000_000_000


def odometry(
    stamp_ns: int,
    pose: Pose2,
    *,
    frame: str = "map",
    child: str = "base_link",
    v: float = 0.0,
    vy: float = 0.0,
    omega: float = 0.0,
) -> Odometry:
    message = Odometry(child_frame_id=child)
    message.header.stamp = ns_to_stamp(stamp_ns)
    message.header.frame_id = frame
    message.pose.pose.position.x = pose.x
    message.pose.pose.position.y = pose.y
    x, y, z, w = quaternion_from_yaw(pose.yaw)
    message.pose.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
    message.twist.twist.linear.x = v
    message.twist.twist.linear.y = vy
    message.twist.twist.angular.z = omega
    return message


def send_static(graph: GraphHarness, parent: str, child: str, pose: Pose2) -> None:
    StaticTransformBroadcaster(graph.node).sendTransform(
        transform_stamped(parent, child, 0, Transform3.from_pose2(pose))
    )
    graph.run_for(0)


@pytest.fixture
def tracker(graph: GraphHarness) -> PoseTracker:
    node = graph.add(Node("stage", context=graph.context))
    return PoseTracker(node, "base_link", "map")


def test_odometry_of_the_base_in_the_map_frame(tracker: PoseTracker) -> None:
    assert tracker.latest is None
    assert tracker.stamp_ns is None
    assert tracker.update(odometry(S, Pose2(1, 2, 0.5), v=0.4, omega=0.2))
    assert tracker.latest == pytest.approx((1, 2, 0.5))
    assert tracker.stamp_ns == S
    assert tracker.velocity == pytest.approx((0.4, 0.2))


def test_odometry_of_a_sensor_is_converted_to_the_base(
    graph: GraphHarness,
) -> None:
    """The course world's odometry is the lidar's, 1.3 m in front of the axle."""
    node = graph.add(Node("stage", context=graph.context))
    tracker = PoseTracker(node, "robot", "sim_world")
    message = odometry(
        S,
        Pose2(1.3, 5.0, math.pi / 2),
        frame="sim_world",
        child="robot/chassis/lidar",
        v=0.5,
        vy=1.3 * 0.4,
        omega=0.4,
    )
    assert not tracker.update(message)  # the mounting is not known yet
    assert tracker.latest is None
    send_static(graph, "robot", "robot/chassis", Pose2(0.5, 0, 0))
    send_static(graph, "robot/chassis", "robot/chassis/lidar", Pose2(0.8, 0, 0))
    assert tracker.update(message)
    assert tracker.latest == pytest.approx((1.3, 3.7, math.pi / 2))
    # Turning, the lidar swings sideways; the axle only rolls.
    assert tracker.velocity == pytest.approx((0.5, 0.4))


class Stage(StageNode):
    INPUTS = (Input.of(topics.ODOMETRY, "pose", callback="on_odometry"),)

    def on_odometry(self, msg: Odometry) -> None:
        self.poses.update(msg)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("stage", **kwargs)
        self.poses = PoseTracker(self, "base_link", "map")


def test_missing_frames_are_reported_once_their_publisher_has_had_time_to_start(
    graph: GraphHarness,
) -> None:
    stage = graph.add(Stage(context=graph.context))
    message = odometry(S, Pose2(0, 0, 0), child="nowhere")
    graph.publish_every(0.1, topics.ODOMETRY.name, lambda _: message)
    graph.run_for(1.9)
    assert not stage.dropped_inputs
    graph.run_for(1.0)
    assert set(stage.dropped_inputs) == {(topics.ODOMETRY.name, "unknown_frame")}


def test_the_frame_of_a_map_may_be_missing_while_the_pose_is_searched_for(
    graph: GraphHarness,
) -> None:
    """The node that searches reports it; later the frame is missed again."""
    stage = graph.add(Stage(context=graph.context))
    moving = odometry(S, Pose2(0, 0, 0), frame="odom")
    graph.publish_every(0.1, topics.ODOMETRY.name, lambda _: moving)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    status = graph.node.create_publisher(
        DiagnosticStatus, topics.LOCALIZATION_STATUS.name, latched
    )
    status.publish(DiagnosticStatus(name="amcl", message="localizing"))
    graph.run_for(5.0)
    assert not stage.dropped_inputs
    status.publish(DiagnosticStatus(name="amcl", message="localized"))
    graph.run_for(3.0)
    assert set(stage.dropped_inputs) == {(topics.ODOMETRY.name, "unknown_frame")}


def test_velocity_of_a_rotated_sensor(
    graph: GraphHarness, tracker: PoseTracker
) -> None:
    send_static(graph, "base_link", "side", Pose2(0, 0.5, math.pi / 2))
    # At 0.5 m to the left, turning left slows the point: v − ω·0.5, along its −y.
    tracker.update(
        odometry(S, Pose2(0, 0, 0), child="side", vy=-(1.0 - 0.2), omega=0.4)
    )
    assert tracker.velocity == pytest.approx((1.0, 0.4))


def test_odometry_frame_by_transform(graph: GraphHarness, tracker: PoseTracker) -> None:
    message = odometry(S, Pose2(1, 0, 0), frame="odom")
    assert not tracker.update(message)
    send_static(graph, "map", "odom", Pose2(10, 0, math.pi / 2))
    assert tracker.update(message)
    assert tracker.latest == pytest.approx((10, 1, math.pi / 2))


def test_moving_odometry_frame(graph: GraphHarness, tracker: PoseTracker) -> None:
    moving = TransformBroadcaster(graph.node)
    assert not tracker.update(odometry(S, Pose2(0, 0, 0), frame="odom"))
    for stamp, x in ((1, 1.0), (2, 2.0)):
        moving.sendTransform(
            transform_stamped(
                "map", "odom", stamp * S, Transform3.from_pose2(Pose2(x, 0, 0))
            )
        )
        graph.run_for(0)
        assert tracker.update(odometry(stamp * S, Pose2(0, 0, 0), frame="odom"))
        assert tracker.latest == pytest.approx((x, 0, 0))


def test_a_correction_moves_the_whole_history(
    graph: GraphHarness, tracker: PoseTracker
) -> None:
    moving = TransformBroadcaster(graph.node)

    def correct(stamp: int, x: float) -> None:
        pose = Transform3.from_pose2(Pose2(x, 0, 0))
        moving.sendTransform(transform_stamped("map", "odom", stamp * S, pose))
        graph.run_for(0)

    tracker.update(odometry(0, Pose2(0, 0, 0), frame="odom"))
    correct(1, 0.0)
    tracker.update(odometry(1 * S, Pose2(0, 0, 0), frame="odom"))
    tracker.update(odometry(2 * S, Pose2(1, 0, 0), frame="odom"))
    correct(3, 0.1)
    tracker.update(odometry(3 * S, Pose2(2, 0, 0), frame="odom"))
    assert tracker.jumps == 0
    assert tracker.pose_at(round(1.5 * S)) == pytest.approx((0.6, 0, 0))
    correct(4, 0.6)
    tracker.update(odometry(4 * S, Pose2(3, 0, 0), frame="odom"))
    assert tracker.jumps == 1
    assert tracker.latest == pytest.approx((3.6, 0, 0))
    assert tracker.pose_at(3 * S) == pytest.approx((2.6, 0, 0))
    assert tracker.first == pytest.approx((0.6, 0, 0))
    assert tracker.in_odom(Pose2(3.6, 0, 0)) == pytest.approx((3, 0, 0))
    correct(5, 6.0)  # carried, or located for the first time
    tracker.update(odometry(5 * S, Pose2(3, 0, 0), frame="odom"))
    assert tracker.first == pytest.approx((9, 0, 0))


def test_pose_at_a_stamp(tracker: PoseTracker) -> None:
    for second in range(1, 4):
        tracker.update(odometry(second * S, Pose2(second, 0, 0)))
    assert tracker.pose_at(S) == pytest.approx((1, 0, 0))
    assert tracker.pose_at(5 * S // 2) == pytest.approx((2.5, 0, 0))
    assert tracker.pose_at(3 * S) == pytest.approx((3, 0, 0))
    assert tracker.pose_at(S - 1) is None
    assert tracker.pose_at(3 * S + 1) is None


def test_yaw_is_interpolated_along_the_shorter_arc(tracker: PoseTracker) -> None:
    tracker.update(odometry(0, Pose2(0, 0, math.pi - 0.1)))
    tracker.update(odometry(S, Pose2(0, 0, -math.pi + 0.1)))
    pose = tracker.pose_at(S // 2)
    assert pose is not None
    assert abs(pose.yaw) == pytest.approx(math.pi)


def test_history_is_bounded(graph: GraphHarness) -> None:
    node = graph.add(Node("stage", context=graph.context))
    tracker = PoseTracker(node, "base_link", "map", history_s=1.0)
    for step in range(100):
        tracker.update(odometry(step * S // 10, Pose2(step, 0, 0)))
    assert tracker.pose_at(89 * S // 10) is not None
    assert tracker.pose_at(88 * S // 10) is None


def test_a_jump_backward_clears_the_history(tracker: PoseTracker) -> None:
    for second in (5, 6):
        tracker.update(odometry(second * S, Pose2(second, 0, 0)))
    tracker.update(odometry(6 * S, Pose2(60, 0, 0)))
    assert tracker.pose_at(6 * S) == pytest.approx((60, 0, 0))
    tracker.update(odometry(S, Pose2(1, 0, 0)))
    assert tracker.stamp_ns == S
    assert tracker.pose_at(5 * S) is None
    tracker.reset()
    assert tracker.latest is None


def test_non_finite_odometry_is_rejected(
    graph: GraphHarness, tracker: PoseTracker
) -> None:
    logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    assert not tracker.update(odometry(S, Pose2(math.nan, 0, 0)))
    assert tracker.latest is None
    graph.run_for(0)
    assert logs.last.msg == "odometry not used: odometry is not finite"


def test_sensor_frames(graph: GraphHarness, tracker: PoseTracker) -> None:
    assert tracker.transform_to_base("base_link") == pytest.approx((0, 0, 0))
    assert tracker.transform_to_base("lidar") is None
    send_static(graph, "base_link", "lidar", Pose2(0.2, 0.1, 0.3))
    assert tracker.transform_to_base("lidar") == pytest.approx((0.2, 0.1, 0.3))
