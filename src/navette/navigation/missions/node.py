"""The node ``missions``: sends goals to the planner, one after the other.

It waits with the first goal until somebody reads /goal_point, the planner was heard
and (unless switched off) a map was seen; then it publishes each goal once.
"""

from collections.abc import Callable
from typing import Any

from navette import topics
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
    """Drives a list of goals; more can be added at any time."""

    PARAMS = MissionParams
    INPUTS = (
        Input(
            topic=topics.PLANNER_STATUS.name,
            type=topics.PLANNER_STATUS.type,
            role="what becomes of the goal",
            rate_hz=2.0,
            depth=1,
            latched=True,
            callback="on_planner_status",
        ),
        Input(
            topic=topics.ODOMETRY.name,
            type=topics.ODOMETRY.type,
            role="path length and distance left",
            rate_hz=10.0,
            callback="on_odometry",
        ),
        Input(
            topic=topics.MAP.name,
            type=topics.MAP.type,
            role="sign that planning can begin",
            depth=1,
            latched=True,
            callback="on_map",
        ),
    )
    OUTPUTS = (
        Output(
            topic=topics.GOAL_POINT.name,
            type=topics.GOAL_POINT.type,
            role="the next goal",
        ),
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("missions", **kwargs)
        params: MissionParams = self.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._odometry: Odometry | None = None  # newest, not counted yet
        self._map_seen = self._planner_heard = False
        #: Called when the last goal has its outcome.
        self.on_done: Callable[[], None] | None = None
        self._sequence = GoalSequence(
            params.goal_points(),
            timeout_ns=round(params.goal_timeout_s * 1e9),
            stop_on_failure=params.on_failure == "stop",
        )
        self.create_timer(1 / params.rate_hz, self._check)

    @property
    def done(self) -> bool:
        """Whether every goal has its outcome."""
        return self._sequence.done

    @property
    def active_goal(self) -> Point | None:
        """The goal under way (x, y; m, map), if any."""
        return self._sequence.active

    @property
    def outcomes(self) -> list[GoalOutcome]:
        """What became of the goals that have ended, in order."""
        return list(self._sequence.outcomes)

    @property
    def standing(self) -> list[GoalOutcome]:
        """Every goal in order; what has not ended yet is ``unfinished``."""
        self._count_way()
        return self.outcomes + self._sequence.unfinished(self._now_ns)

    def add_goal(self, x: float, y: float) -> None:
        """One more goal (m, map) after the others.

        Raises:
            InvalidValueError: not finite.
        """
        self._sequence.add(x, y)

    def on_planner_status(self, msg: DiagnosticStatus) -> None:
        """The planner says how it goes; perhaps the goal is done."""
        self._planner_heard = True
        self._count_way()
        values = {pair.key: pair.value for pair in msg.values}
        report = PlannerReport(
            values.get("goal_id", ""), msg.message, values.get("result")
        )
        self._sequence.hear(report, self._now_ns)
        self._go_on()

    def on_odometry(self, msg: Odometry) -> None:
        """Keep the newest; a few a second are enough to count the way driven."""
        self._odometry = msg

    def on_map(self, msg: OccupancyGrid) -> None:
        """The planner can have its map by now."""
        self._map_seen = True

    def on_params_changed(self, old: MissionParams) -> None:
        """New goals are added; times and failure rule hold from the next goal on."""
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
        self._count_way()
        self._sequence.check(self._now_ns)
        self._go_on()

    def _count_way(self) -> None:
        odometry, self._odometry = self._odometry, None
        if odometry is None or not self._tracker.update(odometry):
            return
        place = self._tracker.latest
        assert place is not None, "the tracker took the odometry"
        self._sequence.move(place.x, place.y)

    def _go_on(self) -> None:
        """Publish the next goal if it is its turn and the planner can take it."""
        if self._sequence.done:
            if self._sequence.total and self.on_done is not None:
                self.on_done()
            return
        map_ready = self._map_seen or not self.params.wait_for_map
        if not (
            map_ready
            and self._planner_heard
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
