"""Named states of the controller, as published."""

from enum import StrEnum


class ControlState(StrEnum):
    """Activity of the controller, or the reason why the robot is stopped."""

    IDLE = "idle"
    FOLLOWING = "following"
    TURNING = "turning"
    PAUSED = "paused"
    REACHED = "reached"
    MISSED_GOAL = "missed_goal"
    BLOCKED = "blocked"
    STALLED = "stalled"
    OFF_PATH = "off_path"
    STALE_ODOMETRY = "stale_odometry"
    STALE_COSTMAP = "stale_costmap"
    STALE_PATH = "stale_path"
    INVALID_PATH = "invalid_path"
    UNKNOWN_FRAME = "unknown_frame"
    COMMAND_NOT_FINITE = "command_not_finite"
    COMMAND_OVER_LIMIT = "command_over_limit"
    METHOD_FAILED = "method_failed"
    """A user's controller raised, or returned something else than a command."""

    @property
    def moves(self) -> bool:
        """Whether the robot is driving along a path."""
        return self in (ControlState.FOLLOWING, ControlState.TURNING)

    @property
    def rests(self) -> bool:
        """Whether the controller waits for a new path."""
        return self in _RESTING


_RESTING = (
    ControlState.IDLE,
    ControlState.REACHED,
    ControlState.MISSED_GOAL,
    ControlState.INVALID_PATH,
    ControlState.UNKNOWN_FRAME,
    ControlState.METHOD_FAILED,
)


class LimitedBy(StrEnum):
    """What keeps a moving robot below its cruise speed, as published."""

    NONE = ""
    ACCELERATION = "acceleration"
    BEND = "bend"
    CLEARANCE = "clearance"
    COLLISION_CHECK = "collision_check"
    HEADING = "heading_error"
    LATE_DATA = "late_data"
    PATH_END = "path_end"
