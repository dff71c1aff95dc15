"""States of a goal and the events that change them.

https://design.ros2.org/articles/actions.html, "Goal States".
"""

from enum import Enum

from navette.msgs.action_msgs.msg import GoalStatus
from navette.runtime.exceptions import RCLError


class GoalResponse(Enum):
    """Return value of a goal callback."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """Return value of a cancel callback."""

    REJECT = 1
    ACCEPT = 2


class GoalEvent(Enum):
    """Event that changes a goal's state; values as in rcl_action."""

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
    """Return the status after ``event``.

    Raises:
        RCLError: the event is invalid in that state; lists the valid events.
    """
    allowed = _TRANSITIONS.get(status, {})
    if event not in allowed:
        listed = ", ".join(each.name for each in allowed) or "none"
        raise RCLError(
            f"event {event.name} is invalid for a goal in state "
            f"{STATUS_NAMES[status]}; valid events: {listed}"
        )
    return allowed[event]


def is_active(status: int) -> bool:
    """Return whether the status is not terminal."""
    return status in _TRANSITIONS


def is_cancelable(status: int) -> bool:
    """Return whether a goal with this status can be cancelled."""
    return GoalEvent.CANCEL_GOAL in _TRANSITIONS.get(status, {})
