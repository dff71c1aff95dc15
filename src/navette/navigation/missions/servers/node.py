"""The actions ``navigate_to_pose``, ``navigate_through_poses``, ``follow_waypoints``.

Names, types, feedback and results are those of Nav2's bt_navigator and
waypoint_follower. The newest goal of any of them replaces the one under way, which ends
as aborted.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.builtin_interfaces.msg import Duration
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.known_fields import fill
from navette.msgs.nav2_msgs.action import (
    FollowWaypoints,
    NavigateThroughPoses,
    NavigateToPose,
)
from navette.msgs.std_msgs.msg import Header
from navette.msgs.unique_identifier_msgs.msg import UUID
from navette.navigation.missions.navigation import (
    PREEMPTED_TEXT,
    Navigation,
    NavigationEnd,
    NavigationProgress,
    TreeNavigator,
)
from navette.navigation.missions.params import MissionParams, tree_path
from navette.navigation.missions.robot.node import NodeRobot, stamped
from navette.navigation.missions.sequence import CANCELED, REACHED
from navette.navigation.servers.distributions import add_missed_waypoint, poses_in
from navette.runtime.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
)
from navette.runtime.future import Future
from navette.runtime.stage.goal_server import Activation, response_of
from navette.runtime.stage.stage_node import StageNode
from navette.runtime.time import ns_to_stamp

NO_TREE = "FAILED_TO_LOAD_BEHAVIOR_TREE"
"""Nav2's error code, from Kilted on."""
_NO_TREE_UP_TO_JAZZY = 9002
NO_GOALS = "no poses given; at least one is needed"
_LONGEST_S = 2**31 - 1
_KEPT_ENDS = 16


class NavigationServers:
    """Action servers of a node that feed one :class:`TreeNavigator`."""

    def __init__(
        self,
        node: StageNode,
        robot: NodeRobot,
        navigator: TreeNavigator,
        *,
        activation: Activation,
    ) -> None:
        self._node, self._robot, self._navigator = node, robot, navigator
        self._running: dict[bytes, tuple[Any, Navigation]] = {}  # with its handle
        self._waypoints: dict[bytes, Any] = {}  # their goal under way
        self._newest_waypoints = b""
        self._ends: dict[bytes, NavigationEnd] = {}
        self._servers = [
            ActionServer(
                node,
                action,
                name,
                execute_callback=execute,
                cancel_callback=cancel,
                goal_callback=lambda goal: response_of(activation),
            )
            for action, name, execute, cancel in (
                (NavigateToPose, "navigate_to_pose", self._to_pose, self._on_cancel),
                (
                    NavigateThroughPoses,
                    "navigate_through_poses",
                    self._through_poses,
                    self._on_cancel,
                ),
                (
                    FollowWaypoints,
                    "follow_waypoints",
                    self._follow_waypoints,
                    self._on_cancel_waypoints,
                ),
            )
        ]
        #: Sends the node's own goals, as Nav2 does with those of ``goal_pose``.
        self.client = ActionClient(node, NavigateToPose, "navigate_to_pose")

    @property
    def _params(self) -> MissionParams:
        params: MissionParams = self._node.params
        return params

    def publish_feedback(self) -> None:
        """Publish feedback on the navigation under way if a program receives it."""
        for handle, navigation in self._running.values():
            if navigation is self._navigator.active and self._is_watched(navigation):
                handle.publish_feedback(
                    _feedback(handle, self._navigator.progress(), self._robot)
                )

    def _is_watched(self, navigation: Navigation) -> bool:
        """Whether a program subscribes to the feedback beside this node's client."""
        to_pose, through_poses = self._servers[:2]
        if navigation.through:
            return through_poses.feedback_subscription_count > 0
        return to_pose.feedback_subscription_count > 1

    def cancel_all(self) -> None:
        """Request the cancellation of every goal."""
        # First the actions that would send their next goal.
        self._robot.cancel_all("nav2_msgs/action/FollowWaypoints", "follow_waypoints")
        through = "nav2_msgs/action/NavigateThroughPoses"
        self._robot.cancel_all(through, "navigate_through_poses")
        self._robot.cancel_all("nav2_msgs/action/NavigateToPose", "navigate_to_pose")

    def take_end(self, goal_id: UUID) -> NavigationEnd | None:
        """Return how a goal of this process ended, once."""
        end = self._ends.pop(bytes(goal_id.uuid), None)
        while len(self._ends) > _KEPT_ENDS:
            self._ends.pop(next(iter(self._ends)))
        return end

    async def _to_pose(self, handle: Any) -> Any:
        goal = handle.request
        result = NavigateToPose.Result()
        tree = self._tree(goal, self._params.to_pose_tree)
        await self._navigate(handle, [goal.pose], tree, result, through=False)
        return result

    async def _through_poses(self, handle: Any) -> Any:
        goal = handle.request
        result = NavigateThroughPoses.Result()
        tree = self._tree(goal, self._params.through_poses_tree)
        poses = poses_in(goal.poses)
        if not poses:
            fill(result, error_msg=NO_GOALS)
            handle.abort()
            return result
        await self._navigate(handle, poses, tree, result, through=True)
        return result

    @staticmethod
    def _tree(goal: Any, default: Path) -> Path:
        return tree_path(goal.behavior_tree) if goal.behavior_tree else default

    async def _navigate(
        self,
        handle: Any,
        goals: Sequence[PoseStamped],
        tree: Path,
        result: Any,
        *,
        through: bool,
    ) -> None:
        """Run a navigation to its end and fill the result."""
        if handle.is_cancel_requested:
            handle.canceled()
            return
        ended: Future[NavigationEnd] = Future()
        navigation = Navigation(goals, tree, on_end=ended.set_result, through=through)
        try:
            self._navigator.start(navigation)
        except FileFormatError as error:
            self._node.get_logger().error(f"goal aborted: {error}")
            code = getattr(result, NO_TREE, _NO_TREE_UP_TO_JAZZY)
            fill(result, error_code=code, error_msg=str(error))
            handle.abort()
            return
        key = bytes(handle.goal_id.uuid)
        self._running[key] = handle, navigation
        self._robot.on_call_end()
        end = await ended
        assert end is not None, "a navigation ends with a result"
        self._ends[key] = end
        del self._running[key]
        fill(result, error_code=end.error_code, error_msg=end.text)
        if end.how == REACHED:
            handle.succeed()
        elif end.how == CANCELED and handle.is_cancel_requested:
            handle.canceled()
        else:
            handle.abort()

    def _on_cancel(self, handle: Any) -> CancelResponse:
        _, navigation = self._running.get(bytes(handle.goal_id.uuid), (None, None))
        if navigation is not None and navigation is self._navigator.active:
            self._navigator.cancel()
        return CancelResponse.ACCEPT

    def _on_cancel_waypoints(self, handle: Any) -> CancelResponse:
        inner = self._waypoints.get(bytes(handle.goal_id.uuid))
        if inner is not None:
            inner.cancel_goal_async()
        return CancelResponse.ACCEPT

    async def _follow_waypoints(self, handle: Any) -> Any:
        result = FollowWaypoints.Result()
        # Before Jazzy, goals have neither loops nor a first waypoint.
        loops = getattr(handle.request, "number_of_loops", 0)
        poses, first = handle.request.poses, getattr(handle.request, "goal_index", 0)
        key = self._newest_waypoints = bytes(handle.goal_id.uuid)
        if not poses[first:]:
            _fail(handle, result, NO_GOALS)
            return result
        for loop in range(loops + 1):
            for index in range(0 if loop else first, len(poses)):
                handle.publish_feedback(
                    FollowWaypoints.Feedback(current_waypoint=index)
                )
                response = await self._drive_to(key, handle, poses[index])
                if handle.is_cancel_requested:
                    handle.canceled()
                    return result
                if response is None or _text_of(response.result) == PREEMPTED_TEXT:
                    _fail(handle, result, PREEMPTED_TEXT)
                    return result
                if response.status != GoalStatus.STATUS_SUCCEEDED:
                    _note_missed(result, index, poses[index], response.result)
                    if self._params.stop_on_failure:
                        handle.abort()
                        return result
        if len(result.missed_waypoints) == len(poses):
            _fail(handle, result, _text_of(result))
            return result
        handle.succeed()
        return result

    async def _drive_to(self, key: bytes, handle: Any, pose: PoseStamped) -> Any:
        """Return the response for one waypoint; None if a newer goal replaces it."""
        if key != self._newest_waypoints:
            return None
        inner = await self.client.send_goal_async(NavigateToPose.Goal(pose=pose))
        assert inner is not None, "the client's future has a result"
        if not inner.accepted:  # navigation is not active any more
            return None
        self._waypoints[key] = inner
        if handle.is_cancel_requested:
            inner.cancel_goal_async()
        try:
            return await inner.get_result_async()
        finally:
            del self._waypoints[key]


def _fail(handle: Any, result: Any, text: str) -> None:
    fill(result, error_code=getattr(result, "UNKNOWN", 0), error_msg=text)
    handle.abort()


def _text_of(result: Any) -> str:
    """Return the error of a result; Humble's have none."""
    return getattr(result, "error_msg", "")


def _note_missed(result: Any, index: int, pose: PoseStamped, of_goal: Any) -> None:
    code, text = getattr(of_goal, "error_code", 0), _text_of(of_goal)
    add_missed_waypoint(result, index, pose, code, text)
    fill(result, error_msg=text)


def _feedback(handle: Any, progress: NavigationProgress, robot: NodeRobot) -> Any:
    """Return the feedback of an action that navigates."""
    through = isinstance(handle.request, NavigateThroughPoses.Goal)
    kind: Any = NavigateThroughPoses.Feedback if through else NavigateToPose.Feedback
    feedback = kind(
        navigation_time=_duration(progress.time_s),
        estimated_time_remaining=_duration(progress.time_left_s),
        number_of_recoveries=progress.recoveries,
        distance_remaining=_bounded(progress.distance_left_m),
    )
    if progress.pose is not None:
        stamp = ns_to_stamp(robot.now_ns)
        header = Header(stamp=stamp, frame_id=robot.map_frame)
        feedback.current_pose = stamped(progress.pose, header)
    if through:
        feedback.number_of_poses_remaining = progress.goals_left
    return feedback


def _duration(seconds: float) -> Duration:
    seconds = _bounded(seconds)
    whole = math.floor(seconds)
    return Duration(sec=whole, nanosec=round((seconds - whole) * 1e9) % 10**9)


def _bounded(value: float) -> float:
    """Return a value for a message; the goal may be at 1e308 m or not a number."""
    return min(max(0.0, value), _LONGEST_S)
