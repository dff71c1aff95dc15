"""How long to wait for progress, and when to give up."""

from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.reports import RobotState

# At rest for this long near the goal counts as arrived; a pause between two pieces
# of a path is shorter.
_REST_NS = 1_000_000_000


class Patience:
    """Clocks of one goal, in nanoseconds of the node's clock."""

    def __init__(self, params: PlannerParams) -> None:
        self.configure(params)
        self.begin(0)

    def configure(self, params: PlannerParams) -> None:
        """Take new limits; the clocks run on."""
        self._timeout_ns = round(params.progress_timeout_s * 1e9)
        self._goal_timeout_ns = round(params.goal_timeout_s * 1e9)
        self._step_m = params.progress_distance_m
        self._attempts = params.max_stuck_replans

    def begin(self, now_ns: int) -> None:
        """A new goal."""
        self._since_ns = self._goal_since_ns = now_ns
        self._resting_since_ns: int | None = None
        self._mark_m = 0.0
        #: Attempts used up since the last progress.
        self.spent = 0

    def new_path(self) -> None:
        """Progress is counted from the new path's start; the clock runs on."""
        self._mark_m = 0.0

    def note(self, covered_m: float, now_ns: int) -> None:
        """Take how much of the path lies behind the robot."""
        if covered_m >= self._mark_m + self._step_m:
            self._mark_m, self._since_ns, self.spent = covered_m, now_ns, 0

    def no_progress(self, now_ns: int) -> bool:
        """Whether the time for a bit of progress is over; starts it anew if so."""
        if now_ns - self._since_ns < self._timeout_ns:
            return False
        self._since_ns = now_ns
        self.spent += 1
        return True

    def spend(self) -> None:
        """Count a plan that failed."""
        self.spent += 1

    @property
    def exhausted(self) -> bool:
        """Whether all attempts without progress are used up."""
        return self.spent > self._attempts

    def goal_timed_out(self, now_ns: int) -> bool:
        """Whether the goal has taken too long."""
        limit = self._goal_timeout_ns
        return 0 < limit <= now_ns - self._goal_since_ns

    def rests(self, robot: RobotState, now_ns: int) -> bool:
        """Whether the robot has stood still for a while."""
        if not robot.stands:
            self._resting_since_ns = None
        elif self._resting_since_ns is None:
            self._resting_since_ns = now_ns
        since = self._resting_since_ns
        return since is not None and now_ns - since >= _REST_NS
