"""The states of a goal, and which event leads from which to which.

https://design.ros2.org/articles/actions.html, "Goal States".
"""

from enum import Enum

from navette.msgs.action_msgs.msg import GoalStatus
from navette.runtime.exceptions import RCLError


class GoalResponse(Enum):
    """What a goal callback says."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """What a cancel callback says."""

    REJECT = 1
    ACCEPT = 2


class GoalEvent(Enum):
    """What happens to a goal; values as in rcl_action."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


STATUS_NAMES: dict[int, str] = {
    GoalStatus.STATUS_UNKNOWN: "UNKNOWN",
    GoalStatus.STATUS_ACCEPTED: "ACCEPTED",
    GoalStatus.STATUS_EXECUTING: "EXECUTING",
    GoalStatus.STATUS_CANCELING: "CANCELING",
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}

_TRANSITIONS: dict[int, dict[GoalEvent, int]] = {
    GoalStatus.STATUS_ACCEPTED: {
        GoalEvent.EXECUTE: GoalStatus.STATUS_EXECUTING,
        GoalEvent.CANCEL_GOAL: GoalStatus.STATUS_CANCELING,
    },
    GoalStatus.STATUS_EXECUTING: {
        GoalEvent.CANCEL_GOAL: GoalStatus.STATUS_CANCELING,
        GoalEvent.SUCCEED: GoalStatus.STATUS_SUCCEEDED,
        GoalEvent.ABORT: GoalStatus.STATUS_ABORTED,
    },
    GoalStatus.STATUS_CANCELING: {
        GoalEvent.SUCCEED: GoalStatus.STATUS_SUCCEEDED,
        GoalEvent.ABORT: GoalStatus.STATUS_ABORTED,
        GoalEvent.CANCELED: GoalStatus.STATUS_CANCELED,
    },
}


def next_status(status: int, event: GoalEvent) -> int:
    """The status after ``event``.

    Raises:
        RCLError: the event cannot happen in that state; names those that can.
    """
    allowed = _TRANSITIONS.get(status, {})
    if event not in allowed:
        listed = ", ".join(each.name for each in allowed) or "none"
        raise RCLError(
            f"goal in state {STATUS_NAMES[status]} cannot take the event {event.name}; "
            f"possible: {listed}"
        )
    return allowed[event]


def is_active(status: int) -> bool:
    """Whether the goal has not ended."""
    return status in _TRANSITIONS


def is_cancelable(status: int) -> bool:
    """Whether it may still be asked to cancel."""
    return GoalEvent.CANCEL_GOAL in _TRANSITIONS.get(status, {})
