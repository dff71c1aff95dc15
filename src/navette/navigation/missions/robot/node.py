"""The robot's servers, topics and pose, by a node's clients and subscriptions."""

from collections.abc import Callable
from typing import Any

from navette.errors import InvalidInputError
from navette.geometry import Pose2, quaternion_from_yaw
from navette.msgs import get_interface, topics
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.action_msgs.srv import CancelGoal
from navette.msgs.geometry_msgs.msg import PointStamped, PoseStamped, Quaternion
from navette.msgs.nav_msgs.msg import Path
from navette.msgs.std_srvs.srv import Trigger
from navette.navigation.missions.robot.planner_goal import PlannerGoal
from navette.navigation.missions.robot.trail import DrivenTrail
from navette.navigation.missions.sequence import PAUSED, PlannerReport
from navette.navigation.missions.tree.robot_access import (
    ABORTED,
    CANCELED,
    REJECTED,
    SUCCEEDED,
    UNAVAILABLE,
    CallResult,
)
from navette.runtime import DurabilityPolicy, QoSProfile
from navette.runtime.action import ActionClient
from navette.runtime.input_check import input_check
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.path_messages import has_heading
from navette.runtime.stage.stage_node import StageNode
from navette.runtime.tf import TransformException
from navette.runtime.time import ns_to_stamp

_SERVER_WAIT_NS = 2_000_000_000
_REST_MPS, _REST_RADPS = 0.02, 0.05
_HOW = {
    GoalStatus.STATUS_SUCCEEDED: SUCCEEDED,
    GoalStatus.STATUS_CANCELED: CANCELED,
    GoalStatus.STATUS_ABORTED: ABORTED,
}


class _ActionCall:
    """A goal of an action client, from the search for a server to the result."""

    def __init__(self, client: ActionClient, goal: Any, robot: "NodeRobot") -> None:
        self._client, self._goal, self._robot = client, goal, robot
        self._handle: Any = None
        self._sent = self._cancelled = False
        self._seen_ns = robot.now_ns
        self.result: CallResult | None = None
        self.feedback: Any = None
        self.poll()

    def poll(self) -> None:
        """Send the goal once a server exists; give up without one."""
        if self.result is not None:
            return
        if self._client.server_is_ready():
            self._seen_ns = self._robot.now_ns
            if not self._sent:
                self._send()
        elif self._robot.now_ns - self._seen_ns >= _SERVER_WAIT_NS:
            name = self._client.action_name
            self._end(UNAVAILABLE, reason=f"no action server {name}; start its node")

    def cancel(self) -> None:
        self._cancelled = True
        if self._handle is not None:
            self._handle.cancel_goal_async()
        elif not self._sent:
            self._end(CANCELED)

    def _send(self) -> None:
        self._sent = True
        future = self._client.send_goal_async(self._goal, self._on_feedback)
        future.add_done_callback(self._on_response)

    def _on_feedback(self, message: Any) -> None:
        self.feedback = message.feedback

    def _on_response(self, future: Any) -> None:
        if self.result is not None or future.cancelled():
            return
        self._handle = future.result()
        if not self._handle.accepted:
            self._end(REJECTED, reason=f"{self._client.action_name}: goal rejected")
            return
        self._handle.get_result_async().add_done_callback(self._on_result)
        if self._cancelled:
            self._handle.cancel_goal_async()

    def _on_result(self, future: Any) -> None:
        if self.result is not None or future.cancelled():
            return
        response = future.result()
        how = _HOW.get(response.status, UNAVAILABLE)
        text = getattr(response.result, "error_msg", "") or how
        name = self._client.action_name
        reason = "" if how == SUCCEEDED else f"{name}: {text}"
        self._end(how, response.result, reason)

    def _end(self, how: str, message: Any = None, reason: str = "") -> None:
        self.result = CallResult(how, message, reason)
        self._robot.on_call_end()


class _ServiceCall:
    """A request to a service, from the search for a server to the response."""

    feedback = None

    def __init__(self, client: Any, request: Any, robot: "NodeRobot") -> None:
        self._client, self._request, self._robot = client, request, robot
        self._since_ns = robot.now_ns
        self._sent = False
        self.result: CallResult | None = None
        self.poll()

    def poll(self) -> None:
        if self.result is not None:
            return
        if not self._sent and self._client.service_is_ready():
            self._sent = True
            self._client.call_async(self._request).add_done_callback(self._on_response)
        elif self._robot.now_ns - self._since_ns >= _SERVER_WAIT_NS:
            what = "no response of" if self._sent else "no"
            name = self._client.service_name
            self._end(CallResult(UNAVAILABLE, None, f"{what} service {name}"))

    def cancel(self) -> None:
        self._end(CallResult(CANCELED))

    def _on_response(self, future: Any) -> None:
        if self.result is None and not future.cancelled():
            self._end(CallResult(SUCCEEDED, future.result()))

    def _end(self, result: CallResult) -> None:
        self.result = result
        self._robot.on_call_end()


OnCallEnd = Callable[[], None]
"""Called when a call of an action or a service ends, to tick the tree."""


class NodeRobot:
    """:class:`RobotAccess` by the clients of a stage's node.

    Args:
        node: publishes on ``topics.PLANNER_GOAL`` and the other outputs used here.
        tracker: the robot's pose.
    """

    def __init__(
        self, node: StageNode, tracker: PoseTracker, *, on_call_end: OnCallEnd
    ) -> None:
        self._node, self.tracker = node, tracker
        self.on_call_end = on_call_end
        self.trail = DrivenTrail()
        self._calls: list[_ActionCall | _ServiceCall] = []
        self._clients: dict[tuple[str, str], Any] = {}
        self._newest: dict[str, Any] = {}
        self._report = PlannerReport("", "")
        self._goal: PlannerGoal | None = None
        self._from_public = ""

    @property
    def now_ns(self) -> int:
        return self._node.get_clock().now_ns

    @property
    def map_frame(self) -> str:
        return self.tracker.map_frame

    @property
    def base_frame(self) -> str:
        return self.tracker.base_frame

    def pose(self) -> Pose2 | None:
        return self.tracker.latest

    def velocity(self) -> tuple[float, float]:
        return self.tracker.velocity

    @property
    def is_at_rest(self) -> bool:
        speed, turn_rate = self.velocity()
        return abs(speed) < _REST_MPS and abs(turn_rate) < _REST_RADPS

    def has_transform(self, target: str, source: str) -> bool:
        try:
            self.tracker.buffer.lookup(target, source, 0)
        except TransformException:
            return False
        return True

    def navigate(self, goal: Any) -> PlannerGoal:
        """Publish the goal for the planner; its status answers."""
        if self._goal is not None:
            self._goal.supersede()
        self._goal = PlannerGoal(goal, self._report, stop_planner=self.stop_planner)
        self._node.publish(topics.PLANNER_GOAL.name, goal)
        if repr(goal) != self._from_public:
            self._publish_for_others(goal)
        self._from_public = ""
        return self._goal

    def stop_planner(self) -> None:
        """End the planner's goal; a planner without the service: stop the robot."""
        service = "std_srvs/srv/Trigger", "/planner/cancel"
        self.call_service(*service, Trigger.Request())
        empty = Path()
        empty.header.frame_id = self.map_frame
        empty.header.stamp = ns_to_stamp(self.now_ns)
        self._node.publish(topics.PATH.name, empty)

    def on_planner_status(self, report: PlannerReport) -> None:
        self._report = report
        if self._goal is not None:
            self._goal.on_report(report)

    @property
    def is_paused(self) -> bool:
        """Whether the planner waits while another source commands the robot."""
        return self._report.message == PAUSED

    def planner_listens(self) -> bool:
        """Whether a node beside this one receives goals."""
        count = self._node.count_subscribers
        private, public = topics.PLANNER_GOAL.name, topics.GOAL_POINT.name
        return count(private) > 0 or count(public) > 1

    def note_public(self, goal: PoseStamped) -> None:
        """Note a goal of a public topic: a user's planner received it there, too."""
        self._from_public = repr(goal)

    def driven_path(self, distance_m: float) -> Path | None:
        here = self.pose()
        if here is None:
            return None
        poses = self.trail.back(here, distance_m)
        if not poses:
            return None
        path = Path()
        path.header.frame_id = self.map_frame
        path.header.stamp = ns_to_stamp(self.now_ns)
        path.poses = [stamped(pose, path.header) for pose in poses]
        return path

    def start_action(self, action_type: str, name: str, goal: Any) -> _ActionCall:
        call = _ActionCall(self._action_client(action_type, name), goal, self)
        self._calls.append(call)
        return call

    def call_service(self, service_type: str, name: str, request: Any) -> _ServiceCall:
        client = self._clients.get((service_type, name))
        if client is None:
            client = self._node.create_client(get_interface(service_type), name)
            self._clients[service_type, name] = client
        call = _ServiceCall(client, request, self)
        self._calls.append(call)
        return call

    def cancel_all(self, action_type: str, name: str) -> _ServiceCall:
        kind = "action_msgs/srv/CancelGoal"
        request = CancelGoal.Request()  # zero id and stamp: all goals
        return self.call_service(kind, f"{name}/_action/cancel_goal", request)

    def newest(self, topic: str, message_type: str, *, latched: bool = False) -> Any:
        if topic not in self._newest:
            self._newest[topic] = None
            durability = (
                DurabilityPolicy.TRANSIENT_LOCAL
                if latched
                else DurabilityPolicy.VOLATILE
            )

            def keep(message: Any) -> None:
                self._newest[topic] = message

            self._node.create_subscription(
                get_interface(message_type),
                topic,
                keep,
                QoSProfile(depth=1, durability=durability),
            )
        return self._newest[topic]

    def poll(self) -> None:
        """Look for missing servers; call this periodically."""
        for call in self._calls:
            call.poll()
        self._calls = [call for call in self._calls if call.result is None]
        pose = self.pose()
        if self._goal is not None and pose is not None:
            self._goal.on_motion(pose, self.now_ns, at_rest=self.is_at_rest)

    def _action_client(self, action_type: str, name: str) -> ActionClient:
        client = self._clients.get((action_type, name))
        if client is None:
            client = ActionClient(self._node, get_interface(action_type), name)
            self._clients[action_type, name] = client
        made: ActionClient = client
        return made

    def _publish_for_others(self, goal: PoseStamped) -> None:
        """Publish the goal on the topics that a user's planner and viewers receive.

        Invalid goals are left out: the planner has them, and refuses them once.
        """
        point = PointStamped(header=goal.header, point=goal.pose.position)
        if _is_valid(topics.GOAL_POINT, point):
            self._node.publish(topics.GOAL_POINT.name, point)
        if has_heading(goal.pose) and _is_valid(topics.GOAL_POSE, goal):
            self._node.publish(topics.GOAL_POSE.name, goal)


def _is_valid(topic: topics.StackTopic, msg: Any) -> bool:
    try:
        input_check(topic.type)(msg)
    except InvalidInputError:
        return False
    return True


def stamped(pose: Pose2, header: Any) -> PoseStamped:
    """Return a pose in the plane as a message."""
    msg = PoseStamped(header=header)
    msg.pose.position.x, msg.pose.position.y = pose.x, pose.y
    x, y, z, w = quaternion_from_yaw(pose.yaw)
    msg.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
    return msg
