"""Timeouts of one goal: progress, attempts, rest at the goal."""

import math

from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.reports import RobotMotion

# Rest near the goal that counts as arrived; a pause between two pieces of a path is
# shorter.
_REST_NS = 1_000_000_000
# A robot that comes no farther (m) than this between its attempts is still stuck, even
# if it drives to and from the place along one new path after another.
_SAME_PLACE_M = 0.5


class ProgressChecker:
    """Checks progress towards one goal, in the time of the node's clock."""

    def __init__(self, params: PlannerParams) -> None:
        self.configure(params)
        self.begin(0)

    def configure(self, params: PlannerParams) -> None:
        """Replace the limits; the timers continue."""
        self._timeout_ns = round(params.progress_timeout_s * 1e9)
        self._goal_timeout_ns = round(params.goal_timeout_s * 1e9)
        self._step_m = params.progress_distance_m
        self._attempts = params.max_stuck_replans

    def begin(self, now_ns: int) -> None:
        """Start the timers of a new goal."""
        self._since_ns = self._goal_since_ns = now_ns
        self._resting_since_ns: int | None = None
        self._mark_m = 0.0
        self._place = (math.inf, math.inf)
        #: Attempts used up since the robot left the place of the first of them.
        self.spent = 0

    def skip(self, span_ns: int) -> None:
        """Leave a span of time out of account."""
        self._since_ns += span_ns
        self._goal_since_ns += span_ns
        self._resting_since_ns = None

    def new_path(self, covered_m: float) -> None:
        """Count progress from ``covered_m`` of a new path; the timers continue."""
        self._mark_m = covered_m

    def note(self, covered_m: float, here: tuple[float, float], now_ns: int) -> None:
        """Update the distance covered along the path (m) and the position (m, map)."""
        if self.spent == 0:
            self._place = here
        if covered_m >= self._mark_m + self._step_m:
            self._mark_m, self._since_ns = covered_m, now_ns
            if math.dist(here, self._place) > _SAME_PLACE_M:
                self.spent = 0

    def no_progress(self, now_ns: int) -> bool:
        """Return whether the progress timeout expired; if so, count it and restart."""
        if now_ns - self._since_ns < self._timeout_ns:
            return False
        self._since_ns = now_ns
        self.spent += 1
        return True

    def spend(self) -> None:
        """Count a failed plan."""
        self.spent += 1

    @property
    def exhausted(self) -> bool:
        """Whether all attempts without progress are used."""
        return self.spent > self._attempts

    def goal_timed_out(self, now_ns: int) -> bool:
        """Return whether the goal timeout expired."""
        limit = self._goal_timeout_ns
        return 0 < limit <= now_ns - self._goal_since_ns

    def rests(self, robot: RobotMotion, now_ns: int) -> bool:
        """Return whether the robot has been stationary for a second."""
        if not robot.is_stationary:
            self._resting_since_ns = None
        elif self._resting_since_ns is None:
            self._resting_since_ns = now_ns
        since = self._resting_since_ns
        return since is not None and now_ns - since >= _REST_NS
