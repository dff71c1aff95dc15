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

# Without any status, this close and at rest counts as reached.
_NEAR_M = 0.5


class PlannerGoal:
    """A :class:`ServerCall` that is answered by the planner's status.

    A planner that publishes no status is supported: then the goal is reached when the
    robot rests near it.

    Args:
        goal: pose; an orientation of zeros means any heading.
        last_report: newest status before the goal was sent.
        stop: makes the planner drop the goal.
    """

    def __init__(
        self, goal: PoseStamped, last_report: PlannerReport, stop: Callable[[], None]
    ) -> None:
        self.goal = goal
        self._stop = stop
        self._filter = StatusFilter(last_report)
        self._result: CallResult | None = None
        self.reported = False

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
            self._stop()

    def supersede(self) -> None:
        """End without stopping the planner: the next goal replaces this one there."""
        self._result = self._result or CallResult(CANCELED)

    def on_report(self, report: PlannerReport) -> None:
        """Process a status; an old one concerns an earlier goal."""
        if self._result is not None or not self._filter.is_new(report):
            return
        self.reported = True
        if report.end == REACHED:
            self._result = CallResult(SUCCEEDED)
        elif report.end:
            x, y = self.goal.pose.position.x, self.goal.pose.position.y
            reason = f"goal ({x:g}, {y:g}): {report.end}"
            self._result = CallResult(ABORTED, report.end, reason)

    def on_rest(self, pose: Pose2) -> None:
        """Note that the robot rests; a goal without any status may be reached."""
        point = self.goal.pose.position
        near = math.dist((point.x, point.y), (pose.x, pose.y)) <= _NEAR_M
        if self._result is None and not self.reported and near:
            self._result = CallResult(SUCCEEDED)
