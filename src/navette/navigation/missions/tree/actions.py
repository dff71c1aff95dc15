"""Leaves that act: Nav2's action and service clients, and Navette's own."""

import math
from typing import Any, ClassVar

from py_trees.common import Status

from navette.msgs.builtin_interfaces.msg import Duration
from navette.msgs.geometry_msgs.msg import Point
from navette.msgs.nav_msgs.msg import Path
from navette.navigation.missions.tree.behaviour import RUNNING, Ports
from navette.navigation.missions.tree.calls import (
    SERVER_PORTS,
    ActionLeaf,
    MissingInputError,
)
from navette.navigation.missions.tree.paths import tracking_error
from navette.navigation.missions.tree.ports import (
    Port,
    output_port,
    parse_absent,
    parse_bool,
    parse_float,
    parse_message,
)
from navette.navigation.missions.tree.robot_access import CallResult

_TIME_ALLOWANCE: Ports = {"time_allowance": Port(parse_float, "10.0")}
_MOTION: Ports = {
    **_TIME_ALLOWANCE,
    "disable_collision_checks": Port(parse_absent, "false"),
}


class ComputePathToPoseNode(ActionLeaf):
    """Plan a path to the goal."""

    ACTION, SERVER = "ComputePathToPose", "compute_path_to_pose"
    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, required=True),
        "start": Port(parse_message),
        "use_start": Port(parse_bool),
        "planner_id": Port(default=""),
        "path": output_port(),
        "viapoints": Port(parse_message),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        if self.input("viapoints"):
            raise MissingInputError("viapoints: not available; plan through poses")
        start = self.input("start")
        use_start = self.input("use_start")
        goal = self.new_goal(
            goal=self.needed("goal"), planner_id=self.input("planner_id") or ""
        )
        if start is not None and use_start is not False:
            goal.start, goal.use_start = start, True
        return goal

    def succeeded(self, message: Any) -> None:
        super().succeeded(message)
        self.output("path", message.path)

    def failed(self, result: CallResult) -> None:
        super().failed(result)
        self.output("path", Path())


class ComputePathThroughPosesNode(ComputePathToPoseNode):
    """Plan a path through several goals."""

    ACTION, SERVER = "ComputePathThroughPoses", "compute_path_through_poses"
    PORTS: ClassVar[Ports] = {
        "goals": Port(parse_message, required=True),
        "start": Port(parse_message),
        "planner_id": Port(default=""),
        "path": output_port(),
        "last_reached_index": output_port(),
        **SERVER_PORTS,
    }

    def succeeded(self, message: Any) -> None:
        super().succeeded(message)
        self.output("last_reached_index", len(self.needed("goals")) - 1)

    def goal(self) -> Any:
        start = self.input("start")
        goal = self.new_goal(
            goals=list(self.needed("goals")), planner_id=self.input("planner_id") or ""
        )
        if start is not None:
            goal.start, goal.use_start = start, True
        return goal


class FollowPathNode(ActionLeaf):
    """Follow a path; a path that changes replaces the one that is followed."""

    ACTION, SERVER = "FollowPath", "follow_path"
    PORTS: ClassVar[Ports] = {
        "path": Port(parse_message, required=True),
        "controller_id": Port(default=""),
        "goal_checker_id": Port(default=""),
        "progress_checker_id": Port(default=""),
        "path_handler_id": Port(default=""),
        "tracking_feedback": output_port(),
        **SERVER_PORTS,
    }

    def update(self) -> Status:
        status = super().update()
        path, pose = self.input("path"), self.robot.pose()
        if status is RUNNING and path is not None and path.poses and pose is not None:
            self.output("tracking_feedback", tracking_error(path, pose))
        return status

    def goal(self) -> Any:
        self._sent = self._fields()
        return self.new_goal(**self._sent)

    def needs_restart(self) -> bool:
        now = self._fields()
        path, before = now["path"], self._sent["path"]
        new_path = path is not before and bool(path.poses) and path != before
        return new_path or any(
            now[key] != self._sent[key] for key in now if key != "path"
        )

    def _fields(self) -> dict[str, Any]:
        ids = ("controller_id", "goal_checker_id", "progress_checker_id")
        fields = {name: self.input(name) or "" for name in ids}
        return {"path": self.needed("path"), **fields}


class SmoothPathNode(ActionLeaf):
    """Smooth a path."""

    ACTION, SERVER = "SmoothPath", "smooth_path"
    PORTS: ClassVar[Ports] = {
        "unsmoothed_path": Port(parse_message, required=True),
        "max_smoothing_duration": Port(parse_float, "3.0"),
        "check_for_collisions": Port(parse_bool, "false"),
        "smoother_id": Port(default=""),
        "smoothed_path": output_port(),
        "smoothing_duration": output_port(),
        "was_completed": output_port(),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(
            path=self.needed("unsmoothed_path"),
            max_smoothing_duration=_duration(self.input("max_smoothing_duration")),
            check_for_collisions=self.input("check_for_collisions"),
            smoother_id=self.input("smoother_id") or "",
        )

    def succeeded(self, message: Any) -> None:
        super().succeeded(message)
        self.output("smoothed_path", message.path)
        took = message.smoothing_duration
        self.output("smoothing_duration", took.sec + took.nanosec / 1e9)
        self.output("was_completed", message.was_completed)


class SpinNode(ActionLeaf):
    """Turn in place."""

    ACTION, SERVER, IS_RECOVERY = "Spin", "spin", True
    PORTS: ClassVar[Ports] = {
        "spin_dist": Port(parse_float, "1.57"),
        "is_recovery": Port(parse_bool, "true"),
        **_MOTION,
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(
            target_yaw=self.input("spin_dist"),
            time_allowance=_duration(self.input("time_allowance")),
        )

    def counts(self) -> bool:
        return bool(self.input("is_recovery"))


class BackUpNode(ActionLeaf):
    """Drive straight backwards."""

    ACTION, SERVER, IS_RECOVERY = "BackUp", "backup", True
    PORTS: ClassVar[Ports] = {
        "backup_dist": Port(parse_float, "0.15"),
        "backup_speed": Port(parse_float, "0.025"),
        **_MOTION,
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(
            target=Point(x=self.input("backup_dist")),
            speed=self.input("backup_speed"),
            time_allowance=_duration(self.input("time_allowance")),
        )


class DriveOnHeadingNode(ActionLeaf):
    """Drive straight ahead."""

    ACTION, SERVER = "DriveOnHeading", "drive_on_heading"
    PORTS: ClassVar[Ports] = {
        "dist_to_travel": Port(parse_float, "0.15"),
        "speed": Port(parse_float, "0.025"),
        **_MOTION,
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(
            target=Point(x=self.input("dist_to_travel")),
            speed=self.input("speed"),
            time_allowance=_duration(self.input("time_allowance")),
        )


class WaitNode(ActionLeaf):
    """Stand for a time."""

    ACTION, SERVER, IS_RECOVERY = "Wait", "wait", True
    PORTS: ClassVar[Ports] = {
        "wait_duration": Port(parse_float, "1.0"),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(time=_duration(abs(self.input("wait_duration"))))


class AssistedTeleopNode(ActionLeaf):
    """Let an operator drive, with collision checks."""

    ACTION, SERVER, IS_RECOVERY = "AssistedTeleop", "assisted_teleop", True
    PORTS: ClassVar[Ports] = {
        "is_recovery": Port(parse_bool, "false"),
        **_TIME_ALLOWANCE,
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(time_allowance=_duration(self.input("time_allowance")))

    def counts(self) -> bool:
        return bool(self.input("is_recovery"))


class NavigateToPoseNode(ActionLeaf):
    """Send a goal to a navigator, such as that of another robot."""

    ACTION, SERVER = "NavigateToPose", "navigate_to_pose"
    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, required=True),
        "behavior_tree": Port(default=""),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(
            pose=self.needed("goal"), behavior_tree=self.input("behavior_tree") or ""
        )


class NavigateThroughPosesNode(ActionLeaf):
    """Send goals to a navigator, such as that of another robot."""

    ACTION, SERVER = "NavigateThroughPoses", "navigate_through_poses"
    PORTS: ClassVar[Ports] = {
        "goals": Port(parse_message, required=True),
        "behavior_tree": Port(default=""),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        return self.new_goal(
            poses=list(self.needed("goals")),
            behavior_tree=self.input("behavior_tree") or "",
        )


def _duration(seconds: float) -> Duration:
    whole = math.floor(seconds)
    return Duration(sec=whole, nanosec=round((seconds - whole) * 1e9) % 1_000_000_000)
