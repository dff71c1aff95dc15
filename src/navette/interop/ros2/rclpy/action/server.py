"""Servers of actions."""

from navette.runtime.action.goal_states import CancelResponse, GoalEvent, GoalResponse
from navette.runtime.action.server import (
    ActionServer,
    default_cancel_callback,
    default_goal_callback,
    default_handle_accepted_callback,
)
from navette.runtime.action.server_goal_handle import ServerGoalHandle

__all__ = [
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalResponse",
    "ServerGoalHandle",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]
