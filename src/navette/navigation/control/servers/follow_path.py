"""Nav2's controller server: the action follow_path."""

from typing import Any

import numpy as np

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.msgs.classes import get_message_class
from navette.msgs.nav2_msgs.action import FollowPath
from navette.navigation.control.follow_monitor import FollowMonitor
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.records import FollowerInputs, FollowerOutput
from navette.navigation.control.servers.control_host import ControlHost
from navette.navigation.control.states import ControlState
from navette.runtime.input_check import FARTHEST
from navette.runtime.node import Node
from navette.runtime.stage.goal_server import (
    Activation,
    DriveGoalServer,
    GoalEnd,
    GoalStepper,
    goal_end,
)
from navette.runtime.stage.path_messages import moved, poses_of
from navette.runtime.time import ns_to_stamp

# Names of Nav2's default parameters; the empty name selects the only one.
_CONTROLLERS = ("", "FollowPath", *CONTROLLERS)
_GOAL_CHECKERS = ("", "general_goal_checker", "goal_checker")
_PROGRESS_CHECKERS = ("", "progress_checker")


class FollowPathServer(GoalStepper):
    """Follows the path of a goal with the follower of the control node.

    :meth:`step` is called after each step of the follower.
    """

    def __init__(
        self, node: Node, *, host: ControlHost, activation: Activation
    ) -> None:
        self._node = node
        self._host = host
        self._goals = DriveGoalServer(
            node, FollowPath, "follow_path", owner=self, activation=activation
        )
        self._monitor: FollowMonitor | None = None
        self._stepped_ns = 0

    @property
    def is_active(self) -> bool:
        """Whether a goal commands the follower."""
        return self._goals.is_active

    def step_paused(self) -> None:
        """Leave the time of a step out: the commands do not reach the wheels."""
        if self._monitor is None or not self._goals.is_active:
            return
        now_ns = self._now_ns
        self._monitor.pause(now_ns - self._stepped_ns)
        self._stepped_ns = now_ns
        if self._goals.cancel_requested:
            self._end(goal_end(FollowPath, reason="cancelled"))
        self._goals.check_rest(None, now_ns)

    def step(
        self, output: FollowerOutput, inputs: FollowerInputs, *, fresh: bool
    ) -> None:
        """Publish feedback; end the goal if it is reached, failed or cancelled.

        Args:
            output: the follower's newest output.
            inputs: from which it was computed.
            fresh: whether the pose and motion in them are recent.
        """
        if self._monitor is None or not self._goals.is_active:
            return
        self._stepped_ns = now_ns = self._now_ns
        if not self._goals.is_ending:
            self._goals.publish_feedback(**self._progress(output))
            self._decide(self._monitor, output.state, inputs.pose if fresh else None)
        motion = (inputs.speed, inputs.turn_rate) if fresh else None
        self._goals.check_rest(motion, now_ns)

    def _progress(self, output: FollowerOutput) -> dict[str, Any]:
        """Return the fields of the feedback, which are one message since Lyrical."""
        left_m, speed = output.distance_left_m, abs(output.command.speed)
        fields: dict[str, Any] = {"distance_to_goal": left_m, "speed": speed}
        if "tracking_feedback" in FollowPath.Feedback.get_fields_and_field_types():
            kind: Any = get_message_class("nav2_msgs/msg/TrackingFeedback")
            feedback = kind(**fields, remaining_path_length=left_m)
            feedback.header.stamp = ns_to_stamp(self._now_ns)
            feedback.header.frame_id = self._host.params.map_frame
            return {"tracking_feedback": feedback}
        return fields

    def interrupt(self, reason: str) -> None:
        """Abort the goal at once: something else commands the follower."""
        self._goals.abort(goal_end(FollowPath, "UNKNOWN", reason))

    def stop(self, reason: str) -> None:
        """Stop the robot and abort the goal when it is at rest."""
        if self._goals.is_active:
            self._end(goal_end(FollowPath, "UNKNOWN", reason))

    def _decide(
        self, monitor: FollowMonitor, state: ControlState, pose: Pose2 | None
    ) -> None:
        if self._goals.cancel_requested:
            self._end(goal_end(FollowPath, reason="cancelled"))
        elif state is ControlState.REACHED:
            self._end(goal_end(FollowPath))
        elif state is ControlState.MISSED_GOAL:
            text = "the path ended farther from its end than goal_tolerance_m"
            self._fail("FAILED_TO_MAKE_PROGRESS", text)
        else:
            failure = monitor.check(state, pose, self._now_ns)
            if failure is not None:
                self._fail(*failure)

    def on_goal(self, request: Any) -> None:
        self._stepped_ns = self._now_ns
        self._monitor = FollowMonitor(self._host.params, self._stepped_ns)
        unknown = _unknown_plugin(request)
        if unknown is not None:
            self._fail(*unknown)
            return
        frame_id = request.path.header.frame_id or self._host.params.map_frame
        map_T_frame = self._host.frame_on_map(frame_id)
        if map_T_frame is None:
            text = f"path in unknown frame {frame_id!r}; expected a frame on /tf"
            self._fail("TF_ERROR", text)
            return
        poses = poses_of(request.path)
        if len(poses) == 0 or not (np.abs(poses) <= FARTHEST).all():
            self._fail("INVALID_PATH", "the path is empty or not finite")
            return
        method = request.controller_id
        if method not in CONTROLLERS:
            method = ""
        try:
            self._host.follow_goal(moved(poses, map_T_frame), method)
        except InvalidValueError as error:
            self._fail("INVALID_PATH", str(error))

    def _fail(self, code: str, reason: str) -> None:
        self._node.get_logger().warning(f"follow_path: {code}: {reason}")
        self._end(goal_end(FollowPath, code, reason))

    def _end(self, end: GoalEnd) -> None:
        """Stop the robot; the result follows when it is at rest."""
        has_moved = self._host.stop_goal()
        self._goals.end_at_rest(end, self._now_ns, has_moved=has_moved)

    @property
    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds


def _unknown_plugin(goal: Any) -> tuple[str, str] | None:
    """Return error code and reason if the goal names an unknown plugin."""
    for field, known, code in (
        ("controller_id", _CONTROLLERS, "INVALID_CONTROLLER"),
        ("goal_checker_id", _GOAL_CHECKERS, "UNKNOWN"),
        ("progress_checker_id", _PROGRESS_CHECKERS, "UNKNOWN"),
    ):
        name = getattr(goal, field, "")  # not every distribution has each
        if name not in known:
            return code, f"{field} {name!r}: unknown; known: {', '.join(known[1:])}"
    return None
