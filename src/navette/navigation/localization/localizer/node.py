"""The node ``localizer``: odometry in, Nav2's ``/amcl_pose`` out.

The pose comes from the node that publishes the odometry: the simulator's is exact, the
filter of the node ``ekf`` is set by ``/initialpose`` itself. This node publishes the
pose as Nav2's localizer does (latched, after motion and after each initial pose) and
logs when an initial pose differs from the estimate.
"""

import math
from typing import Any

import numpy as np

from navette.geometry import Pose2, angle_difference
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.localization.localizer.params import LocalizerParams
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.path_messages import pose_message, pose_of
from navette.runtime.stage.stage_node import Input, Output, StageNode


class LocalizerNode(StageNode):
    """Publish the estimated pose as Nav2's programs expect it."""

    PARAMS = LocalizerParams
    INPUTS = (
        Input.of(
            topics.ODOMETRY,
            "pose and its covariance",
            rate_hz=10.0,
            callback="on_odometry",
            most_hz=20.0,
        ),
        Input.of(
            topics.INITIAL_POSE,
            "pose of the robot according to a person or program",
            callback="on_initial_pose",
        ),
    )
    OUTPUTS = (Output.of(topics.AMCL_POSE, "estimated pose with covariance"),)

    params: LocalizerParams
    _newest: Odometry | None
    _published: Pose2 | None

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("localizer", **kwargs)
        self._lifecycle = StageLifecycle(self, "amcl")
        self._start()

    def on_odometry(self, msg: Odometry) -> None:
        """Publish the pose if the robot moved far enough."""
        if not self._tracker.update(msg):
            return
        self._newest = msg
        pose = self._tracker.latest
        assert pose is not None, "the tracker accepted the odometry"
        if self._is_due(pose):
            self._publish(pose, msg)

    def on_initial_pose(self, msg: PoseWithCovarianceStamped) -> None:
        """Publish the pose at once, and log an initial pose that differs from it."""
        pose = self._tracker.latest
        if pose is None or self._newest is None:
            self.get_logger().warning("initial pose received before any odometry")
            return
        self._compare(msg, pose)
        self._publish(pose, self._newest)

    def on_params_changed(self, old: LocalizerParams) -> None:
        """Use the new frames and distances."""
        self._start()

    def on_time_jump(self) -> None:
        """Drop the pose."""
        self._start()

    def _start(self) -> None:
        params = self.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._newest = None
        self._published = None

    def _is_due(self, pose: Pose2) -> bool:
        before, params = self._published, self.params
        return (
            before is None
            or before.distance_to(pose) >= params.update_distance_m
            or abs(angle_difference(pose.yaw, before.yaw)) >= params.update_angle_rad
        )

    def _publish(self, pose: Pose2, odometry: Odometry) -> None:
        self._published = pose
        message = PoseWithCovarianceStamped()
        message.header.frame_id = self.params.map_frame
        message.header.stamp = odometry.header.stamp
        message.pose.pose = pose_message(pose)
        message.pose.covariance = np.asarray(odometry.pose.covariance)
        self.publish(topics.AMCL_POSE.name, message)

    def _compare(self, msg: PoseWithCovarianceStamped, estimate: Pose2) -> None:
        frame_id = msg.header.frame_id or self.params.map_frame
        map_T_frame = self._tracker.frame_on_map(frame_id)
        if map_T_frame is None:
            self.get_logger().error(
                f"initial pose in unknown frame {frame_id!r}; expected a frame on /tf"
            )
            return
        given = map_T_frame @ pose_of(msg.pose.pose)
        away = given.distance_to(estimate)
        if away <= self.params.initial_pose_tolerance_m:
            return
        turn = math.degrees(abs(angle_difference(given.yaw, estimate.yaw)))
        self.get_logger().warning(
            f"initial pose ({given.x:.2f}, {given.y:.2f}) is {away:.2f} m and "
            f"{turn:.0f} degrees from the estimate ({estimate.x:.2f}, "
            f"{estimate.y:.2f}); the estimate is kept unless its publisher uses "
            f"{topics.INITIAL_POSE.name}, as the node ekf does"
        )
