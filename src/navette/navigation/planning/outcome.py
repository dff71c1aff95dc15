"""Named results of planning and of driving to a goal."""

from enum import StrEnum


class Outcome(StrEnum):
    """Published results; ``ok`` and ``goal_snapped`` come with a path."""

    OK = "ok"
    GOAL_SNAPPED = "goal_snapped"
    """The goal is not reachable; the path ends near it, within the tolerance."""

    START_BLOCKED = "start_blocked"
    START_OUTSIDE_MAP = "start_outside_map"
    GOAL_BLOCKED = "goal_blocked"
    GOAL_OUTSIDE_MAP = "goal_outside_map"
    GOAL_NOT_FINITE = "goal_not_finite"
    GOAL_ORIENTATION_INVALID = "goal_orientation_invalid"
    """The goal's quaternion is not of norm 1."""

    GOAL_STAMP_INVALID = "goal_stamp_invalid"
    UNKNOWN_FRAME = "unknown_frame"
    NO_PATH = "no_path"
    """No cells connect start and goal, or the footprint does not fit along any path."""

    SEARCH_LIMIT = "search_limit"
    """The search with headings exhausted its budget."""

    METHOD_FAILED = "method_failed"
    """A user's planner or controller raised, or returned something else."""

    TIMED_OUT = "timed_out"
    STUCK = "stuck"
    STALE_ODOMETRY = "stale_odometry"
    LOST = "lost"
    """Localization reports that the pose is not known."""

    CANCELED = "canceled"

    @property
    def has_path(self) -> bool:
        return self in (Outcome.OK, Outcome.GOAL_SNAPPED)
