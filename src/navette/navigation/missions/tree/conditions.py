"""Conditions: Nav2's, and Navette's FailureIs."""

import math
from collections.abc import Sequence
from typing import Any, ClassVar

from py_trees.common import Status

from navette.geometry import Pose2, angle_difference, yaw_of
from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    RUNNING,
    SUCCESS,
    LeafNode,
    NodeSetup,
    Ports,
    to_status,
)
from navette.navigation.missions.tree.decorators import GoalWatch, moved_m
from navette.navigation.missions.tree.interfaces import action_interface, interface
from navette.navigation.missions.tree.paths import point_of
from navette.navigation.missions.tree.ports import (
    Port,
    output_port,
    parse_absent,
    parse_bool,
    parse_float,
    parse_ints,
    parse_message,
    parse_milliseconds,
    parse_texts,
)
from navette.navigation.missions.tree.robot_access import SUCCEEDED, ServerCall

_FRAMES: Ports = {"global_frame": Port(), "robot_base_frame": Port()}
_STUCK_DECELERATION_MPS2 = -10.0


class GoalReachedNode(LeafNode):
    """Whether the robot is within ``goal_reached_tol`` (m) of the goal."""

    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, entry="goal"),
        **_FRAMES,
    }

    def update(self) -> Status:
        pose, goal = self.robot.pose(), self.input("goal")
        if pose is None or goal is None:
            return FAILURE
        near: float = self.blackboard.get("@goal_reached_tol", 0.25)
        return to_status(math.dist(point_of(goal), (pose.x, pose.y)) <= near)


class PoseReachedNode(LeafNode):
    """Navette: whether position and heading are within tolerances (m, rad) of a goal.

    A goal with an orientation of zeros has any heading.
    """

    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, entry="goal"),
        "tolerance": Port(parse_float, "0.05"),
        "yaw_tolerance": Port(parse_float, "0.1"),
    }

    def update(self) -> Status:
        pose, goal = self.robot.pose(), self.input("goal")
        if pose is None or goal is None:
            return FAILURE
        off_m = math.dist(point_of(goal), (pose.x, pose.y))
        q = goal.pose.orientation
        quaternion = (q.x, q.y, q.z, q.w)
        yaw = yaw_of(quaternion) if any(quaternion) else pose.yaw
        off_rad = abs(angle_difference(yaw, pose.yaw))
        self.feedback_message = f"{off_m:.3f} m, {off_rad:.3f} rad off"
        near = off_m <= self.input("tolerance")
        return to_status(near and off_rad <= self.input("yaw_tolerance"))


class IsStuckNode(LeafNode):
    """Whether the robot bumped into something: a very large deceleration."""

    _before: tuple[float, int] | None = None

    def update(self) -> Status:
        now = self.robot.velocity()[0], self.robot.now_ns
        before, self._before = self._before, now
        if before is None or now[1] <= before[1]:
            return FAILURE
        acceleration = (abs(now[0]) - abs(before[0])) / ((now[1] - before[1]) / 1e9)
        return to_status(acceleration < _STUCK_DECELERATION_MPS2)


class TransformAvailableNode(LeafNode):
    """Whether a transform exists; once found, always."""

    PORTS: ClassVar[Ports] = {
        "child": Port(required=True),
        "parent": Port(required=True),
    }
    _found = False

    def update(self) -> Status:
        self._found = self._found or self.robot.has_transform(
            self.input("parent"), self.input("child")
        )
        return to_status(self._found)


class GoalUpdatedNode(LeafNode):
    """Whether the goal changed since the last tick."""

    PORTS: ClassVar[Ports] = GoalWatch.PORTS
    _goals: GoalWatch | None = None

    def begin(self) -> None:
        self._goals = None

    def update(self) -> Status:
        if self._goals is None:
            self._goals = GoalWatch(self)
            return FAILURE
        return to_status(self._goals.changed())


class GlobalUpdatedGoalNode(GoalUpdatedNode):
    """Whether the goal changed since the last tick, also of an earlier run.

    The first tick of the tree succeeds.
    """

    def begin(self) -> None:
        """Keep the goal of the last run."""

    def update(self) -> Status:
        if self._goals is None:
            super().update()
            return SUCCESS
        return super().update()


class IsBatteryLowNode(LeafNode):
    """Whether the battery's percentage (0 to 1) or voltage is low."""

    PORTS: ClassVar[Ports] = {
        "min_battery": Port(parse_float, required=True),
        "battery_topic": Port(default="/battery_status"),
        "is_voltage": Port(parse_bool, "false"),
    }

    def update(self) -> Status:
        state = self.robot.newest(
            self.input("battery_topic"), "sensor_msgs/msg/BatteryState"
        )
        if state is None:
            return FAILURE
        value = state.voltage if self.input("is_voltage") else state.percentage
        return to_status(value <= self.input("min_battery"))


class IsBatteryChargingNode(LeafNode):
    """Whether the battery is charged."""

    PORTS: ClassVar[Ports] = {"battery_topic": Port(default="/battery_status")}

    def update(self) -> Status:
        state = self.robot.newest(
            self.input("battery_topic"), "sensor_msgs/msg/BatteryState"
        )
        if state is None:
            return FAILURE
        charging = state.POWER_SUPPLY_STATUS_CHARGING
        return to_status(state.power_supply_status == charging)


class IsPathValidNode(LeafNode):
    """Whether the service ``is_path_valid`` finds no obstacle on the path."""

    PORTS: ClassVar[Ports] = {
        "path": Port(parse_message, required=True),
        "service_name": Port(default="is_path_valid"),
        "server_timeout": Port(parse_milliseconds),
        "max_cost": Port(),
        "consider_cost_change": Port(),
        "consider_unknown_as_obstacle": Port(parse_absent, "false"),
    }
    _call: ServerCall | None = None

    def update(self) -> Status:
        path = self.input("path")
        if path is None:
            return FAILURE
        if self.status is not RUNNING or self._call is None:
            kind = "nav2_msgs/srv/IsPathValid"
            request = interface(kind).Request(path=path)
            name = self.input("service_name")
            self._call = self.robot.call_service(kind, name, request)
        result = self._call.result
        if result is None:
            return RUNNING
        if result.how != SUCCEEDED:
            self.feedback_message = result.reason
            return FAILURE
        self.found(path, result.message.invalid_pose_indices)
        return to_status(result.message.is_valid)

    def found(self, path: Any, colliding: Sequence[int]) -> None:
        """Override to write outputs."""


class ValidatePathNode(IsPathValidNode):
    """Lyrical's name of IsPathValid, with the poses that collide."""

    PORTS: ClassVar[Ports] = {
        **IsPathValidNode.PORTS,
        "layer_name": Port(),
        "footprint": Port(),
        "stop_at_first_collision": Port(parse_bool, "true"),
        "max_lookahead_distance": Port(parse_float, "-1.0"),
        "collision_poses": output_port(),
    }

    def found(self, path: Any, colliding: Sequence[int]) -> None:
        poses = [path.poses[index] for index in colliding]
        self.output("collision_poses", poses)


class DistanceTraveledNode(LeafNode):
    """Whether the robot has moved by a distance since the last success."""

    PORTS: ClassVar[Ports] = {"distance": Port(parse_float, "1.0"), **_FRAMES}
    _from: Pose2 | None = None

    def begin(self) -> None:
        self._from = self.robot.pose()

    def update(self) -> Status:
        pose = self.robot.pose()
        if moved_m(self._from, pose) < self.input("distance"):
            return FAILURE
        self._from = pose
        return SUCCESS


class TimeExpiredNode(LeafNode):
    """Whether a time has passed since the last success."""

    PORTS: ClassVar[Ports] = {"seconds": Port(parse_float, "1.0")}

    def begin(self) -> None:
        self._start_ns = self.robot.now_ns

    def update(self) -> Status:
        if self.seconds_since(self._start_ns) < self.input("seconds"):
            return FAILURE
        self._start_ns = self.robot.now_ns
        return SUCCESS


class PathExpiringTimerNode(LeafNode):
    """Whether a path has not changed for a time."""

    PORTS: ClassVar[Ports] = {
        "seconds": Port(parse_float, "1.0"),
        "path": Port(parse_message, required=True),
    }
    _start_ns: int | None = None
    _path: Any = None

    def update(self) -> Status:
        path = self.input("path")
        if self._start_ns is None or (path is not self._path and path != self._path):
            self._start_ns, self._path = self.robot.now_ns, path
        if self.seconds_since(self._start_ns) < self.input("seconds"):
            return FAILURE
        self._start_ns = self.robot.now_ns
        return SUCCESS


class InitialPoseReceivedNode(LeafNode):
    """Whether an initial pose has been given, or the pose is known."""

    PORTS: ClassVar[Ports] = {
        "initial_pose_received": Port(parse_bool, entry="initial_pose_received")
    }

    def update(self) -> Status:
        return to_status(self.input("initial_pose_received"))


class AreErrorCodesPresentNode(LeafNode):
    """Whether an error code is one of a list."""

    PORTS: ClassVar[Ports] = {
        "error_code": Port(parse_ints, required=True),
        "error_codes_to_check": Port(parse_ints, required=True),
    }

    def update(self) -> Status:
        code = self.input("error_code")
        codes = self.codes()
        return to_status((code[0] if isinstance(code, tuple) else code) in codes)

    def codes(self) -> tuple[int, ...]:
        return self.input("error_codes_to_check") or ()


class _WouldHelpNode(AreErrorCodesPresentNode):
    """Whether the error is one that a recovery may end."""

    PORTS: ClassVar[Ports] = {
        "error_code": Port(parse_ints, required=True),
        "error_codes_to_check": Port(parse_ints),
    }
    ACTIONS: ClassVar[tuple[str, ...]]
    HELPED: ClassVar[tuple[str, ...]]

    def __init__(self, setup: NodeSetup) -> None:
        super().__init__(setup)
        results = [action_interface(a).Result for a in self.ACTIONS]
        self._codes = tuple(getattr(r, name) for r in results for name in self.HELPED)

    def codes(self) -> tuple[int, ...]:
        return self._codes


class WouldAControllerRecoveryHelpNode(_WouldHelpNode):
    """Whether the controller's error is one that a recovery may end."""

    ACTIONS = ("FollowPath",)
    HELPED = (
        "UNKNOWN",
        "PATIENCE_EXCEEDED",
        "FAILED_TO_MAKE_PROGRESS",
        "NO_VALID_CONTROL",
    )


class WouldAPlannerRecoveryHelpNode(_WouldHelpNode):
    """Whether the planner's error is one that a recovery may end."""

    ACTIONS = ("ComputePathToPose", "ComputePathThroughPoses")
    HELPED = ("UNKNOWN", "NO_VALID_PATH", "TIMEOUT")


class WouldASmootherRecoveryHelpNode(_WouldHelpNode):
    """Whether the smoother's error is one that a recovery may end."""

    ACTIONS = ("SmoothPath",)
    HELPED = (
        "UNKNOWN",
        "TIMEOUT",
        "FAILED_TO_SMOOTH_PATH",
        "SMOOTHED_PATH_IN_COLLISION",
    )


class ArePosesNearNode(LeafNode):
    """Whether two poses of the same frame are near each other."""

    PORTS: ClassVar[Ports] = {
        "ref_pose": Port(parse_message, required=True),
        "target_pose": Port(parse_message, required=True),
        "global_frame": Port(),
        "tolerance": Port(parse_float, "0.5"),
    }

    def update(self) -> Status:
        a, b = self.input("ref_pose"), self.input("target_pose")
        if a is None or b is None or a.header.frame_id != b.header.frame_id:
            return FAILURE
        return to_status(math.dist(point_of(a), point_of(b)) <= self.input("tolerance"))


class FailureIsNode(LeafNode):
    """Whether Navigate failed in one of the named ways."""

    PORTS: ClassVar[Ports] = {
        "failure": Port(entry="failure"),
        "any_of": Port(parse_texts, required=True),
    }

    def update(self) -> Status:
        failure = self.input("failure") or ""
        self.feedback_message = failure
        return to_status(failure in self.input("any_of"))
