"""The node ``missions``: goals in, navigation by a behaviour tree, results out.

Goals come from the actions ``navigate_to_pose``, ``navigate_through_poses`` and
``follow_waypoints``, from people on /goal_point and /goal_pose, and from the list of
parameter ``goals_m``. Goals of topics and of the list become goals of
``navigate_to_pose``. The first goal of the list is sent when a planner listens and,
with ``wait_for_map``, a map has arrived; each is sent once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import PointStamped, PoseStamped, Quaternion
from navette.msgs.known_fields import made
from navette.msgs.nav2_msgs.action import NavigateToPose
from navette.msgs.nav2_msgs.msg import BehaviorTreeLog, BehaviorTreeStatusChange
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.std_msgs.msg import Empty, String
from navette.navigation.missions.navigation import TreeNavigator
from navette.navigation.missions.params import MissionParams
from navette.navigation.missions.robot.node import NodeRobot
from navette.navigation.missions.sequence import (
    CANCELED,
    GoalOutcome,
    GoalSequence,
    PlannerReport,
    Point,
)
from navette.navigation.missions.servers.node import NavigationServers
from navette.navigation.missions.tree.drawing import tree_text
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.stage_node import Input, Output, StageNode
from navette.runtime.time import ns_to_stamp

_EXPLAIN_AFTER_NS = 5_000_000_000
ANY_HEADING = Quaternion(x=0.0, y=0.0, z=0.0, w=0.0)


class MissionNode(StageNode):
    """Navigate to goals; more can be added at any time."""

    PARAMS = MissionParams
    INPUTS = (
        Input.of(
            topics.PLANNER_STATUS,
            "progress and result of the goal",
            rate_hz=2.0,
            callback="on_planner_status",
        ),
        Input.of(
            topics.ODOMETRY,
            "position, for path length and distance left",
            rate_hz=10.0,
            callback="on_odometry",
        ),
        Input.of(
            topics.MAP,
            "availability of a map",
            callback="on_map",
            checks_contents=False,
        ),
        Input.of(
            topics.GOAL_POINT,
            "goal position of a person",
            callback="on_goal_point",
            ignores_own=True,
        ),
        Input.of(
            topics.GOAL_POSE,
            "goal position and heading of a person",
            callback="on_goal_pose",
            ignores_own=True,
        ),
        Input.of(
            topics.CANCEL_GOAL,
            "cancels every goal, those of the list too",
            callback="on_cancel_goal",
        ),
    )
    OUTPUTS = (
        Output.of(
            topics.PLANNER_GOAL,
            "goal for the planner; an orientation of zeros means any heading",
        ),
        Output.of(
            topics.GOAL_POINT,
            "each goal, for viewers and a planner of the user",
        ),
        Output.of(
            topics.GOAL_POSE,
            "each goal with a heading, for viewers and a planner of the user",
        ),
        Output.of(
            topics.PATH,
            "empty = stop, when a goal is cancelled",
        ),
        Output.of(
            topics.BEHAVIOR_TREE,
            "the behaviour tree with the status of its nodes, as text",
        ),
        Output.of(
            topics.BEHAVIOR_TREE_LOG,
            "nodes of the behaviour tree whose status changed",
        ),
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("missions", **kwargs)
        params: MissionParams = self.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._odometry: Odometry | None = None  # newest, not used yet
        self._map_arrived = self._planner_reported = False
        #: Called when every goal has a result.
        self.on_done: Callable[[], None] | None = None
        #: Called with a goal of the list that timed out, before it is cancelled.
        self.on_timed_out: Callable[[Point], None] | None = None
        self._sequence = GoalSequence(
            params.goal_points(),
            timeout_ns=round(params.goal_timeout_s * 1e9),
            stop_on_failure=params.on_failure == "stop",
        )
        self._sent = 0  # goals of the list sent so far
        self._list_goal: _ListGoal | None = None
        self._waiting_since_ns: int | None = None
        self._has_explained = False
        self._robot = NodeRobot(self, self._tracker, on_call_end=self._step)
        self._navigator = TreeNavigator(self._robot, params.error_code_names)
        self._load_trees()
        self._lifecycle = StageLifecycle(
            self, "bt_navigator", on_inactive=self._navigator.cancel
        )
        StageLifecycle(self, "waypoint_follower")
        self._servers = NavigationServers(
            self, self._robot, self._navigator, activation=self._lifecycle
        )
        self._stepping = False
        self._timer = self.create_timer(1 / params.rate_hz, self._check)

    @property
    def done(self) -> bool:
        """Whether every goal of the list has a result."""
        return self._sequence.done

    @property
    def active_goal(self) -> Point | None:
        """The active goal of the list (x, y; m, map), if any."""
        return self._sequence.active

    @property
    def outcomes(self) -> list[GoalOutcome]:
        """Outcomes of the ended goals, in order."""
        return list(self._sequence.outcomes)

    @property
    def all_outcomes(self) -> list[GoalOutcome]:
        """Outcomes of all goals, in order; ``unfinished`` for those not ended."""
        self._update_position()
        return self.outcomes + self._sequence.unfinished(self._now_ns)

    def add_goal(self, x: float, y: float) -> None:
        """Append a goal (m, map).

        Raises:
            InvalidValueError: not finite.
        """
        self._sequence.add(x, y)

    def on_planner_status(self, msg: DiagnosticStatus) -> None:
        """Forward the planner's status; it may end the goal."""
        self._planner_reported = True
        self._update_position()
        values = {pair.key: pair.value for pair in msg.values}
        report = PlannerReport(
            values.get("goal_id", ""), msg.message, values.get("result")
        )
        self._robot.on_planner_status(report)
        self._step()

    def on_odometry(self, msg: Odometry) -> None:
        """Store the newest message; the path length is updated a few times a second."""
        self._odometry = msg

    def on_map(self, msg: OccupancyGrid) -> None:
        """Note that the planner has a map."""
        self._map_arrived = True

    def on_goal_point(self, msg: PointStamped) -> None:
        """Navigate to a point, with any heading."""
        pose = PoseStamped(header=msg.header)
        pose.pose.position = msg.point
        pose.pose.orientation = ANY_HEADING
        self._robot.note_public(pose)
        self._send(pose)

    def on_goal_pose(self, msg: PoseStamped) -> None:
        """Navigate to a pose."""
        self._robot.note_public(msg)
        self._send(msg)

    def on_cancel_goal(self, msg: Empty) -> None:
        """Cancel every goal of every action, and the list."""
        if self._sequence.active is None:
            self._sequence.skip_rest()  # otherwise after the active goal's result
        self._servers.cancel_all()

    def on_params_changed(self, old: MissionParams) -> None:
        """Append new goals; other values apply from the next goal on."""
        params: MissionParams = self.params
        if params.goals_m != old.goals_m:
            for goal in params.goal_points():
                self._sequence.add(*goal)
        if params.rate_hz != old.rate_hz:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(1 / params.rate_hz, self._check)
        self._sequence.timeout_ns = round(params.goal_timeout_s * 1e9)
        self._sequence.stop_on_failure = params.on_failure == "stop"

    @property
    def _now_ns(self) -> int:
        return self.get_clock().now_ns

    def _load_trees(self) -> None:
        """Read the default trees, so that an invalid file is refused at the start."""
        for path in (self.params.to_pose_tree, self.params.through_poses_tree):
            self._navigator.load(path)

    def _check(self) -> None:
        self._update_position()
        self._robot.poll()
        self._step()
        self._servers.publish_feedback()
        goal = self._sequence.active
        self._sequence.check(self._now_ns, paused=self._robot.is_paused)
        if goal is not None and self._sequence.active is None:
            self._cancel_timed_out(goal)
        self._send_next()

    def _step(self) -> None:
        """Tick the tree and publish what changed; also called when a call ends."""
        if self._stepping:  # a call that ended while the tree was ticked
            return
        self._stepping = True
        try:
            self._navigator.step()
        finally:
            self._stepping = False
        self._publish_tree()

    def _publish_tree(self) -> None:
        changes = self._navigator.take_changes()
        if not changes or self._navigator.run is None:
            return
        stamp = ns_to_stamp(self._now_ns)
        events = [
            made(
                BehaviorTreeStatusChange,
                timestamp=stamp,
                node_name=change.node,
                uid=change.uid,  # since Jazzy
                previous_status=change.before,
                current_status=change.now,
            )
            for change in changes
        ]
        log = BehaviorTreeLog(timestamp=stamp, event_log=events)
        self.publish(topics.BEHAVIOR_TREE_LOG.name, log)
        text = tree_text(self._navigator.run.root)
        self.publish(topics.BEHAVIOR_TREE.name, String(data=text))

    def _update_position(self) -> None:
        odometry, self._odometry = self._odometry, None
        if odometry is None or not self._tracker.update(odometry):
            return
        pose = self._tracker.latest
        assert pose is not None, "the tracker accepted the odometry"
        self._sequence.move(pose.x, pose.y)
        self._robot.trail.add(pose)

    def _send_next(self) -> None:
        """Send the next goal of the list if none is active and the planner is ready."""
        if self._sequence.done:
            if self._sequence.total and self.on_done is not None:
                self.on_done()
            return
        if self._navigator.active is not None:
            return
        if not self._is_ready():
            self._explain_waiting()
            return
        goal = self._sequence.start_next(self._now_ns)
        if goal is None:
            return
        self.get_logger().info(
            f"goal {len(self.outcomes) + 1} of {self._sequence.total}: "
            f"({goal[0]:g}, {goal[1]:g})"
        )
        pose = PoseStamped()
        pose.header.frame_id = self.params.map_frame
        pose.header.stamp = ns_to_stamp(self._now_ns)
        pose.pose.position.x, pose.pose.position.y = goal
        pose.pose.orientation = ANY_HEADING
        self._sent += 1
        self._list_goal = _ListGoal(self._sent)
        self._send(pose, self._list_goal)

    def _is_ready(self) -> bool:
        """Whether a planner listens, and a map has arrived if one is needed."""
        map_ready = self._map_arrived or not self.params.wait_for_map
        planners = topics.PLANNER_STATUS.name
        reported = self._planner_reported or not self.count_publishers(planners)
        return map_ready and reported and self._robot.planner_listens()

    def _explain_waiting(self) -> None:
        """Log once what the first goal waits for, when that takes long."""
        if self._has_explained or self._sequence.active is not None:
            return
        if self._waiting_since_ns is None:
            self._waiting_since_ns = self._now_ns
        if self._now_ns - self._waiting_since_ns < _EXPLAIN_AFTER_NS:
            return
        self._has_explained = True
        missing = []
        if not self._robot.planner_listens():
            missing.append(
                f"no node subscribes to {topics.PLANNER_GOAL.name} or "
                f"{topics.GOAL_POINT.name} (is a planner running?)"
            )
        if self.params.wait_for_map and not self._map_arrived:
            missing.append(
                f"no map has arrived on {topics.MAP.name} (is map_memory running? A "
                "planner that needs no map: set wait_for_map to false)"
            )
        if not missing:
            missing.append(f"no status has arrived on {topics.PLANNER_STATUS.name}")
        self.get_logger().warning(f"no goal sent yet: {'; '.join(missing)}")

    def _send(self, pose: PoseStamped, of_list: "_ListGoal | None" = None) -> None:
        """Send a goal to the own action, as Nav2 does with those of ``goal_pose``."""
        goal = NavigateToPose.Goal(pose=pose)
        future = self._servers.client.send_goal_async(goal)

        def on_response(_: object) -> None:
            handle = future.result()
            if handle is None:
                return
            if not handle.accepted:
                self.get_logger().warning("goal refused: bt_navigator is not active")
                return
            if of_list is not None:
                of_list.handle = handle
            result = handle.get_result_async()
            result.add_done_callback(lambda _: self._on_result(handle, of_list))

        future.add_done_callback(on_response)

    def _on_result(self, handle: Any, of_list: "_ListGoal | None") -> None:
        end = self._servers.take_end(handle.goal_id)
        if end is None:
            return
        if of_list is not None and of_list is self._list_goal:
            self._list_goal = None
            report = PlannerReport(str(of_list.number), end.how, end.how)
            self._sequence.on_report(report, self._now_ns)
            if end.how == CANCELED:
                self._sequence.skip_rest()
        self._send_next()

    def _cancel_timed_out(self, point: Point) -> None:
        """Cancel the list's goal: the list does not wait for it any more."""
        if self.on_timed_out is not None:
            self.on_timed_out(point)
        goal, self._list_goal = self._list_goal, None
        if goal is not None and goal.handle is not None:
            goal.handle.cancel_goal_async()


@dataclass
class _ListGoal:
    """A goal of the list that was sent; ``handle`` follows the response."""

    number: int
    handle: Any = None
