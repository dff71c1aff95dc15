import math

import numpy as np
import pytest

from navette.errors import ParameterError
from navette.geometry import Transform3, quaternion_from_rpy, quaternion_from_yaw
from navette.geometry.messages import transform_message
from navette.geometry.se3 import multiply
from navette.msgs.geometry_msgs.msg import (
    PoseWithCovarianceStamped,
    Quaternion,
    TwistWithCovarianceStamped,
    Vector3,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import Imu, NavSatFix
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.localization.ekf.kalman import are_finite, correct, predict
from navette.navigation.localization.ekf.node import EkfNode
from navette.runtime import Parameter, ns_to_stamp
from navette.runtime.testing import GraphHarness, Probe

SECOND = 1_000_000_000
ORDER = "x y z roll pitch yaw vx vy vz vroll vpitch vyaw ax ay az".split()


def config(*names: str) -> list[bool]:
    return [name in names for name in ORDER]


WHEELS = {"odom0": "/wheels", "odom0_config": config("vx", "vy", "vyaw")}


def started(graph: GraphHarness, **values) -> tuple[EkfNode, Probe]:
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = EkfNode(context=graph.context, parameter_overrides=overrides)
    return graph.add(node), graph.collect("/odom/filtered", "nav_msgs/msg/Odometry")


def stamped(msg, stamp_s: float, frame: str):
    msg.header.stamp = ns_to_stamp(round(stamp_s * 1e9))
    msg.header.frame_id = frame
    return msg


def wheels(stamp_s: float, vx: float, vyaw: float = 0.0, child="base_link") -> Odometry:
    msg = stamped(Odometry(child_frame_id=child), stamp_s, "odom")
    msg.twist.twist.linear.x, msg.twist.twist.angular.z = vx, vyaw
    msg.twist.covariance = (np.eye(6) * 1e-4).ravel()
    msg.pose.covariance = (np.eye(6) * 1e-4).ravel()
    return msg


def placed(graph: GraphHarness, child: str, transform: Transform3, parent="base_link"):
    message = TFMessage(transforms=[transform_message(0, parent, child, transform)])
    graph.publish("/tf_static", message, latched=True)


def pose_of(msg: Odometry) -> tuple[float, float, float]:
    q = msg.pose.pose.orientation
    return msg.pose.pose.position.x, msg.pose.pose.position.y, 2 * math.atan2(q.z, q.w)


def test_an_input_is_required_and_nothing_is_published_before_its_first_message() -> (
    None
):
    with GraphHarness() as graph:
        with pytest.raises(ParameterError, match="at least one of odom0, odom1, pose0"):
            started(graph)
        _, estimates = started(graph, **WHEELS)
        graph.run_for(1.0)
        assert estimates.count == 0


def test_velocities_are_integrated_to_a_pose_in_odometry_and_tf() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **WHEELS)
        transforms = graph.collect("/tf", "tf2_msgs/msg/TFMessage")
        graph.publish_every(
            0.05, "/wheels", lambda now: wheels(now / 1e9, 1.0, math.pi / 8)
        )
        graph.run_for(4.1)
        x, y, yaw = pose_of(estimates.last)
        assert yaw == pytest.approx(math.pi / 2, abs=0.05)
        assert (x, y) == pytest.approx((8 / math.pi,) * 2, abs=0.05)
        assert estimates.last.header.frame_id == "odom"
        assert estimates.last.twist.twist.linear.x == pytest.approx(1.0, abs=0.01)
        assert estimates.last.pose.covariance[0] > 0
        (transform,) = transforms.last.transforms
        assert transform.child_frame_id == "base_link"
        assert transform.transform.translation.x == x


def test_prediction_ends_after_the_sensor_timeout_with_a_warning() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **WHEELS, sensor_timeout_s=0.5)
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        graph.publish("/wheels", wheels(100.0, 2.0))
        graph.run_for(3.0)
        assert estimates.count == 15  # 0.5 s, the first one included
        assert pose_of(estimates.last)[0] == pytest.approx(1.0, abs=0.05)
        stamps = [stamp_of(m) for m in estimates.messages]
        assert stamps == sorted(set(stamps))
        warnings = [log.msg for log in logs.messages]
        assert warnings == [
            "nothing is published: no measurement within sensor_timeout_s"
        ]
        graph.publish("/wheels", wheels(103.5, 2.0))
        graph.run_for(0.04)
        assert stamp_of(estimates.last) == 103 * SECOND + SECOND // 2


def stamp_of(msg: Odometry) -> int:
    return msg.header.stamp.sec * SECOND + msg.header.stamp.nanosec


def test_a_bag_that_loops_resets_the_filter() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **WHEELS)
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        for stamp in (10.0, 11.0, 12.0):
            graph.publish("/wheels", wheels(stamp, 1.0))
            graph.run_for(0.05)
        assert pose_of(estimates.last)[0] == pytest.approx(2.0, abs=0.05)
        graph.publish("/wheels", wheels(3.0, 1.0))
        graph.run_for(0.04)
        assert stamp_of(estimates.last) == 3 * SECOND
        assert pose_of(estimates.last)[0] == pytest.approx(0.0, abs=1e-3)
        assert any("jumped to 3.000 s" in log.msg for log in logs.messages)


def test_the_mounting_pose_of_a_sensor_is_applied() -> None:
    """A scanner 1 m ahead of the base that faces left, on a robot that turns."""
    with GraphHarness() as graph:
        placed(
            graph, "ahead", Transform3((1.0, 0, 0), quaternion_from_yaw(math.pi / 2))
        )
        twist = {"twist0": "/seen", "twist0_config": config("vx", "vy", "vyaw")}
        _, estimates = started(graph, **twist)
        msg = stamped(TwistWithCovarianceStamped(), 1.0, "ahead")
        # The base drives 2 m/s and turns 0.5 rad/s: the scanner moves (2, 0.5).
        msg.twist.twist.linear = Vector3(x=0.5, y=-2.0)
        msg.twist.twist.angular.z = 0.5
        msg.twist.covariance = (np.eye(6) * 1e-4).ravel()
        graph.publish("/seen", msg)
        graph.run_for(0.05)
        linear = estimates.last.twist.twist.linear
        assert (linear.x, linear.y) == pytest.approx((2.0, 0.0), abs=1e-6)


def test_an_upside_down_imu_provides_heading_rate_and_level_acceleration() -> None:
    with GraphHarness() as graph:
        upside_down = quaternion_from_rpy(math.pi, 0.0, 0.0)
        placed(graph, "imu", Transform3((0.0, 0.0, 0.0), upside_down))
        _, estimates = started(
            graph,
            imu0="/imu",
            imu0_config=config("yaw", "vyaw", "ax", "ay"),
            imu0_remove_gravitational_acceleration=True,
        )
        msg = stamped(Imu(), 1.0, "imu")
        x, y, z, w = quaternion_from_rpy(math.pi, 0.0, 0.7)
        msg.orientation = Quaternion(x=x, y=y, z=z, w=w)
        msg.angular_velocity.z = -0.3
        msg.linear_acceleration = Vector3(x=0.4, y=0.0, z=-9.80665)
        for name in ("orientation", "angular_velocity", "linear_acceleration"):
            setattr(msg, f"{name}_covariance", (np.eye(3) * 1e-4).ravel())
        graph.publish("/imu", msg)
        graph.run_for(0.04)
        assert pose_of(estimates.last)[2] == pytest.approx(0.7, abs=1e-3)
        assert estimates.last.twist.twist.angular.z == pytest.approx(0.3, abs=1e-3)
        graph.run_for(0.4)  # predicted with the measured acceleration
        elapsed = (stamp_of(estimates.last) - SECOND) / 1e9
        vx = estimates.last.twist.twist.linear.x
        assert vx == pytest.approx(0.4 * elapsed, abs=1e-3)


def test_the_measured_tilt_is_published_with_the_filtered_heading() -> None:
    with GraphHarness() as graph:
        imu = {"imu0": "/imu", "imu0_config": config("roll", "pitch", "vyaw")}
        _, estimates = started(graph, **WHEELS, **imu)
        transforms = graph.collect("/tf", "tf2_msgs/msg/TFMessage")
        placed(graph, "imu_link", Transform3((0, 0, 0.2), quaternion_from_yaw(0.5)))
        # The IMU's own heading, 2.5 rad, is not used.
        x, y, z, w = quaternion_from_rpy(0.05, -0.08, 2.0)
        qx, qy, qz, qw = multiply((x, y, z, w), quaternion_from_yaw(0.5))
        reading = stamped(Imu(), 1.0, "imu_link")
        reading.orientation = Quaternion(x=qx, y=qy, z=qz, w=qw)
        reading.angular_velocity_covariance = (np.eye(3) * 1e-4).ravel()
        graph.publish("/wheels", wheels(1.0, 0.0))
        graph.publish("/imu", reading)
        graph.run_for(0.2)
        q = estimates.last.pose.pose.orientation
        expected = quaternion_from_rpy(0.05, -0.08, 0.0)
        assert (q.x, q.y, q.z, q.w) == pytest.approx(expected, abs=1e-6)
        rotation = transforms.last.transforms[0].transform.rotation
        assert rotation.x == pytest.approx(expected[0], abs=1e-6)


def fix(stamp_s: float, latitude: float, longitude: float, status: int = 0):
    msg = stamped(NavSatFix(latitude=latitude, longitude=longitude), stamp_s, "antenna")
    msg.status.status = status
    msg.position_covariance = (np.eye(3) * 0.01).ravel()
    return msg


def test_a_fix_is_the_position_of_the_antenna() -> None:
    with GraphHarness() as graph:
        placed(graph, "antenna", Transform3((0.5, 0.0, 2.0), (0.0, 0.0, 0.0, 1.0)))
        datum = {"gps0": "/fix", "gps0_datum_deg": [48.0, 11.0]}
        _, estimates = started(graph, **datum)
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        # 100 m east at 48°: 1° of longitude is 74 628.5 m on WGS 84.
        graph.publish("/fix", fix(1.0, 48.0, 11.0 + 100 / 74628.5))
        graph.publish("/fix", fix(1.1, 48.1, 11.0, status=-1))
        graph.run_for(0.05)
        assert pose_of(estimates.last)[:2] == pytest.approx((99.5, 0.0), abs=0.01)
        assert any("gps0 not used: it has no fix" in log.msg for log in logs.messages)


def test_no_kernel_is_compiled_after_the_start() -> None:
    def compiled() -> list[int]:
        return [len(kernel.signatures) for kernel in (predict, correct, are_finite)]

    with GraphHarness() as graph:
        placed(graph, "antenna", Transform3((0.5, 0.0, 2.0), (0.0, 0.0, 0.0, 1.0)))
        _, estimates = started(graph, **WHEELS, gps0="/fix")
        at_the_start = compiled()
        graph.publish("/wheels", wheels(1.0, 0.5))
        graph.publish("/fix", fix(1.1, 48.0, 11.0))
        graph.run_for(0.2)
        assert estimates.count > 0
        assert min(at_the_start) >= 1
        assert compiled() == at_the_start


def pose(stamp_s: float, x: float, y: float, yaw: float, frame: str = "odom"):
    msg = stamped(PoseWithCovarianceStamped(), stamp_s, frame)
    msg.pose.pose.position.x, msg.pose.pose.position.y = x, y
    qx, qy, qz, qw = quaternion_from_yaw(yaw)
    msg.pose.pose.orientation = Quaternion(x=qx, y=qy, z=qz, w=qw)
    msg.pose.covariance = (np.eye(6) * 1e-4).ravel()
    return msg


POSE = {"pose0": "/pose", "pose0_config": config("x", "y", "yaw")}


@pytest.mark.parametrize(
    ("option", "expected"),
    [({}, (2.0, 3.0)), ({"pose0_relative": True}, (0.0, 2.0))],
)
def test_poses_are_absolute_or_relative_to_the_first(option, expected) -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **POSE, **option)
        graph.publish("/pose", pose(1.0, 4.0, 3.0, math.pi / 2))
        graph.publish("/pose", pose(9.0, 2.0, 3.0, math.pi / 2))
        graph.run_for(0.04)
        assert pose_of(estimates.last)[:2] == pytest.approx(expected, abs=0.01)


def test_an_invalid_quaternion_is_refused_if_the_heading_is_used() -> None:
    message = pose(1.0, 4.0, 3.0, 0.0)
    message.pose.pose.orientation = Quaternion(w=0.0)
    for names, used in ((("x", "y"), True), (("x", "y", "yaw"), False)):
        with GraphHarness() as graph:
            _, estimates = started(graph, pose0="/pose", pose0_config=config(*names))
            logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
            graph.publish("/pose", message)
            graph.run_for(0.05)
            assert (estimates.count > 0) is used
            assert (
                any("not a unit quaternion" in log.msg for log in logs.messages)
                is not used
            )


def test_differential_poses_are_velocities() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **POSE, pose0_differential=True)
        for step in range(20):
            graph.publish(
                "/pose", pose(0.1 * step, 50.0, 7.0 + 0.2 * step, math.pi / 2)
            )
            graph.run_for(0.04)
        assert estimates.last.twist.twist.linear.x == pytest.approx(2.0, abs=0.01)
        assert pose_of(estimates.last)[1] == pytest.approx(0.0, abs=0.1)


@pytest.mark.parametrize("names", [("x", "y"), ("x", "y", "yaw")])
def test_changes_are_along_the_axes_of_the_base_also_without_the_heading(
    names: tuple[str, ...],
) -> None:
    with GraphHarness() as graph:
        inputs = {"pose0": "/pose", "pose0_config": config(*names)}
        _, estimates = started(graph, **inputs, pose0_differential=True)
        for step in range(20):
            graph.publish("/pose", pose(0.1 * step, 5.0, 0.2 * step, math.pi / 2))
            graph.run_for(0.04)
        velocity = estimates.last.twist.twist.linear
        assert (velocity.x, velocity.y) == pytest.approx((2.0, 0.0), abs=0.02)


def test_the_heading_turns_the_offset_of_a_frame_also_where_it_is_not_fused() -> None:
    with GraphHarness() as graph:
        inputs = {"odom0": "/wheels", "odom0_config": config("x", "y")}
        _, estimates = started(graph, **inputs)
        ahead = Transform3((0.3, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        placed(graph, "tracker", ahead)
        graph.run_for(0.05)
        msg = wheels(0.1, 0.0, child="tracker")
        place = msg.pose.pose
        place.position.x, place.position.y = 4.7, 5.0
        place.orientation = Quaternion(z=1.0, w=0.0)
        graph.publish("/wheels", msg)
        graph.run_for(0.05)
        assert pose_of(estimates.last)[:2] == pytest.approx((5.0, 5.0), abs=0.01)


def test_unusable_messages_are_logged_without_effect() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **POSE)
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        graph.publish("/pose", pose(1.0, 1.0, 2.0, 0.0))
        graph.publish("/pose", pose(1.1, math.nan, 2.0, 0.0))
        graph.run_for(6.0)
        graph.publish("/pose", pose(1.2, 1.0, 2.0, 0.0, frame="mars"))
        graph.run_for(6.0)
        bad = pose(1.3, 9.0, 2.0, 0.0)
        bad.pose.covariance = (-np.eye(6)).ravel()
        graph.publish("/pose", bad)
        graph.run_for(1.0)
        assert pose_of(estimates.last)[0] == pytest.approx(1.0, abs=1e-3)
        text = "\n".join(log.msg for log in logs.messages)
        for reason in ("not finite", "mars", "negative eigenvalues"):
            assert reason in text


def test_in_the_map_frame_the_transform_to_odom_is_published() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **POSE, world_frame="map")
        at = Transform3((1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        moving = TFMessage(transforms=[transform_message(0, "odom", "base_link", at)])
        graph.publish("/tf", moving)
        transforms = graph.collect("/tf", "tf2_msgs/msg/TFMessage")
        graph.run_for(0.01)
        graph.publish("/pose", pose(1.0, 5.0, 2.0, 0.0, frame="map"))
        graph.run_for(0.04)
        assert estimates.last.header.frame_id == "map"
        (transform,) = transforms.last.transforms
        assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
        translation = transform.transform.translation
        assert (translation.x, translation.y) == pytest.approx((4.0, 2.0), abs=1e-3)


def test_a_missing_variance_is_logged_once() -> None:
    with GraphHarness() as graph:
        started(graph, **WHEELS)
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        for stamp in (1.0, 1.1):
            msg = wheels(stamp, 1.0)
            msg.twist.covariance = np.zeros(36)
            graph.publish("/wheels", msg)
            graph.run_for(0.05)
        warnings = [log.msg for log in logs.messages if "variance" in log.msg]
        assert warnings == ["odom0: no variance of vx, vy, vyaw; 1e-09 is used"]


def test_parameters_may_change_while_it_runs() -> None:
    with GraphHarness() as graph:
        node, estimates = started(graph, **WHEELS)
        graph.publish("/wheels", wheels(1.0, 1.0))
        graph.run_for(0.2)
        node.set_parameters([Parameter("frequency_hz", value=10.0)])
        estimates.clear()
        graph.publish("/wheels", wheels(1.2, 1.0))
        graph.run_for(0.35)
        assert estimates.count == 3
        noisy = Parameter("process_noise_covariance", value=[0.5] * 15)
        assert node.set_parameters([noisy])[0].successful
        bad = Parameter("process_noise_covariance", value=[0.5] * 7)
        assert "7 numbers" in node.set_parameters([bad])[0].reason
        moved = node.set_parameters([Parameter("odom0", value="/other")])[0]
        assert "cannot change after the start" in moved.reason


def initial_pose(x: float, y: float, yaw: float, frame: str = "odom", variance=0.0):
    msg = stamped(PoseWithCovarianceStamped(), 0.0, frame)
    msg.pose.pose.position.x, msg.pose.pose.position.y = x, y
    qx, qy, qz, qw = quaternion_from_yaw(yaw)
    msg.pose.pose.orientation = Quaternion(x=qx, y=qy, z=qz, w=qw)
    msg.pose.covariance = (np.eye(6) * variance).ravel()
    return msg


def test_an_initial_pose_replaces_the_estimate() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **WHEELS)
        for i in range(10):
            graph.publish("/wheels", wheels(0.1 * i, 1.0))
            graph.run_for(0.1)
        assert pose_of(estimates.last)[0] > 0.5
        graph.publish("/initialpose", initial_pose(5.0, -2.0, math.pi / 2))
        graph.run_for(0.01)
        for i in range(10, 20):
            graph.publish("/wheels", wheels(0.1 * i, 1.0))
            graph.run_for(0.1)
        x, y, yaw = pose_of(estimates.last)
        assert x == pytest.approx(5.0, abs=0.02)
        assert y == pytest.approx(-1.0, abs=0.15)
        assert yaw == pytest.approx(math.pi / 2, abs=0.01)
        variances = np.asarray(estimates.last.pose.covariance).reshape(6, 6).diagonal()
        assert 0.25 <= variances[0] < 0.6  # none was given


def test_a_late_measurement_does_not_undo_an_initial_pose() -> None:
    with GraphHarness() as graph:
        _, estimates = started(graph, **WHEELS)
        for i in range(10):
            graph.publish("/wheels", wheels(0.1 * i, 1.0))
            graph.run_for(0.1)
        graph.publish("/initialpose", initial_pose(5.0, 0.0, 0.0, variance=0.01))
        graph.run_for(0.01)
        for late_s in (0.45, 0.95):
            graph.publish("/wheels", wheels(late_s, 1.0))
            graph.run_for(0.1)
        assert pose_of(estimates.last)[0] > 5.0


def test_an_initial_pose_in_an_unknown_frame_is_dropped() -> None:
    with GraphHarness() as graph:
        node, estimates = started(graph, **WHEELS)
        graph.publish("/wheels", wheels(0.0, 0.0))
        graph.run_for(0.1)
        graph.publish("/initialpose", initial_pose(5.0, 0.0, 0.0, frame="moon"))
        graph.publish("/wheels", wheels(0.1, 0.0))
        graph.run_for(0.1)
        assert pose_of(estimates.last)[0] == pytest.approx(0.0)
        assert sum(node.dropped_inputs.values()) == 1


def test_beside_a_node_that_locates_the_robot_a_pose_in_the_map_is_for_that_node() -> (
    None
):
    with GraphHarness() as graph:
        node, estimates = started(graph, **WHEELS, publish_status=False)
        graph.publish("/wheels", wheels(0.0, 0.0))
        graph.run_for(0.1)
        graph.publish("/initialpose", initial_pose(5.0, 0.0, 0.0, frame="map"))
        graph.publish("/wheels", wheels(0.1, 0.0))
        graph.run_for(0.1)
        assert pose_of(estimates.last)[0] == pytest.approx(0.0)
        assert not node.dropped_inputs
