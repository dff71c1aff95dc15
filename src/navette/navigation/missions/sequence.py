"""Goals one after another, and their results."""

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from navette.errors import InvalidValueError

REACHED = "reached"
PAUSED = "paused"
TIMED_OUT = "timed_out"
CANCELED = "canceled"
PREEMPTED = "preempted"  # a newer goal replaced it
FAILED = "failed"  # the behaviour tree failed without naming a failure
SKIPPED = "skipped"  # a goal before this one ended the mission
UNFINISHED = "unfinished"  # the run ended before the goal did

FAILURES = frozenset(
    {
        "no_path",
        "search_limit",
        "method_failed",
        "start_blocked",
        "start_outside_map",
        "goal_blocked",
        "goal_outside_map",
        "goal_not_finite",
        "goal_orientation_invalid",
        "goal_stamp_invalid",
        "unknown_frame",
        "stuck",
        CANCELED,
        TIMED_OUT,
        PREEMPTED,
        FAILED,
    }
)
"""Results, and status messages of a planner, of a goal that was not reached."""

Point = tuple[float, float]


@dataclass(frozen=True)
class GoalOutcome:
    """Result of one goal (x, y; m, map).

    ``distance_left_m`` is infinite without a pose of the robot.
    """

    goal: Point
    result: str
    time_s: float
    path_length_m: float
    distance_left_m: float


@dataclass(frozen=True)
class PlannerReport:
    """Status of the planner.

    Attributes:
        goal_id: identifies the goal; "" from a planner without ids.
        message: activity or failure.
        result: how the goal ended, "" until then; None from a planner that reports
            it by message only.
    """

    goal_id: str
    message: str
    result: str | None = None

    @property
    def end(self) -> str:
        """How the goal ended; "" until then."""
        if self.result is not None:
            return self.result
        is_end = self.message == REACHED or self.message in FAILURES
        return self.message if is_end else ""


class StatusFilter:
    """Drops reports of an earlier goal.

    A report that repeats the last one before the goal was sent concerns an earlier
    goal: reports count from the first different one.
    """

    def __init__(self, before: PlannerReport) -> None:
        self._before = before

    def is_new(self, report: PlannerReport) -> bool:
        before = self._before
        if before.goal_id:
            is_old = report.goal_id == before.goal_id
        else:
            is_old = bool(before.message) and report == before
        if not is_old:
            self._before = PlannerReport("", "")
        return not is_old


class GoalSequence:
    """State machine of the goals, without clock or topics.

    Args:
        goals: initial goals (x, y), metres.
        timeout_ns: time for each goal; 0: no limit.
        stop_on_failure: skip the remaining goals after a failed one.
    """

    def __init__(
        self,
        goals: Iterable[Point] = (),
        *,
        timeout_ns: int = 0,
        stop_on_failure: bool = False,
    ) -> None:
        self._pending: deque[Point] = deque()
        self.timeout_ns = timeout_ns
        self.stop_on_failure = stop_on_failure
        self._last_report = PlannerReport("", "")
        self._filter = StatusFilter(self._last_report)
        self._position: Point | None = None
        self._active: Point | None = None
        self._started_ns = self._checked_ns = self._paused_ns = 0
        self._path_length = 0.0
        self.outcomes: list[GoalOutcome] = []
        for goal in goals:
            self.add(*goal)

    @property
    def active(self) -> Point | None:
        """The active goal, if any."""
        return self._active

    @property
    def done(self) -> bool:
        """Whether every goal has a result."""
        return self._active is None and not self._pending

    @property
    def total(self) -> int:
        """Number of goals, ended ones included."""
        return len(self.outcomes) + len(self._pending) + (self._active is not None)

    def add(self, x: float, y: float) -> None:
        """Append a goal.

        Raises:
            InvalidValueError: not finite.
        """
        if not (math.isfinite(x) and math.isfinite(y)):
            raise InvalidValueError(f"goal ({x}, {y}): expected finite metres")
        self._pending.append((float(x), float(y)))

    def start_next(self, now_ns: int) -> Point | None:
        """Start the next goal and return it; None if one is active or none is left."""
        if self._active is not None or not self._pending:
            return None
        self._active = self._pending.popleft()
        self._filter = StatusFilter(self._last_report)
        self._started_ns, self._paused_ns = now_ns, 0
        self._path_length = 0.0
        return self._active

    def move(self, x: float, y: float) -> None:
        """Update the position of the robot (x, y), metres, map."""
        if self._position is not None:
            self._path_length += math.dist(self._position, (x, y))
        self._position = (x, y)

    def on_report(self, report: PlannerReport, now_ns: int) -> None:
        """Process a report; a final one ends the active goal."""
        self._last_report = report
        if self._active is None or not self._filter.is_new(report):
            return
        if report.end:
            self._end(report.end, now_ns)

    def check(self, now_ns: int, *, paused: bool = False) -> None:
        """End the active goal if its timeout has expired; a pause does not count."""
        if paused:
            self._paused_ns += max(0, now_ns - self._checked_ns)
        self._checked_ns = now_ns
        if self._active is None or not self.timeout_ns:
            return
        if now_ns - self._started_ns - self._paused_ns >= self.timeout_ns:
            self._end(TIMED_OUT, now_ns)

    def skip_rest(self) -> None:
        """End the goals that have not started, as skipped."""
        while self._pending:
            skipped = self._pending.popleft()
            self.outcomes.append(GoalOutcome(skipped, SKIPPED, 0.0, 0.0, math.inf))

    def unfinished(self, now_ns: int) -> list[GoalOutcome]:
        """Return outcomes of the goals that have not ended, the active one first."""
        outcomes = [
            GoalOutcome(goal, UNFINISHED, 0.0, 0.0, self._distance_to(goal))
            for goal in self._pending
        ]
        if self._active is not None:
            outcomes.insert(0, self._outcome(self._active, UNFINISHED, now_ns))
        return outcomes

    def _end(self, result: str, now_ns: int) -> None:
        goal = self._active
        assert goal is not None, "only an active goal ends"
        self.outcomes.append(self._outcome(goal, result, now_ns))
        self._active = None
        if result == CANCELED or (result != REACHED and self.stop_on_failure):
            self.skip_rest()

    def _outcome(self, goal: Point, result: str, now_ns: int) -> GoalOutcome:
        seconds = (now_ns - self._started_ns) / 1e9
        left = self._distance_to(goal)
        return GoalOutcome(goal, result, seconds, self._path_length, left)

    def _distance_to(self, goal: Point) -> float:
        return math.dist(self._position, goal) if self._position else math.inf
