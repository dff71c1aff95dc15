"""Servers of actions."""

from navette.runtime import Future, QoSProfile
from navette.runtime.action.goal_states import CancelResponse, GoalEvent, GoalResponse
from navette.runtime.action.server import (
    ActionServer,
    default_cancel_callback,
    default_goal_callback,
    default_handle_accepted_callback,
)
from navette.runtime.action.server_goal_handle import ServerGoalHandle
from navette.runtime.exceptions import RCLError
from navette.runtime.executor import await_or_execute
from navette.runtime.qos import (
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from navette.runtime.type_support import check_for_type_support
from navette.runtime.wait_set import NumberOfEntities
from navette.runtime.waitable import Waitable

__all__ = [
    "ActionServer",
    "CancelResponse",
    "Future",
    "GoalEvent",
    "GoalResponse",
    "NumberOfEntities",
    "QoSProfile",
    "RCLError",
    "ServerGoalHandle",
    "Waitable",
    "await_or_execute",
    "check_for_type_support",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
    "qos_profile_action_status_default",
    "qos_profile_services_default",
]
