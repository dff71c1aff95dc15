"""Leaves that act: Nav2's action and service clients, and Navette's own."""

import math
from typing import Any, ClassVar

from py_trees.common import Status

from navette.geometry import quaternion_from_yaw
from navette.msgs.builtin_interfaces.msg import Duration
from navette.msgs.geometry_msgs.msg import Point, PoseStamped, Quaternion
from navette.msgs.nav_msgs.msg import Path
from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    SUCCESS,
    LeafNode,
    NodeSetup,
    Ports,
)
from navette.navigation.missions.tree.calls import (
    SERVER_PORTS,
    ActionLeaf,
    CallLeaf,
    MissingInputError,
    ServiceLeaf,
)
from navette.navigation.missions.tree.interfaces import interface
from navette.navigation.missions.tree.paths import (
    around,
    truncated,
    without_passed,
)
from navette.navigation.missions.tree.ports import (
    Port,
    output_port,
    parse_bool,
    parse_float,
    parse_int,
    parse_message,
    parse_milliseconds,
)
from navette.navigation.missions.tree.robot_access import CallResult, ServerCall

_TIME_ALLOWANCE: Ports = {"time_allowance": Port(parse_float, "10.0")}


class ComputePathToPoseNode(ActionLeaf):
    """Plan a path to the goal."""

    ACTION, SERVER = "ComputePathToPose", "compute_path_to_pose"
    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, required=True),
        "start": Port(parse_message),
        "use_start": Port(parse_bool),
        "planner_id": Port(default=""),
        "path": output_port(),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
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
        **SERVER_PORTS,
    }

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
        **SERVER_PORTS,
    }

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
        **_TIME_ALLOWANCE,
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
        **_TIME_ALLOWANCE,
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
        **_TIME_ALLOWANCE,
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


class ClearEntireCostmapNode(ServiceLeaf):
    """Clear a costmap."""

    TYPE, IS_RECOVERY = "nav2_msgs/srv/ClearEntireCostmap", True


class ClearCostmapExceptRegionNode(ServiceLeaf):
    """Clear a costmap except around the robot."""

    TYPE, IS_RECOVERY = "nav2_msgs/srv/ClearCostmapExceptRegion", True
    PORTS: ClassVar[Ports] = {
        "reset_distance": Port(parse_float, "1.0"),
        **ServiceLeaf.PORTS,
    }

    def request(self) -> Any:
        kind = interface(self.TYPE)
        return kind.Request(reset_distance=self.input("reset_distance"))


class ClearCostmapAroundRobotNode(ClearCostmapExceptRegionNode):
    """Clear a costmap around the robot."""

    TYPE = "nav2_msgs/srv/ClearCostmapAroundRobot"


class ClearCostmapAroundPoseNode(ServiceLeaf):
    """Clear a costmap around a pose."""

    TYPE, IS_RECOVERY = "nav2_msgs/srv/ClearCostmapAroundPose", True
    PORTS: ClassVar[Ports] = {
        "pose": Port(parse_message, required=True),
        "reset_distance": Port(parse_float, "1.0"),
        **ServiceLeaf.PORTS,
    }

    def request(self) -> Any:
        return interface(self.TYPE).Request(
            pose=self.needed("pose"), reset_distance=self.input("reset_distance")
        )


class ReinitializeGlobalLocalizationNode(ServiceLeaf):
    """Distribute the localization's particles over the map."""

    TYPE = "std_srvs/srv/Empty"
    PORTS: ClassVar[Ports] = {
        "service_name": Port(default="reinitialize_global_localization"),
        "server_timeout": Port(parse_milliseconds),
    }


class CancelNode(CallLeaf):
    """Cancel the goals of a server."""

    ACTION: ClassVar[str]
    SERVER: ClassVar[str]
    PORTS: ClassVar[Ports] = {
        "server_name": Port(),
        "server_timeout": Port(parse_milliseconds),
    }

    def start(self) -> ServerCall:
        name = self.input("server_name") or self.SERVER
        return self.robot.cancel_all(f"nav2_msgs/action/{self.ACTION}", name)


class CancelControlNode(CancelNode):
    """Stop following a path."""

    ACTION, SERVER = "FollowPath", "follow_path"


class CancelBackUpNode(CancelNode):
    """Stop backing up."""

    ACTION, SERVER = "BackUp", "backup"


class CancelDriveOnHeadingNode(CancelNode):
    """Stop driving on a heading."""

    ACTION, SERVER = "DriveOnHeading", "drive_on_heading"


class CancelSpinNode(CancelNode):
    """Stop turning."""

    ACTION, SERVER = "Spin", "spin"


class CancelAssistedTeleopNode(CancelNode):
    """End the operator's driving."""

    ACTION, SERVER = "AssistedTeleop", "assisted_teleop"


class CancelWaitNode(CancelNode):
    """Stop waiting."""

    ACTION, SERVER = "Wait", "wait"


class RemovePassedGoalsNode(LeafNode):
    """Remove the first goals that the robot has passed."""

    PORTS: ClassVar[Ports] = {
        "radius": Port(parse_float, "0.5"),
        "global_frame": Port(),
        "robot_base_frame": Port(),
        "input_goals": Port(parse_message, required=True),
        "output_goals": output_port(),
    }

    def update(self) -> Status:
        pose, goals = self.robot.pose(), self.input("input_goals")
        if pose is None or goals is None:
            return FAILURE
        self.output("output_goals", without_passed(goals, pose, self.input("radius")))
        return SUCCESS


class TruncatePathNode(LeafNode):
    """Remove the end of a path."""

    PORTS: ClassVar[Ports] = {
        "input_path": Port(parse_message, required=True),
        "output_path": output_port(),
        "distance": Port(parse_float, "1.0"),
    }

    def update(self) -> Status:
        path = self.input("input_path")
        if path is None:
            return FAILURE
        self.output("output_path", truncated(path, self.input("distance")))
        return SUCCESS


class TruncatePathLocalNode(LeafNode):
    """Keep the part of a path around the robot."""

    PORTS: ClassVar[Ports] = {
        "input_path": Port(parse_message, required=True),
        "output_path": output_port(),
        "distance_forward": Port(parse_float, "8.0"),
        "distance_backward": Port(parse_float, "4.0"),
        "robot_frame": Port(default="base_link"),
        "transform_tolerance": Port(parse_float, "0.2"),
        "pose": Port(parse_message),
        "angular_distance_weight": Port(parse_float, "0.0"),
        "max_robot_pose_search_dist": Port(parse_float, "inf"),
    }

    def update(self) -> Status:
        path, pose = self.input("input_path"), self.robot.pose()
        if path is None or pose is None:
            return FAILURE
        ahead, behind = self.input("distance_forward"), self.input("distance_backward")
        self.output("output_path", around(path, pose, ahead_m=ahead, behind_m=behind))
        return SUCCESS


class GetPoseFromPathNode(LeafNode):
    """Pick a pose of a path; negative indices count from the end."""

    PORTS: ClassVar[Ports] = {
        "path": Port(parse_message, required=True),
        "index": Port(parse_int, "0"),
        "pose": output_port(),
    }

    def update(self) -> Status:
        path, index = self.input("path"), self.input("index")
        if path is None or not -len(path.poses) <= index < len(path.poses):
            return FAILURE
        pose = path.poses[index].pose
        self.output("pose", PoseStamped(header=path.header, pose=pose))
        return SUCCESS


class GetCurrentPoseNode(LeafNode):
    """Store the robot's pose."""

    PORTS: ClassVar[Ports] = {
        "global_frame": Port(),
        "robot_base_frame": Port(),
        "current_pose": output_port(),
    }

    def update(self) -> Status:
        pose = self.robot.pose()
        if pose is None:
            return FAILURE
        msg = PoseStamped()
        msg.header.frame_id = self.robot.map_frame
        msg.pose.position.x, msg.pose.position.y = pose.x, pose.y
        x, y, z, w = quaternion_from_yaw(pose.yaw)
        msg.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
        self.output("current_pose", msg)
        return SUCCESS


class ConcatenatePathsNode(LeafNode):
    """Join two paths."""

    PORTS: ClassVar[Ports] = {
        "input_path1": Port(parse_message),
        "input_path2": Port(parse_message),
        "output_path": output_port(),
    }

    def update(self) -> Status:
        paths = [self.input("input_path1"), self.input("input_path2")]
        given = [path for path in paths if path is not None and path.poses]
        if not given:
            return FAILURE
        poses = [pose for path in given for pose in path.poses]
        self.output("output_path", Path(header=given[0].header, poses=poses))
        return SUCCESS


class SelectorNode(LeafNode):
    """Choose a plugin by the newest message of a topic."""

    WHAT: ClassVar[str]

    @classmethod
    def ports(cls, what: str) -> Ports:
        return {
            "topic_name": Port(default=f"{what}_selector"),
            f"default_{what}": Port(),
            f"selected_{what}": output_port(),
        }

    def update(self) -> Status:
        newest = self.robot.newest(
            self.input("topic_name"), "std_msgs/msg/String", latched=True
        )
        default = self.input(f"default_{self.WHAT}")
        selected = default if newest is None else newest.data
        if not selected:
            self.feedback_message = f"no default_{self.WHAT}, no message"
            return FAILURE
        self.output(f"selected_{self.WHAT}", selected)
        return SUCCESS


class PlannerSelectorNode(SelectorNode):
    """Choose the planner."""

    WHAT = "planner"
    PORTS: ClassVar[Ports] = SelectorNode.ports(WHAT)


class ControllerSelectorNode(SelectorNode):
    """Choose the controller."""

    WHAT = "controller"
    PORTS: ClassVar[Ports] = SelectorNode.ports(WHAT)


class SmootherSelectorNode(SelectorNode):
    """Choose the smoother."""

    WHAT = "smoother"
    PORTS: ClassVar[Ports] = SelectorNode.ports(WHAT)


class GoalCheckerSelectorNode(SelectorNode):
    """Choose the goal checker."""

    WHAT = "goal_checker"
    PORTS: ClassVar[Ports] = SelectorNode.ports(WHAT)


class ProgressCheckerSelectorNode(SelectorNode):
    """Choose the progress checker."""

    WHAT = "progress_checker"
    PORTS: ClassVar[Ports] = SelectorNode.ports(WHAT)


class NavigateNode(CallLeaf):
    """Navette: drive to the goal by planner and control, which run on their own.

    Fails with a named ``failure`` such as ``stuck`` or ``no_path``.
    """

    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, entry="goal"),
        "failure": Port(parse_message, output=True, entry="failure"),
        "error_code_id": Port(parse_message, output=True, entry="navigate_error_code"),
        "error_msg": Port(parse_message, output=True, entry="navigate_error_msg"),
    }

    def start(self) -> ServerCall:
        self._goal = self.needed("goal")
        return self.robot.navigate(self._goal)

    def needs_restart(self) -> bool:
        goal = self.input("goal")
        return goal is not None and goal is not self._goal

    def succeeded(self, message: Any) -> None:
        self._report("", 0, "")

    def failed(self, result: CallResult) -> None:
        self._report(str(result.message), ERROR_CODES.get(str(result.message), 200),
                     result.reason)  # fmt: skip

    def _report(self, failure: str, code: int, text: str) -> None:
        self.output("failure", failure)
        self.output("error_code_id", code)
        self.output("error_msg", text)


class BackUpAlongPathNode(ActionLeaf):
    """Navette: drive back along the path that the robot came."""

    ACTION, SERVER, IS_RECOVERY = "FollowPath", "follow_path", True
    PORTS: ClassVar[Ports] = {
        "distance": Port(parse_float, "0.5"),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        path = self.robot.driven_path(self.input("distance"))
        if path is None:
            raise MissingInputError("no driven path: the robot has not moved yet")
        return self.new_goal(path=path)


class AvoidPlaceNode(ServiceLeaf):
    """Navette: plan around the place where the robot got stuck; fail without one."""

    TYPE, IS_RECOVERY = "std_srvs/srv/Trigger", True
    PORTS: ClassVar[Ports] = {
        "service_name": Port(default="/planner/avoid_place"),
        "server_timeout": Port(parse_milliseconds),
    }

    def update(self) -> Status:
        status = super().update()
        if status is not SUCCESS or self._call is None or self._call.result is None:
            return status
        self.feedback_message = self._call.result.message.message
        return SUCCESS if self._call.result.message.success else FAILURE


class SetBlackboardNode(LeafNode):
    """Write a blackboard entry."""

    PORTS: ClassVar[Ports] = {
        "value": Port(required=True),
        "output_key": Port(required=True),
    }

    def __init__(self, setup: NodeSetup) -> None:
        super().__init__(setup)
        self._key = setup.attributes["output_key"].strip("{} ")

    def update(self) -> Status:
        self.blackboard.set(self._key, self.input("value"))
        return SUCCESS


class UnsetBlackboardNode(LeafNode):
    """Remove a blackboard entry."""

    PORTS: ClassVar[Ports] = {"key": Port(required=True)}

    def update(self) -> Status:
        self.blackboard.unset(str(self._attributes["key"]).strip("{} "))
        return SUCCESS


class AlwaysSuccessNode(LeafNode):
    """Succeed."""

    def update(self) -> Status:
        return SUCCESS


class AlwaysFailureNode(LeafNode):
    """Fail."""

    def update(self) -> Status:
        return FAILURE


class SleepNode(LeafNode):
    """Run for a time, then succeed; the robot is not stopped by it."""

    PORTS: ClassVar[Ports] = {"msec": Port(parse_int, required=True)}

    def initialise(self) -> None:
        super().initialise()
        self._start_ns = self.robot.now_ns

    def update(self) -> Status:
        passed = self.seconds_since(self._start_ns) * 1000 >= self.input("msec")
        return SUCCESS if passed else Status.RUNNING


def _duration(seconds: float) -> Duration:
    whole = math.floor(seconds)
    return Duration(sec=whole, nanosec=round((seconds - whole) * 1e9) % 1_000_000_000)


ERROR_CODES = {
    "unknown_frame": 202,
    "start_outside_map": 203,
    "goal_outside_map": 204,
    "start_blocked": 205,
    "goal_blocked": 206,
    "search_limit": 207,
    "no_path": 208,
    "goal_not_finite": 200,
    "stale_odometry": 102,
    "stuck": 105,
    "timed_out": 107,
}
"""Nav2's codes (ComputePathToPose, FollowPath) of the planner's failures."""
