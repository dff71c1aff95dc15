"""Progress of a run for display: the goal and its state."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.navigation.missions import TIMED_OUT
from navette.runtime import Context, DurabilityPolicy, Node, QoSProfile
from navette.runtime.stage.commander import NO_COMMANDER, Commander

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass(frozen=True)
class RunProgress:
    """Progress of a run. Metres and simulated seconds.

    Attributes:
        retry: how often the goal was started again after it had failed; 0 if the
            planner does not report it.
        distance_left_m: None before the first plan to the goal.
    """

    goal: tuple[float, float] | None = None
    goal_id: str = ""
    retry: int = 0
    state: str = "starting"
    control: str = ""
    distance_left_m: float | None = None
    failed: bool = False
    commander: Commander = NO_COMMANDER
    sim_time_s: float = 0.0


OnProgress = Callable[[RunProgress], None]
"""Called when the planner's state or goal or the commander changes."""


class MonitorNode(Node):
    """Follow the status of planner and controller."""

    def __init__(self, *, context: Context, on_change: OnProgress) -> None:
        super().__init__("monitor", context=context)
        self._on_change = on_change
        self.progress = RunProgress()
        self._timed_out = ""  # id of a goal whose reports are ignored
        for topic, callback in (
            (topics.PLANNER_STATUS.name, self._on_planner),
            (topics.CONTROL_STATUS.name, self._on_control),
            (topics.COMMANDER.name, self._on_commander),
        ):
            self.create_subscription(
                DiagnosticStatus, topic, callback, LATCHED, shared=True
            )

    def on_timed_out(self, goal: tuple[float, float]) -> None:
        """Show that a goal timed out; the planner reports only its cancellation."""
        self._timed_out = self.progress.goal_id
        self.progress = replace(
            self.progress,
            goal=goal,
            state=TIMED_OUT,
            failed=True,
            sim_time_s=self.get_clock().now().nanoseconds / 1e9,
        )
        self._on_change(self.progress)

    def _on_planner(self, status: DiagnosticStatus) -> None:
        values = {item.key: item.value for item in status.values}
        if self._timed_out and values.get("goal_id") == self._timed_out:
            return
        before = self.progress
        goal = _number(values, "goal_x"), _number(values, "goal_y")
        has_plan = values.get("plan") != ""  # a planner of one's own may not report it
        left = _number(values, "distance_left_m") if has_plan else math.nan
        retry = _number(values, "retry")
        self.progress = replace(
            before,
            goal=None if math.isnan(goal[0]) else goal,
            goal_id=values.get("goal_id", ""),
            retry=0 if math.isnan(retry) else int(retry),
            state=status.message,
            distance_left_m=None if math.isnan(left) else left,
            failed=status.level >= DiagnosticStatus.ERROR,
            sim_time_s=self.get_clock().now().nanoseconds / 1e9,
        )
        if (before.state, before.goal_id) != (status.message, self.progress.goal_id):
            self._on_change(self.progress)

    def _on_control(self, status: DiagnosticStatus) -> None:
        self.progress = replace(self.progress, control=status.message)

    def _on_commander(self, status: DiagnosticStatus) -> None:
        before, commander = self.progress.commander, Commander.of(status)
        self.progress = replace(
            self.progress,
            commander=commander,
            sim_time_s=self.get_clock().now().nanoseconds / 1e9,
        )
        if before.name != commander.name:
            self._on_change(self.progress)


def _number(values: dict[str, str], key: str) -> float:
    """Return a number of a status; NaN if missing."""
    return float(values.get(key) or math.nan)
