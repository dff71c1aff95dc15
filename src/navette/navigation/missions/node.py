"""The node ``missions``: send goals to the planner, one after another.

The node publishes its first goal when /goal_point has a subscriber, a planner status
has arrived and, with ``wait_for_map``, a map. Each goal is published once.
"""

from collections.abc import Callable
from typing import Any

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.navigation.missions.params import MissionParams
from navette.navigation.missions.sequence import (
    GoalOutcome,
    GoalSequence,
    PlannerReport,
    Point,
)
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.stage_node import Input, Output, StageNode
from navette.runtime.time import ns_to_stamp


class MissionNode(StageNode):
    """Send a list of goals; more can be added at any time."""

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
    )
    OUTPUTS = (
        Output.of(
            topics.GOAL_POINT,
            "the next goal",
        ),
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("missions", **kwargs)
        params: MissionParams = self.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._odometry: Odometry | None = None  # newest, not used yet
        self._map_arrived = self._planner_ready = False
        #: Called when every goal has a result.
        self.on_done: Callable[[], None] | None = None
        self._sequence = GoalSequence(
            params.goal_points(),
            timeout_ns=round(params.goal_timeout_s * 1e9),
            stop_on_failure=params.on_failure == "stop",
        )
        self.create_timer(1 / params.rate_hz, self._check)

    @property
    def done(self) -> bool:
        """Whether every goal has a result."""
        return self._sequence.done

    @property
    def active_goal(self) -> Point | None:
        """The active goal (x, y; m, map), if any."""
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
        """Forward the planner's status; it may end the active goal."""
        self._planner_ready = True
        self._update_position()
        values = {pair.key: pair.value for pair in msg.values}
        report = PlannerReport(
            values.get("goal_id", ""), msg.message, values.get("result")
        )
        self._sequence.on_report(report, self._now_ns)
        self._send_next()

    def on_odometry(self, msg: Odometry) -> None:
        """Store the newest message; the path length is updated a few times a second."""
        self._odometry = msg

    def on_map(self, msg: OccupancyGrid) -> None:
        """Note that the planner has a map."""
        self._map_arrived = True

    def on_params_changed(self, old: MissionParams) -> None:
        """Append new goals; timeout and failure rule apply from the next goal on."""
        params: MissionParams = self.params
        if params.goals_m != old.goals_m:
            for goal in params.goal_points():
                self._sequence.add(*goal)
        self._sequence.timeout_ns = round(params.goal_timeout_s * 1e9)
        self._sequence.stop_on_failure = params.on_failure == "stop"

    @property
    def _now_ns(self) -> int:
        return self.get_clock().now_ns

    def _check(self) -> None:
        self._update_position()
        self._sequence.check(self._now_ns)
        self._send_next()

    def _update_position(self) -> None:
        odometry, self._odometry = self._odometry, None
        if odometry is None or not self._tracker.update(odometry):
            return
        pose = self._tracker.latest
        assert pose is not None, "the tracker accepted the odometry"
        self._sequence.move(pose.x, pose.y)

    def _send_next(self) -> None:
        """Publish the next goal if no goal is active and the planner is ready."""
        if self._sequence.done:
            if self._sequence.total and self.on_done is not None:
                self.on_done()
            return
        map_ready = self._map_arrived or not self.params.wait_for_map
        if not (
            map_ready
            and self._planner_ready
            and self.has_listeners(topics.GOAL_POINT.name)
        ):
            return
        goal = self._sequence.start_next(self._now_ns)
        if goal is None:
            return
        self.get_logger().info(
            f"goal {len(self.outcomes) + 1} of {self._sequence.total}: "
            f"({goal[0]:g}, {goal[1]:g})"
        )
        msg = PointStamped()
        msg.header.frame_id = self.params.map_frame
        msg.header.stamp = ns_to_stamp(self._now_ns)
        msg.point.x, msg.point.y = goal
        self.publish(topics.GOAL_POINT.name, msg)
