"""A goal that the planner drives to: progress and end, from its status."""

import math
from collections.abc import Callable

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.navigation.missions.sequence import REACHED, PlannerReport, StatusFilter
from navette.navigation.missions.tree.robot_access import (
    ABORTED,
    CANCELED,
    SUCCEEDED,
    CallResult,
)

# Without a status that names results, resting this close for this long is arrival.
_NEAR_M = 0.5
_REST_NS = 2_000_000_000


StopPlanner = Callable[[], None]
"""Makes the planner drop its goal."""


class PlannerGoal:
    """A :class:`ServerCall` that is answered by the planner's status.

    A planner that publishes no status is supported: then the goal is reached when the
    robot rests near it.

    Args:
        goal: pose; an orientation of zeros means any heading.
        last_report: newest status before the goal was sent.
    """

    def __init__(
        self,
        goal: PoseStamped,
        last_report: PlannerReport,
        *,
        stop_planner: StopPlanner,
    ) -> None:
        self.goal = goal
        self._stop_planner = stop_planner
        self._filter = StatusFilter(last_report)
        self._result: CallResult | None = None
        self._names_results = False
        self._resting_since_ns: int | None = None

    @property
    def result(self) -> CallResult | None:
        return self._result

    @property
    def feedback(self) -> None:
        return None

    def cancel(self) -> None:
        """Make the planner drop the goal."""
        if self._result is None:
            self._result = CallResult(CANCELED)
            self._stop_planner()

    def supersede(self) -> None:
        """End without stopping the planner: the next goal replaces this one there."""
        self._result = self._result or CallResult(CANCELED)

    def on_report(self, report: PlannerReport) -> None:
        """Process a status; an old one concerns an earlier goal."""
        if self._result is not None or not self._filter.is_new(report):
            return
        self._names_results |= report.result is not None
        if report.end == REACHED:
            self._result = CallResult(SUCCEEDED)
        elif report.end:
            x, y = self.goal.pose.position.x, self.goal.pose.position.y
            reason = f"goal ({x:g}, {y:g}): {report.end}"
            self._result = CallResult(ABORTED, report.end, reason)

    def on_motion(self, pose: Pose2, now_ns: int, *, at_rest: bool) -> None:
        """Note the robot's pose: it may rest at a goal of a planner without status."""
        point = self.goal.pose.position
        near = math.dist((point.x, point.y), (pose.x, pose.y)) <= _NEAR_M
        if not (at_rest and near):
            self._resting_since_ns = None
            return
        if self._resting_since_ns is None:
            self._resting_since_ns = now_ns
        rested = now_ns - self._resting_since_ns >= _REST_NS
        if rested and not self._names_results and self._result is None:
            self._result = CallResult(SUCCEEDED)
