"""What became of a request to plan or of a drive to a goal: named results."""

from enum import StrEnum


class Outcome(StrEnum):
    """Results on the wire; ``ok`` and ``goal_snapped`` come with a path."""

    OK = "ok"
    GOAL_SNAPPED = "goal_snapped"
    """The goal itself cannot be reached; the path ends near it, within tolerance."""

    START_BLOCKED = "start_blocked"
    START_OUTSIDE_MAP = "start_outside_map"
    GOAL_BLOCKED = "goal_blocked"
    GOAL_OUTSIDE_MAP = "goal_outside_map"
    GOAL_NOT_FINITE = "goal_not_finite"
    UNKNOWN_FRAME = "unknown_frame"
    NO_PATH = "no_path"
    """Cells connect start and goal nowhere, or the body fits through nowhere."""

    SEARCH_LIMIT = "search_limit"
    """The search with headings ran out of its budget."""

    TIMED_OUT = "timed_out"
    STUCK = "stuck"
    STALE_ODOMETRY = "stale_odometry"

    @property
    def has_path(self) -> bool:
        return self in (Outcome.OK, Outcome.GOAL_SNAPPED)
