"""What the node ``control`` publishes and logs about itself."""

from collections.abc import Callable

import numpy as np

from navette.geometry import Pose2
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import Point32, PolygonStamped
from navette.msgs.nav2_msgs.msg import CollisionMonitorState
from navette.msgs.std_msgs.msg import Header
from navette.navigation.control.explanations import EXPLAINED, explain
from navette.navigation.control.records import FollowerOutput, Rollouts
from navette.navigation.control.servers.control_host import ControlHost
from navette.navigation.control.servers.rollout_markers import rollout_markers
from navette.navigation.control.states import ControlState, LimitedBy
from navette.runtime.stage.stage_node import StageNode
from navette.runtime.stage.status import StatusReporter
from navette.runtime.time import ns_to_stamp

_STEPS_PER_REPORT = 5
_ROLLOUTS, _ROLLOUTS_PERIOD_NS = 48, 200_000_000
# A stop that ends by itself, as before the first costmap, needs no explanation.
_EXPLAIN_AFTER_NS = 1_000_000_000
_EXPLAIN_PERIOD_NS = 60_000_000_000
_NORMAL = (ControlState.IDLE, ControlState.PAUSED, ControlState.REACHED)
_WARNINGS = (
    ControlState.BLOCKED,
    ControlState.STALLED,
    ControlState.OFF_PATH,
    ControlState.MISSED_GOAL,
)


class ControlReports:
    """Status, collision check and footprint on topics; explanations in the log."""

    def __init__(self, node: StageNode, *, host: ControlHost) -> None:
        self._node, self._host = node, host
        self._status = StatusReporter(node, topics.CONTROL_STATUS.name)
        self._steps_left = 0
        self._reported = (ControlState.IDLE, LimitedBy.NONE)
        self._stopped_in, self._stopped_ns = ControlState.IDLE, 0
        self._explained_ns: dict[ControlState, int] = {}
        self._action = CollisionMonitorState.DO_NOTHING
        self._rollouts_ns, self._has_rollouts = -_ROLLOUTS_PERIOD_NS, False

    def state(self, output: FollowerOutput) -> None:
        """Publish the state at once when it changes, and every few steps."""
        self._steps_left -= 1
        shown = (output.state, output.limited_by)
        if self._steps_left > 0 and shown == self._reported:
            return
        self._reported = shown
        self._steps_left = _STEPS_PER_REPORT
        self._explain(output.state)
        self._status.report(
            str(output.state),
            _level(output.state),
            cause=output.limited_by,
            speed_mps=output.command.speed,
            turn_rate_radps=output.command.turn_rate,
            cross_track_m=output.cross_track_m,
            heading_error_rad=output.heading_error_rad,
            distance_left_m=output.distance_left_m,
            clearance_m=output.clearance_m,
            limited_by=str(output.limited_by),
        )

    def collision(self, output: FollowerOutput) -> None:
        """Publish what the collision check does to the command when it changes."""
        action = _collision_action(output)
        if action == self._action:
            return
        self._action = action
        name = "footprint" if action != CollisionMonitorState.DO_NOTHING else ""
        self._node.publish(
            topics.COLLISION_MONITOR_STATE.name,
            CollisionMonitorState(action_type=action, polygon_name=name),
        )

    def publish_footprint(self, pose: Pose2 | None) -> None:
        """Publish the outline at a pose, map_T_base, while it is subscribed to."""
        node = self._node
        if pose is None or not node.has_listeners(topics.LOCAL_FOOTPRINT.name):
            return
        corners = np.array(node.params.footprint_m).reshape(-1, 2)
        message = PolygonStamped()
        message.header.frame_id = node.params.map_frame
        message.header.stamp = ns_to_stamp(node.get_clock().now_ns)
        message.polygon.points = [
            Point32(x=x, y=y) for x, y in pose.apply(corners).tolist()
        ]
        node.publish(topics.LOCAL_FOOTPRINT.name, message)

    def publish_rollouts(self, rollouts: Callable[[int], Rollouts | None]) -> None:
        """Publish the motions that were compared, now and then, while subscribed to."""
        node = self._node
        now_ns = node.get_clock().now_ns
        is_due = not 0 <= now_ns - self._rollouts_ns < _ROLLOUTS_PERIOD_NS
        if not is_due or not node.has_listeners(topics.TRAJECTORIES.name):
            return
        self._rollouts_ns = now_ns
        found = rollouts(_ROLLOUTS)
        if found is not None or self._has_rollouts:
            header = Header(frame_id=node.params.map_frame, stamp=ns_to_stamp(now_ns))
            message = rollout_markers(found, header)
            node.hand_over(topics.TRAJECTORIES.name, message)
        self._has_rollouts = found is not None

    def _explain(self, state: ControlState) -> None:
        """Log why the robot stays stopped, once a minute for each state."""
        now_ns = self._node.get_clock().now_ns
        if state != self._stopped_in:
            self._stopped_in, self._stopped_ns = state, now_ns
        last_ns = self._explained_ns.get(state)
        lasts = now_ns - self._stopped_ns >= _EXPLAIN_AFTER_NS
        is_new = last_ns is None or not 0 <= now_ns - last_ns < _EXPLAIN_PERIOD_NS
        if state not in EXPLAINED or not (lasts and is_new):
            return
        text = explain(state, self._host.situation(), self._node.params)
        if text:
            self._explained_ns[state] = now_ns
            self._node.get_logger().warning(f"{state}: {text}")


def _collision_action(output: FollowerOutput) -> int:
    if output.state is ControlState.BLOCKED:
        return CollisionMonitorState.STOP
    if output.collision_scale < 1.0:
        return CollisionMonitorState.APPROACH
    if output.limited_by is LimitedBy.CLEARANCE:
        return CollisionMonitorState.SLOWDOWN
    return CollisionMonitorState.DO_NOTHING


def _level(state: ControlState) -> bytes:
    if state.moves or state in _NORMAL:
        return StatusReporter.OK
    return StatusReporter.WARN if state in _WARNINGS else StatusReporter.ERROR
