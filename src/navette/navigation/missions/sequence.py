"""Goals one after the other, and what became of each."""

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from navette.errors import InvalidValueError

REACHED = "reached"
TIMED_OUT = "timed_out"
SKIPPED = "skipped"  # a goal before this one failed and the mission stops there
UNFINISHED = "unfinished"  # the run ended before the goal did

FAILURES = frozenset(
    {
        "no_path",
        "search_limit",
        "start_blocked",
        "start_outside_map",
        "goal_blocked",
        "goal_outside_map",
        "goal_not_finite",
        "unknown_frame",
        "stuck",
        TIMED_OUT,
    }
)
"""Messages of a planner that has given the goal up."""

Point = tuple[float, float]


@dataclass(frozen=True)
class GoalOutcome:
    """One goal (x, y; m, map): result, seconds, metres driven and metres to go.

    ``distance_left_m`` is infinite as long as the robot's place was never known.
    """

    goal: Point
    result: str
    time_s: float
    path_length_m: float
    distance_left_m: float


@dataclass(frozen=True)
class PlannerReport:
    """What the planner says.

    ``goal_id`` tells its goals apart, "" if it does not. ``result`` says how the goal
    ended, "" while under way; None from a planner that says it by message only.
    """

    goal_id: str
    message: str
    result: str | None = None

    @property
    def end(self) -> str:
        """How the goal ended, or "" if it has not."""
        if self.result is not None:
            return self.result
        is_end = self.message == REACHED or self.message in FAILURES
        return self.message if is_end else ""


class GoalSequence:
    """Decides which goal is next and when one has ended; knows no clock, no topic.

    Args:
        goals: what to begin with, (x, y) in metres.
        timeout_ns: time for each goal, 0 for ever.
        stop_on_failure: skip what is left after a goal that was not reached.
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
        self._heard = PlannerReport("", "")
        self._before_goal = self._heard
        self._place: Point | None = None
        self._active: Point | None = None
        self._began_ns = 0
        self._path_length = 0.0
        self.outcomes: list[GoalOutcome] = []
        for goal in goals:
            self.add(*goal)

    @property
    def active(self) -> Point | None:
        """The goal under way, if any."""
        return self._active

    @property
    def done(self) -> bool:
        """Whether every goal has its outcome."""
        return self._active is None and not self._pending

    @property
    def total(self) -> int:
        """How many goals there are, ended ones included."""
        return len(self.outcomes) + len(self._pending) + (self._active is not None)

    def add(self, x: float, y: float) -> None:
        """One more goal after the others.

        Raises:
            InvalidValueError: not finite.
        """
        if not (math.isfinite(x) and math.isfinite(y)):
            raise InvalidValueError(f"goal ({x}, {y}): wanted finite metres")
        self._pending.append((float(x), float(y)))

    def start_next(self, now_ns: int) -> Point | None:
        """Begin the next goal and return it; None while one is under way or none is."""
        if self._active is not None or not self._pending:
            return None
        self._active = self._pending.popleft()
        self._before_goal = self._heard
        self._began_ns = now_ns
        self._path_length = 0.0
        return self._active

    def move(self, x: float, y: float) -> None:
        """The robot is now at (x, y), metres, map."""
        if self._place is not None:
            self._path_length += math.dist(self._place, (x, y))
        self._place = (x, y)

    def hear(self, report: PlannerReport, now_ns: int) -> None:
        """The planner reports; ends the active goal if it is the last word on it.

        What was said last before the goal was sent, and is repeated, concerns an
        earlier goal: a report counts from the first that differs.
        """
        self._heard = report
        if self._active is None or self._is_old(report):
            return
        self._before_goal = PlannerReport("", "")
        if report.end:
            self._end(report.end, now_ns)

    def check(self, now_ns: int) -> None:
        """End the active goal if its time is over."""
        if self._active is None or not self.timeout_ns:
            return
        if now_ns - self._began_ns >= self.timeout_ns:
            self._end(TIMED_OUT, now_ns)

    def unfinished(self, now_ns: int) -> list[GoalOutcome]:
        """How the goals stand that have not ended: the one under way, then the rest."""
        standing = [
            GoalOutcome(goal, UNFINISHED, 0.0, 0.0, self._distance_to(goal))
            for goal in self._pending
        ]
        if self._active is not None:
            standing.insert(0, self._outcome(self._active, UNFINISHED, now_ns))
        return standing

    def _is_old(self, report: PlannerReport) -> bool:
        before = self._before_goal
        if before.goal_id:
            return report.goal_id == before.goal_id
        return bool(before.message) and report == before

    def _end(self, result: str, now_ns: int) -> None:
        goal = self._active
        assert goal is not None, "only an active goal ends"
        self.outcomes.append(self._outcome(goal, result, now_ns))
        self._active = None
        if result != REACHED and self.stop_on_failure:
            while self._pending:
                skipped = self._pending.popleft()
                self.outcomes.append(GoalOutcome(skipped, SKIPPED, 0.0, 0.0, math.inf))

    def _outcome(self, goal: Point, result: str, now_ns: int) -> GoalOutcome:
        seconds = (now_ns - self._began_ns) / 1e9
        left = self._distance_to(goal)
        return GoalOutcome(goal, result, seconds, self._path_length, left)

    def _distance_to(self, goal: Point) -> float:
        return math.dist(self._place, goal) if self._place else math.inf
