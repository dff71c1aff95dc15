"""Conditions about how the robot follows its path."""

from typing import ClassVar

from py_trees.common import Status

from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    RUNNING,
    SUCCESS,
    LeafNode,
    Ports,
    to_status,
)
from navette.navigation.missions.tree.paths import nearest_index, path_length_m
from navette.navigation.missions.tree.ports import (
    Port,
    parse_float,
    parse_message,
    parse_milliseconds,
)


class IsGoalNearbyNode(LeafNode):
    """Whether less than ``proximity_threshold`` (m) of the path is left."""

    PORTS: ClassVar[Ports] = {
        "path": Port(parse_message, required=True),
        "proximity_threshold": Port(parse_float, "1.0"),
        "max_robot_pose_search_dist": Port(parse_float, "-1.0"),
        "global_frame": Port(),
        "robot_base_frame": Port(),
    }

    def update(self) -> Status:
        path, pose = self.input("path"), self.robot.pose()
        if path is None or not path.poses or pose is None:
            return FAILURE
        left_m = path_length_m(path, nearest_index(path, pose.x, pose.y))
        return to_status(left_m < self.input("proximity_threshold"))


class IsWithinPathTrackingBoundsNode(LeafNode):
    """Whether the errors of FollowPath's ``tracking_feedback`` are within bounds.

    Before the first feedback they are.
    """

    PORTS: ClassVar[Ports] = {
        "tracking_feedback": Port(parse_message, required=True),
        "max_error_left": Port(parse_float, "0.5"),
        "max_error_right": Port(parse_float, "0.5"),
        "max_error_heading": Port(parse_float, "3.14"),
    }

    def update(self) -> Status:
        error = self.input("tracking_feedback")
        if error is None:
            return SUCCESS
        off_m, off_rad = error.position_tracking_error, error.heading_tracking_error
        self.feedback_message = f"{off_m:.2f} m, {off_rad:.2f} rad off"
        side = "max_error_left" if off_m >= 0 else "max_error_right"
        is_near = abs(off_m) <= abs(self.input(side))
        return to_status(
            is_near and abs(off_rad) <= abs(self.input("max_error_heading"))
        )


class CheckStopStatusNode(LeafNode):
    """Whether the robot is at rest: running until it was for ``duration_stopped`` ms.

    Speeds below ``velocity_threshold`` (m/s, rad/s) are rest.
    """

    PORTS: ClassVar[Ports] = {
        "velocity_threshold": Port(parse_float, "0.01"),
        "duration_stopped": Port(parse_milliseconds, "1000"),
    }
    _since_ns: int | None = None

    def begin(self) -> None:
        self._since_ns = None

    def update(self) -> Status:
        if max(map(abs, self.robot.velocity())) >= self.input("velocity_threshold"):
            self._since_ns = None
            return FAILURE
        if self._since_ns is None:
            self._since_ns = self.robot.now_ns
        if 1000 * self.seconds_since(self._since_ns) <= self.input("duration_stopped"):
            return RUNNING
        self._since_ns = None
        return SUCCESS
